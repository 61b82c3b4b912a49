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
