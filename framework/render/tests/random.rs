//! Random valid graphs run, and give what a few lines of Rust give.

mod common;

use aquifer_render::RendererOptions;
use common::{pixels, plan, registry, render, renderer, small};
use proptest::{prelude::*, test_runner::Config};
use std::fmt::Write as _;

const FRAMES: usize = 4;

/// A tiny pass: what it does, and where its input comes from.
#[derive(Clone, Copy, Debug)]
struct Draft {
    kind: Kind,
    from: usize,
    previous: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// The frame's number.
    Source,
    /// Its input.
    Copy,
    /// Its input, or nothing, and one more.
    Count,
}

impl Kind {
    fn output(self) -> &'static str {
        match self {
            Kind::Source => "value",
            Kind::Copy => "image",
            Kind::Count => "after",
        }
    }
}

fn drafts() -> impl Strategy<Value = Vec<Draft>> {
    let kind = prop_oneof![1 => Just(Kind::Source), 1 => Just(Kind::Copy), 2 => Just(Kind::Count)];
    let draft = (kind, any::<usize>(), any::<bool>()).prop_map(|(kind, from, previous)| Draft { kind, from, previous });
    prop::collection::vec(draft, 1..9).prop_map(|mut drafts| {
        // A copy needs something to copy.
        drafts[0].kind = if drafts[0].kind == Kind::Copy { Kind::Count } else { drafts[0].kind };
        drafts
    })
}

/// The pass that pass `index` reads, and whether it reads last frame's output of it.
fn input(drafts: &[Draft], index: usize) -> Option<(usize, bool)> {
    match drafts[index] {
        Draft { kind: Kind::Source, .. } => None,
        Draft { from, previous: true, .. } => Some((from % drafts.len(), true)),
        Draft { .. } if index == 0 => None,
        Draft { from, .. } => Some((from % index, false)),
    }
}

fn text(drafts: &[Draft]) -> String {
    let mut text = String::new();
    for (index, draft) in drafts.iter().enumerate() {
        let _ = writeln!(text, "[pass.p{index}]\nkind = \"{}\"", format!("{:?}", draft.kind).to_lowercase());
        if let Some((from, previous)) = input(drafts, index) {
            let port = if draft.kind == Kind::Copy { "value" } else { "before" };
            let wire = format!("p{from}.{}{}", drafts[from].kind.output(), if previous { "@prev" } else { "" });
            let _ = writeln!(text, "in.{port} = \"{wire}\"");
        }
    }
    text
}

/// What each pass gives in the last frame.
fn expected(drafts: &[Draft]) -> Vec<f32> {
    let mut before = vec![0.0; drafts.len()];
    for frame in 0..FRAMES {
        let mut now = vec![0.0; drafts.len()];
        for (index, draft) in drafts.iter().enumerate() {
            let read = input(drafts, index).map_or(0.0, |(from, previous)| if previous { before[from] } else { now[from] });
            now[index] = match draft.kind {
                Kind::Source => frame as f32,
                Kind::Copy => read,
                Kind::Count => read + 1.0,
            };
        }
        before = now;
    }
    before
}

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::with_cases(48) })]

    #[test]
    fn valid_graphs_run(drafts in drafts(), poison: bool, counters: bool) {
        let registry = registry(&[]);
        let last = drafts.len() - 1;
        let output = format!("p{last}.{}", drafts[last].kind.output());
        let plan = plan(&registry, &output, &text(&drafts), &[]);
        let mut renderer = renderer(&registry, plan, RendererOptions { poison, counters, ..small() });
        render(&mut renderer, FRAMES as u32);
        prop_assert_eq!(pixels(&mut renderer, &output), vec![[expected(&drafts)[last]; 4]; 13 * 9], "{}", text(&drafts));
        prop_assert!(renderer.counts().unwrap().iter().all(|counts| counts.nan + counts.infinite == 0));
    }
}
