//! Parameters, host code, timing, and what happens when something goes wrong.

mod common;

use aquifer_graph::Value;
use aquifer_render::{
    Batch, Clock, Context, ContextOptions, Data, Error, Frame, NoGlobals, Once, Pass, PassError, PassKind, Renderer, RendererOptions,
    run_once,
};
use aquifer_shader::Specialisation;
use common::{TestGlobals, context, library, pixels, plan, registry, render, renderer, small};
use std::time::{Duration, Instant};

const SCALE: &str = "[pass.source]\n[pass.scale]\nin.value = \"source.value\"\n";

#[test]
fn live_parameters_change_between_frames_and_baked_ones_by_plan() {
    let registry = registry(&[]);
    let options = RendererOptions { first_frame: 3, ..small() };
    let mut renderer = renderer(&registry, plan(&registry, "scale.image", SCALE, &[]), options);
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "scale.image")[0], [3.0 * 2.0 + 3.0; 4]);
    renderer.set_param("scale", "gain", Value::F32(10.0)).unwrap();
    renderer.set_param("scale", "offset", Value::U32(1)).unwrap();
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "scale.image")[0], [41.0; 4]);
    assert!(matches!(renderer.set_param("scale", "power", Value::U32(2)), Err(Error::Pass { source: PassError::NotLive { .. }, .. })));
    assert!(matches!(renderer.set_param("scale", "offset", Value::F32(0.5)), Err(Error::Pass { source: PassError::WrongValue(_), .. })));
    assert!(matches!(renderer.set_param("stale", "gain", Value::F32(0.5)), Err(Error::NoPass { .. })));
    let squared = plan(&registry, "scale.image", &format!("{SCALE}set.power = 2\nset.gain = 1.0\nset.offset = 0\n"), &[]);
    renderer.replace_plan(&registry, squared).unwrap();
    render(&mut renderer, 1);
    let shown = pixels(&mut renderer, "scale.image")[0][0];
    assert!((shown - 9.0).abs() < 1e-4, "{shown}");
}

#[test]
fn nodes_have_random_numbers_of_their_own_that_depend_on_their_names_alone() {
    let registry = registry(&[]);
    let first_of = |passes: &str, output: &str| {
        let mut renderer = renderer(&registry, plan(&registry, output, passes, &[]), small());
        render(&mut renderer, 1);
        pixels(&mut renderer, output)[0]
    };
    let (a, b) = ("[pass.a]\nkind = \"stage\"\n", "[pass.b]\nkind = \"stage\"\n");
    assert_ne!(first_of(a, "a.value"), first_of(b, "b.value"));
    assert_eq!(first_of(b, "b.value"), first_of(&format!("{a}{b}"), "b.value"));
}

/// Runs its shader every third frame, and counts.
struct Sometimes {
    frames: u32,
}

impl Pass for Sometimes {
    fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError> {
        frame.set("gain", Value::F32(self.frames as f32))?;
        if self.frames.is_multiple_of(3) {
            frame.run("main")?;
        }
        self.frames += 1;
        Ok(())
    }

    fn restart(&mut self) {
        self.frames = 0;
    }

    fn report(&self) -> Option<String> {
        Some(format!("{} frames", self.frames))
    }
}

#[test]
fn a_pass_with_host_state_decides_what_runs() {
    let kind = PassKind {
        name: "sometimes",
        about: "Scales now and then.",
        shader: "pass/scale",
        build: |_| Ok(Box::new(Sometimes { frames: 0 })),
    };
    let registry = registry(&[kind]);
    let passes = "[pass.source]\n[pass.sometimes]\nin.value = \"source.value\"\n";
    let plan = plan(&registry, "sometimes.image", passes, &[]);
    assert_eq!(plan.steps[1].contract.about, "Scales now and then.");
    let mut renderer = renderer(&registry, plan, small());
    render(&mut renderer, 5);
    assert_eq!(pixels(&mut renderer, "sometimes.image")[0], [3.0 * 3.0 + 3.0; 4], "frame 3 was the last that ran");
    assert_eq!(renderer.reports(), [("sometimes".to_owned(), "5 frames".to_owned())]);
    renderer.restart().unwrap();
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "sometimes.image")[0], [3.0; 4]);
}

#[test]
fn a_pass_that_asks_for_what_is_not_there_is_an_error_with_its_name() {
    struct Lost;
    impl Pass for Lost {
        fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError> {
            frame.dispatch("nowhere", [1, 1, 1])
        }
    }
    let registry = registry(&[PassKind { name: "lost", about: "", shader: "pass/source", build: |_| Ok(Box::new(Lost)) }]);
    let mut renderer = renderer(&registry, plan(&registry, "lost.value", "[pass.lost]\n", &[]), small());
    let error = renderer.frame().unwrap_err();
    assert_eq!(error.to_string(), "pass `lost`: no compute entry point `nowhere`; there are: main");
}

