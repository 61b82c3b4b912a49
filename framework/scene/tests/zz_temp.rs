//! temporary
use aquifer_scene::*;
use glam::*;
#[test]
fn measure() {
    let n = 724u32;
    let mut mesh = Mesh::default();
    for y in 0..=n { for x in 0..=n {
        let h = ((x as f32)*0.07).sin()*((y as f32)*0.05).cos()*3.0 + ((x*7919+y*104729)%97) as f32*0.01;
        mesh.positions.push(vec3(x as f32*0.1, h, y as f32*0.1)); mesh.normals.push(Vec3::Y);
    }}
    for y in 0..n { for x in 0..n { let a=y*(n+1)+x; mesh.triangles.push([a,a+n+1,a+1]); mesh.triangles.push([a+1,a+n+1,a+n+2]); mesh.materials.extend([0,0]); }}
    let t = mesh.triangles.len();
    let scene = Scene { meshes: vec![mesh], materials: vec![Material::default()], nodes: vec![Node{mesh:Some(0),..Node::default()}], ..Scene::default() };
    for q in [BvhQuality::Fast, BvhQuality::Medium] {
        let start = std::time::Instant::now();
        let s = scene.clone().finish_with(&BvhOptions{max_leaf:4,quality:q}).unwrap();
        let e = start.elapsed();
        let h = blake3::hash(bytemuck::cast_slice(&s.meshes[0].bvh.nodes));
        println!("MEASURE {t} {q:?} {e:?} nodes {} depth {} {}", s.meshes[0].bvh.nodes.len(), s.meshes[0].bvh.depth, h);
        if q == BvhQuality::Medium {
            let m = s.at(0.0, None).unwrap();
            let tl = Tlas::build(&s,&m); let tr = CpuTracer::new(&s,&m,&tl);
            let c = m.camera; let start = std::time::Instant::now(); let mut hits=0;
            for y in 0..256 { for x in 0..256 { hits += tr.closest(c.position(), c.ray([x as f32+0.5,y as f32+0.5],[256,256]), [0.0,f32::INFINITY]).is_some() as u32; }}
            println!("MEASURE rays 65536 hits {hits} {:?}", start.elapsed());
        }
    }
}
