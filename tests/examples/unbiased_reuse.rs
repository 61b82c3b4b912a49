//! Is unbiased reuse unbiased? One row for each scene, motion and rule: frame 8 over independent seeds against path tracing.
//!
//! ```text
//! cargo run -p aquifer-tests --example unbiased_reuse -- di|gi FILE FOLDER COMMIT DATE MINUTES [+SEEDS] [SCENE[:RULE] …]
//! ```
//!
//! FOLDER keeps references and what seeds have shown so far: a run that was stopped goes on where it was. Seeds are added to all rows in turn, twice as
//! many each time, until a row is resolved or has failed, has its 4,000 seeds, or the time is over. Rows that FILE holds as settled are left alone, of
//! whichever commit they are: who wants them anew deletes them there, and who would know more of one that passed asks for at least so many seeds
//! (`+1024`). Each part of a row is a process of its own: lavapipe keeps some memory of every
//! dispatch for as long as a process lives.
//!
//! The film is centred, on both sides: what a pixel sees is the same for every seed. With a jittered film the largest part of the noise is edges and
//! lamps that some seeds see and others do not, which is nothing about reuse.

use aquifer_lab::{
    film::Film,
    stats::{
        BlockTest, Blocks, Rule, Verdict,
        blocks::{BlockMoments, Quantity},
        compare_blocks,
        difference::largest_error,
    },
};
use aquifer_render::{Context, View};
use aquifer_scene::Scene;
use aquifer_tests::{
    Parts, context,
    evidence::{Evidence, told},
    motion::gliding,
    seeds::{SIDE, add_seeds, path_traced_parts},
    vanishing::lamps,
};
use serde_json::{Value, json};
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
    sync::Arc,
    time::{Duration, Instant},
};

/// The frame that is compared; those before are its history.
const FRAME: u32 = 8;
const FEWEST_SEEDS: u64 = 32;
/// Of a row that fails: few seeds of a mean with a heavy tail lie below it, and know nothing of its error.
const FEWEST_TO_FAIL: u64 = 512;
const MOST_SEEDS: u64 = 4000;
/// Seeds of one process.
const PART: u64 = 256;
/// Seconds a frame.
const STEP: f32 = 1.0 / 30.0;
/// Of a part of a reference, of eight paths each: how many at a time, and at most.
const REFERENCE_FRAMES: u32 = 512;
const MOST_REFERENCE_FRAMES: u32 = 16_384;
/// Share that a reference may have of the variance that resolves a row: while seeds are added, and of a row that all seeds have not resolved.
const REFERENCE_SHARES: [f64; 2] = [0.35, 0.15];

/// What is shown of a kind of light.
struct Subject {
    name: &'static str,
    graph: &'static str,
    settings: &'static [&'static str],
    scenes: &'static [Lit],
    rules: &'static [&'static str],
    test: fn() -> BlockTest,
}

/// A scene and how it moves, the paths that count, what fills slots of both sides, and of ours.
struct Lit {
    scene: &'static str,
    motions: &'static [&'static str],
    transport: &'static str,
    slots: &'static str,
    ours: &'static str,
    settings: &'static [&'static str],
    /// Further ones, by rule.
    by_rule: &'static [(&'static str, &'static [&'static str])],
}

