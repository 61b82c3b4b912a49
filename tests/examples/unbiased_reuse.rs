//! Is unbiased reuse unbiased? One row for each scene, motion and rule: frame 8 over independent seeds against path tracing.
//!
//! ```text
//! cargo run -p aquifer-tests --example unbiased_reuse -- di|gi FILE FOLDER COMMIT DATE MINUTES [SCENE[:RULE] …]
//! ```
//!
//! FOLDER keeps references and what seeds have shown so far: a run that was stopped goes on where it was. Seeds are added to all rows in turn, twice as
//! many each time, until a row is resolved or has failed, has its 4,000 seeds, or the time is over. Rows that FILE holds as settled are left alone, of
//! whichever commit they are: who wants them anew deletes them there. Each part of a row is a process of its own: lavapipe keeps some memory of every
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
    path::Path,
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
/// Of a reference, of eight paths each: how many at a time, and at most.
const REFERENCE_FRAMES: u32 = 512;
const MOST_REFERENCE_FRAMES: u32 = 16_384;

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
    /// Further ones, by the rule `contribution`.
    by_contribution: &'static [&'static str],
}

const fn direct(scene: &'static str, motions: &'static [&'static str], slots: &'static str) -> Lit {
    Lit { scene, motions, transport: "direct", slots, ours: "", settings: &[], by_contribution: &[] }
}

const fn indirect(scene: &'static str, transport: &'static str, slots: &'static str, ours: &'static str) -> Lit {
    Lit { scene, motions: &["still", "camera moves"], transport, slots, ours, settings: &[], by_contribution: &[] }
}

const STILL_AND_MOVING: &[&str] = &["still", "all moves"];
/// `LAMPS`: one goes out and one comes up at the frame that is compared.
const SWITCHED: &[&str] = &["lamps switch"];
const LAMPS: &str = "lamps";

/// Where a sun is among few lights, drawing them by power gives it nearly all samples, and what the lamps light is noise.
const EVENLY: &str = "proposal = 'uniform'\n";
/// Most of what is drawn there is hidden: more samples are tested.
const SEEN: &[&str] = &["initial.candidates=8", "initial.winners=8"];
/// Lamps mirrored by glossy surfaces are seldom drawn by their power: their light would come in few large pieces. And where what is mirrored moves, a
/// history of confidence c outweighs by up to c what the pixel itself finds there, frame after frame.
const MET: &[&str] = &["initial.candidates=12", "initial.bsdf_rays=4", "temporal.cap=1"];
/// Shares of confidence alone bound no weight by p̂ / p̂_i, which is large between narrow lobes that point elsewhere: neighbours must be turned alike.
/// What they give otherwise is told in docs/restir_di.md.
const ALIKE: &[&str] = &["spatial.normal=4.0", "temporal.normal=4.0"];
/// Exact on glossy surfaces too.
const EXACT: &str = "domain = 'gi_path'\n";

const SUBJECTS: [Subject; 2] = [
    Subject {
        name: "di",
        graph: "restir_di_unbiased",
        settings: &["spatial.radius=4.0", "spatial.rows=0.0"],
        scenes: &[
            direct("cornell", STILL_AND_MOVING, ""),
            direct("many_lights", STILL_AND_MOVING, ""),
            Lit { settings: SEEN, ..direct("sun_room", STILL_AND_MOVING, EVENLY) },
            Lit { settings: MET, by_contribution: ALIKE, ..direct("glossy", STILL_AND_MOVING, "") },
            direct(LAMPS, SWITCHED, ""),
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
            indirect("cornell", "indirect:2", "", ""),
            Lit { by_contribution: ALIKE, ..indirect("glossy", "indirect:2", "", EXACT) },
            indirect("door_ajar", "indirect:2", "", EXACT),
            indirect("sun_room", "indirect:2", EVENLY, EXACT),
            indirect("cornell", "indirect:3", "", ""),
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
        block_rule: Rule::Exceeds { alpha: 0.05 },
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
        eprintln!("unbiased_reuse di|gi FILE FOLDER COMMIT DATE MINUTES [SCENE[:RULE] …]");
        return ExitCode::from(2);
    };
    let Some(subject) = SUBJECTS.iter().find(|it| it.name == *subject) else {
        eprintln!("unbiased_reuse: `{subject}` is neither di nor gi");
        return ExitCode::from(2);
    };
    let minutes: f64 = minutes.parse().expect("MINUTES is a number");
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    if let [part, case, goal] = rest
        && part == "part"
    {
        let Some(context) = context() else { return ExitCode::from(75) };
        let case = subject.cases()[case.parse::<usize>().expect("a number of a case")];
        let goal = goal.parse().expect("a number of seeds");
        let measuring = Measuring { context: &context, subject, case, folder: Path::new(folder), end };
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
                found = in_a_process(&arguments[..5], left, case, goal.min(MOST_SEEDS));
            }
            if found != End::Settled {
                open.push(case);
            }
        }
        goal *= 2;
    }
    ExitCode::SUCCESS
}

fn in_a_process(arguments: &[String], minutes: f64, case: usize, goal: u64) -> End {
    let program = std::env::current_exe().expect("this program");
    let rest = [format!("{minutes:.2}"), "part".into(), case.to_string(), goal.to_string()];
    let status = Command::new(program).args(arguments).args(rest).status().expect("this program runs");
    let ends = [End::Settled, End::Open, End::More];
    ends.into_iter().find(|end| status.code() == Some(*end as i32)).unwrap_or_else(|| panic!("a part of case {case} ended with {status}"))
}

