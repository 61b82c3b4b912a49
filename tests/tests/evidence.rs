//! Tables in the docs say what the evidence files say.

use serde_json::Value;
use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn text<'a>(row: &'a Value, key: &str) -> &'a str {
    row[key].as_str().unwrap_or_else(|| panic!("no text `{key}` in {row}"))
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or(f64::NAN)
}

/// Those lines of a page that `shown` finds are the evidence's rows as `line` writes them. To renew the page, take them from the failure.
fn assert_table(page: &str, evidence: &str, shown: fn(&&str) -> bool, line: fn(&Value) -> String) {
    let evidence: Value = serde_json::from_str(&read(evidence)).expect("the evidence is JSON");
    let table: Vec<String> = evidence["rows"].as_array().expect("rows").iter().map(line).collect();
    assert!(!table.is_empty());
    let text = read(page);
    let shown: Vec<&str> = text.lines().filter(shown).collect();
    assert_eq!(shown, table, "{page} should hold:\n{}", table.join("\n"));
}

#[test]
fn the_table_of_external_truth_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && !line.starts_with("| `") && line.contains('%');
    assert_table("docs/external_truth.md", "docs/evidence/external.json", shown, |row| {
        format!(
            "| {} | {} | {} | {} | {:+.3} % ± {:.3} % | {} of {} | {:.2} % | {} | {} |",
            text(row, "scene"),
            text(row, "transport"),
            text(row, "size"),
            number(row, "samples"),
            number(row, "mean difference %"),
            number(row, "standard error %"),
            number(row, "resolved blocks"),
            number(row, "lit blocks"),
            number(row, "largest block difference %"),
            text(row, "verdict"),
            text(row, "date")
        )
    });
}

#[test]
fn the_table_of_held_out_scenes_is_its_evidence() {
    assert_table(
        "docs/external_truth.md",
        "docs/evidence/held_out.json",
        |line| line.starts_with("| `"),
        |row| {
            format!(
                "| `{}` | {} | {:+.2} % ± {:.2} % | {:+.1} % ± {:.1} % | {} |",
                text(row, "scene"),
                text(row, "tries"),
                number(row, "mean difference %"),
                number(row, "standard error %"),
                number(row, "block difference %"),
                number(row, "block standard error %"),
                text(row, "verdict")
            )
        },
    );
}

/// A row of unbiased reuse.
fn told(row: &Value) -> String {
    format!(
        "| {} | {} | {} | {} | {} | {:+.3} % ± {:.3} % | {} of {} | {} | {} | {} |",
        text(row, "scene"),
        text(row, "transport"),
        text(row, "motion"),
        text(row, "mis"),
        number(row, "seeds"),
        number(row, "mean difference %"),
        number(row, "standard error %"),
        number(row, "resolved blocks"),
        number(row, "lit blocks"),
        row["largest block difference %"].as_f64().map_or("–".into(), |largest| format!("{largest:.2} %")),
        match &row["furthest unresolved block"] {
            Value::Null => "–".into(),
            block => format!("{:+.2} % ± {:.2} %", number(block, "difference %"), number(block, "standard error %")),
        },
        text(row, "verdict"),
    )
}

const VERDICTS: [&str; 3] = ["| passed |", "| failed |", "| not resolved |"];

#[test]
fn the_table_of_unbiased_direct_light_is_its_evidence() {
    assert_table("docs/restir_di.md", "docs/evidence/restir_di.json", |line| VERDICTS.iter().any(|end| line.ends_with(end)), told);
}

#[test]
fn the_table_of_unbiased_indirect_light_is_its_evidence() {
    assert_table("docs/restir_gi.md", "docs/evidence/restir_gi.json", |line| VERDICTS.iter().any(|end| line.ends_with(end)), told);
}