/// Draws some instances of the pass `paint`.
struct Painter {
    instances: std::ops::Range<u32>,
}

impl Pass for Painter {
    fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError> {
        frame.draw("ids", &[Batch { vertices: 0..3, instances: self.instances.clone() }])?;
        frame.run("look")
    }
}

#[test]
fn a_pass_draws_into_images_and_looks_at_them() {
    let kind = |build| PassKind { name: "painter", about: "", shader: "pass/paint", build };
    let painted = |kind: PassKind| {
        let registry = registry(&[kind]);
        let mut renderer = renderer(&registry, plan(&registry, "painter.image", "[pass.painter]\n", &[]), small());
        render(&mut renderer, 2);
        (pixels(&mut renderer, "painter.image"), renderer.memory().clone(), renderer.timings())
    };
    let (image, memory, timings) = painted(kind(|_| Ok(Box::new(Painter { instances: 0..2 }))));
    let expected = |x: usize| if x < 6 { [2.0, 7.0, 0.0, 1.0] } else { [1.0, 7.0, 0.0, 1.0] };
    for (at, pixel) in image.iter().enumerate() {
        assert_eq!(*pixel, expected(at % 13), "pixel {at}: the nearer one wins, whatever the order");
    }
    let images: Vec<_> = memory.resources.iter().filter(|resource| resource.life == "image").map(|image| image.bytes).collect();
    assert_eq!(images, [13 * 9 * 8, 13 * 9 * 4], "ids and depth");
    assert!(timings.passes[0].median_ms.is_some_and(|time| time > 0.0), "{timings:?}");
    let (image, ..) = painted(kind(|_| Ok(Box::new(Painter { instances: 1..2 }))));
    assert_eq!(image[12], [0.0, 0.0, 0.0, 1.0], "zeros where nothing is drawn");
}

#[test]
fn a_drawing_without_host_code_is_refused() {
    let registry = registry(&[]);
    let mut renderer = renderer(&registry, plan(&registry, "paint.image", "[pass.paint]\n", &[]), small());
    let error = renderer.frame().unwrap_err().to_string();
    assert!(error.starts_with("pass `paint`: fragment entry point `ids` is drawn by nobody"), "{error}");
}

#[test]
fn a_plan_that_does_not_compile_names_its_pass_and_leaves_the_old_one_running() {
    let registry = registry(&[]);
    let counting = plan(&registry, "count.after", "[pass.count]\nin.before = \"count.after@prev\"\n", &[]);
    let mut renderer = renderer(&registry, counting, small());
    render(&mut renderer, 2);
    let broken = plan(&registry, "broken.value", "[pass.broken]\nkind = \"incomplete\"\n", &[]);
    let error = renderer.replace_plan(&registry, broken).unwrap_err();
    assert!(matches!(&error, Error::Validation { pass, .. } if pass == "broken"), "{error}");
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "count.after")[0], [3.0; 4], "history went on too");
}

#[test]
fn globals_that_are_missing_are_named() {
    let registry = registry(&[]);
    let plan = plan(&registry, "source.value", "[pass.source]\n", &[]);
    let mut renderer = Renderer::new(context(), &registry, plan, Box::new(NoGlobals), small()).unwrap();
    let error = renderer.frame().unwrap_err();
    assert_eq!(error.to_string(), "pass `source`: nothing is bound to `test/frame::frame`");
    renderer.replace_globals(TestGlobals::new(context())).unwrap();
    render(&mut renderer, 1);
}

#[test]
fn timings_agree_with_the_clock_on_the_wall() {
    let registry = registry(&[]);
    let passes = "[pass.source]\n[pass.short]\nkind = \"chase\"\nin.value = \"source.value\"\nset.steps = 2000\n\
                  [pass.long]\nkind = \"chase\"\nin.value = \"short.image\"\nset.steps = 20000\n";
    let options = RendererOptions { size: [128, 64], ..small() };
    let mut renderer = renderer(&registry, plan(&registry, "long.image", passes, &[]), options);
    render(&mut renderer, 1);
    let begin = Instant::now();
    render(&mut renderer, 9);
    renderer.finish().unwrap();
    let wall = begin.elapsed().as_secs_f64() * 1e3;
    let timings = renderer.timings();
    assert_eq!((timings.frames, timings.passes.len()), (9, 3));
    let median = |index: usize| timings.passes[index].median_ms.unwrap();
    assert!(median(2) > 4.0 * median(1), "ten times the work: {timings:?}");
    let all: f64 = 9.0 * (0..3).map(median).sum::<f64>();
    assert!(all < 1.2 * wall, "{all} ms in passes, {wall} ms on the wall");
    if timings.clock == Clock::Timestamps {
        assert!(all > 0.3 * wall, "{all} ms in passes, {wall} ms on the wall");
    }
    let startup = renderer.startup();
    assert!(startup.first_frame.is_some() && startup.compose + startup.pipelines + startup.memory > Duration::ZERO);
}

