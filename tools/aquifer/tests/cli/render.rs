//! `aquifer render`: needs an adapter, and skips (or, with AQUIFER_REQUIRE_ADAPTER=1, fails) without one.

use crate::{
    dark_triangle::dark_triangle,
    run::{Run, aquifer, aquifer_with, names},
};
use aquifer_lab::film::Film;
use std::{
    path::Path,
    process::{Command, Stdio},
};

/// Is there an adapter? Says so when a test is skipped for want of one.
fn adapter() -> bool {
    let found = !aquifer_render::adapters().is_empty();
    if !found {
        assert!(std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none(), "no adapter was found, and AQUIFER_REQUIRE_ADAPTER is set");
        eprintln!("skipped: no adapter was found");
    }
    found
}

fn render(out: &Path, options: &[&str]) -> Run {
    let out = out.to_string_lossy().into_owned();
    let args = ["render", "path_tracer", "--scene", "cornell", "--size", "16x9", "--transport", "full:2", "-o", &out];
    aquifer(&[&args[..], options].concat())
}

fn assert_close(a: &[[f32; 3]], b: &[[f32; 3]], tolerance: f32) {
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a} {b}");
    }
}

#[test]
fn a_picture_its_numbers_and_what_made_it() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (exr, png) = (folder.path().join("a.exr"), folder.path().join("a.png"));
    let run = render(&exr, &["--frames", "8", "--seed", "7", "--json", "-o", &png.to_string_lossy()]).succeeds();
    let summary: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!((summary["frames"].as_u64(), summary["scene"].as_str()), (Some(8), Some("cornell")));
    assert!(summary["passes"]["passes"].as_array().is_some_and(|passes| passes.len() >= 3), "{summary}");
    let film = Film::read(&exr).expect("it was written");
    assert!(film.color.iter().flatten().all(|x| x.is_finite()) && film.color.iter().flatten().any(|&x| x > 0.0));
    assert!(film.variance.as_ref().is_some_and(|v| v.iter().flatten().any(|&x| x > 0.0)));
    assert_first_surfaces(&film);
    let facts = film.facts.expect("it says what made it");
    assert_eq!((facts.samples_per_pixel, facts.transport.as_str(), facts.camera.as_str()), (8, "full:2", "main"));
    assert!(facts.graph.text.contains("path_tracer.toml"));
    assert_eq!(Film::read(&png).expect("it was written").size, [16, 9]);
    assert_eq!(names(folder.path()), ["a.exr", "a.png"]);
}

/// Asserts that a render of cornell carries what its pixels see: a material of the scene, a unit normal, a depth; or nothing.
fn assert_first_surfaces(film: &Film) {
    let [albedo, normal] = [&film.albedo, &film.normal].map(|plane| plane.as_ref().expect("the graph has a g-buffer"));
    let depth = film.depth.as_ref().expect("the graph has a g-buffer");
    let scene = aquifer_scenes::by_name("cornell").map(|generator| (generator.make)()).expect("a scene");
    let whites = scene.materials.iter().map(|material| material.base_color.truncate());
    let whites: Vec<[f32; 3]> = whites.map(Into::into).collect();
    for (pixel, depth) in depth.iter().enumerate() {
        let near = |a: [f32; 3], b: &[f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
        if depth.is_infinite() {
            assert!(albedo[pixel] == [0.0; 3] && normal[pixel] == [0.0; 3]);
            continue;
        }
        assert!(whites.iter().any(|white| near(albedo[pixel], white)), "no material is {:?}", albedo[pixel]);
        let length = normal[pixel].iter().map(|x| x * x).sum::<f32>();
        assert!((length - 1.0).abs() < 1e-3 && *depth > 0.0, "{:?}, {depth} m", normal[pixel]);
    }
    assert!(depth.iter().filter(|depth| depth.is_finite()).count() > depth.len() / 3, "few surfaces are seen");
}

#[test]
fn equal_seeds_give_equal_bits_and_parts_make_the_whole() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let film = |name: &str, options: &[&str]| {
        render(&at(name), options).succeeds();
        Film::read(&at(name)).expect("it was written")
    };
    let whole = film("whole.exr", &["--frames", "8"]);
    assert_eq!(whole.color, film("again.exr", &["--frames", "8"]).color);
    assert_ne!(whole.color, film("other.exr", &["--frames", "8", "--seed", "1"]).color);
    film("early.exr", &["--frames", "3"]);
    film("late.exr", &["--frames", "5", "--first-frame", "3"]);
    let path = |name: &str| at(name).to_string_lossy().into_owned();
    aquifer(&["merge", &path("early.exr"), &path("late.exr"), "-o", &path("merged.exr")]).succeeds();
    let merged = Film::read(&at("merged.exr")).expect("it was written");
    assert_close(&merged.color, &whole.color, 1e-6);
    assert_close(merged.variance.as_ref().expect("of 8 frames"), whole.variance.as_ref().expect("of 8 frames"), 1e-4);
    assert_eq!(merged.facts.map(|facts| facts.runs), whole.facts.map(|facts| facts.runs));
}

