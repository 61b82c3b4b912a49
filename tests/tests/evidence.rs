//! Tables in the docs say what the evidence files say.

use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The rows of the table in docs/external_truth.md, made from the file. To renew the page, take them from this test's failure.
#[test]
fn the_table_of_external_truth_is_its_evidence() {
    let evidence: serde_json::Value = serde_json::from_str(&read("docs/evidence/external.json")).expect("the evidence is JSON");
    let rows = evidence["rows"].as_array().expect("rows");
    assert!(!rows.is_empty());
    let page = read("docs/external_truth.md");
    let table: Vec<String> = rows
        .iter()
        .map(|row| {
            let text = |key: &str| row[key].as_str().expect("text").to_owned();
            let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
            format!(
                "| {} | {} | {} | {} | {:+.3} % ± {:.3} % | {} of {} | {:.2} % | {} | {} |",
                text("scene"),
                text("transport"),
                text("size"),
                number("samples"),
                number("mean difference %"),
                number("standard error %"),
                number("resolved blocks"),
                number("lit blocks"),
                number("largest block difference %"),
                text("verdict"),
                text("date")
            )
        })
        .collect();
    let shown: Vec<&str> = page.lines().filter(|line| line.starts_with("| ") && line.contains('%')).collect();
    assert_eq!(shown, table, "docs/external_truth.md should hold:\n{}", table.join("\n"));
}
