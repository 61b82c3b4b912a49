//! A comparison as a page: `report.html`, one file that opens from disk without a network, with `report.json` and `results.csv` beside it.
//!
//! Everything that can be said in words or tables is in the HTML itself; a script draws the plots (with Observable Plot, bundled in
//! `assets/plot.js`, see `assets/vendor.md`) and shows the images, which the page carries as half floats.

mod charts;
mod model;
mod passes;
mod picture;
mod table;
mod verdict;
mod words;

use crate::{
    atomic::{self, WriteError},
    compare::report::{Cell, Report, Share},
    film::FilmError,
    metrics::heat,
    stats::SizesDiffer,
};
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, value::Serde};
use model::Page;
use serde::Serialize;
use std::path::Path;

const TEMPLATE: &str = include_str!("page/assets/page.html");
const STYLE: &str = include_str!("page/assets/page.css");
const PLOT: &str = include_str!("page/assets/plot.js");
/// One script: the order is that of use.
const SCRIPT: &str = concat!(
    include_str!("page/assets/pixels.js"),
    include_str!("page/assets/viewer.js"),
    include_str!("page/assets/charts.js"),
    include_str!("page/assets/page.js"),
);

/// What the page says of the bias of each graph, for those who only read words.
pub fn biases(report: &Report) -> Vec<String> {
    verdict::biases(report)
}

/// Why no page could be made.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// An image is damaged.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// An image has not the size of its reference.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// The report holds something that JSON cannot.
    #[error("the report cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The template and the report do not fit together.
    #[error("the page's template failed: {0:#}")]
    Template(#[from] minijinja::Error),
}

/// Writes `report.html`, `report.json` and `results.csv` into the folder where the report's images are.
pub fn write(report: &Report, folder: &Path) -> Result<(), PageError> {
    atomic::write(&folder.join("report.json"), serde_json::to_string_pretty(report)?.as_bytes())?;
    atomic::write(&folder.join("results.csv"), table::csv(report).as_bytes())?;
    Ok(atomic::write(&folder.join("report.html"), html(report, folder)?.as_bytes())?)
}

/// What the template sees.
#[derive(Serialize)]
struct Context<'a> {
    report: &'a Report,
    page: &'a Page,
    data: String,
    css: &'static str,
    plot: &'static str,
    script: &'static str,
}

/// What the script sees.
#[derive(Serialize)]
struct Data<'a> {
    graphs: Vec<&'a str>,
    scenes: Vec<&'a model::Data>,
    magma: String,
    difference: String,
}

/// The page, with the images found in `folder`.
pub fn html(report: &Report, folder: &Path) -> Result<String, PageError> {
    let page = Page::new(report, folder)?;
    let data = Data {
        graphs: report.graphs.iter().map(|graph| graph.name.as_str()).collect(),
        scenes: page.scenes.iter().map(|scene| &scene.data).collect(),
        magma: picture::base64(&heat::scale_of_flip()),
        difference: picture::base64(&heat::scale_of_difference()),
    };
    let data = within_script(&serde_json::to_string(&data)?);
    let environment = environment()?;
    let context = Context { report, page: &page, data, css: STYLE, plot: PLOT, script: SCRIPT };
    Ok(environment.get_template("page")?.render(Serde(context))?)
}

fn environment() -> Result<Environment<'static>, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("number", |value: Option<f64>| value.map_or("undefined".to_owned(), words::number));
    environment.add_filter("thousands", words::thousands);
    environment.add_filter("prose", |text: String| Value::from_safe_string(words::prose(&text)));
    environment.add_filter("date", words::date);
    environment.add_filter("command", |words: Vec<String>| words::command(&words));
    environment.add_filter("run_as", |Serde(cell): Serde<Cell>| words::run_as(&cell));
    environment.add_filter("mean_of", |Serde(share): Serde<Share>| verdict::mean(share.mean_difference, share.mean_error));
    environment.add_template("page", TEMPLATE)?;
    Ok(environment)
}

/// JSON in a script element: nothing in it may look like the element's end.
fn within_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}
