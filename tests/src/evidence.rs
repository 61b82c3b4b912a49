//! Evidence files: rows of JSON, each with the commit, the adapter and the date it was made with.

use aquifer_lab::stats::blocks::BlockComparison;
use aquifer_render::Context;
use serde_json::{Map, Value, json};
use std::{fs, path::PathBuf};

/// A file of rows, a line each, written anew after each.
pub struct Evidence {
    path: PathBuf,
    about: Map<String, Value>,
    rows: Vec<Value>,
}

impl Evidence {
    /// The rows that the file holds already, if it is there. New ones are of this commit and date, and of the context's adapter.
    pub fn open(path: &str, commit: &str, date: &str, context: &Context) -> Self {
        let old = fs::read_to_string(path).ok().and_then(|text| serde_json::from_str::<Value>(&text).ok());
        let rows = old.map_or_else(Vec::new, |file| file["rows"].as_array().cloned().unwrap_or_default());
        let about = object(json!({ "commit": commit, "adapter": context.adapter().name, "date": date }));
        Evidence { path: path.into(), about, rows }
    }

    /// Is there a row of this key?
    pub fn has(&self, key: &Value) -> bool {
        self.row(key).is_some()
    }

    /// The row of this key, whichever commit it was made with.
    pub fn row(&self, key: &Value) -> Option<&Value> {
        self.place(key).map(|at| &self.rows[at])
    }

    fn place(&self, key: &Value) -> Option<usize> {
        let key = key.as_object()?;
        self.rows.iter().position(|row| key.iter().all(|(name, value)| row[name] == *value))
    }

    /// The rows so far that were made with this commit.
    pub fn rows(&self) -> impl Iterator<Item = &Value> {
        self.rows.iter().filter(|row| row["commit"] == self.about["commit"])
    }

    /// Writes a row: `key` says what it is of, `found` what was found. It takes the place of an older one of the same key.
    ///
    /// # Panics
    /// When the file cannot be written, or `key` or `found` is no object.
    pub fn put(&mut self, key: Value, found: Value) {
        let place = self.place(&key);
        let row = Value::Object(object(key).into_iter().chain(object(found)).chain(self.about.clone()).collect());
        match place {
            Some(at) => self.rows[at] = row,
            None => self.rows.push(row),
        }
        let rows: Vec<String> = self.rows.iter().map(Value::to_string).collect();
        let text = format!("{{\"rows\": [\n{}\n]}}\n", rows.join(",\n"));
        fs::write(&self.path, text).unwrap_or_else(|error| panic!("{}: {error}", self.path.display()));
    }
}

fn object(value: Value) -> Map<String, Value> {
    let Value::Object(map) = value else { panic!("not an object: {value}") };
    map
}

/// What a row says of a comparison by blocks.
pub fn told(found: &BlockComparison) -> Value {
    let plane = &found.planes[0];
    let percent = |share: f64| (share * 1e5).round() / 1e3;
    let largest = plane.resolved.iter().map(|block| block.difference.value.abs()).reduce(f64::max);
    let other = plane.unresolved.first().map(|block| {
        let [x, y] = block.corner;
        json!({ "at": [x, y], "difference %": percent(block.difference.value), "standard error %": percent(block.difference.standard_error) })
    });
    json!({
        "mean difference %": percent(plane.overall.value), "standard error %": percent(plane.overall.standard_error),
        "lit blocks": plane.lit, "resolved blocks": plane.resolved.len(), "largest block difference %": largest.map(percent),
        "furthest unresolved block": other,
        "verdict": found.verdict.to_string(),
    })
}
