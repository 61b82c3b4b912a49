//! The reference: from the cache that `aquifer compare` fills, made better on demand, in a thread of its own.

use super::{build::Workshop, message::Inbox};
use crate::opening::Content as TellContent;
use aquifer_graph::Transport;
use aquifer_lab::{
    compare::{
        error::CompareError,
        observer::Unwatched,
        reference::{Content, Reference, Tracer},
        subject::Stage,
    },
    film::Film,
};
use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::Sender,
    },
};

/// What is taken for the truth.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Radiance, with the variance of its mean.
    pub film: Film,
    /// Samples a pixel.
    pub samples: u64,
    /// What it is the truth about.
    pub about: About,
}

/// What decides a reference, beside the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// Name of the camera.
    pub camera: String,
    /// Seconds into the animation.
    pub time: f32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Which light paths.
    pub transport: Transport,
}

/// What the maker tells.
pub enum News {
    /// There is one, or a better one.
    Better(Arc<Truth>),
    /// What it does, in words; empty when it does nothing.
    State(String),
}

/// A wish for a reference.
pub struct Wish {
    pub about: About,
    /// Samples a pixel; 0: what the cache has.
    pub goal: u64,
    pub content: TellContent,
    pub environment: Option<String>,
    pub shaders: Vec<PathBuf>,
    pub cache: PathBuf,
    pub version: String,
}

/// Ends the making when it is dropped.
pub struct Making(Arc<AtomicBool>);

impl Drop for Making {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Begins to fulfil a wish.
pub fn make(workshop: Workshop, wish: Wish, news: Sender<Inbox>) -> Making {
    let stop = Arc::new(AtomicBool::new(false));
    let making = Making(stop.clone());
    std::thread::spawn(move || {
        let tell = |what: News| {
            if !stop.load(Ordering::Relaxed) {
                // Nobody listens when the session has ended.
                let _ = news.send(Inbox::News(what));
            }
        };
        let words = match fulfil(&workshop, &wish, &stop, &tell) {
            Ok(()) => String::new(),
            Err(error) => format!("no reference: {error}"),
        };
        tell(News::State(words));
    });
    making
}

/// Why there is no reference.
#[derive(Debug, thiserror::Error)]
enum NoTruth {
    #[error(transparent)]
    Stage(#[from] aquifer_lab::stage::StageError),
    #[error("{0}")]
    Scene(String),
    #[error(transparent)]
    Compare(#[from] CompareError),
}

fn fulfil(workshop: &Workshop, wish: &Wish, stop: &AtomicBool, tell: &dyn Fn(News)) -> Result<(), NoTruth> {
    let about = &wish.about;
    let registry = aquifer_lab::stage::registry(Some(&workshop.scene), &wish.shaders)?;
    let scene = (wish.content)().map_err(NoTruth::Scene)?;
    let stage = Stage {
        context: workshop.context.clone(),
        registry,
        scene: workshop.scene.clone(),
        camera: Some(about.camera.clone()),
        time: about.time,
        step: 0.0,
        size: about.size,
        centred: false,
    };
    let content = Content { scene: &scene, environment: wish.environment.as_deref(), camera: &about.camera, version: &wish.version };
    let mut tracer = Tracer::new(&stage, &(workshop.load)("path_tracer").map_err(CompareError::from)?, about.transport, about.time)?;
    let mut reference = Reference::open(&wish.cache, &stage, &tracer, &content, &mut Unwatched);
    let show = |reference: &Reference| {
        if let Some(film) = reference.film() {
            let truth = Truth { film: film.clone(), samples: reference.samples(), about: about.clone() };
            tell(News::Better(Arc::new(truth)));
        }
    };
    show(&reference);
    while reference.samples() < wish.goal && !stop.load(Ordering::Relaxed) {
        tell(News::State(format!("reference: {} of {} samples", reference.samples(), wish.goal)));
        reference.extend(&stage, &mut tracer, &content)?;
        show(&reference);
    }
    Ok(())
}