/// Sentences that count rows say how many there are, and that all of them are passed.
#[test]
fn sentences_count_the_rows_of_the_evidence() {
    let sentences = [
        ("README.md", "restir_di", "all # rows of [docs/restir_di.md](docs/restir_di.md) are passed"),
        ("README.md", "external", "all # rows are resolved and passed"),
        ("docs/restir_di.md", "restir_di", "All # rows are passed."),
        ("docs/restir_gi.md", "restir_gi", "All # rows are passed."),
    ];
    for (page, evidence, sentence) in sentences {
        let evidence: Value = serde_json::from_str(&read(&format!("docs/evidence/{evidence}.json"))).expect("the evidence is JSON");
        let rows = evidence["rows"].as_array().expect("rows");
        let other: Vec<&Value> = rows.iter().filter(|row| row["verdict"] != "passed").collect();
        let sentence = sentence.replace('#', &rows.len().to_string());
        assert!(other.is_empty() && read(page).contains(&sentence), "{page}: {sentence}; {other:?}");
    }
}

/// Resampling against path tracing at equal time, of one kind of light.
fn assert_equal_time(page: &str, subject: &str) {
    let evidence: Value = serde_json::from_str(&read("docs/evidence/equal_time.json")).expect("the evidence is JSON");
    let times = |found: &Value| {
        let side = |at: usize| found["interval"][at].as_f64().expect("a number");
        format!("{:.1} ({:.1} to {:.1})", number(found, "value"), side(0), side(1))
    };
    let line = |row: &Value| {
        let untold = if row["better"].is_null() { "cannot be told: " } else { "" };
        let unequal = if row["equal time"] == true { "" } else { ", error × time" };
        format!(
            "| {} | `{}` | {} | {:.1} | {} | {}, in {:.1} ms | {untold}{}{unequal} | {} | {:.0} % |",
            text(row, "scene"),
            text(row, "graph"),
            text(row, "size").replace('x', "×"),
            number(row, "ms"),
            short(number(&row["mse"], "value")),
            short(number(&row["baseline mse"], "value")),
            number(row, "baseline ms"),
            times(&row["times lower"]),
            times(&row["times lower, relMSE"]),
            100.0 * number(row, "bias² share").max(0.0)
        )
    };
    let rows = evidence["rows"].as_array().expect("rows");
    let table: Vec<String> = rows.iter().filter(|row| row["subject"] == subject).map(line).collect();
    let page_text = read(page);
    let shown: Vec<&str> =
        page_text.lines().filter(|line| line.starts_with("| ") && line.contains(", in ") && line.contains(" ms | ")).collect();
    assert_eq!(shown, table, "{page} should hold:\n{}", table.join("\n"));
    assert!(!table.is_empty());
    let noisy: Vec<f64> = rows.iter().map(|row| number(row, "reference share")).filter(|share| !(0.0..=0.1).contains(share)).collect();
    assert!(noisy.is_empty(), "references hold {noisy:?} of the smallest error: both pages say a tenth at most");
}

