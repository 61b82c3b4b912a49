//! χ² of every sampling routine against its own density, run on the adapter.
//!
//! A sampler maps to a chart [0, 1)²: (height, azimuth) for directions, where the sphere is uniform with density 1; barycentrics for
//! triangles. One pass draws and stores the bin of each sample, another integrates the density over each bin.

use aquifer_lab::stats::{chi_square::goodness_of_fit, multiple::sidak};
use aquifer_tests::{Kept, Parts, context, scene};

const SIDE: usize = 48;

const DRAW: &str = "
import package::base::rng::{rng_begin, rng_bits};
import package::slot::sampler::{draw};
/// @extent fixed 1048576
@group(1) @binding(0) var<storage, read_write> bins: array<u32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&bins)) { return; }
    var rng = rng_begin(vec2<u32>(17u, 4u), id.xy, 0u, 0u);
    let chart = draw(rng_bits(&rng));
    // Below the horizon: lost, in a bin of its own.
    if (chart.x < 0.0) {
        bins[id.x] = 48u * 48u;
        return;
    }
    let bin = min(vec2<u32>(chart * 48.0), vec2<u32>(47u));
    bins[id.x] = bin.y * 48u + bin.x;
}
";

const INTEGRATE: &str = "
import package::slot::sampler::{density};
/// @extent fixed 2304
@group(1) @binding(0) var<storage, read_write> expected: array<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= 2304u) { return; }
    let corner = vec2<f32>(f32(id.x % 48u), f32(id.x / 48u));
    var sum = 0.0;
    for (var i = 0u; i < 64u * 64u; i++) {
        sum += density((corner + (vec2<f32>(f32(i % 64u), f32(i / 64u)) + 0.5) / 64.0) / 48.0);
    }
    expected[id.x] = sum / (64.0 * 64.0 * 48.0 * 48.0);
}
";

const CHART: &str = "
const TAU: f32 = 6.283185307;
const FOUR_PI: f32 = 12.566370614;
fn unit(bits: vec4<u32>) -> vec4<f32> { return vec4<f32>(bits >> vec4<u32>(8u)) * 5.9604644775390625e-8; }
fn chart_of(d: vec3<f32>) -> vec2<f32> { return vec2<f32>(0.5 + 0.5 * d.z, fract(atan2(d.y, d.x) / TAU + 1.0)); }
fn direction_of(c: vec2<f32>) -> vec3<f32> {
    let z = 2.0 * c.x - 1.0;
    let r = sqrt(max(0.0, 1.0 - z * z));
    return vec3<f32>(r * cos(TAU * c.y), r * sin(TAU * c.y), z);
}
";

/// Draws and integrates; the p-value that both agree.
fn p_value(name: &str, sampler: &str, on: &str) -> Option<f64> {
    let context = context()?;
    let scene = scene(on);
    let graph = "transport = 'emission'\noutput = 'test_draw.bins'\n[slots]\nsampler = 'it'\n[pass.test_draw]\n[pass.test_integrate]";
    let sampler = format!("import package::sampler::chart::{{FOUR_PI, chart_of, direction_of, unit}};\n{sampler}");
    let shaders = [("pass/test_draw", DRAW), ("pass/test_integrate", INTEGRATE), ("sampler/it", &sampler), ("sampler/chart", CHART)];
    let keep = ["test_integrate.expected"];
    let mut renderer = Parts { shaders: &shaders, keep: &keep, kept: Kept::All, ..Parts::new(&scene, graph) }.renderer(&context);
    renderer.frame().unwrap();
    let bins = renderer.read_f32("test_draw.bins").unwrap();
    let mut observed = vec![0_u64; SIDE * SIDE + 1];
    bins.iter().for_each(|bin| observed[bin.to_bits() as usize] += 1);
    let mut expected: Vec<f64> = renderer.read_f32("test_integrate.expected").unwrap().into_iter().map(f64::from).collect();
    let total: f64 = expected.iter().sum();
    assert!(total <= 1.0 + 2e-3, "{name}: the density integrates to {total}");
    expected.push((1.0 - total).max(0.0));
    // The lost bin takes the error of the integral, which then must be small where nothing can be lost.
    if observed[SIDE * SIDE] == 0 {
        assert!((total - 1.0).abs() <= 2e-3, "{name}: the density integrates to {total}, and no sample is lost");
        expected.pop();
        observed.pop();
        expected.iter_mut().for_each(|value| *value /= total);
    }
    let count = bins.len() as f64;
    expected.iter_mut().for_each(|value| *value *= count);
    Some(goodness_of_fit(&observed, &expected, 0).unwrap_or_else(|error| panic!("{name}: {error}")).p)
}

const BSDF: &str = "
import package::bsdf::{Bsdf, bsdf_pdf, bsdf_sample};
fn it() -> Bsdf { return Bsdf(vec3<f32>(BASE), METALLIC, vec3<f32>(0.04), 1.0, ALPHA); }
fn view() -> vec3<f32> { return vec3<f32>(sqrt(1.0 - COS * COS), 0.0, COS); }
fn draw(bits: vec4<u32>) -> vec2<f32> {
    let s = bsdf_sample(it(), view(), unit(bits).xyz);
    if (s.direction.z <= 0.0) { return vec2<f32>(-1.0); }
    return chart_of(s.direction);
}
fn density(c: vec2<f32>) -> f32 { return FOUR_PI * bsdf_pdf(it(), view(), direction_of(c)); }
";

