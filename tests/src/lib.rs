//! The test harness: an adapter shared by all tests of a binary, and rigs that run graphs with kernels written in a test.

pub mod cost;
pub mod error_parts;
pub mod evidence;
pub mod leaving_out;
pub mod motion;
pub mod references;
pub mod seeds;
pub mod vanishing;

use aquifer_graph::{Document, Graph, Needs, NeedsAll, Plan, Shelf, Source};
use aquifer_lab::{capture::Capture, film::Film};
use aquifer_render::{Context, ContextOptions, Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::{Features, Scene};
use std::sync::{Arc, OnceLock};

/// The adapter, opened once a process; `None` where there is none, unless AQUIFER_REQUIRE_ADAPTER=1 forbids that.
///
/// # Panics
/// Without an adapter when one is required, and when an adapter that exists gives no device.
pub fn context() -> Option<Context> {
    static SHARED: OnceLock<Option<Context>> = OnceLock::new();
    let open = || match Context::new(&ContextOptions::default()) {
        Ok(context) => Some(context),
        Err(aquifer_render::Error::NoAdapter) if std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none() => {
            eprintln!("SKIPPED: no graphics adapter; tools/setup.sh installs a software one");
            None
        }
        Err(error) => panic!("{error}"),
    };
    SHARED.get_or_init(open).clone()
}

/// What a rig is made of.
#[derive(Clone)]
pub struct Parts<'a> {
    /// A finished scene.
    pub scene: &'a Arc<Scene>,
    /// The text of a graph file; it may extend a built-in graph.
    pub graph: &'a str,
    /// Modules over the built-in ones: (path, text).
    pub shaders: &'a [(&'a str, &'a str)],
    /// `--set` texts.
    pub settings: &'a [&'a str],
    /// Resources to keep for reading, beside the output.
    pub keep: &'a [&'a str],
    /// Camera and time.
    pub view: View,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Seed.
    pub seed: u64,
    /// Number of the first frame.
    pub first_frame: u32,
    /// What is not left out.
    pub kept: Kept,
}

/// How much of a renderer a scene may do without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// What the scene needs.
    Needed,
    /// Every pass and every array; shaders are cut to the scene.
    Resources,
    /// Everything.
    All,
}

impl<'a> Parts<'a> {
    /// 64×36 pixels, seed 0, nothing special.
    pub fn new(scene: &'a Arc<Scene>, graph: &'a str) -> Self {
        Parts {
            scene,
            graph,
            shaders: &[],
            settings: &[],
            keep: &[],
            view: View::default(),
            size: [64, 36],
            seed: 0,
            first_frame: 0,
            kept: Kept::Needed,
        }
    }

    /// A renderer of these parts.
    ///
    /// # Panics
    /// When anything is wrong: a test should not go on then.
    pub fn renderer(&self, context: &Context) -> Renderer {
        self.build(context).0
    }

    /// The mean over `frames` frames with its variance, of a graph that accumulates.
    ///
    /// # Panics
    /// When anything is wrong.
    pub fn film(&self, context: &Context, frames: u32) -> Film {
        self.rolling(context).after(frames)
    }

    /// Rendering that can go on after a look at it.
    ///
    /// # Panics
    /// When anything is wrong.
    pub fn rolling(&self, context: &Context) -> Rolling {
        let (renderer, capture) = self.build(context);
        Rolling { renderer, capture }
    }

    /// Hash of the shaders, linked for the scene: the version of the code that decides the picture.
    ///
    /// # Panics
    /// When anything is wrong.
    pub fn shader_digest(&self) -> String {
        let (registry, plan, _) = self.plan();
        aquifer_lab::compare::reference::shaders(&registry, &plan)
    }

