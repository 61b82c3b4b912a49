//! A small comparison with images whose values are known: the reference dark on its left half and bright on its right, one graph equal to it, one
//! half as bright again.

use aquifer_lab::{
    compare::{
        report::{
            Better, BiasFigures, BiasVerdict, Cell, Correlation, EqualError, Explained, GraphFacts, Made, Pair, PassShare, Point, Protocol,
            Ratio, Reach, ReferenceFacts, Report, SCHEMA, SceneResult, Share, SwitchShare, Variant,
        },
        summary::Summary,
    },
    film::Film,
};
use std::path::Path;

pub const SIZE: [u32; 2] = [32, 18];
pub const DARK: f32 = 0.125;
pub const BRIGHT: f32 = 0.5;
/// Of the second graph over the reference.
pub const FACTOR: f32 = 1.5;

fn film(factor: f32) -> Film {
    let pixel = |i: u32| [factor * if i % SIZE[0] < SIZE[0] / 2 { DARK } else { BRIGHT }; 3];
    Film::new(SIZE, (0..SIZE[0] * SIZE[1]).map(pixel).collect()).expect("a pixel for every place")
}

fn summary(median: f64) -> Summary {
    Summary { median, interval: Some([0.9 * median, 1.1 * median]), values: vec![median; 16] }
}

fn cell(graph: usize, error: f64) -> Cell {
    let pass = |pass: &str, ms: f64, counted| PassShare { pass: pass.into(), ms, counted };
    let point = |n: u32| Point {
        frame: n,
        time_ms: 10.0 * f64::from(n),
        mse: summary(error / f64::from(n)),
        rel_mse: Some(summary(2.0 * error / f64::from(n))),
        ..Point::default()
    };
    Cell {
        graph,
        variants: vec![Variant { knob: None, frames: 16, time_ms: 160.0, weight: 1.0 }],
        time_ms: summary(160.0),
        mse: summary(error),
        rel_mse: Some(summary(2.0 * error)),
        metrics: [("mape".to_owned(), summary(0.1)), ("flip_hdr".to_owned(), summary(0.2))].into(),
        passes: vec![pass("gbuffer", 2.0, true), pass("path_tracer", 8.0, true), pass("tonemap", 1.0, false)],
        image: Some(format!("graph{graph}.exr")),
        mean_image: Some(format!("graph{graph}.exr")),
        curve: [1, 2, 4, 8, 16].map(point).to_vec(),
        bias: Some(BiasFigures {
            seeds: 16,
            variance: error,
            band: 0.005,
            mean_difference: graph as f64 * 0.5,
            mean_error: 1e-3,
            verdict: if graph == 1 { BiasVerdict::Biased } else { BiasVerdict::Unbiased },
            ..BiasFigures::default()
        }),
        correlation: Some(Correlation {
            temporal: vec![0.5, 0.25, 0.1],
            spatial: vec![0.3, 0.1],
            flicker: 0.2,
            accumulation_gain: vec![(8, 0.5)],
        }),
        ..Cell::default()
    }
}

fn reach(cell: usize, time: f64, speed_up: Option<Ratio>) -> Reach {
    let sentence =
        if cell == 1 { "`second` reaches it in 37.5 ms, 4.00 times sooner than `first`" } else { "`first` reaches it in 150.0 ms" };
    Reach { cell, time_ms: Some(time), interval: Some([0.9 * time, 1.1 * time]), at_once: false, speed_up, sentence: sentence.into() }
}

fn explained() -> Explained {
    let share = |mean_difference: f64| Share {
        mean_difference,
        mean_error: 1e-3,
        bias_squared: mean_difference.powi(2),
        bias_squared_interval: Some([0.0, 0.5]),
    };
    let switch = SwitchShare {
        what: "slot `mis` is `constant`: it loses energy".into(),
        setting: Some("slots.mis=contribution".into()),
        alone: Some(share(0.25)),
        without: Some(share(0.125)),
    };
    let stuck = SwitchShare { what: "kind `boiling_filter`: what is hard to find darkens".into(), ..SwitchShare::default() };
    Explained { graph: 1, seeds: 16, all_on: share(0.5), all_off: Some(share(0.0)), switches: vec![switch, stuck] }
}

/// The report; its images go to `folder`.
pub fn report(folder: &Path) -> Report {
    for (name, factor) in [("reference.exr", 1.0), ("graph0.exr", 1.0), ("graph1.exr", FACTOR)] {
        film(factor).write(&folder.join(name)).expect("the folder can be written");
    }
    let graph = |name: &str| GraphFacts {
        name: name.into(),
        title: "A <title> & more".into(),
        text: "title = \"</script>\"".into(),
        ..GraphFacts::default()
    };
    let ratio = |value| Ratio { value, interval: Some([0.8 * value, 1.2 * value]) };
    let pair = Pair {
        other: 1,
        time: ratio(1.0),
        equal_time: true,
        mse: ratio(4.0),
        rel_mse: Some(ratio(4.0)),
        mse_time: ratio(4.0),
        better: Better::Other,
        sentence: "second has 4.00 times lower relMSE than first at equal time".into(),
        ..Pair::default()
    };
    let scene = |name: &str| SceneResult {
        name: name.into(),
        size: SIZE,
        references: vec![ReferenceFacts {
            transport: "full:4".into(),
            image: "reference.exr".into(),
            samples: 65_536,
            ..ReferenceFacts::default()
        }],
        cells: vec![cell(0, 0.04), cell(1, 0.01)],
        pairs: vec![pair.clone()],
        equal_error: Some(EqualError { mse: 0.002, reaches: vec![reach(0, 150.0, None), reach(1, 37.5, Some(ratio(4.0)))] }),
        explained: vec![explained()],
        ..SceneResult::default()
    };
    Report {
        schema: SCHEMA,
        made: Made { command: vec!["aquifer".into(), "compare".into()], ..Made::default() },
        protocol: Protocol::Accumulate { warm_up: 0, frames: 16, seeds: 16, centred: false },
        graphs: vec![graph("first"), graph("second")],
        scenes: vec![scene("cornell"), scene("glossy")],
        warnings: vec!["a warning".into()],
    }
}
