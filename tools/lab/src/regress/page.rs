//! Pictures that changed, as a page: one file that opens from disk.

use super::{Picture, Verdict};
use crate::{
    atomic::{self, WriteError},
    film::{Film, luminance, png_bytes},
    metrics::heat,
    stats::SizesDiffer,
};
use minijinja::{AutoEscape, Environment, UndefinedBehavior, value::Serde};
use serde::Serialize;
use std::path::Path;

const TEMPLATE: &str = include_str!("page.html");

/// One picture that is shown.
pub struct Shown<'a> {
    /// Its name.
    pub name: &'a str,
    /// Today's.
    pub got: &'a Picture,
    /// The one kept.
    pub want: &'a Film,
    /// What differs.
    pub verdict: &'a Verdict,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A picture cannot be drawn.
    #[error("a picture cannot be drawn: {0}")]
    Png(#[from] image::ImageError),
    /// Pictures of different sizes.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// The template and the pictures do not fit together.
    #[error("the page's template failed: {0:#}")]
    Template(#[from] minijinja::Error),
}

#[derive(Serialize)]
struct Row {
    name: String,
    passed: bool,
    verdict: String,
    /// PNG in base64: got, want, difference.
    images: [String; 3],
}

impl Row {
    fn new(shown: &Shown<'_>) -> Result<Row, PageError> {
        let Shown { name, got, want, verdict } = *shown;
        let exposure = exposure(want);
        let drawn = |film: &Film| png(film.color.iter().map(|color| color.map(|value| value * exposure)).collect(), film.size);
        let images = [drawn(&got.film)?, drawn(want)?, png(heat::of_difference(&got.film, want)?.color, want.size)?];
        Ok(Row { name: name.to_owned(), passed: verdict.passed(), verdict: verdict.to_string(), images })
    }
}

/// Writes the page `changed.html` into a folder.
///
/// # Errors
/// See [`PageError`].
pub fn write(shown: &[Shown<'_>], folder: &Path) -> Result<(), PageError> {
    let rows = shown.iter().map(Row::new).collect::<Result<Vec<_>, _>>()?;
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("page", TEMPLATE)?;
    #[derive(Serialize)]
    struct Page {
        rows: Vec<Row>,
    }
    let text = environment.get_template("page")?.render(Serde(Page { rows }))?;
    Ok(atomic::write(&folder.join("changed.html"), text.as_bytes())?)
}

/// What makes the image's 99th percentile white.
fn exposure(film: &Film) -> f32 {
    let mut bright: Vec<f64> = film.color.iter().map(|color| luminance(color.map(f64::from))).filter(|value| value.is_finite()).collect();
    bright.sort_by(f64::total_cmp);
    match bright.get(bright.len() * 99 / 100) {
        Some(&white) if white > 0.0 => (1.0 / white) as f32,
        _ => 1.0,
    }
}

fn png(color: Vec<[f32; 3]>, size: [u32; 2]) -> Result<String, image::ImageError> {
    Ok(base64::encode(png_bytes(&Film { size, color, ..Film::default() })?))
}