#[test]
fn without_a_mean_the_film_is_the_last_frame() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("a.exr");
    aquifer(&["render", "gbuffer_view", "--size", "16x9", "--frames", "5", "-o", &out.to_string_lossy()]).succeeds();
    let film = Film::read(&out).expect("it was written");
    assert!(film.variance.is_none());
    assert_eq!(film.facts.map(|facts| (facts.samples_per_pixel, facts.runs)), Some((1, aquifer_lab::film::Runs::one(0, 4, 1))));
}

#[test]
fn frames_have_numbers_up_to_the_last() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("a.exr");
    render(&out, &["--first-frame", "4294967290", "--frames", "64"]).fails(1, "they end at 2³²");
    assert!(names(folder.path()).is_empty());
    if !adapter() {
        return;
    }
    for end in [&["--frames", "2"], &["--time", "600"]] {
        let run = render(&out, &[&["--first-frame", "4294967294"], &end[..]].concat()).succeeds();
        assert_eq!(run.err.contains("the render ends before its time"), end[0] == "--time", "{}", run.err);
        let facts = Film::read(&out).expect("it was written").facts.expect("it says what made it");
        assert_eq!(facts.runs, aquifer_lab::film::Runs::one(0, 4_294_967_294, 2));
    }
}

#[test]
fn one_looks_from_points_of_the_world() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    std::fs::write(at("far.gltf"), dark_triangle(5000)).expect("a file");
    let film = |options: &[&str]| {
        let args = ["render", "gbuffer_view", "--scene", &at("far.gltf"), "--size", "16x9", "--frames", "1", "-o", &at("a.exr")];
        aquifer(&[&args[..], options].concat()).succeeds();
        Film::read(Path::new(&at("a.exr"))).expect("it was written")
    };
    let (named, placed) = (film(&[]), film(&["--look", "5000,0,3:5000,0,0"]));
    assert!(named.depth.as_ref().is_some_and(|depth| depth.iter().any(|depth| depth.is_finite())), "the triangle is seen");
    assert_eq!((named.color, named.depth), (placed.color, placed.depth));
    assert_eq!(placed.facts.map(|facts| facts.camera).as_deref(), Some("[5000.0, 0.0, 3.0] looking at [5000.0, 0.0, 0.0]"));
}

#[test]
fn failures_leave_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("a.exr");
    render(&folder.path().join("no/such/a.exr"), &[]).fails(1, "there is no folder");
    render(&out, &["--scene", "cornel"]).fails(2, "cannot be used multiple times");
    render(&out, &["--camera", "nobody"]).fails(1, "nobody");
    render(&out, &["--set", "path_tracer.bounces=3"]).fails(1, "unknown-param");
    render(&out, &["--adapter", "no such adapter"]).fails(1, "adapter");
    render(&out, &["--environment", "gone.hdr"]).fails(1, "gone.hdr");
    let arguments = ["render", "path_tracer", "-o", &out.to_string_lossy()];
    aquifer_with(("VK_DRIVER_FILES", "/nowhere.json"), &arguments).fails(1, "no GPU adapter found");
    if adapter() {
        // A g-buffer of 25 GB: no adapter binds that.
        let large = ["render", "path_tracer", "--size", "20000x20000", "-o", &out.to_string_lossy()];
        aquifer(&large).fails(1, "bytes, but the adapter offers");
    }
    assert!(names(folder.path()).is_empty());
}

/// A program that does not outlive its test.
#[cfg(unix)]
struct Killed(std::process::Child);