#[test]
fn a_pass_that_hangs_is_named_and_the_device_is_not_trusted_any_more() {
    // A device of its own: it is lost to all after this.
    let patient = Context::new(&ContextOptions::default()).unwrap();
    let registry = registry(&[]);
    let passes = "[pass.source]\n[pass.slow]\nkind = \"chase\"\nin.value = \"source.value\"\n";
    let plan = plan(&registry, "slow.image", passes, &[]);
    let options = RendererOptions { size: [1024, 512], ..small() };
    let limit = Duration::from_millis(250);
    let steps = {
        let mut renderer = Renderer::new(&patient, &registry, plan.clone(), TestGlobals::new(&patient), options).unwrap();
        render(&mut renderer, 1);
        renderer.set_param("slow", "steps", Value::U32(1000)).unwrap();
        let begin = Instant::now();
        render(&mut renderer, 1);
        renderer.finish().unwrap();
        let most = if patient.adapter().kind == "cpu" { 60e3 } else { 1e9 };
        Value::U32((1000.0 * 6.0 * limit.div_duration_f64(begin.elapsed())).clamp(1000.0, most) as u32)
    };
    let impatient = patient.with_patience(limit);
    let mut renderer = Renderer::new(&impatient, &registry, plan, TestGlobals::new(&impatient), options).unwrap();
    render(&mut renderer, 1);
    renderer.set_param("slow", "steps", steps).unwrap();
    renderer.frame().unwrap();
    let error = renderer.finish().unwrap_err();
    assert_eq!(error.to_string(), "pass `slow` did not finish within 0.25 s");
    assert!(matches!(renderer.frame(), Err(Error::Hung { pass, .. }) if pass == "slow"));
    assert!(matches!(patient.health(), Err(Error::Hung { .. })));
}

#[test]
fn a_composed_shader_runs_on_the_callers_buffers() {
    let mut library = (*library()).clone();
    library.insert(
        "sum",
        "override factor: f32 = 1.0;\n@group(1) @binding(3) var<uniform> first: u32;\n@group(1) @binding(5) var<storage, read> terms: array<f32>;\n\
         @group(0) @binding(9) var<storage, read_write> total: array<f32, 2>;\n\
         @compute @workgroup_size(1) fn add() { for (var i = first; i < arrayLength(&terms); i++) { total[1] += factor * terms[i]; } }\n",
        "sum.wgsl",
    );
    let shader = library.compose(&Specialisation { entry: "sum".to_owned(), ..Default::default() }).unwrap();
    let (first, terms, total) = (1u32.to_le_bytes(), [1.0f32, 2.0, 3.0, 4.0], [10.0f32, 20.0]);
    let buffers = [
        ("first", Data::In(&first)),
        ("sum::terms", Data::In(bytemuck::cast_slice(&terms))),
        ("total", Data::InOut(bytemuck::cast_slice(&total))),
    ];
    let once = Once { shader: &shader, entry: "add", constants: &[("factor", 10.0)], buffers: &buffers, workgroups: [1, 1, 1] };
    let found = run_once(context(), &once).unwrap();
    assert_eq!(found, [bytemuck::cast_slice::<f32, u8>(&[10.0, 110.0])]);
    let named = |result: Result<_, Error>| result.map(drop).unwrap_err().to_string();
    assert!(named(run_once(context(), &Once { entry: "sub", ..once })).contains("no compute entry point `sub`; there are: add"));
    assert!(named(run_once(context(), &Once { constants: &[("power", 1.0)], ..once })).contains("declares no `power`; there are: factor"));
    assert!(named(run_once(context(), &Once { buffers: &buffers[..2], ..once })).contains("nothing is bound to `sum::total`"));
    let unknown = [("terms", Data::Out(4)), ("other", Data::Out(4))];
    assert!(named(run_once(context(), &Once { buffers: &unknown, ..once })).contains("declares no `other`"));
}
