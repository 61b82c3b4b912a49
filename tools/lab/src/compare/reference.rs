//! What is taken for the truth: path traced, kept on disk by content, extended on demand.
//!
//! An entry is a film and a small file beside it that says which film, how much of it there is and the film's hash: written last, so that an
//! interruption leaves the older entry whole. Samples come in chunks, each a seed of its own, so that a reference in parts is the
//! reference in one go.

use super::{error::CompareError, observer::Observer, subject::Stage};
use crate::{
    atomic,
    capture::Capture,
    film::{Facts, Film, GraphText, Packing, Runs, merge},
};
use aquifer_graph::{Document, Graph, Plan, Source, Transport};
use aquifer_render::{Registry, Renderer, RendererOptions, SceneGlobals, View};
use serde::{Deserialize, Serialize};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Paths a pixel and frame: fewer dispatches for as many samples.
const SAMPLES: u32 = 8;
/// Paths in a chunk: a few seconds on two cores.
const CHUNK_PATHS: u64 = 2_500_000;
/// The first chunk's seed, far from those of the measurements.
const FIRST_SEED: u64 = 1 << 48;

/// A reference in the cache.
pub struct Reference {
    folder: PathBuf,
    key: String,
    transport: Transport,
    entry: Entry,
    film: Option<Film>,
}

/// The file beside the film.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Entry {
    /// What the key is the hash of, for people.
    about: String,
    chunks: u32,
    /// Of the film's file.
    hash: String,
}

/// Renders what is missing.
pub struct Tracer {
    graph: Graph,
    renderer: Renderer,
    capture: Capture,
    frames: u32,
    time: f32,
}

/// What names a reference: everything that decides its expectation.
pub struct Content<'a> {
    /// A text that changes whenever the scene does.
    pub scene: &'a str,
    /// The environment over it.
    pub environment: Option<&'a str>,
    /// Name of the camera.
    pub camera: &'a str,
    /// Of the program, for the film's attributes; no part of the name.
    pub version: &'a str,
}

impl Tracer {
    /// The path tracer for `transport` on a stage, at `time`.
    ///
    /// # Errors
    /// What the graph or the device refuses.
    pub fn new(stage: &Stage, path_tracer: &Document, transport: Transport, time: f32) -> Result<Self, CompareError> {
        let mut document = path_tracer.clone();
        let edits = [format!("transport={transport}"), format!("path_tracer.samples={SAMPLES}")];
        document.apply(edits.map(|text| Source::new("reference", text)))?;
        let graph = stage.graph(&document, None)?;
        let capture = Capture::of(&graph);
        let plan = graph.plan(&stage.registry, &capture.keep())?;
        let view = View { camera: stage.camera.clone(), free: None, time, step: 0.0, centred: stage.centred };
        let globals = SceneGlobals::new(&stage.context, stage.scene.clone(), view)?;
        let options = RendererOptions { size: stage.size, ..RendererOptions::default() };
        let renderer = Renderer::new(&stage.context, &stage.registry, plan, Box::new(globals), options)?;
        let pixels = u64::from(stage.size[0]) * u64::from(stage.size[1]);
        let frames = (CHUNK_PATHS / (pixels * u64::from(SAMPLES)).max(1)).clamp(2, 64) as u32;
        Ok(Self { graph, renderer, capture, frames, time })
    }

    /// Samples of one chunk.
    pub fn chunk(&self) -> u32 {
        self.frames * SAMPLES
    }

    fn render(&mut self, chunk: u32) -> Result<Film, CompareError> {
        self.renderer.reseed(FIRST_SEED + u64::from(chunk))?;
        for _ in 0..self.frames {
            self.renderer.frame()?;
        }
        Ok(self.capture.radiance(&mut self.renderer)?)
    }
}

impl Reference {
    /// Opens the entry for what `tracer` renders; a damaged one counts as absent, and the observer is told.
    pub fn open(folder: &Path, stage: &Stage, tracer: &Tracer, content: &Content<'_>, observer: &mut dyn Observer) -> Self {
        let ([width, height], time) = (stage.size, tracer.time);
        let about = format!(
            "scene {}, environment {}, camera {}, time {time}, {width}x{height}, centred {}, graph {}, shaders {}",
            content.scene,
            content.environment.unwrap_or("its own"),
            content.camera,
            stage.centred,
            tracer.graph.digest(),
            shaders(&stage.registry, tracer.renderer.plan()),
        );
        let key = blake3::hash(about.as_bytes()).to_hex()[..32].to_owned();
        let empty = Entry { about, ..Entry::default() };
        let mut reference = Self { folder: folder.to_owned(), key, transport: tracer.graph.transport(), entry: empty, film: None };
        match reference.load() {
            Ok(Some((entry, mut film))) => {
                // Films of older programs say 0 of any time.
                film.facts.iter_mut().for_each(|facts| facts.animation_time = time);
                (reference.entry, reference.film) = (entry, Some(film));
            }
            Ok(None) => {}
            Err(why) => observer.warn(&format!("reference {} in the cache is damaged ({why}): it is made again", reference.key)),
        }
        reference
    }