#[cfg(unix)]
impl Drop for Killed {
    fn drop(&mut self) {
        // It has ended already when the test went well.
        let _ = self.0.kill();
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_render_writes_what_it_has() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("a.exr");
    let command = Command::new(env!("CARGO_BIN_EXE_aquifer"))
        .args(["render", "path_tracer", "--size", "16x9", "--transport", "direct", "--time", "60", "-o"])
        .arg(&out)
        .stderr(Stdio::piped())
        .spawn();
    let mut child = Killed(command.expect("the program was built with this test"));
    // Listening begins with rendering; a line of progress comes every five seconds and shows that frames are done.
    let stderr = child.0.stderr.take().expect("it is piped");
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(stderr)).map_while(Result::ok);
    assert!(lines.any(|line| line.contains("frames/s")), "no progress was told");
    let interrupted = Command::new("kill").args(["-INT", &child.0.id().to_string()]).status().expect("kill is everywhere");
    assert!(interrupted.success());
    let rest: Vec<String> = lines.collect();
    assert_eq!(child.0.wait().expect("it ends").code(), Some(0), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("interrupted")), "{rest:?}");
    assert!(Film::read(&out).expect("it was written").facts.is_some_and(|facts| facts.runs.frames() > 0));
}

#[test]
fn a_sequence_is_numbered_images_of_what_moves() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let averaging = "extends = 'gbuffer_view.toml'\noutput = 'tonemap.image'\n\
                     [pass.accumulate]\nin.color = 'debug_view.color'\nin.history = 'accumulate.moments@prev'\n\
                     [pass.tonemap]\nin.color = 'accumulate.image'\n";
    let graphs = tempfile::tempdir().expect("a temporary folder");
    let graph = graphs.path().join("graph.toml").to_string_lossy().into_owned();
    std::fs::write(&graph, averaging).expect("a file");
    let sequence = |name: &str, options: &[&str]| {
        let out = at(name).to_string_lossy().into_owned();
        let args = ["render", &graph, "--scene", "animated", "--size", "16x9", "-o", &out];
        aquifer(&[&args[..], options].concat())
    };
    let run = sequence("a.####.exr", &["--frames", "2..5", "--fps", "10", "--json"]).succeeds();
    let summaries: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(summaries.as_array().map(Vec::len), Some(3));
    assert_eq!(names(folder.path()), ["a.0002.exr", "a.0003.exr", "a.0004.exr"]);
    let film = Film::read(&at("a.0003.exr")).expect("it was written");
    let facts = film.facts.expect("it says what made it");
    assert_eq!((facts.animation_time, facts.samples_per_pixel, facts.runs), (0.3, 1, aquifer_lab::film::Runs::one(0, 3, 1)));
    // Each image is its own frame's, and not a mean with those before: rendered alone it is the same.
    let alone = ["--animation-time", "0.3", "--first-frame", "3", "--frames", "1"];
    sequence("alone.exr", &alone).succeeds();
    assert_eq!(film.color, Film::read(&at("alone.exr")).expect("it was written").color);
    // Held, each image is the mean over frames of one moment.
    sequence("held{frame}.exr", &["--frames", "1..3", "--fps", "10", "--hold", "4"]).succeeds();
    let held = Film::read(&at("held0002.exr")).expect("it was written");
    assert!(held.variance.is_some());
    let facts = held.facts.expect("it says what made it");
    assert_eq!((facts.animation_time, facts.samples_per_pixel, facts.runs), (0.2, 4, aquifer_lab::film::Runs::one(0, 8, 4)));
    sequence("b.exr", &["--frames", "0..2"]).fails(1, "b.####.exr");
    sequence("b.#.exr", &["--frames", "0..2", "--time", "3"]).fails(1, "--time");
    sequence("b.#.exr", &["--frames", "2..2"]).fails(2, "the last number is not included");
}

/// A pass of one's own that spoils one pixel.
const SPOILT: &str = "//! Spoils a pixel.
import package::frame::frame::{frame, index_of, inside};
@group(1) @binding(0) var<storage, read> color: array<vec4<f32>>;
@group(1) @binding(1) var<storage, read_write> image: array<vec4<f32>>;
@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    image[at] = select(color[at], vec4<f32>(bitcast<f32>(0x7fc00000u | frame.index)), at == 5u);
}
";