    fn plan(&self) -> (Registry, Plan, Capture) {
        let mut library = aquifer_passes::library();
        for (path, text) in self.shaders {
            library.insert(*path, *text, format!("test:{path}.wgsl"));
        }
        let facts = Features::of(self.scene);
        let texts = if self.kept == Kept::All { Features::ALL } else { facts };
        let registry = aquifer_passes::registry_keeping(library, self.scene, &texts).expect("the scene is finished");
        let files = Shelf::new("", aquifer_graphs::files());
        let mut document = Document::parse(Source::new("test.toml", self.graph), &files).unwrap_or_else(|faults| panic!("{faults}"));
        document.apply(self.settings.iter().map(|text| Source::new("--set", *text))).unwrap_or_else(|faults| panic!("{faults}"));
        let graph = Graph::check(&document, &registry).unwrap_or_else(|faults| panic!("{faults}"));
        let capture = Capture::of(&graph);
        let keep: Vec<&str> = self.keep.iter().copied().chain(capture.keep()).collect();
        let needs: &dyn Needs = if self.kept == Kept::Needed { &registry } else { &NeedsAll };
        let plan = graph.plan(needs, &keep).expect("a checked graph has a plan");
        (registry, plan, capture)
    }

    fn build(&self, context: &Context) -> (Renderer, Capture) {
        let (registry, plan, capture) = self.plan();
        let facts = Features::of(self.scene);
        let arrays = if self.kept == Kept::Needed { facts } else { Features::ALL };
        let globals =
            SceneGlobals::keeping(context, self.scene.clone(), self.view.clone(), &arrays).unwrap_or_else(|error| panic!("{error}"));
        let options = RendererOptions { size: self.size, seed: self.seed, first_frame: self.first_frame, ..RendererOptions::default() };
        let renderer = Renderer::new(context, &registry, plan, Box::new(globals), options).unwrap_or_else(|error| panic!("{error}"));
        (renderer, capture)
    }
}

/// A renderer of a graph that accumulates.
pub struct Rolling {
    renderer: Renderer,
    capture: Capture,
}

impl Rolling {
    /// The mean with its variance, `frames` frames later.
    ///
    /// # Panics
    /// When the device fails.
    pub fn after(&mut self, frames: u32) -> Film {
        for _ in 0..frames {
            self.renderer.frame().unwrap_or_else(|error| panic!("{error}"));
        }
        self.capture.radiance(&mut self.renderer).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Settings of all graphs that are compared on a built-in scene: where a sun is among few lights, drawing them by power gives it nearly all samples, and
/// what the lamps light is noise.
pub fn fair_settings(scene: &str) -> &'static [&'static str] {
    if scene == "sun_room" { &["slots.proposal=uniform"] } else { &[] }
}

/// A built-in scene, finished.
///
/// # Panics
/// When there is none of that name.
pub fn scene(name: &str) -> Arc<Scene> {
    let generator = aquifer_scenes::by_name(name).unwrap_or_else(|| panic!("no scene `{name}`"));
    Arc::new((generator.make)().finish().unwrap_or_else(|error| panic!("{name}: {error}")))
}

/// The output after `frames` frames, in f64: RGBA.
///
/// # Panics
/// When the device fails.
pub fn image(renderer: &mut Renderer, frames: u32) -> Vec<[f64; 4]> {
    for _ in 0..frames {
        renderer.frame().unwrap_or_else(|error| panic!("{error}"));
    }
    let name = renderer.output().to_owned();
    let words = renderer.read_f32(&name).unwrap_or_else(|error| panic!("{error}"));
    words.chunks_exact(4).map(|pixel| [0, 1, 2, 3].map(|channel| f64::from(pixel[channel]))).collect()
}

/// Mean over the image of one channel, with its standard error: pixels and frames are independent.
///
/// # Panics
/// When the film has no variance.
pub fn mean_of(film: &Film, channel: usize) -> Estimate {
    let count = film.color.len() as f64;
    let sum = |pixels: &[[f32; 3]]| pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>();
    let variance = film.variance.as_ref().expect("frames of a graph without history tell their variance");
    Estimate { value: sum(&film.color) / count, standard_error: sum(variance).sqrt() / count }
}

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Estimate {
    /// Asserts that this is `expected` to 4 standard errors and the share `rounding`, and that the standard error is at most `resolution`.
    ///
    /// # Panics
    /// When it is not, or when the test could not tell.
    pub fn assert_is(&self, what: &str, expected: f64, resolution: f64, rounding: f64) {
        let Estimate { value, standard_error } = *self;
        assert!(standard_error <= resolution * expected, "{what}: the test resolves only {standard_error} of {expected}");
        assert!(
            (value - expected).abs() <= 4.0 * standard_error + rounding * expected,
            "{what}: {value} ± {standard_error}, not {expected}"
        );
    }
}
