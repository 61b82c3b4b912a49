//! `aquifer graphs [NAME]`

use crate::{failure::Failure, source, ui::Ui};
use aquifer_graph::{Document, nearest};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print this graph's text, ready to be changed
    name: Option<String>,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    match args.name {
        Some(name) => ui.print(text(&name)?),
        None => ui.print(&list()?),
    }
}

fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
    aquifer_graphs::files().into_iter().map(|(file, text)| (file.trim_end_matches(".toml"), text))
}

fn text(wanted: &str) -> Result<&'static str, Failure> {
    let wanted = wanted.trim_end_matches(".toml");
    if let Some((_, text)) = names().find(|(name, _)| *name == wanted) {
        return Ok(text);
    }
    let known: Vec<&str> = names().map(|(name, _)| name).collect();
    let cure = match nearest(wanted, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there are: {}", known.join(", ")),
    };
    Err(Failure::new(format!("there is no graph `{wanted}`; {cure}")))
}

/// Name, transport and title of each, `extends` followed.
fn list() -> Result<String, Failure> {
    let mut lines = Vec::new();
    for (name, _) in names() {
        let document = Document::load(&format!("{name}.toml"), &source::files())?;
        let words = |words: Option<&aquifer_graph::Spanned<String>>| words.map_or("", |words| words.value.as_str()).to_owned();
        lines.push(format!("{name:24} {:12} {}", words(document.transport.as_ref()), words(document.title.as_ref())));
    }
    Ok(lines.join("\n"))
}
