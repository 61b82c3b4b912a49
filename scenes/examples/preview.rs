//! scratch
#![allow(warnings)]
use aquifer_scene::*;
use aquifer_scenes::*;
use aquifer_scenes::build::Random;
use glam::*;
use std::f32::consts::*;

struct Ctx { scene: Scene, moment: Moment, tracer: CpuTracer, emitters: Emitters, list: LightList, env: Option<EnvironmentDistribution> }

fn lin(b: u8) -> f32 { let c = b as f32/255.0; if c <= 0.04045 { c/12.92 } else { ((c+0.055)/1.055).powf(2.4) } }
fn tex(s: &Scene, t: &TextureRef, uv: Vec2) -> Vec4 {
    let im = &s.images[t.image as usize];
    let p = (t.transform * uv.extend(1.0)).truncate();
    let w = |v: f32, m: Wrap| match m { Wrap::Repeat => v - v.floor(), Wrap::Clamp => v.clamp(0.0, 0.9999), Wrap::Mirror => { let a = v.rem_euclid(2.0); if a > 1.0 { 2.0 - a } else { a } } };
    let (u, v) = (w(p.x, t.wrap[0]), w(p.y, t.wrap[1]));
    let x = ((u * im.width as f32) as u32).min(im.width-1); let y = ((v * im.height as f32) as u32).min(im.height-1);
    let c = im.rgba[(y*im.width+x) as usize];
    if im.srgb { vec4(lin(c[0]), lin(c[1]), lin(c[2]), c[3] as f32/255.0) } else { Vec4::from(c.map(|b| b as f32/255.0)) }
}
struct Surf { p: Vec3, ng: Vec3, n: Vec3, base: Vec3, alpha: f32, metal: f32, rough: f32, emit: Vec3, mat: usize, light: Option<u32>, front: bool }
fn surf(c: &Ctx, h: &Hit, o: Vec3, d: Vec3) -> Surf {
    let inst = &c.moment.instances[h.instance as usize]; let mesh = &c.scene.meshes[inst.mesh as usize];
    let t = mesh.triangles[h.triangle as usize]; let [b1, b2] = h.barycentrics; let b0 = 1.0-b1-b2;
    let mi = mesh.materials[h.triangle as usize] as usize; let m = &c.scene.materials[mi];
    let pos = t.map(|i| inst.transform.transform_point3(mesh.positions[i as usize]));
    let mut ng = (pos[1]-pos[0]).cross(pos[2]-pos[0]).normalize();
    if inst.transform.matrix3.determinant() < 0.0 { ng = -ng; }
    let nm = inst.transform.matrix3.inverse().transpose();
    let mut n = (nm * (mesh.normals[t[0] as usize]*b0 + mesh.normals[t[1] as usize]*b1 + mesh.normals[t[2] as usize]*b2)).normalize();
    let uv = if mesh.uvs[0].is_empty() { Vec2::ZERO } else { mesh.uvs[0][t[0] as usize]*b0 + mesh.uvs[0][t[1] as usize]*b1 + mesh.uvs[0][t[2] as usize]*b2 };
    let mut base = m.base_color;
    if let Some(r) = &m.base_color_texture { base *= tex(&c.scene, r, uv); }
    if !mesh.colors.is_empty() { base *= mesh.colors[t[0] as usize]*b0 + mesh.colors[t[1] as usize]*b1 + mesh.colors[t[2] as usize]*b2; }
    let (mut metal, mut rough) = (m.metallic, m.roughness);
    if let Some(r) = &m.metallic_roughness_texture { let x = tex(&c.scene, r, uv); rough *= x.y; metal *= x.z; }
    if let (Some(r), false) = (&m.normal_texture, mesh.tangents.is_empty()) {
        let x = tex(&c.scene, r, uv).truncate()*2.0-1.0;
        let tg = mesh.tangents[t[0] as usize]; let tv = (inst.transform.matrix3 * tg.truncate()).normalize();
        let tv = (tv - n*n.dot(tv)).normalize();
        n = (tv*x.x + n.cross(tv)*tg.w*x.y + n*x.z).normalize();
    }
    let mut emit = m.emission; if let Some(r) = &m.emission_texture { emit *= tex(&c.scene, r, uv).truncate(); }
    let front = ng.dot(d) < 0.0;
    if !front { ng = -ng; n = -n; if !m.double_sided { emit = Vec3::ZERO; } }
    if m.unlit { emit = base.truncate(); }
    let alpha = match m.alpha { Alpha::Opaque => 1.0, Alpha::Mask { cutoff } => if base.w < cutoff {0.0} else {1.0}, Alpha::Blend => base.w };
    Surf { p: o + d*h.t, ng, n, base: base.truncate(), alpha, metal, rough, emit, mat: mi, light: c.list.of_hit(&c.emitters, h.instance, inst.mesh, h.triangle), front }
}
fn hit(c: &Ctx, o: Vec3, d: Vec3, r: &mut Random, tmax: f32) -> Option<Surf> {
    let mut o = o; let mut left = tmax;
    for _ in 0..64 {
        let h = c.tracer.closest(o, d, [0.0, left])?;
        let s = surf(c, &h, o, d);
        if s.alpha >= 1.0 || r.unit() < s.alpha { return Some(s); }
        o = s.p + d * 1e-4 * (1.0 + s.p.abs().max_element()); left -= h.t;
    }
    None
}
fn envl(c: &Ctx, d: Vec3) -> Vec3 { match &c.scene.environment { None => Vec3::ZERO, Some(e) => { let [u,v] = Environment::uv(d); let x = ((u*e.width as f32) as u32).min(e.width-1); let y = ((v*e.height as f32) as u32).min(e.height-1); e.radiance[(y*e.width+x) as usize].into() } } }
fn frame(n: Vec3) -> (Vec3, Vec3) { n.any_orthonormal_pair() }
fn fresnel(s: &Surf, m: &Material, cos: f32) -> Vec3 {
    let f0 = if m.specular == 0.0 { Vec3::ZERO } else { Vec3::splat(0.04) };
    let f0 = f0.lerp(s.base, s.metal); let f90 = if m.specular == 0.0 && s.metal == 0.0 {0.0} else {1.0};
    f0 + (f90 - f0) * (1.0-cos).clamp(0.0,1.0).powi(5)
}
// returns brdf*cos
fn eval(c: &Ctx, s: &Surf, v: Vec3, l: Vec3) -> Vec3 {
    let nl = s.n.dot(l); let nv = s.n.dot(v).max(1e-3); if nl <= 0.0 || s.ng.dot(l) <= 0.0 { return Vec3::ZERO; }
    let h = (l+v).normalize(); let a = (s.rough*s.rough).max(1e-3); let a2=a*a;
    let nh = s.n.dot(h); let d = a2/(PI*(nh*nh*(a2-1.0)+1.0).powi(2));
    let vis = 0.5/(nl*(nv*nv*(1.0-a2)+a2).sqrt() + nv*(nl*nl*(1.0-a2)+a2).sqrt());
    let f = fresnel(s, &c.scene.materials[s.mat], v.dot(h));
    ((1.0-f.max_element())*s.base*(1.0-s.metal)/PI + f*d*vis)*nl
}
fn pdf(s: &Surf, v: Vec3, l: Vec3) -> f32 {
    let h=(l+v).normalize(); let a=(s.rough*s.rough).max(1e-3); let a2=a*a; let nh=s.n.dot(h).max(0.0);
    let d = a2/(PI*(nh*nh*(a2-1.0)+1.0).powi(2));
    0.5*s.n.dot(l).max(0.0)/PI + 0.5*d*nh/(4.0*v.dot(h).abs().max(1e-4))
}
fn radiance(c: &Ctx, mut o: Vec3, mut d: Vec3, r: &mut Random) -> Vec3 {
    let mut l = Vec3::ZERO; let mut t = Vec3::ONE; let mut bp = f32::INFINITY;
    for depth in 0..7 {
        let Some(s) = hit(c, o, d, r, 1e30) else {
            let e = envl(c, d);
            if e != Vec3::ZERO { let w = if bp.is_infinite() {1.0} else { let env=c.env.as_ref().unwrap(); let lp = env.pdf(d) * c.list.table.entries.last().unwrap().pmf; bp/(bp+lp) }; l += t*e*w; }
            break };
        if s.emit != Vec3::ZERO {
            let w = if bp.is_infinite() || s.light.is_none() {1.0} else {
                let li = s.light.unwrap() as usize; let Light::Triangle(tr) = c.list.lights[li] else {panic!()};
                let inst=&c.moment.instances[tr.instance as usize]; let q=c.scene.meshes[inst.mesh as usize].corners(tr.triangle as usize).map(|p| inst.transform.transform_point3(p));
                let area=0.5*(q[1]-q[0]).cross(q[2]-q[0]).length();
                let lp=c.list.table.entries[li].pmf/area*(s.p-o).length_squared()/s.ng.dot(d).abs().max(1e-6); bp/(bp+lp) };
            l += t*s.emit*w; if c.scene.materials[s.mat].unlit { break; }
        }
        let v=-d; let eps=1e-4*(1.0+s.p.abs().max_element()*0.2);
        let po = s.p + s.ng*eps;
        // nee
        if let Some(li) = c.list.table.sample(r.unit(), r.unit()) {
            let pm=c.list.table.entries[li as usize].pmf;
            let (dir, dist, e, lp, delta) = match c.list.lights[li as usize] {
                Light::Triangle(tr) => {
                    let inst=&c.moment.instances[tr.instance as usize]; let q=c.scene.meshes[inst.mesh as usize].corners(tr.triangle as usize).map(|p| inst.transform.transform_point3(p));
                    let (mut a,mut b)=(r.unit(),r.unit()); if a+b>1.0 {a=1.0-a;b=1.0-b;}
                    let p=q[0]+(q[1]-q[0])*a+(q[2]-q[0])*b; let dv=p-po; let dist=dv.length(); let dir=dv/dist;
                    let area=0.5*(q[1]-q[0]).cross(q[2]-q[0]).length();
                    let h=Hit{t:dist,instance:tr.instance,triangle:tr.triangle,barycentrics:[a,b]};
                    let ls=surf(c,&h,po,dir); let cos=ls.ng.dot(dir).abs();
                    (dir,dist*(1.0-1e-3),ls.emit,pm/area*dist*dist/cos.max(1e-6),false)
                }
                Light::Punctual(i) => { let pl=&c.moment.lights[i as usize]; let k=&c.scene.lights[pl.light as usize];
                    match k.shape { PunctualShape::Directional => (-pl.direction,1e30,k.intensity,pm,true),
                        PunctualShape::Point => { let dv=pl.position-po; let dist=dv.length(); (dv/dist,dist,k.intensity/(dist*dist),pm,true)},
                        PunctualShape::Spot{inner,outer} => { let dv=pl.position-po; let dist=dv.length(); let dir=dv/dist; let cs=(-dir).dot(pl.direction); let f=((cs-outer.cos())/(inner.cos()-outer.cos())).clamp(0.0,1.0); (dir,dist,k.intensity*f*f/(dist*dist),pm,true)} } }
                Light::Environment => { let env=c.env.as_ref().unwrap(); let dir=env.sample([r.unit(),r.unit(),r.unit(),r.unit()]).unwrap(); (dir,1e30,envl(c,dir),pm*env.pdf(dir),false)}
            };
            if e != Vec3::ZERO && s.ng.dot(dir)>0.0 {
                let f=eval(c,&s,v,dir);
                if f != Vec3::ZERO && hit(c,po,dir,r,dist).is_none() { let w = if delta {1.0} else { let b=pdf(&s,v,dir); lp/(lp+b)}; l += t*f*e*w/lp; }
            }
        }
        let (tx,ty)=frame(s.n);
        let dir = if r.unit()<0.5 { let u=r.in_disk(); (tx*u.x+ty*u.y+s.n*(1.0-u.length_squared()).max(0.0).sqrt()).normalize() }
        else { let a=(s.rough*s.rough).max(1e-3); let x=r.unit(); let ct=((1.0-x)/(x*(a*a-1.0)+1.0)).sqrt(); let st=(1.0-ct*ct).max(0.0).sqrt(); let ph=TAU*r.unit(); let h=(tx*st*ph.cos()+ty*st*ph.sin()+s.n*ct).normalize(); h*2.0*v.dot(h)-v };
        let f=eval(c,&s,v,dir); if f==Vec3::ZERO {break;} bp=pdf(&s,v,dir); t*=f/bp;
        if depth>2 { let q=t.max_element().min(0.95); if r.unit()>q {break;} t/=q; }
        o=po; d=dir;
    }
    l
}
fn main() {
    let a: Vec<String>=std::env::args().collect();
    let (name,w,spp)=(&a[1],a[2].parse::<u32>().unwrap(),a[3].parse::<u32>().unwrap());
    let cam=a.get(4).filter(|s| *s!="-").map(|s| s.as_str()); let time: f32=a.get(5).map_or(0.0,|s| s.parse().unwrap());
    let t0=std::time::Instant::now();
    let scene=(by_name(name).unwrap().make)(); let t1=t0.elapsed();
    let scene=scene.finish().unwrap(); let t2=t0.elapsed();
    for x in &scene.warnings { println!("WARN {x}"); }
    println!("{name}: made {:?} finished {:?} tris {}", t1, t2, scene.meshes.iter().map(|m| m.triangles.len()).sum::<usize>());
    let moment=scene.at(time,cam).unwrap(); let tlas=Tlas::build(&scene,&moment); let tracer=CpuTracer::new(&scene,&moment,&tlas);
    let emitters=Emitters::find(&scene); let env=scene.environment.as_ref().map(EnvironmentDistribution::new);
    let list=LightList::build(&scene,&emitters,env.as_ref(),&moment,&tlas);
    println!("lights {} bounds {:?}", list.lights.len(), tlas.bounds().map(|b| (b.min,b.max)));
    let c=Ctx{scene,moment,tracer,emitters,list,env}; let h=w*9/16;
    let rows: Vec<std::sync::Mutex<Vec<Vec3>>>=(0..h).map(|_| Default::default()).collect(); let next=std::sync::atomic::AtomicU32::new(0);
    std::thread::scope(|sc| for _ in 0..2 { sc.spawn(|| loop { let y=next.fetch_add(1,std::sync::atomic::Ordering::Relaxed); if y>=h {break;}
        let mut r=Random::new(y as u64*7919+1); let mut out=vec![];
        for x in 0..w { let mut sum=Vec3::ZERO; for _ in 0..spp { let d=c.moment.camera.ray([x as f32+r.unit(),y as f32+r.unit()],[w,h]); let l=radiance(&c,c.moment.camera.position(),d,&mut r); if l.is_finite() { sum+=l.min(Vec3::splat(20.0)); } else { eprintln!("nan"); } } out.push(sum/spp as f32); }
        *rows[y as usize].lock().unwrap()=out; }); });
    let px: Vec<Vec3>=rows.into_iter().flat_map(|m| m.into_inner().unwrap()).collect();
    let mut lum: Vec<f32>=px.iter().map(|p| p.dot(vec3(0.2126,0.7152,0.0722))).collect(); let mean=lum.iter().sum::<f32>()/lum.len() as f32; lum.sort_by(f32::total_cmp);
    println!("mean {mean:.3} p10 {:.3} p50 {:.3} p90 {:.3} p99 {:.3} total {:?}", lum[lum.len()/10], lum[lum.len()/2], lum[lum.len()*9/10], lum[lum.len()*99/100], t0.elapsed());
    let mut img=image::RgbImage::new(w,h);
    for (i,p) in px.iter().enumerate() { let e=p.to_array().map(|c| { let c=c.clamp(0.0,1.0); ((if c<=0.0031308 {c*12.92} else {1.055*c.powf(1.0/2.4)-0.055})*255.0+0.5) as u8}); img.put_pixel(i as u32%w,i as u32/w,image::Rgb(e)); }
    img.save(format!("/tmp/preview/{name}{}{}.png", cam.map_or(String::new(),|c| format!("_{c}")), if time>0.0 {format!("_{time}")} else {String::new()})).unwrap();
}