/// What BSDF rays from `POSITION`, seen from `VIEW`, meet of light `light()`.
const BSDF_RAY: &str = "
import package::base::math::{HUGE};
import package::bsdf::{Bsdf};
import package::frame::frame::{NOW};
import package::scene::geometry::{NONE};
import package::scene::ray::{Hit};
import package::slot::lights::{arrive, light_of, light_point, uv_of};
import package::slot::trace::{closest};
import package::surface::{Surface, ray_from, scatter_pdf, scatter_sample};
fn at() -> Surface {
    var s: Surface;
    s.position = POSITION;
    s.view = normalize(VIEW);
    s.normal = vec3<f32>(0.0, 1.0, 0.0);
    s.geometric = s.normal;
    s.size = 1.0;
    s.bsdf = Bsdf(vec3<f32>(0.5), 0.0, vec3<f32>(0.04), 1.0, 0.3);
    return s;
}
fn draw(bits: vec4<u32>) -> vec2<f32> {
    let drawn = scatter_sample(at(), unit(bits).xyz);
    if (drawn.pdf <= 0.0) { return vec2<f32>(-1.0); }
    let hit = closest(ray_from(at(), drawn.direction), NOW);
    if (light_of(hit) != light()) { return vec2<f32>(-1.0); }
    return chart_of_uv(uv_of(hit, drawn.direction));
}
";

/// Half of Cornell's lamp, by its uv, from where nothing hides it: a ray for each point of the integral would be more rounds of loops than lavapipe
/// runs.
const OF_LAMP: &str = "
const POSITION = vec3<f32>(0.0, 1.5, 0.4);
const VIEW = vec3<f32>(0.3, 1.0, 0.2);
fn light() -> u32 { return 1u; }
fn chart_of_uv(uv: vec2<f32>) -> vec2<f32> { return uv; }
fn density(c: vec2<f32>) -> f32 {
    let arrival = arrive(light_point(light(), c, NOW), at().position);
    return scatter_pdf(at(), arrival.direction) * arrival.jacobian;
}
";

/// The sky, from above everything that could hide it, by the direction that its uv stand for: by uv the density is spikes, as narrow as the texels beside
/// the sun. How density by uv follows from that by direction, the environment's own sampler shows.
const OF_SKY: &str = "
const POSITION = vec3<f32>(0.0, 1000.0, 0.0);
const VIEW = vec3<f32>(0.6, 1.0, 0.2);
fn light() -> u32 { return light_of(Hit(HUGE, NONE, 0u, vec2<f32>(0.0))); }
fn chart_of_uv(uv: vec2<f32>) -> vec2<f32> { return chart_of(light_point(light(), uv, NOW).position); }
fn density(c: vec2<f32>) -> f32 { return FOUR_PI * scatter_pdf(at(), direction_of(c)); }
";

fn samplers() -> Vec<(String, String, &'static str)> {
    let warp = |name: &str, call: &str, pdf: &str, import: &str| {
        let text = format!(
            "import package::base::sampling::{{{import}}};\nfn draw(bits: vec4<u32>) -> vec2<f32> {{ return chart_of({call}(unit(bits).xy)); }}\n\
             fn density(c: vec2<f32>) -> f32 {{ let d = direction_of(c); return FOUR_PI * {pdf}; }}\n"
        );
        (name.to_owned(), text, "cornell")
    };
    let mut all = vec![
        warp("hemisphere", "sample_hemisphere", "select(0.0, pdf_hemisphere(), d.z > 0.0)", "sample_hemisphere, pdf_hemisphere"),
        warp("cosine", "sample_cosine", "pdf_cosine(d.z)", "sample_cosine, pdf_cosine"),
        warp("sphere", "sample_sphere", "(1.0 / FOUR_PI)", "sample_sphere"),
        (
            "triangle".into(),
            "import package::base::sampling::{sample_triangle};\nfn draw(bits: vec4<u32>) -> vec2<f32> { return sample_triangle(unit(bits).xy); }\n\
             fn density(c: vec2<f32>) -> f32 { return select(0.0, 2.0, c.x + c.y < 1.0); }\n"
                .into(),
            "cornell",
        ),
        (
            "environment".into(),
            "import package::scene::environment::{environment_direction, environment_jacobian};\n\
             fn draw(bits: vec4<u32>) -> vec2<f32> { return chart_of(environment_direction(unit(bits).xy)); }\n\
             fn density(c: vec2<f32>) -> f32 { let j = environment_jacobian(direction_of(c)); if (j <= 0.0) { return 0.0; } return FOUR_PI / j; }\n"
                .into(),
            "outdoor",
        ),
    ];
    for (base, metallic, alpha, cos) in
        [(0.8, 0.0, 0.25, 0.9), (0.5, 0.0, 0.04, 0.5), (0.9, 1.0, 0.16, 0.7), (0.9, 1.0, 1.0, 0.2), (0.6, 0.5, 0.5, 0.1)]
    {
        let define = format!(
            "const BASE: f32 = {base:?};\nconst METALLIC: f32 = {metallic:?};\nconst ALPHA: f32 = {alpha:?};\nconst COS: f32 = {cos:?};\n"
        );
        // Imports come first.
        let text = BSDF.replacen("fn it()", &format!("{define}fn it()"), 1);
        all.push((format!("bsdf metallic {metallic} alpha {alpha} cos {cos}"), text, "cornell"));
    }
    all.push(("BSDF rays on a light".into(), format!("{BSDF_RAY}{OF_LAMP}"), "cornell"));
    all.push(("BSDF rays on the sky".into(), format!("{BSDF_RAY}{OF_SKY}"), "outdoor"));
    all
}

