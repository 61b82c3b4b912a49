//! Live graphs without a window: messages in, pictures out.
//!
//! The thread of `worker` owns scene, device and renderers. It puts what it did on the [`Board`]; whoever looks takes a copy, whose large
//! parts are shared. Graphs are compiled in threads of their own (`build`), references in another (`truth`), errors in a third
//! (`judge`): the pictures go on meanwhile.

mod build;
mod guard;
mod judge;
mod live;
mod message;
mod scale;
mod truth;
mod turns;
mod worker;

pub use judge::{Judged, Point, difference};
pub use live::{Picture, Watched};
pub use message::{Camera, Message, Moment, Watch};
pub use scale::{Choice, LEAST};
pub use truth::{About, Truth};

use crate::{Opening, Recipe};
use aquifer_graph::{Graph, Plan};
use aquifer_render::{MemoryReport, PassTime, Startup};
use guard::guard;
use message::Inbox;
use std::{
    collections::BTreeMap,
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{Sender, channel},
    },
    thread::JoinHandle,
    time::Duration,
};

/// A running session; dropping it ends its thread.
pub struct Session {
    messages: Sender<Inbox>,
    board: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What there is to see.
#[derive(Clone, Debug, Default)]
pub struct Board {
    /// What is being waited for before anything can be rendered.
    pub waiting: Option<String>,
    /// Why nothing can be rendered at all.
    pub trouble: Option<String>,
    /// Names of the scene's cameras.
    pub cameras: Vec<String>,
    /// Seconds of the scene's animation; 0 where nothing moves.
    pub duration: f32,
    /// Largest side of the scene, metres.
    pub extent: f32,
    /// Adapter that renders.
    pub adapter: String,
    /// The environment over the scene's own, as films name it.
    pub environment: Option<String>,
    /// What is rendered at the moment.
    pub moment: Option<Moment>,
    /// Every slot with all that can fill it.
    pub slots: BTreeMap<String, Vec<String>>,
    /// What fills a slot when nobody says otherwise.
    pub defaults: BTreeMap<String, String>,
    /// One or two.
    pub sides: Vec<Side>,
    /// Pictures so far: one for every update.
    pub updates: u64,
    /// From one update to the next.
    pub update: Duration,
    /// The reference, where there is one for this moment.
    pub truth: Option<Arc<Truth>>,
    /// What the reference's maker does.
    pub truth_state: String,
}

/// One side of the board.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// What was asked for.
    pub recipe: Recipe,
    /// What renders.
    pub shown: Option<Arc<Shown>>,
    /// The latest.
    pub picture: Option<Arc<Picture>>,
    /// A new plan is being made.
    pub building: bool,
    /// What is wrong with the newest wish; the last good graph goes on.
    pub fault: Option<String>,
    /// Latest and median time of each pass.
    pub times: Vec<PassTime>,
    /// Frames of the last update.
    pub frames: u32,
    /// Milliseconds spent on the picture.
    pub spent: f64,
    /// The resource that is looked at.
    pub watched: Option<Arc<Watched>>,
    /// What the reservoirs of the chosen pixel hold.
    pub records: Arc<Vec<crate::record::Record>>,
    /// Errors against the reference.
    pub judged: Option<Arc<Judged>>,
}

impl Board {
    /// The reference, where it is of the light paths that a side renders.
    pub fn truth_of(&self, side: usize) -> Option<&Truth> {
        let picture = self.sides.get(side)?.picture.as_ref()?;
        self.truth.as_deref().filter(|truth| truth.about.transport == picture.transport)
    }

    /// Why a side is not held against the reference that there is.
    pub fn unjudged(&self, side: usize) -> Option<String> {
        let (truth, picture) = (self.truth.as_ref()?, self.sides.get(side)?.picture.as_ref()?);
        let (of, rendered) = (truth.about.transport, picture.transport);
        (of != rendered).then(|| format!("the reference is of `{of}`, and this graph renders `{rendered}`"))
    }
}

/// A graph that renders.
#[derive(Debug)]
pub struct Shown {
    /// As asked for.
    pub graph: Graph,
    /// As its files have it, with nothing laid over it: what changes are told against.
    pub written: Graph,
    /// What runs of it.
    pub plan: Plan,
    /// Its memory.
    pub memory: MemoryReport,
    /// How long it took to make.
    pub startup: Startup,
}

/// The board, and who is told when it changes.
pub(crate) struct Shared {
    board: Mutex<Board>,
    changed: Box<dyn Fn() + Send + Sync>,
}

impl Shared {
    /// Changes the board and tells who looks.
    fn post<T>(&self, change: impl FnOnce(&mut Board) -> T) -> T {
        let answer = change(&mut self.board.lock().unwrap_or_else(PoisonError::into_inner));
        (self.changed)();
        answer
    }

    fn look(&self) -> Board {
        self.board.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Session {
    /// Begins; `changed` is called from other threads whenever the board changes.
    pub fn start(opening: Opening, changed: impl Fn() + Send + Sync + 'static) -> Self {
        let sides = opening.graphs.iter().map(|recipe| Side { recipe: recipe.clone(), ..Side::default() }).collect();
        let board = Board { sides, waiting: Some("loading the scene".to_owned()), ..Board::default() };
        let board = Arc::new(Shared { board: Mutex::new(board), changed: Box::new(changed) });
        let (messages, inbox) = channel();
        let thread = {
            let (board, messages) = (board.clone(), messages.clone());
            std::thread::Builder::new().name("session".to_owned()).spawn(move || {
                if let Err(words) = guard(|| worker::run(opening, &board, &inbox, &messages)) {
                    board.post(|board| (board.trouble, board.waiting) = (Some(words), None));
                }
            })
        };
        let thread = thread.map_err(|error| board.post(|board| board.trouble = Some(format!("no thread: {error}")))).ok();
        Self { messages, board, thread }
    }

    /// What there is to see now.
    pub fn look(&self) -> Board {
        self.board.look()
    }

    /// Asks for something; the board shows when it is done.
    pub fn send(&self, message: Message) {
        // A session that has ended has said why on its board.
        let _ = self.messages.send(Inbox::Asked(message));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.send(Message::End);
        if let Some(thread) = self.thread.take() {
            // A panic there was told on the board.
            let _ = thread.join();
        }
    }
}
