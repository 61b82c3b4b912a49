//! `aquifer compare`: growing budgets, animations, and what biased switches do, on the renderer.

use crate::{
    compare::report,
    run::{Run, aquifer, names},
};
use aquifer_lab::film::Film;
use serde_json::Value;

/// Compares light sampling with reuse at small cost, and reads the report.
fn compared(protocol: &str) -> (tempfile::TempDir, Run, Value) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let graphs = ["compare", "light_sampling", "restir_di_unbiased", "-o", out, "--cache", out];
    let run = aquifer(&graphs.into_iter().chain(protocol.split_whitespace()).collect::<Vec<_>>());
    assert_eq!(run.code, 0, "{}", run.err);
    let report = report(folder.path());
    (folder, run, report)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|value| value.as_f64().expect("a number")).collect()
}

#[test]
fn growing_budgets_give_curves_and_the_time_of_equal_error() {
    let protocol = "--protocol accumulate --frames 16 --warm-up 4 --seeds 5";
    let (folder, run, report) = compared(&format!("--scene cornell --size 32x18 --reference-samples 1024 {protocol}"));
    let scene = &report["scenes"][0];
    for cell in scene["cells"].as_array().unwrap() {
        let curve = cell["curve"].as_array().unwrap();
        let frames: Vec<f64> = curve.iter().map(|point| point["frame"].as_f64().unwrap()).collect();
        let times: Vec<f64> = curve.iter().map(|point| point["time_ms"].as_f64().unwrap()).collect();
        assert!(frames.starts_with(&[1.0, 2.0, 4.0]) && frames.is_sorted() && times.is_sorted(), "{frames:?} {times:?}");
        let errors: Vec<f64> = curve.iter().map(|point| point["mse"]["median"].as_f64().unwrap()).collect();
        assert!(errors[0] > 2.0 * errors[errors.len() - 1], "averages have less error: {errors:?}");
        let gains = cell["correlation"]["accumulation_gain"].as_array().unwrap();
        assert_eq!(gains.len(), curve.len());
    }
    // Frames of light sampling share nothing: the mean of N has a share of 1/N of the variance.
    let gain = scene["cells"][0]["correlation"]["accumulation_gain"][3][1].as_f64().unwrap();
    assert!((0.6..1.6).contains(&gain), "{gain}");
    let reaches = scene["equal_error"]["reaches"].as_array().unwrap();
    assert_eq!(reaches.len(), 2);
    for reach in reaches {
        let most = scene["cells"][reach["cell"].as_u64().unwrap() as usize]["time_ms"]["median"].as_f64().unwrap();
        let time = reach["time_ms"].as_f64().expect("what all reach is reached");
        assert!(time > 0.0 && time <= 1.01 * most, "{reach}");
    }
    assert!(run.out.contains("`restir_di_unbiased` reaches it in"), "{}", run.out);
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains("<h3>Equal error</h3>") && page.contains("data-kind=\"reach\""));
}

#[test]
fn every_frame_of_an_animation_has_its_own_truth() {
    let protocol = "--protocol trace --frames 3 --step 0.25 --seeds 3";
    let (folder, _, report) = compared(&format!("--scene animated --size 16x9 --reference-samples 256 {protocol}"));
    let cells = report["scenes"][0]["cells"].as_array().unwrap();
    let restir = cells.iter().find(|cell| cell["graph"] == 1).unwrap();
    let curve = restir["curve"].as_array().unwrap();
    let times: Vec<f64> = curve.iter().map(|point| point["animation_time"].as_f64().unwrap()).collect();
    assert_eq!(times, [0.0, 0.25, 0.5]);
    assert_eq!(restir["correlation"]["temporal"].as_array().unwrap().len(), 2);
    // A reference of the first moment would be far from the last frame. Each says of which moment it is.
    let references = names(folder.path()).into_iter().filter(|name| name.len() > 32 && name.ends_with(".exr"));
    let time = |name: String| Film::read(&folder.path().join(name)).unwrap().facts.unwrap().animation_time;
    let mut times: Vec<f32> = references.map(time).collect();
    times.sort_by(f32::total_cmp);
    assert_eq!(times, [0.0, 0.25, 0.5]);
    assert!(numbers(&restir["mse"]["values"]).iter().all(|mse| mse.is_finite()));
}

#[test]
fn biased_switches_are_turned_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    // Far neighbours whose shadows are not tested: what 1/M loses, light through walls makes up for in the mean.
    let biased = "restir_di,slots.visibility=untested,spatial.radius=360.0";
    let args = ["compare", "restir_di_unbiased", biased, "--scene", "cornell", "--size", "32x18", "--warm-up", "6", "--seeds", "6"];
    let more = ["--explain-bias", "--reference-samples", "1024", "-o", out, "--cache", out];
    let run = aquifer(&[&args[..], &more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let report = report(folder.path());
    let explained = report["scenes"][0]["explained"].as_array().unwrap();
    assert_eq!(explained.len(), 1, "an unbiased graph has nothing to explain");
    let explained = &explained[0];
    assert_eq!(explained["graph"], 1);
    let [visibility, mis] = &explained["switches"].as_array().unwrap()[..] else { panic!("{explained}") };
    assert_eq!([&visibility["setting"], &mis["setting"]], ["slots.visibility=in_target", "slots.mis=contribution"]);
    let mean = |share: &Value| (share["mean_difference"].as_f64().unwrap(), share["mean_error"].as_f64().unwrap());
    let (lost, error) = mean(&mis["alone"]);
    assert!(lost < -4.0 * error, "{explained}");
    let (kept, error) = mean(&visibility["alone"]);
    assert!(kept - lost > 4.0 * error, "{explained}");
    let (off, error) = mean(&explained["all_off"]);
    assert!(off.abs() < 4.0 * error && off.abs() < 0.5 * lost.abs(), "{explained}");
    // Where the mean hides it, the squared bias does not.
    let squared = |share: &Value| numbers(&share["bias_squared_interval"]);
    assert!(squared(&explained["all_on"])[0] > squared(&explained["all_off"])[1], "{explained}");
    assert!(run.out.contains("off: slots.mis=contribution"), "{}", run.out);
    assert!(std::fs::read_to_string(folder.path().join("report.html")).unwrap().contains("by its switches</h3>"));
}

#[test]
fn what_belongs_to_another_protocol_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let with = |more: &[&str]| {
        let all = ["compare", "restir_di", "--scene", "cornell", "-o", folder.path().to_str().unwrap()];
        aquifer(&all.iter().chain(more).copied().collect::<Vec<&str>>())
    };
    with(&["--equal-error", "0.1"]).fails(1, "--protocol accumulate");
    with(&["--equal-error", "0", "--protocol", "accumulate"]).fails(2, "an error above 0");
    with(&["--explain-bias", "--protocol", "trace"]).fails(1, "--protocol frame");
}