const fn direct(scene: &'static str, motions: &'static [&'static str], slots: &'static str) -> Lit {
    Lit { scene, motions, transport: "direct", slots, ours: "", settings: &[], by_rule: &[] }
}

const fn indirect(scene: &'static str, transport: &'static str, slots: &'static str, ours: &'static str) -> Lit {
    Lit { scene, motions: &["still", "camera moves"], transport, slots, ours, settings: &[], by_rule: &[] }
}

const STILL_AND_MOVING: &[&str] = &["still", "all moves"];
/// `LAMPS`: one goes out and one comes up at the frame that is compared.
const SWITCHED: &[&str] = &["lamps switch"];
const LAMPS: &str = "lamps";

/// Where a sun is among few lights, drawing them by power gives it nearly all samples, and what the lamps light is noise.
const EVENLY: &str = "proposal = 'uniform'\n";
/// Most of what is drawn there is hidden: all of it is tested.
const SEEN: &[&str] = &["initial.candidates=1", "initial.winners=16", "temporal.cap=4"];
/// Lamps mirrored by glossy surfaces are seldom drawn by their power: their light would come in few large pieces. And where what is mirrored moves, a
/// history of confidence c outweighs by up to c what the pixel itself finds there, frame after frame.
const MET: &[&str] = &["initial.candidates=12", "initial.bsdf_rays=4", "temporal.cap=1"];
/// Shares of confidence alone bound no weight by p̂ / p̂_i, which is large between narrow lobes that point elsewhere: neighbours must be turned alike.
/// What they give otherwise is told in docs/restir_di.md.
const ALIKE: &[&str] = &["spatial.normal=1.0", "temporal.normal=1.0"];
/// Where lamps are many a reservoir holds few of them: what a history of confidence c is short of comes back as pieces c times as large.
const MANY: &[&str] = &["initial.candidates=64", "initial.winners=2", "temporal.cap=1"];
/// By confidence alone the mean of few seeds is the noisiest: more of what is drawn is tested.
const MORE: &[&str] = &["initial.candidates=64", "initial.winners=4", "temporal.cap=1"];
/// Of a lamp that has just come up a history knows nothing, and of one beside another that went out little, for all its confidence.
const FORGETFUL: &[&str] = &["temporal.cap=1"];
/// What shares of confidence do not know: that an input could hardly have made a sample.
const BOUNDED: &[&str] = &["temporal.target_limit=10", "spatial.target_limit=10"];
/// Lobes of half a degree, and a camera that moves on by more: what is carried there is the tail of another lobe.
const CLOSE: &[&str] = &["temporal.target_limit=2", "spatial.target_limit=2"];
/// Where little of what a pixel sees is lit, more paths a pixel cost less than more seeds; and histories that count less are less alike.
const DENSE: &[&str] = &["initial.candidates=32", "spatial.cap=8"];
/// The paper's targets, and its neighbours.
const LUMINANCE: &str = "magnitude = 'luminance'\n";
const THREE: &[&str] = &["spatial.taps=3"];
/// Exact on glossy surfaces too.
const EXACT: &str = "domain = 'gi_path'\n";

const SUBJECTS: [Subject; 2] = [
    Subject {
        name: "di",
        graph: "restir_di_unbiased",
        settings: &["spatial.radius=4.0", "spatial.rows=0.0"],
        scenes: &[
            direct("cornell", STILL_AND_MOVING, ""),
            Lit { by_rule: &[("balance", MANY), ("contribution", MORE)], ..direct("many_lights", STILL_AND_MOVING, "") },
            Lit { settings: SEEN, by_rule: &[("contribution", FORGETFUL)], ..direct("sun_room", STILL_AND_MOVING, EVENLY) },
            Lit { settings: MET, by_rule: &[("contribution", ALIKE)], ..direct("glossy", STILL_AND_MOVING, "") },
            Lit { settings: FORGETFUL, ..direct(LAMPS, SWITCHED, "") },
        ],
        rules: &["pairwise", "balance", "contribution"],
        // 0.2 % of the whole, shown as equivalence; 1 % of every block that is resolved to 0.3 %.
        test: || BlockTest {
            overall_band: 0.002,
            overall_error: largest_error(0.002),
            block_band: 0.01,
            block_error: 0.003,
            ..equivalence()
        },
    },
    Subject {
        name: "gi",
        graph: "restir_gi_unbiased",
        settings: &["spatial.radius=4.0", "spatial.rows=0.0", "initial.candidates=8"],
        scenes: &[
            Lit { settings: THREE, ..indirect("cornell", "indirect:2", "", LUMINANCE) },
            Lit { settings: DENSE, by_rule: &[("contribution", CLOSE)], ..indirect("glossy", "indirect:2", "", EXACT) },
            Lit { settings: DENSE, by_rule: &[("contribution", BOUNDED)], ..indirect("door_ajar", "indirect:2", "", EXACT) },
            Lit { settings: DENSE, by_rule: &[("contribution", BOUNDED)], ..indirect("sun_room", "indirect:2", EVENLY, EXACT) },
            Lit { settings: THREE, ..indirect("cornell", "indirect:3", "", LUMINANCE) },
        ],
        rules: &["pairwise", "contribution"],
        // 0.5 % of the whole, shown as equivalence; 2 % of every block that is resolved to 0.7 %.
        test: || BlockTest { overall_error: largest_error(0.005), ..equivalence() },
    },
];

/// 80 % of the blocks must be resolved.
fn equivalence() -> BlockTest {
    BlockTest {
        overall_rule: Rule::Equivalent { alpha: 0.05 },
        block_rule: Rule::Inside { alpha: 0.05 },
        resolved_share: 0.8,
        ..BlockTest::default()
    }
}

/// What a row is about.
#[derive(Clone, Copy)]
struct Case {
    lit: &'static Lit,
    motion: &'static str,
    mis: &'static str,
}

impl Subject {
    fn cases(&'static self) -> Vec<Case> {
        let of = |lit: &'static Lit| lit.motions.iter().flat_map(move |motion| self.rules.iter().map(move |mis| Case { lit, motion, mis }));
        self.scenes.iter().flat_map(of).collect()
    }
}

/// How a process ends.
#[derive(Clone, Copy, PartialEq)]
enum End {
    /// Resolved, failed, or out of seeds.
    Settled = 0,
    /// It has the seeds that were asked for, and they do not resolve it.
    Open = 10,
    /// There are seeds to add.
    More = 11,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [subject, file, folder, commit, date, minutes, rest @ ..] = &arguments[..] else {
        eprintln!("unbiased_reuse di|gi FILE FOLDER COMMIT DATE MINUTES [+SEEDS] [SCENE[:RULE] …]");
        return ExitCode::from(2);
    };
    let Some(subject) = SUBJECTS.iter().find(|it| it.name == *subject) else {
        eprintln!("unbiased_reuse: `{subject}` is neither di nor gi");
        return ExitCode::from(2);
    };
    let minutes: f64 = minutes.parse().expect("MINUTES is a number");
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    let (fewest, rest) = match rest {
        [first, rest @ ..] if first.starts_with('+') => (first[1..].parse().expect("+SEEDS is a number"), rest),
        _ => (FEWEST_SEEDS, rest),
    };
    if let [part, case, goal] = rest
        && part == "part"
    {
        let Some(context) = context() else { return ExitCode::from(75) };
        let case = subject.cases()[case.parse::<usize>().expect("a number of a case")];
        let goal = goal.parse().expect("a number of seeds");
        let measuring = Measuring { context: &context, subject, case, folder: Path::new(folder), end, fewest };
        return ExitCode::from(measuring.part(goal, Evidence::open(file, commit, date, &context)) as u8);
    }
    fs::create_dir_all(folder).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let is_it = |case: &Case, name: &str| [case.lit.scene, &format!("{}:{}", case.lit.scene, case.mis)].contains(&name);
    let asked = |case: &Case| rest.is_empty() || rest.iter().any(|name| is_it(case, name));
    let mut open: Vec<usize> = subject.cases().iter().enumerate().filter(|(_, case)| asked(case)).map(|(number, _)| number).collect();
    let mut goal = FEWEST_SEEDS;
    while !open.is_empty() && goal < 2 * MOST_SEEDS {
        for case in std::mem::take(&mut open) {
            let mut found = End::More;
            while found == End::More && Instant::now() < end {
                let left = (end - Instant::now()).as_secs_f64() / 60.0;
                found = in_a_process(&arguments[..5], left, fewest, case, goal.min(MOST_SEEDS));
            }
            if found != End::Settled {
                open.push(case);
            }
        }
        goal *= 2;
    }
    ExitCode::SUCCESS
}

fn in_a_process(arguments: &[String], minutes: f64, fewest: u64, case: usize, goal: u64) -> End {
    let program = std::env::current_exe().expect("this program");
    let rest = [format!("{minutes:.2}"), format!("+{fewest}"), "part".into(), case.to_string(), goal.to_string()];
    let status = Command::new(program).args(arguments).args(rest).status().expect("this program runs");
    let ends = [End::Settled, End::Open, End::More];
    ends.into_iter().find(|end| status.code() == Some(*end as i32)).unwrap_or_else(|| panic!("a part of case {case} ended with {status}"))
}

/// Seeds with which a verdict settles a row that is to have at least `fewest`.
fn enough(verdict: Verdict, fewest: u64) -> u64 {
    let by_itself = match verdict {
        Verdict::Passed => FEWEST_SEEDS,
        Verdict::Failed => FEWEST_TO_FAIL,
        Verdict::NotResolved => MOST_SEEDS,
    };
    by_itself.max(fewest.min(MOST_SEEDS))
}

/// What seeds have shown so far, kept in a file, and of which graph, settings and shaders: of others it would be something else.
struct Shown {
    path: PathBuf,
    of: Value,
    moments: BlockMoments,
}

impl Shown {
    fn open(path: PathBuf, of: Value) -> Self {
        let kept = || {
            let kept: Value = serde_json::from_str(&fs::read_to_string(&path).ok()?).ok()?;
            if kept["of"] == of { serde_json::from_value(kept["moments"].clone()).ok() } else { None }
        };
        let moments = kept().unwrap_or_else(|| BlockMoments::new([64, 36], SIDE, Quantity::Luminance));
        Self { path, of, moments }
    }

    fn write(&self) {
        let text = json!({ "of": self.of, "moments": self.moments }).to_string();
        fs::write(&self.path, text).unwrap_or_else(|error| panic!("{}: {error}", self.path.display()));
    }
}

struct Measuring<'a> {
    context: &'a Context,
    subject: &'static Subject,
    case: Case,
    folder: &'a Path,
    end: Instant,
    fewest: u64,
}