/// Three digits.
fn short(value: f64) -> String {
    if value >= 0.1 {
        return format!("{value:.3}");
    }
    let scientific = format!("{value:.2e}");
    let (digits, exponent) = scientific.split_once('e').expect("an exponent");
    let raised = exponent
        .chars()
        .map(|c| if c == '-' { '⁻' } else { "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c as usize - '0' as usize).expect("a digit") });
    format!("{digits}·10{}", raised.collect::<String>())
}

#[test]
fn the_table_of_direct_light_at_equal_time_is_its_evidence() {
    assert_equal_time("docs/restir_di.md", "di");
}

#[test]
fn the_table_of_indirect_light_at_equal_time_is_its_evidence() {
    assert_equal_time("docs/restir_gi.md", "gi");
}

/// Milliseconds and rays a pixel of each pass.
fn passes(row: &Value) -> String {
    let pass = |it: &Value| format!("{} {:.1} ({:.2})", text(it, "pass"), number(it, "ms"), number(it, "rays a pixel"));
    row["passes"].as_array().expect("passes").iter().map(pass).collect::<Vec<_>>().join(", ")
}

#[test]
fn the_table_of_what_direct_light_costs_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| `") && line.contains(" lights |");
    assert_table("docs/restir_di.md", "docs/evidence/restir_di_cost.json", shown, |row| {
        format!("| `{}` | {} lights | {:.1} | {} |", text(row, "graph"), number(row, "lights"), number(row, "ms"), passes(row))
    });
}

#[test]
fn the_table_of_what_indirect_light_costs_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && line.contains(" B |");
    assert_table("docs/restir_gi.md", "docs/evidence/restir_gi_cost.json", shown, |row| {
        let bytes = &row["bytes a pixel"];
        format!(
            "| {} | `{}` | {} | {:.1} | {} | {} B | {} B | {} B |",
            text(row, "scene"),
            text(row, "graph"),
            text(row, "transport"),
            number(row, "ms"),
            passes(row),
            number(bytes, "history"),
            number(bytes, "read"),
            number(bytes, "written")
        )
    });
}

#[test]
fn the_figures_of_indirect_light_are_their_evidence() {
    let evidence: Value = serde_json::from_str(&read("docs/evidence/indirect_figures.json")).expect("the evidence is JSON");
    let rows = evidence["rows"].as_array().expect("rows");
    let of = |figure: u64| rows.iter().filter(move |row| row["figure"] == figure);
    let noise = |row: &Value| format!("{:.3} ± {:.3}", number(row, "variance / mean²"), number(row, "standard error"));
    let drawn: Vec<Value> = of(14).cloned().collect();
    let line = |graph: &str| {
        let cells: Vec<String> = drawn.iter().filter(|row| text(row, "graph") == graph).map(noise).collect();
        format!("| `{graph}` | {} |", cells.join(" | "))
    };
    let mut table: Vec<String> = names(&drawn, "graph").into_iter().map(line).collect();
    let second = |row: &Value| {
        format!(
            "| {} | second bounce | {:.1} % ± {:.1} % |",
            text(row, "scene"),
            number(row, "second bounce %"),
            number(row, "standard error %")
        )
    };
    table.extend(of(8).map(second));
    let page = read("docs/restir_gi.md");
    let begin = page.find("**Where initial directions come from**").expect("a paragraph of figure 14");
    let end = page.find("**At equal time**").expect("a paragraph of equal time");
    let shown: Vec<&str> = page[begin..end].lines().filter(|line| line.starts_with("| ") && line.contains('±')).collect();
    assert_eq!(shown, table, "docs/restir_gi.md should hold:\n{}", table.join("\n"));
}

#[test]
fn the_table_of_what_the_error_of_indirect_light_is_made_of_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && line.contains(" rays |");
    assert_table("docs/restir_gi.md", "docs/evidence/error_parts.json", shown, |row| {
        format!(
            "| {} | `{}` | {} | {:.1} | {:.2} rays | {:.1} | {:.0} % | {:.0} % |",
            text(row, "scene"),
            text(row, "graph"),
            short(number(row, "MSE")),
            number(row, "lower error"),
            number(row, "rays a pixel"),
            number(row, "lower error") / number(row, "more rays"),
            100.0 * number(row, "share of hue"),
            100.0 * number(row, "share of few pixels")
        )
    });
}

#[test]
fn the_table_of_choices_in_indirect_light_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && line.contains(" times the error |");
    assert_table("docs/restir_gi.md", "docs/evidence/gi_choices.json", shown, |row| {
        format!(
            "| {} | {} | {:.2} times the error | {:.2} times | {:.2} |",
            text(row, "scene"),
            text(row, "instead"),
            number(row, "times the error"),
            number(row, "times the rays"),
            number(row, "times the error") * number(row, "times the rays")
        )
    });
}

#[test]
fn the_table_of_the_light_change_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| `") && line.contains(" frames |");
    assert_table("docs/restir_gi.md", "docs/evidence/light_change.json", shown, |row| {
        let by_frame = row["error / converged by frame"].as_array().expect("a number for each frame");
        let at = |frame: usize| by_frame[frame].as_f64().expect("a number");
        let errors: Vec<String> = [0, 4, 5, 6, 12, 30, 60].map(|frame| format!("{:.1}", at(frame))).to_vec();
        let with: String =
            text(row, "line").lines().map(|line| format!(", `{}`", line.replace("pass.", "").replace(".set.", "."))).collect();
        let [above, own] = ["frames above twice", "frames above twice its own"].map(|name| number(row, name));
        format!("| `{}`{with} | {} | {above} | {own} frames |", text(row, "graph"), errors.join(" | "))
    });
}

#[test]
fn the_table_of_bias_where_all_moves_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && !line.starts_with("| `") && line.contains(" validation |");
    assert_table("docs/restir_gi.md", "docs/evidence/moving_bias.json", shown, |row| {
        let cell = |found: &Value| format!("{:+.1} ± {:.1}", number(found, "bias %"), number(found, "standard error %"));
        let cells: Vec<String> = row["frames"].as_array().expect("frames").iter().map(cell).collect();
        format!("| {} | {} validation | {} |", text(row, "scene"), text(row, "validation"), cells.join(" | "))
    });
}

