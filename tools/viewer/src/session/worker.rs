//! The thread of a session.

mod orders;
mod posts;

use super::{
    Shared,
    build::{Order, Workshop},
    judge::{self, Task},
    live::Live,
    message::{Camera, Inbox, Message, Moment, Watch},
    scale::Scale,
    truth::{About, Making, Truth},
    turns::Turns,
};
use crate::{Loaded, Opening, Recipe, opening::Content};
use aquifer_graph::Contracts as _;
use aquifer_lab::watch::Watch as FileWatch;
use aquifer_render::{Context, ContextOptions};
use std::{
    path::PathBuf,
    sync::{
        Arc,
        mpsc::{Receiver, Sender},
    },
    time::{Duration, Instant},
};

/// How long to wait for messages where nothing renders: files are looked after this often.
const IDLE: Duration = Duration::from_millis(50);
/// Seconds that one step of the animation takes.
pub const STEP: f32 = 1.0 / 24.0;
/// Weight of the newest in the mean time between updates.
const NEWEST: f64 = 0.2;

/// Runs a session to its end.
pub fn run(opening: Opening, board: &Arc<Shared>, inbox: &Receiver<Inbox>, outbox: &Sender<Inbox>) {
    match Worker::open(opening, board.clone(), outbox.clone()) {
        Ok(mut worker) => worker.work(inbox),
        Err(words) => board.post(|board| (board.trouble, board.waiting) = (Some(words), None)),
    }
}

struct Worker {
    board: Arc<Shared>,
    outbox: Sender<Inbox>,
    workshop: Workshop,
    cache: PathBuf,
    version: String,
    content: Content,
    environment: Option<String>,
    desks: Vec<Desk>,
    scale: Scale,
    turns: Turns,
    camera: Camera,
    /// The same at all times.
    origin: glam::DVec3,
    time: f32,
    duration: f32,
    plays: bool,
    holds: bool,
    averages: bool,
    /// What the means are of.
    moment: Option<Moment>,
    inspected: Option<[f32; 2]>,
    files: Option<FileWatch>,
    updates: u64,
    last_update: Option<Instant>,
    update: f64,
    goal: Option<u64>,
    flip: bool,
    truth: Option<Arc<Truth>>,
    wished: Option<(About, u64)>,
    making: Option<Making>,
    judge: Sender<Task>,
    began: Instant,
}

/// One side.
struct Desk {
    recipe: Recipe,
    live: Option<Live>,
    builds: bool,
    next: Option<Order>,
    watch: Option<Watch>,
    /// Its first picture was told of.
    announced: bool,
    /// That a fault may be cured in, beside those of the graph that renders.
    suspects: Vec<PathBuf>,
}

impl Desk {
    fn new(recipe: Recipe) -> Self {
        Self { recipe, live: None, builds: false, next: None, watch: None, announced: false, suspects: Vec::new() }
    }
}

impl Worker {
    fn open(mut opening: Opening, board: Arc<Shared>, outbox: Sender<Inbox>) -> Result<Self, String> {
        let began = Instant::now();
        let nothing: crate::opening::LoadScene = Box::new(|| Err("the scene was loaded before".to_owned()));
        let Loaded { scene, content, environment } = std::mem::replace(&mut opening.load_scene, nothing)()?;
        board.post(|board| board.waiting = Some("opening the device".to_owned()));
        let options = ContextOptions { adapter: opening.adapter.clone(), ..ContextOptions::default() };
        let context = Context::new(&options).map_err(|error| error.to_string())?;
        let workshop = Workshop::open(&opening, scene.clone(), context)?;
        let camera = Camera::Named(opening.camera.clone());
        let moment = scene.at(0.0, opening.camera.as_deref()).map_err(|error| error.to_string())?;
        let duration = scene.duration();
        let extent = aquifer_scene::Tlas::build(&scene, &moment).bounds().map_or(1.0, |bounds| (bounds.max - bounds.min).max_element());
        board.post(|board| {
            board.waiting = None;
            board.cameras = scene.camera_names();
            (board.duration, board.extent) = (duration, extent);
            board.environment.clone_from(&environment);
            board.adapter = workshop.context.adapter().name.clone();
            board.slots = workshop.registry.slots();
            board.defaults = workshop.registry.library().default_slots();
        });
        let desks = opening.graphs.iter().cloned().map(Desk::new).collect();
        let judge = judge::start(board.clone());
        let mut worker = Self {
            board,
            outbox,
            workshop,
            cache: opening.cache,
            version: opening.version,
            content,
            environment,
            desks,
            scale: Scale::new(opening.size),
            turns: Turns::default(),
            camera,
            origin: moment.origin,
            time: 0.0,
            duration,
            plays: false,
            holds: false,
            averages: true,
            moment: None,
            inspected: None,
            files: FileWatch::new().inspect_err(|error| tracing::warn!(%error, "no hot reload")).ok(),
            updates: 0,
            last_update: None,
            update: 0.0,
            goal: None,
            flip: false,
            truth: None,
            wished: None,
            making: None,
            judge,
            began,
        };
        (0..worker.desks.len()).for_each(|side| worker.order(side));
        Ok(worker)
    }

