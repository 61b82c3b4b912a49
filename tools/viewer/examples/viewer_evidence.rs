//! What the viewer's session is measured by: seconds to the first pictures, pictures a second, memory while graphs are switched. Run it with
//! the machine to itself.
//!
//! ```text
//! cargo run -p aquifer-viewer --example viewer_evidence -- FILE COMMIT DATE MINUTES
//! ```
//!
//! Memory is that of the process, once a minute: first without switching, then while another graph is taken every few pictures. Software
//! adapters may lose some with every dispatch; what switching costs is the difference between the two slopes, for one frame rendered.

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
    let [file, commit, date, minutes] = &arguments[..] else {
        eprintln!("viewer_evidence FILE COMMIT DATE MINUTES");
        std::process::exit(2);
    };
    let minutes: f64 = minutes.parse().expect("minutes are a number");
    let began = Instant::now();
    let full = |graphs: &[&str]| aquifer_viewer::Opening { size: [1280, 720], ..opening(graphs, "cornell", vec![]) };
    let session = Session::start(full(&["path_tracer"]), || {});
    let board = wait(&session, "the first picture", |board| board.sides[0].picture.is_some());
    let first = began.elapsed().as_secs_f64();
    let one = pace(&session);
    let asked = Instant::now();
    session.send(Message::Recipe(1, Recipe::of("restir_di_unbiased")));
    wait(&session, "the second graph", |board| board.sides.len() > 1 && board.sides[1].picture.is_some());
    let second = asked.elapsed().as_secs_f64();
    let two = pace(&session);
    let spent: Vec<f64> = session.look().sides.iter().map(|side| side.spent).collect();
    drop(session);
    let memory = memory(minutes);
    let all = json!({
        "commit": commit, "date": date, "adapter": board.adapter, "scene": "cornell",
        "first picture s": rounded(first), "second graph s": rounded(second),
        "one graph": one, "two graphs": two, "ms spent by each": spent.into_iter().map(rounded).collect::<Vec<_>>(),
        "memory": memory,
    });
    let text = serde_json::to_string_pretty(&all).expect("plain data");
    println!("{text}");
    std::fs::write(file, text + "\n").unwrap_or_else(|error| panic!("{file}: {error}"));
}

/// Pictures a second at the size that the session chose, once it has settled.
fn pace(session: &Session) -> Value {
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