/// What rows have under a key, each once.
fn names<'a>(rows: &'a [Value], key: &str) -> Vec<&'a str> {
    let mut found = Vec::new();
    for name in rows.iter().map(|row| text(row, key)) {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// One line a case, with what came of each graph.
#[test]
fn the_table_of_stress_is_its_evidence() {
    let evidence: Value = serde_json::from_str(&read("docs/evidence/stress.json")).expect("the evidence is JSON");
    let rows = evidence["rows"].as_array().expect("rows");
    let word = |row: &Value| match text(row, "outcome") {
        "passed" => if row["labelled"] == true { "*pass*" } else { "pass" }.to_owned(),
        "failed" => format!("**{:+.0} %**", 100.0 * number(&row["bias"], "value")),
        "not_resolved" => format!("± {:.0} %", 100.0 * number(&row["bias"], "standard_error")),
        other => other.to_owned(),
    };
    let (graphs, cases) = (names(rows, "graph"), names(rows, "case"));
    let line = |case: &&str| {
        let cell = |graph: &&str| {
            let row = rows.iter().find(|row| text(row, "case") == *case && text(row, "graph") == *graph);
            row.map_or("not run".to_owned(), word)
        };
        format!("| `{case}` | {} |", graphs.iter().map(cell).collect::<Vec<_>>().join(" | "))
    };
    let head = format!("| case | {} |", graphs.iter().map(|graph| graph.replace('_', " ")).collect::<Vec<_>>().join(" | "));
    let table: Vec<String> = std::iter::once(head).chain(cases.iter().map(line)).collect();
    let page = read("docs/stress.md");
    let shown: Vec<&str> = page.lines().filter(|line| line.starts_with("| `") || line.starts_with("| case |")).collect();
    assert_eq!(shown, table, "docs/stress.md should hold:\n{}", table.join("\n"));
}

#[test]
fn the_table_of_long_runs_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| ") && line.contains("0 frames |");
    assert_table("docs/stress.md", "docs/evidence/long.json", shown, |row| {
        let (drift, bytes) = (&row["drift"], &row["device_bytes"]);
        format!(
            "| {} | {} frames | {:+.2} % ± {:.2} % | {}, {} | {}, then {} |",
            text(row, "graph"),
            number(row, "frames"),
            100.0 * number(drift, "value"),
            100.0 * number(drift, "standard_error"),
            number(row, "nan"),
            number(row, "infinite"),
            bytes[0],
            bytes[1]
        )
    });
}