impl Measuring<'_> {
    /// Adds seeds, at most up to `goal`, and writes what all of them show.
    fn part(&self, goal: u64, mut evidence: Evidence) -> End {
        let Case { lit, motion, mis } = self.case;
        let key = json!({ "scene": lit.scene, "transport": lit.transport, "motion": motion, "mis": mis });
        let is_settled = |row: &Value| {
            let seeds = row["seeds"].as_u64().unwrap_or_default();
            let verdicts = [Verdict::Passed, Verdict::Failed, Verdict::NotResolved];
            verdicts.into_iter().any(|verdict| row["verdict"] == verdict.to_string() && seeds >= enough(verdict, self.fewest))
        };
        if evidence.row(&key).is_some_and(is_settled) {
            return End::Settled;
        }
        let scene = if lit.scene == LAMPS { lamps(FRAME as f32 * STEP) } else { gliding(lit.scene, motion) };
        let moving = View { step: STEP, centred: true, ..View::default() };
        let name = format!("{}-{}-{}-{motion}", self.subject.name, lit.scene, lit.transport).replace([' ', ':'], "_");
        let mut reference = self.reference(&scene, &moving, &name, REFERENCE_SHARES[0]);
        let judged = |moments: &BlockMoments, reference: &Blocks| {
            compare_blocks(&moments.blocks(), reference, &(self.subject.test)()).expect("grids of one size")
        };
        let settled = |moments: &BlockMoments, reference: &Blocks| {
            moments.count() >= FEWEST_SEEDS && moments.count() >= enough(judged(moments, reference).verdict, self.fewest)
        };
        let graph = format!(
            "extends = '{}.toml'\ntransport = '{}'\n[slots]\nmis = '{mis}'\n{}{}",
            self.subject.graph, lit.transport, lit.slots, lit.ours
        );
        let further = lit.by_rule.iter().filter(|(rule, _)| *rule == mis).flat_map(|(_, settings)| *settings);
        let settings: Vec<&str> = self.subject.settings.iter().chain(lit.settings).chain(further).copied().collect();
        let parts = Parts { settings: &settings, keep: &["shade.color"], view: moving.clone(), ..Parts::new(&scene, &graph) };
        let mut renderer = parts.renderer(self.context);
        let shaders = parts.shader_digest();
        let mut shown = Shown::open(
            self.folder.join(format!("{name}-{mis}.json")),
            json!({ "graph": graph, "settings": settings, "shaders": shaders }),
        );
        let most = goal.min(shown.moments.count() + PART);
        while shown.moments.count() < most && Instant::now() < self.end && !settled(&shown.moments, &reference) {
            let from = shown.moments.count();
            add_seeds(&mut renderer, FRAME, from..most.min(from + FEWEST_SEEDS), &mut shown.moments);
            shown.write();
        }
        let moments = &shown.moments;
        if moments.count() >= MOST_SEEDS && judged(moments, &reference).verdict == Verdict::NotResolved {
            reference = self.reference(&scene, &moving, &name, REFERENCE_SHARES[1]);
        }
        if moments.count() > 0 {
            let found = judged(moments, &reference);
            eprintln!("{}, {}, {motion}, {mis}, {} seeds: {found}", lit.scene, lit.transport, moments.count());
            let mut row = told(&found);
            if moments.count() < enough(found.verdict, FEWEST_SEEDS) {
                row["verdict"] = json!(Verdict::NotResolved.to_string());
            }
            row["seeds"] = json!(moments.count());
            row["frame"] = json!(FRAME);
            row["slots"] = json!(format!("{}{}", lit.slots, lit.ours).trim());
            row["settings"] = json!(settings);
            row["shaders"] = json!(shaders);
            evidence.put(key, row);
        }
        if settled(moments, &reference) {
            End::Settled
        } else if moments.count() >= goal {
            End::Open
        } else {
            End::More
        }
    }

    /// At the moment of the frame that is compared, with that share of the variance that resolves a row. It has parts, a file each with its frames in
    /// its name, so that one which is not fine enough goes on.
    fn reference(&self, scene: &Arc<Scene>, moving: &View, name: &str, share: f64) -> Blocks {
        let blocks = |parts: &[(u32, Film)]| Blocks::of_film(&joined(parts), SIDE, Quantity::Luminance);
        // A film beside itself has twice its variance.
        let shrink = (2.0 * share).sqrt();
        let test = (self.subject.test)();
        let fine = BlockTest { overall_error: shrink * test.overall_error, block_error: shrink * test.block_error, ..test };
        let beside_itself = |parts: &[(u32, Film)]| compare_blocks(&blocks(parts), &blocks(parts), &fine).expect("grids of one size");
        let mut parts = self.parts_of_reference(name);
        if parts.is_empty() || beside_itself(&parts).verdict != Verdict::Passed {
            let held = View { time: moving.time_at(FRAME), step: 0.0, ..moving.clone() };
            let Lit { transport, slots, .. } = self.case.lit;
            let graph = format!("extends = 'path_tracer.toml'\ntransport = '{transport}'\n[slots]\n{slots}");
            let tracer = path_traced_parts(scene, &graph, held);
            let mut rolling = Parts { seed: tracer.seed + parts.len() as u64, ..tracer }.rolling(self.context);
            let begin = Instant::now();
            parts.push((0, Film::default()));
            let found = loop {
                let last = parts.last_mut().expect("one was pushed");
                *last = (last.0 + REFERENCE_FRAMES, rolling.after(REFERENCE_FRAMES));
                let frames = last.0;
                let found = beside_itself(&parts);
                if found.verdict == Verdict::Passed || frames >= MOST_REFERENCE_FRAMES {
                    break found;
                }
            };
            let (frames, film) = parts.last().expect("one was pushed");
            let path = self.folder.join(format!("{name}-{}-{frames}.exr", parts.len() - 1));
            eprintln!("{}: {:.0?}: {found}", path.display(), begin.elapsed());
            film.write(&path).unwrap_or_else(|error| panic!("{error}"));
        }
        blocks(&parts)
    }

    /// Those that are kept, by number: frames and films.
    fn parts_of_reference(&self, name: &str) -> Vec<(u32, Film)> {
        let folder = fs::read_dir(self.folder).unwrap_or_else(|error| panic!("{}: {error}", self.folder.display()));
        let numbered = |path: PathBuf| {
            let (number, frames) =
                path.file_name()?.to_str()?.strip_prefix(name)?.strip_prefix('-')?.strip_suffix(".exr")?.split_once('-')?;
            let film = Film::read(&path).unwrap_or_else(|error| panic!("{error}"));
            Some((number.parse::<u32>().ok()?, frames.parse().ok()?, film))
        };
        let mut parts: Vec<_> = folder.filter_map(|entry| numbered(entry.expect("a folder").path())).collect();
        parts.sort_by_key(|(number, ..)| *number);
        parts.into_iter().map(|(_, frames, film)| (frames, film)).collect()
    }
}

/// Means of so many frames each, as one mean.
fn joined(parts: &[(u32, Film)]) -> Film {
    let all: u32 = parts.iter().map(|(frames, _)| frames).sum();
    let share = |frames: u32| f64::from(frames) / f64::from(all);
    let size = parts[0].1.size;
    let mut color = vec![[0.0_f64; 3]; parts[0].1.pixels()];
    let mut variance = color.clone();
    for (frames, film) in parts {
        let of_mean = film.variance.as_ref().expect("a mean that was rendered has a variance");
        for (pixel, (mean, square)) in film.color.iter().zip(of_mean).enumerate() {
            for channel in 0..3 {
                color[pixel][channel] += share(*frames) * f64::from(mean[channel]);
                variance[pixel][channel] += share(*frames).powi(2) * f64::from(square[channel]);
            }
        }
    }
    let rounded = |plane: Vec<[f64; 3]>| plane.into_iter().map(|pixel| pixel.map(|value| value as f32)).collect();
    Film { size, color: rounded(color), variance: Some(rounded(variance)), ..Film::default() }
}