#[test]
fn a_nan_is_told_with_the_pass_that_made_it() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    std::fs::create_dir(at("pass")).and_then(|()| std::fs::write(at("pass/spoil.wgsl"), SPOILT)).expect("a file");
    let graph =
        "extends = \"path_tracer.toml\"\n[pass.spoil]\nin.color = \"path_tracer.color\"\n[pass.accumulate]\nin.color = \"spoil.image\"\n";
    std::fs::write(at("spoilt.toml"), graph).expect("a file");
    let spoilt = ["render", &at("spoilt.toml"), "--shaders", &at(""), "--size", "16x9", "--frames", "3", "--counters", "-o", &at("a.exr")];
    let run = aquifer(&spoilt).succeeds();
    assert!(run.err.contains("first in pass `spoil`"), "{}", run.err);
    assert!(run.err.contains("spoil.image: 3 NaN, 0 infinite"), "{}", run.err);
    let clean = render(Path::new(&at("b.exr")), &["--frames", "3", "--counters"]).succeeds();
    assert!(clean.err.contains("no NaN and no infinity in"), "{}", clean.err);
    render(Path::new(&at("c.exr")), &["--frames", "3"]).succeeds();
    let bits = |name: &str| -> Vec<u32> {
        let film = Film::read(Path::new(&at(name))).expect("it was written");
        film.color.iter().chain(film.variance.iter().flatten()).flatten().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits("b.exr"), bits("c.exr"), "counting changes nothing");
}

#[cfg(unix)]
#[test]
fn a_watched_graph_is_rendered_anew_and_a_broken_one_changes_nothing() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let write = |channel: &str| {
        let text = format!("extends = \"gbuffer_view.toml\"\n[pass.debug_view]\nset.channel = \"{channel}\"\n");
        std::fs::write(at("new.toml"), text).and_then(|()| std::fs::rename(at("new.toml"), at("graph.toml"))).expect("a file");
    };
    write("normal");
    let command = Command::new(env!("CARGO_BIN_EXE_aquifer"))
        .args(["render", &at("graph.toml").to_string_lossy(), "--size", "16x9", "--frames", "1", "--watch", "-o"])
        .arg(at("a.png"))
        .stderr(Stdio::piped())
        .spawn();
    let mut child = Killed(command.expect("the program was built with this test"));
    let stderr = child.0.stderr.take().expect("it is piped");
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(stderr)).map_while(Result::ok);
    let mut told = |words: &str| assert!(lines.any(|line| line.contains(words)), "`{words}` was not told");
    told("wrote");
    let first = std::fs::read(at("a.png")).expect("it was written");
    write("nrmal");
    told("graph.toml:3");
    told("the last good graph stays");
    assert_eq!(first, std::fs::read(at("a.png")).expect("it is still there"));
    write("distance");
    told("wrote");
    assert_ne!(first, std::fs::read(at("a.png")).expect("it was written"));
    let interrupted = Command::new("kill").args(["-INT", &child.0.id().to_string()]).status().expect("kill is everywhere");
    assert!(interrupted.success());
    assert_eq!(child.0.wait().expect("it ends").code(), Some(0));
}

#[test]
fn the_tracer_is_chosen_once_and_named() {
    if !adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let cache = folder.path().to_string_lossy().into_owned();
    let out = folder.path().join("a.exr");
    let path = out.to_string_lossy().into_owned();
    let args = ["render", "path_tracer", "--scene", "cornell", "--size", "16x9", "--frames", "1", "--set", "slots.trace=auto", "-o", &path];
    let chosen = || {
        assert_eq!(aquifer_with(("XDG_CACHE_HOME", &cache), &args).code, 0);
        let text = Film::read(&out).expect("the film").facts.expect("facts").graph.text;
        let (_, chosen) = text.rsplit_once("slots.trace=").expect("the last word on the tracer");
        chosen.trim().to_owned()
    };
    let measured = chosen();
    assert!(["bvh2", "cwbvh"].contains(&measured.as_str()), "{measured}");
    // What is kept has the word, whoever wins today.
    let kept = names(&folder.path().join("aquifer")).into_iter().find(|name| name.starts_with("tracer-")).expect("the choice is kept");
    let kept = folder.path().join("aquifer").join(kept);
    let text = std::fs::read_to_string(&kept).expect("JSON");
    let other = if measured == "bvh2" { "cwbvh" } else { "bvh2" };
    std::fs::write(&kept, text.replace(&format!("\"{measured}\""), &format!("\"{other}\""))).expect("the folder can be written");
    assert_eq!(chosen(), other);
    // Without an adapter at hand it is the default.
    aquifer(&["check", "path_tracer", "--set", "slots.trace=auto"]).succeeds();
}