#[test]
fn the_table_of_graphs_held_against_themselves_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| `") && line.contains(" runs |");
    assert_table("docs/compare.md", "docs/evidence/compare_aa.json", shown, |row| {
        format!("| `{}` | {} runs | {} |", text(row, "graph"), number(row, "runs"), number(row, "verdicts"))
    });
}

/// Graphs on scenes: with passes and arrays kept no bit changes; where one does with everything kept, it is listed.
#[test]
fn the_table_of_what_leaving_out_changes_is_its_evidence() {
    let evidence: Value = serde_json::from_str(&read("docs/evidence/leaving_out.json")).expect("the evidence is JSON");
    let rows = evidence["rows"].as_array().expect("rows");
    for (graph, _) in aquifer_graphs::files() {
        for scene in aquifer_scenes::all() {
            let is_it = |row: &&Value| graph.strip_suffix(".toml") == row["graph"].as_str() && row["scene"] == scene.name;
            assert_eq!(rows.iter().filter(is_it).count(), 1, "{graph} on {}: tools/evidence.sh leaving_out", scene.name);
        }
    }
    assert!(rows.iter().all(|row| row["with resources"].is_null()), "the same shaders make other bits");
    let changed: Vec<&Value> = rows.iter().filter(|row| !row["with everything"].is_null()).collect();
    assert!(changed.iter().all(|row| number(&row["with everything"], "ulps") <= 4.0 && row["means agree"] == true), "{changed:#?}");
    let line = |row: &&Value| {
        let found = &row["with everything"];
        format!("| {} on {} | `{}` | {} |", text(row, "graph"), text(row, "scene"), text(found, "resource"), number(found, "ulps"))
    };
    let table: Vec<String> = changed.iter().map(line).collect();
    let page = read("docs/leaving_out.md");
    let shown: Vec<&str> = page.lines().filter(|line| line.starts_with("| ") && line.contains(" on ")).collect();
    assert_eq!(shown, table, "docs/leaving_out.md should hold:\n{}", table.join("\n"));
    let sentence = format!("Of {} pairs {} are bit-identical with everything kept", rows.len(), rows.len() - changed.len());
    assert!(page.contains(&sentence), "docs/leaving_out.md should say: {sentence}");
}

#[test]
fn the_table_of_what_leaving_out_saves_is_its_evidence() {
    let shown: fn(&&str) -> bool = |line| line.starts_with("| `") && line.contains(" MB | ");
    assert_table("docs/leaving_out.md", "docs/evidence/leaving_out_cost.json", shown, |row| {
        let megabytes = |way: &str| number(&row["bytes"], way) / 1e6;
        let (frame, ratio) = (&row["frame ms"], &row["ratio"]);
        format!(
            "| `{}` | {} | {:.2} MB | {:.2} MB | {:.1} | {:.1} | {:.2} ({:.2} to {:.2}) | {}, {}, {} |",
            text(row, "graph"),
            text(row, "scene"),
            megabytes("needed"),
            megabytes("all"),
            number(&frame["needed"], "median"),
            number(&frame["all"], "median"),
            number(ratio, "median"),
            number(ratio, "low"),
            number(ratio, "high"),
            number(row, "ports"),
            number(row, "arrays"),
            number(row, "pieces")
        )
    });
}

#[test]
fn the_figures_of_the_viewer_are_its_evidence() {
    let evidence: Value = serde_json::from_str(&read("docs/evidence/viewer.json")).expect("the evidence is JSON");
    let (pace, memory) = (&evidence["pace"]["found"], &evidence["memory"]["found"]);
    let pictures = |found: &Value| {
        let side = |axis: usize| found["size"][axis].as_u64().expect("pixels");
        format!("{:.1} pictures a second at {}×{}", number(found, "pictures/s"), side(0), side(1))
    };
    let kept = |found: &Value| {
        let by_minute: Vec<f64> = found["MiB by minute"].as_array().expect("minutes").iter().filter_map(Value::as_f64).collect();
        let (first, last) = (by_minute.first().expect("a first"), by_minute.last().expect("a last"));
        let most = by_minute.iter().copied().fold(0.0, f64::max);
        format!("{first:.0} MiB, then {last:.0} MiB, at most {most:.0}; {} pictures", number(found, "pictures"))
    };
    let (still, switching) = (&memory["without switching"], &memory["switching"]);
    let table = [
        format!("| first picture, after the start | {:.2} s |", number(pace, "first picture s")),
        format!("| a second graph, after it was asked for | {:.2} s |", number(pace, "second graph s")),
        format!("| one graph | {} |", pictures(&pace["one graph"])),
        format!("| two graphs | {} |", pictures(&pace["two graphs"])),
        format!("| memory, {:.0} minutes of one graph | {} |", number(still, "minutes"), kept(still)),
        format!(
            "| memory, {:.0} minutes with {} switches | {} |",
            number(switching, "minutes"),
            number(switching, "switches"),
            kept(switching)
        ),
    ];
    let page = read("docs/viewer.md");
    let begin = page.find("## Figures").expect("a section of figures");
    let shown: Vec<&str> =
        page[begin..].lines().skip_while(|line| !line.starts_with("|---")).skip(1).take_while(|line| line.starts_with("| ")).collect();
    assert_eq!(shown, table, "docs/viewer.md should hold:\n{}", table.join("\n"));
}