/// Seeds with which a verdict settles a row.
fn enough(verdict: Verdict) -> u64 {
    match verdict {
        Verdict::Passed => FEWEST_SEEDS,
        Verdict::Failed => FEWEST_TO_FAIL,
        Verdict::NotResolved => MOST_SEEDS,
    }
}

struct Measuring<'a> {
    context: &'a Context,
    subject: &'static Subject,
    case: Case,
    folder: &'a Path,
    end: Instant,
}

impl Measuring<'_> {
    /// Adds seeds, at most up to `goal`, and writes what all of them show.
    fn part(&self, goal: u64, mut evidence: Evidence) -> End {
        let Case { lit, motion, mis } = self.case;
        let key = json!({ "scene": lit.scene, "transport": lit.transport, "motion": motion, "mis": mis });
        let is_settled = |row: &Value| {
            let seeds = row["seeds"].as_u64().unwrap_or_default();
            let verdicts = [Verdict::Passed, Verdict::Failed, Verdict::NotResolved];
            verdicts.into_iter().any(|verdict| row["verdict"] == verdict.to_string() && seeds >= enough(verdict))
        };
        if evidence.row(&key).is_some_and(is_settled) {
            return End::Settled;
        }
        let scene = if lit.scene == LAMPS { lamps(FRAME as f32 * STEP) } else { gliding(lit.scene, motion) };
        let moving = View { step: STEP, centred: true, ..View::default() };
        let name = format!("{}-{}-{}-{motion}", self.subject.name, lit.scene, lit.transport).replace([' ', ':'], "_");
        let kept = self.folder.join(format!("{name}-{mis}.json"));
        let read = || serde_json::from_str::<BlockMoments>(&fs::read_to_string(&kept).ok()?).ok();
        let mut moments = read().unwrap_or_else(|| BlockMoments::new([64, 36], SIDE, Quantity::Luminance));
        let reference = self.reference(&scene, &moving, &self.folder.join(format!("{name}.exr")));
        let judged =
            |moments: &BlockMoments| compare_blocks(&moments.blocks(), &reference, &(self.subject.test)()).expect("grids of one size");
        let settled = |moments: &BlockMoments| moments.count() >= FEWEST_SEEDS && moments.count() >= enough(judged(moments).verdict);
        let most = goal.min(moments.count() + PART);
        let graph = format!(
            "extends = '{}.toml'\ntransport = '{}'\n[slots]\nmis = '{mis}'\n{}{}",
            self.subject.graph, lit.transport, lit.slots, lit.ours
        );
        let further = if mis == "contribution" { lit.by_contribution } else { &[] };
        let settings = [self.subject.settings, lit.settings, further].concat();
        let parts = Parts { settings: &settings, keep: &["shade.color"], view: moving, ..Parts::new(&scene, &graph) };
        let mut renderer = parts.renderer(self.context);
        while moments.count() < most && Instant::now() < self.end && !settled(&moments) {
            let from = moments.count();
            add_seeds(&mut renderer, FRAME, from..most.min(from + FEWEST_SEEDS), &mut moments);
            let text = serde_json::to_string(&moments).expect("plain data");
            fs::write(&kept, text).unwrap_or_else(|error| panic!("{}: {error}", kept.display()));
        }
        if moments.count() > 0 {
            let found = judged(&moments);
            eprintln!("{}, {}, {motion}, {mis}, {} seeds: {found}", lit.scene, lit.transport, moments.count());
            let mut row = told(&found);
            if !settled(&moments) {
                row["verdict"] = json!(Verdict::NotResolved.to_string());
            }
            row["seeds"] = json!(moments.count());
            row["frame"] = json!(FRAME);
            evidence.put(key, row);
        }
        if settled(&moments) {
            End::Settled
        } else if moments.count() >= goal {
            End::Open
        } else {
            End::More
        }
    }

    /// At the moment of the frame that is compared, with at most half the variance that resolves a row: what is resolved beside itself.
    fn reference(&self, scene: &Arc<Scene>, moving: &View, path: &Path) -> Blocks {
        let blocks = |film: &Film| Blocks::of_film(film, SIDE, Quantity::Luminance);
        let film = Film::read(path).unwrap_or_else(|_| {
            let held = View { time: moving.time_at(FRAME), step: 0.0, ..moving.clone() };
            let graph =
                format!("extends = 'path_tracer.toml'\ntransport = '{}'\n[slots]\n{}", self.case.lit.transport, self.case.lit.slots);
            let mut rolling = path_traced_parts(scene, &graph, held).rolling(self.context);
            let test = (self.subject.test)();
            let begin = Instant::now();
            let mut frames = 0;
            let film = loop {
                let film = rolling.after(REFERENCE_FRAMES);
                frames += REFERENCE_FRAMES;
                let beside_itself = compare_blocks(&blocks(&film), &blocks(&film), &test).expect("grids of one size");
                if beside_itself.verdict == Verdict::Passed || frames >= MOST_REFERENCE_FRAMES {
                    eprintln!("{}: {frames} frames in {:.0?}: {beside_itself}", path.display(), begin.elapsed());
                    break film;
                }
            };
            film.write(path).unwrap_or_else(|error| panic!("{error}"));
            film
        });
        blocks(&film)
    }
}
