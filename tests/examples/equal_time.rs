//! Resampling against path tracing at equal time, by `aquifer compare`: one frame after 32, a scene at a time.
//!
//! ```text
//! cargo run -p aquifer-tests --example equal_time -- PROGRAM FILE FOLDER COMMIT DATE di|gi WxH [SCENE …]
//! ```
//!
//! Rows are added to FILE, or renewed there; FOLDER keeps pages and films, and references for the next time.

use aquifer_tests::{context, evidence::Evidence, fair_settings};
use serde_json::{Value, json};
use std::process::{Command, Stdio};

/// A kind of light: the baseline, what is held against it, and where.
struct Subject {
    name: &'static str,
    transport: &'static str,
    graphs: &'static [&'static str],
    scenes: &'static [&'static str],
    seeds: &'static str,
}

const SUBJECTS: [Subject; 2] = [
    Subject {
        name: "di",
        transport: "direct",
        graphs: &["path_tracer", "restir_di", "restir_di_unbiased"],
        scenes: &["many_lights", "cornell"],
        seeds: "16",
    },
    Subject {
        name: "gi",
        transport: "indirect:2",
        graphs: &["path_tracer_indirect", "restir_gi_unbiased", "restir_gi_tuned", "restir_gi"],
        scenes: &["sunlit_wall", "door_ajar", "cornell", "sun_room", "glossy", "animated"],
        // With 16, two runs on animated had 9.9 and 7.9 times.
        seeds: "32",
    },
];

const WARM_UP: &str = "32";
/// At most; they end when their variance is small beside the errors.
const REFERENCE_SAMPLES: &str = "65536";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [program, file, folder, commit, date, subject, size, named @ ..] = &arguments[..] else {
        eprintln!("equal_time PROGRAM FILE FOLDER COMMIT DATE di|gi WxH [SCENE …]");
        std::process::exit(2);
    };
    let Some(subject) = SUBJECTS.iter().find(|it| it.name == *subject) else {
        eprintln!("equal_time: `{subject}` is neither di nor gi");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    let wanted: Vec<&str> = if named.is_empty() { subject.scenes.to_vec() } else { named.iter().map(String::as_str).collect() };
    for scene in wanted {
        let out = format!("{folder}/{}-{scene}-{size}", subject.name);
        let options = ["--transport", subject.transport, "--scene", scene, "--size", size, "--seeds", subject.seeds, "--warm-up", WARM_UP];
        let rest = ["--reference-samples", REFERENCE_SAMPLES, "--json", "-o", &out];
        let settings = fair_settings(scene).iter().flat_map(|setting| ["--set", setting]);
        let mut command = Command::new(program);
        let command = command.arg("compare").args(subject.graphs).args(options).args(rest).args(settings);
        let output = command.stderr(Stdio::inherit()).output();
        let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
        let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{scene}: {error}"));
        for (graph, found) in told(&report) {
            evidence.put(json!({ "subject": subject.name, "scene": scene, "graph": graph, "size": size }), found);
        }
    }
}

/// Of each graph but the baseline.
fn told(report: &Value) -> Vec<(String, Value)> {
    let scene = &report["scenes"][0];
    let cells = scene["cells"].as_array().expect("cells");
    let row = |pair: &Value| {
        let cell = |side: &str| &cells[pair[side].as_u64().expect("the number of a cell") as usize];
        let (ours, baseline) = (cell("other"), cell("baseline"));
        let graph = report["graphs"][ours["graph"].as_u64().expect("the number of a graph") as usize]["name"].as_str().expect("a name");
        let is_equal = pair["equal_time"].as_bool().expect("yes or no");
        let bias = &ours["bias"];
        let of = |name: &str| bias[name].as_f64().unwrap_or(f64::NAN);
        let interval = |estimate: &Value, value: &str| json!({ "value": estimate[value], "interval": estimate["interval"] });
        let found = json!({
            "ms": ours["time_ms"]["median"], "mse": interval(&ours["mse"], "median"),
            "baseline ms": baseline["time_ms"]["median"], "baseline mse": interval(&baseline["mse"], "median"),
            "equal time": is_equal, "times lower": interval(&pair[if is_equal { "mse" } else { "mse_time" }], "value"),
            "times lower, relMSE": interval(&pair["rel_mse"], "value"), "better": pair["better"],
            "bias² share": of("bias_squared") / (of("bias_squared") + of("variance")),
            "reference share": scene["references"][ours["reference"].as_u64().unwrap_or_default() as usize]["share"],
            "driver": report["made"]["driver"],
        });
        (graph.to_owned(), found)
    };
    scene["pairs"].as_array().expect("pairs").iter().map(row).collect()
}