    fn load(&self) -> Result<Option<(Entry, Film)>, String> {
        let path = self.entry_path();
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error.to_string()),
        };
        let entry: Entry = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
        let path = self.film_path(entry.chunks);
        let bytes = fs::read(&path).map_err(|error| error.to_string())?;
        if blake3::hash(&bytes).to_hex().as_str() != entry.hash || entry.about != self.entry.about {
            return Err("its hash is not the one noted".to_owned());
        }
        Ok(Some((entry, Film::read(&path).map_err(|error| error.to_string())?)))
    }

    fn entry_path(&self) -> PathBuf {
        self.folder.join(format!("{}.json", self.key))
    }

    fn film_path(&self, chunks: u32) -> PathBuf {
        self.folder.join(format!("{}-{chunks}.exr", self.key))
    }

    /// Renders one chunk more and keeps it.
    ///
    /// # Errors
    /// What the device or the disk refuses; the entry is then as it was.
    pub fn extend(&mut self, stage: &Stage, tracer: &mut Tracer, content: &Content<'_>) -> Result<(), CompareError> {
        let chunk = self.entry.chunks;
        let film = tracer.render(chunk)?;
        let facts = Facts {
            samples_per_pixel: tracer.chunk(),
            render_seconds: 0.0,
            graph: GraphText { text: tracer.graph.title().to_owned(), hash: tracer.graph.digest() },
            scene: content.scene.to_owned(),
            environment: content.environment.map(str::to_owned),
            camera: content.camera.to_owned(),
            animation_time: tracer.time,
            transport: self.transport.to_string(),
            runs: Runs::one(FIRST_SEED + u64::from(chunk), 0, u64::from(tracer.frames)),
            adapter: stage.context.adapter().name.clone(),
            version: content.version.to_owned(),
        };
        let more = Film { facts: Some(facts), ..film };
        let film = match &self.film {
            Some(film) => merge(film, &more)?,
            None => more,
        };
        self.keep(film, chunk + 1)
    }

    fn keep(&mut self, film: Film, chunks: u32) -> Result<(), CompareError> {
        fs::create_dir_all(&self.folder).map_err(|source| CompareError::Io { path: self.folder.clone(), source })?;
        let hash = film.write_hashed(&self.film_path(chunks), Packing::Packed)?;
        self.entry = Entry { chunks, hash: hash.to_hex().to_string(), ..self.entry.clone() };
        let text = serde_json::to_vec_pretty(&self.entry).expect("an entry is plain data");
        atomic::write(&self.entry_path(), &text)?;
        self.film = Some(film);
        self.forget_older();
        Ok(())
    }

    /// Removes the film of one chunk less, unless another process has written the entry since: it may name that film. A film too many does no harm.
    fn forget_older(&self) {
        let found = fs::read(self.entry_path()).ok().and_then(|text| serde_json::from_slice::<Entry>(&text).ok());
        if found.as_ref() == Some(&self.entry) {
            let _ = fs::remove_file(self.film_path(self.entry.chunks - 1));
        }
    }

    /// Mean and variance of the mean; `None` before the first chunk.
    pub fn film(&self) -> Option<&Film> {
        self.film.as_ref()
    }

    /// Samples in every pixel.
    pub fn samples(&self) -> u64 {
        self.film.as_ref().and_then(|film| film.facts.as_ref()).map_or(0, |facts| u64::from(facts.samples_per_pixel))
    }

    /// Names the entry and how much of it there is.
    pub fn hash(&self) -> String {
        format!("{}-{}", self.key, self.entry.chunks)
    }

    /// Which light paths.
    pub fn transport(&self) -> Transport {
        self.transport
    }
}

/// Hash of the shaders of a plan, linked for a scene: the version of the code that decides the picture.
pub fn shaders(registry: &Registry, plan: &Plan) -> String {
    let mut hash = blake3::Hasher::new();
    for step in &plan.steps {
        if let Ok(known) = registry.known(&step.kind, &step.slots) {
            hash.update(known.composed.text.as_bytes());
        }
    }
    hash.finalize().to_hex()[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        sync::atomic::{AtomicBool, Ordering},
        thread,
    };

    fn reference(folder: &Path) -> Reference {
        let entry = Entry { about: "a scene".into(), ..Entry::default() };
        Reference { folder: folder.to_owned(), key: "key".into(), transport: Transport::Emission, entry, film: None }
    }

    fn film(chunks: u32) -> Film {
        Film::new([8, 8], vec![[chunks as f32; 3]; 64]).unwrap()
    }

    #[test]
    fn what_was_kept_is_found_and_what_it_replaces_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let mut kept = reference(folder.path());
        for chunks in [1, 2] {
            kept.keep(film(chunks), chunks).unwrap();
        }
        let (entry, found) = reference(folder.path()).load().unwrap().unwrap();
        assert_eq!((entry, found), (kept.entry.clone(), film(2)));
        assert!(!kept.film_path(1).exists());
    }

    #[test]
    fn the_film_of_another_process_stays() {
        let folder = tempfile::tempdir().unwrap();
        let [mut late, mut early] = [reference(folder.path()), reference(folder.path())];
        late.keep(film(1), 1).unwrap();
        late.keep(film(2), 2).unwrap();
        // Another, which knew of no entry, keeps its first chunk just before the older film would go.
        early.keep(film(1), 1).unwrap();
        late.forget_older();
        assert!(reference(folder.path()).load().unwrap().is_some_and(|(entry, _)| entry == early.entry));
        // And one whose films another removes as soon as they are there can still say what it wrote.
        let done = AtomicBool::new(false);
        let paths: Vec<PathBuf> = (2..12).map(|chunks| early.film_path(chunks)).collect();
        thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    for path in &paths {
                        let _ = fs::remove_file(path);
                    }
                }
            });
            let kept = (2..12).try_for_each(|chunks| early.keep(film(chunks), chunks));
            done.store(true, Ordering::Relaxed);
            kept.unwrap();
        });
        assert_eq!(early.entry.chunks, 11);
    }
}