    fn work(&mut self, inbox: &Receiver<Inbox>) {
        loop {
            let first = if self.renders() { inbox.try_recv().ok() } else { inbox.recv_timeout(IDLE).ok() };
            for message in first.into_iter().chain(inbox.try_iter()) {
                match message {
                    Inbox::Asked(Message::End) => return,
                    Inbox::Asked(message) => self.take(message),
                    Inbox::Built(built) => self.adopt(*built),
                    Inbox::News(news) => self.hear(news),
                }
            }
            self.look_after_files();
            if self.renders() {
                self.update();
            }
        }
    }

    fn renders(&self) -> bool {
        !self.holds && self.desks.iter().any(|desk| desk.live.is_some())
    }

    fn take(&mut self, message: Message) {
        match message {
            Message::Recipe(side, recipe) => self.change(side, recipe),
            Message::Close => self.close(),
            Message::Camera(camera) => self.camera = camera,
            Message::Time(time) => self.time = time,
            Message::Play(plays) => self.plays = plays && self.duration > 0.0,
            Message::Step => self.advance(STEP),
            Message::Hold(holds) => (self.holds, self.last_update) = (holds, None),
            Message::Average(averages) => self.averages = averages,
            Message::Scale(choice) => {
                self.scale.choose(choice);
                self.resize();
            }
            Message::Watch(side, watch) => self.watch(side, watch),
            Message::Inspect(pixel) => self.inspect(pixel),
            Message::Truth(goal) => (self.goal, self.wished) = (Some(goal), None),
            Message::Flip(flip) => self.flip = flip,
            Message::End => {}
        }
    }

    /// All means begin anew, so that they go on from the same point.
    fn begin_anew(&mut self) {
        self.moment = None;
    }

    fn advance(&mut self, seconds: f32) {
        if self.duration > 0.0 {
            self.time = (self.time + seconds).rem_euclid(self.duration);
        }
    }

    fn resize(&mut self) {
        let size = self.scale.size();
        for (side, desk) in self.desks.iter_mut().enumerate() {
            let Some(live) = desk.live.as_mut().filter(|live| live.size() != size) else { continue };
            if let Err(error) = live.resize(size) {
                self.board.post(|board| board.sides[side].fault = Some(error.to_string()));
            }
        }
        self.begin_anew();
    }

    /// Where the picture is taken from now.
    fn now(&self) -> Result<Moment, String> {
        let (time, origin) = (self.time, self.origin);
        match &self.camera {
            Camera::Free(camera) => Ok(Moment { camera: *camera, origin, name: None, time }),
            Camera::Named(wanted) => {
                let name = wanted.clone().or_else(|| self.workshop.scene.camera_names().into_iter().next());
                match &self.moment {
                    Some(known) if known.time == time && known.name == name => Ok(known.clone()),
                    _ => {
                        let camera = self.workshop.scene.at(time, name.as_deref()).map_err(|error| error.to_string())?.camera;
                        Ok(Moment { camera, origin, name, time })
                    }
                }
            }
        }
    }

    /// One picture of every side.
    fn update(&mut self) {
        let elapsed = self.last_update.replace(Instant::now()).map_or(Duration::ZERO, |last| last.elapsed());
        if self.plays {
            self.advance(elapsed.as_secs_f32());
        }
        let moment = match self.now() {
            Ok(moment) => moment,
            Err(words) => {
                self.board.post(|board| board.trouble = Some(words));
                self.holds = true;
                return;
            }
        };
        if !self.averages || self.moment.as_ref() != Some(&moment) {
            self.desks.iter_mut().filter_map(|desk| desk.live.as_mut()).for_each(Live::forget_mean);
            self.turns.restart();
        }
        let began = Instant::now();
        self.render(&moment);
        let spent = began.elapsed();
        self.moment = Some(moment);
        self.updates += 1;
        self.update = if self.updates < 2 { spent.as_secs_f64() } else { self.update + NEWEST * (elapsed.as_secs_f64() - self.update) };
        self.wish_truth();
        self.post_pictures();
        let graphs = self.desks.iter().filter(|desk| desk.live.is_some()).count();
        if self.scale.note(spent.as_secs_f64() * 1e3, graphs) {
            self.resize();
        }
    }

    fn render(&mut self, moment: &Moment) {
        self.turns.begin();
        let lives = |desks: &[Desk]| [0, 1].map(|side| desks.get(side).is_some_and(|desk| desk.live.is_some()));
        while let Some(side) = self.turns.next(lives(&self.desks)) {
            let desk = &mut self.desks[side];
            match desk.live.as_mut().map(|live| live.frame(moment)) {
                Some(Ok(milliseconds)) => self.turns.rendered(side, milliseconds),
                Some(Err(error)) => {
                    desk.live = None;
                    self.board.post(|board| board.sides[side].fault = Some(error.to_string()));
                }
                None => {}
            }
        }
    }
}