#[test]
fn samples_follow_their_densities() {
    let all = samplers();
    // Šidák over the samplers: 1 % for the whole test.
    let alpha = sidak(0.01, all.len());
    for (name, text, on) in &all {
        let Some(p) = p_value(name, text, on) else { return };
        eprintln!("{name}: p = {p:.3}");
        assert!(p > alpha, "{name}: p = {p}");
    }
}

#[test]
fn a_wrong_density_is_found() {
    let wrong = "import package::base::sampling::{sample_cosine};\nfn draw(bits: vec4<u32>) -> vec2<f32> { return chart_of(sample_cosine(unit(bits).xy)); }\n\
        fn density(c: vec2<f32>) -> f32 { let z = direction_of(c).z; return select(0.0, FOUR_PI / 3.14159265 * (0.9 * z + 0.1 * 1.5 * z * z), z > 0.0); }\n";
    let Some(p) = p_value("cosine, 10 % off", wrong, "cornell") else { return };
    assert!(p < 1e-6, "a density that is up to 10 % off passes: p = {p}");
}

/// Lights: how often each is proposed against its stored probability.
#[test]
fn proposals_follow_their_probabilities() {
    const KERNEL: &str = "
import package::base::rng::{rng_begin, rng_bits};
import package::slot::proposal::{propose, weighting_pdf};
struct Drawn { light: u32, weight: f32, pdf: f32, u: f32, v: f32 }
/// @extent fixed 1048576
@group(1) @binding(0) var<storage, read_write> drawn: array<Drawn>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&drawn)) { return; }
    var rng = rng_begin(vec2<u32>(23u, 9u), id.xy, 0u, 0u);
    let c = propose(vec3<f32>(0.0), rng_bits(&rng));
    drawn[id.x] = Drawn(c.light, c.weight, weighting_pdf(c.light, vec3<f32>(0.0)), c.uv.x, c.uv.y);
}
";
    let Some(context) = context() else { return };
    for (proposal, on) in [("power", "many_lights"), ("uniform", "many_lights"), ("power", "sun_room")] {
        let scene = scene(on);
        let graph = format!("transport = 'emission'\noutput = 'test_propose.drawn'\n[slots]\nproposal = '{proposal}'\n[pass.test_propose]");
        let mut renderer = Parts { shaders: &[("pass/test_propose", KERNEL)], ..Parts::new(&scene, &graph) }.renderer(&context);
        renderer.frame().unwrap();
        let words = renderer.read_f32("test_propose.drawn").unwrap();
        let lights = words.chunks_exact(5).map(|drawn| drawn[0].to_bits() as usize).max().unwrap() + 1;
        let (mut observed, mut pdf) = (vec![0_u64; lights], vec![0.0_f64; lights]);
        let mut quarters = [0_u64; 4];
        for drawn in words.chunks_exact(5) {
            let light = drawn[0].to_bits() as usize;
            observed[light] += 1;
            pdf[light] = f64::from(drawn[2]);
            assert!((drawn[1] * drawn[2] - 1.0).abs() < 1e-5, "{proposal}: the weight is 1 / P");
            quarters[usize::from(drawn[3] >= 0.5) + 2 * usize::from(drawn[4] >= 0.5)] += 1;
        }
        let count = (words.len() / 5) as f64;
        // Lights that were never drawn together hold what is left of 1.
        let rest = (1.0 - pdf.iter().sum::<f64>()).max(0.0);
        assert!(rest < 1e-3, "{proposal} on {on}: the probabilities of lights that were drawn sum to {}", 1.0 - rest);
        let expected: Vec<f64> = pdf.iter().map(|p| p * count / (1.0 - rest)).collect();
        let p = goodness_of_fit(&observed, &expected, 0).unwrap().p;
        let even = goodness_of_fit(&quarters, &[count / 4.0; 4], 0).unwrap().p;
        eprintln!("{proposal} on {on}: {lights} lights, p = {p:.3}, uv p = {even:.3}");
        assert!(p > 1e-3 && even > 1e-3, "{proposal} on {on}: p = {p}, uv p = {even}");
    }
}
