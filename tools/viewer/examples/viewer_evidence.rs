//! What the viewer's session is measured by: seconds to the first pictures and pictures a second, with the machine to itself; memory while
//! graphs are switched, for so many minutes.
//!
//! ```text
//! cargo run -p aquifer-viewer --example viewer_evidence -- FILE COMMIT DATE pace
//! cargo run -p aquifer-viewer --example viewer_evidence -- FILE COMMIT DATE memory MINUTES
//! ```
//!
//! Memory is that of the process, once a minute: first without switching, then while another graph is taken every few pictures. Some drivers
//! lose memory with every dispatch (docs/limits.md); what switching costs is the difference between the two slopes, for one picture.

#[path = "../tests/common/board.rs"]
mod board;
#[path = "../tests/common/opening.rs"]
mod opening;
#[path = "../tests/common/waiting.rs"]
mod waiting;

use aquifer_viewer::{
    Recipe,
    session::{Board, Choice, Message, Session},
};
use board::wait;
use opening::opening;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Graphs that take turns.
const GRAPHS: [&str; 4] = ["light_sampling", "ris_only", "restir_di", "path_tracer"];
/// How much shorter than the switching the time without it is: enough for a slope.
const STILL: f64 = 5.0;
/// Seconds that pictures are counted for.
const COUNTING: Duration = Duration::from_secs(10);

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (about, found) = match words[..] {
        [file, commit, date, "pace"] => ([file, commit, date, "pace"], pace()),
        [file, commit, date, "memory", minutes] => ([file, commit, date, "memory"], memory(minutes.parse().expect("minutes are a number"))),
        _ => {
            eprintln!("viewer_evidence FILE COMMIT DATE pace | memory MINUTES");
            std::process::exit(2);
        }
    };
    println!("{found:#}");
    keep(about, found);
}

/// Puts what was found into the file, in place of what was there under that name.
fn keep([file, commit, date, name]: [&str; 4], found: Value) {
    let old = std::fs::read_to_string(file).ok().and_then(|text| serde_json::from_str(&text).ok());
    let mut all: Value = old.unwrap_or_else(|| json!({}));
    let adapter = aquifer_render::adapters().into_iter().next().expect("something has rendered");
    all[name] =
        json!({ "commit": commit, "date": date, "adapter": adapter.name, "driver": adapter.driver, "scene": "cornell", "found": found });
    let text = format!("{all:#}\n");
    std::fs::write(file, text).unwrap_or_else(|error| panic!("{file}: {error}"));
}

/// Seconds to the first pictures, and pictures a second.
fn pace() -> Value {
    let began = Instant::now();
    let full = |graphs: &[&str]| aquifer_viewer::Opening { size: [1280, 720], ..opening(graphs, "cornell", vec![]) };
    let session = Session::start(full(&["path_tracer"]), || {});
    wait(&session, "the first picture", |board| board.sides[0].picture.is_some());
    let first = began.elapsed().as_secs_f64();
    let one = counted(&session);
    let asked = Instant::now();
    session.send(Message::Recipe(1, Recipe::of("restir_di_unbiased")));
    wait(&session, "the second graph", |board| board.sides.len() > 1 && board.sides[1].picture.is_some());
    let second = asked.elapsed().as_secs_f64();
    let two = counted(&session);
    let spent: Vec<f64> = session.look().sides.iter().map(|side| rounded(side.spent)).collect();
    json!({ "first picture s": rounded(first), "second graph s": rounded(second), "one graph": one, "two graphs": two, "ms spent by each": spent })
}

/// Pictures a second at the size that the session chose, once it has settled.
fn counted(session: &Session) -> Value {
    std::thread::sleep(COUNTING);
    let (before, began) = (session.look().updates, Instant::now());
    std::thread::sleep(COUNTING);
    let board = session.look();
    let size = board.sides[0].picture.as_ref().map(|picture| picture.film.size);
    json!({ "size": size, "pictures/s": rounded((board.updates - before) as f64 / began.elapsed().as_secs_f64()) })
}

/// MiB of the process while one graph renders, then while graphs are switched.
fn memory(minutes: f64) -> Value {
    let session = Session::start(opening(&GRAPHS[..1], "cornell", vec![]), || {});
    session.send(Message::Scale(Choice::Fixed(f64::MAX)));
    // Every graph once, so that nothing is compiled for the first time later.
    for graph in GRAPHS {
        switch(&session, graph);
    }
    switch(&session, GRAPHS[0]);
    let still = watch(&session, minutes / STILL, |_| 0);
    let switched = watch(&session, minutes, |turn| {
        switch(&session, GRAPHS[turn % GRAPHS.len()]);
        1
    });
    json!({ "without switching": still, "switching": switched })
}

fn switch(session: &Session, graph: &str) {
    let wanted = Recipe::of(graph);
    session.send(Message::Recipe(0, wanted.clone()));
    let renders = |board: &Board| {
        board.sides[0].recipe == wanted
            && !board.sides[0].building
            && board.sides[0].picture.as_ref().is_some_and(|picture| picture.frames > 1)
    };
    wait(session, graph, renders);
}

fn watch(session: &Session, minutes: f64, mut turn: impl FnMut(usize) -> u64) -> Value {
    let (began, first) = (Instant::now(), session.look().updates);
    let (mut switches, mut turns, mut samples) = (0, 0, vec![resident()]);
    while began.elapsed().as_secs_f64() < 60.0 * minutes {
        switches += turn(turns);
        turns += 1;
        std::thread::sleep(Duration::from_millis(200));
        if began.elapsed().as_secs_f64() >= 60.0 * samples.len() as f64 {
            samples.push(resident());
        }
    }
    samples.push(resident());
    let pictures = session.look().updates - first;
    let growth = samples.last().unwrap_or(&0.0) - samples[0];
    json!({
        "minutes": rounded(began.elapsed().as_secs_f64() / 60.0), "pictures": pictures, "switches": switches, "MiB by minute": samples.iter().copied().map(rounded).collect::<Vec<_>>(),
        "KiB a picture": rounded(1024.0 * growth / pictures.max(1) as f64),
    })
}

/// MiB that the process occupies; 0 where the system does not tell.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).map_or(0.0, |kib| kib / 1024.0)
}

fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}
