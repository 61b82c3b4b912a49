//! The rows as a page, with pictures: one file that needs no network.

use super::{Pictures, Row};
use crate::film::{Film, luminance, png_bytes};
use minijinja::{AutoEscape, Environment, UndefinedBehavior, value::Serde};
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html");
/// Mean luminance of a picture on the page.
const GREY: f64 = 0.25;

/// What the template sees.
#[derive(Serialize)]
struct Context<'a> {
    cases: Vec<About>,
    rows: Vec<Shown<'a>>,
    adapter: &'a str,
    version: &'a str,
}

#[derive(Serialize)]
struct About {
    name: &'static str,
    about: &'static str,
}

/// A row as the template sees it.
#[derive(Serialize)]
struct Shown<'a> {
    row: &'a Row,
    word: &'static str,
    good: bool,
    sentence: String,
    /// What was got, and what it should be, as data URLs.
    got: Option<String>,
    want: Option<String>,
}

/// The page's text.
///
/// # Errors
/// When the template and the rows do not fit together.
pub fn page(rows: &[(Row, Option<Pictures>)], adapter: &str, version: &str) -> Result<String, minijinja::Error> {
    let cases = super::all().map(|case| About { name: case.name, about: case.about }).collect();
    let rows = rows.iter().map(|(row, pictures)| shown(row, pictures.as_ref())).collect();
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("stress", TEMPLATE)?;
    environment.get_template("stress")?.render(Serde(Context { cases, rows, adapter, version }))
}

fn shown<'a>(row: &'a Row, pictures: Option<&Pictures>) -> Shown<'a> {
    // Both with one exposure, so that what differs shows.
    let exposure = pictures.map_or(1.0, |pictures| GREY / mean(&pictures.want));
    let picture = |film: &Film| data_url(film, if exposure.is_finite() { exposure as f32 } else { 1.0 });
    Shown {
        row,
        word: row.word(),
        good: row.is_as_known(),
        sentence: row.sentence(),
        got: pictures.and_then(|pictures| picture(&pictures.got)),
        want: pictures.and_then(|pictures| picture(&pictures.want)),
    }
}

fn mean(film: &Film) -> f64 {
    film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64
}

fn data_url(film: &Film, exposure: f32) -> Option<String> {
    let color = film.color.iter().map(|color| color.map(|channel| channel * exposure)).collect();
    let bytes = png_bytes(&Film { size: film.size, color, ..Film::default() }).ok()?;
    Some(format!("data:image/png;base64,{}", base64::encode(bytes)))
}
