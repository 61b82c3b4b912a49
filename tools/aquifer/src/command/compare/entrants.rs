//! Graphs as they are typed: a name or a file, with settings after commas.

use crate::{failure::Failure, source::GraphArgs, source::ShaderArgs, value};
use aquifer_graph::Transport;
use aquifer_lab::compare::bench::Entrant;
use std::path::Path;

/// Every graph with what is laid over it, under names that differ.
pub fn entrants(typed: &[String], settings: &[String], transport: Option<Transport>) -> Result<Vec<Entrant>, Failure> {
    let mut entrants: Vec<Entrant> = Vec::new();
    for text in typed {
        let mut parts = text.split(',').map(str::trim);
        let graph = parts.next().unwrap_or_default().to_owned();
        let own = parts.map(|part| value::setting(part).map_err(|why| Failure::new(format!("`{part}` after graph `{graph}`: {why}"))));
        let own = own.collect::<Result<Vec<String>, Failure>>()?;
        let name = unique(short(&graph, &own), &entrants);
        let settings: Vec<String> = settings.iter().cloned().chain(own).collect();
        let args = GraphArgs { graph, settings: settings.clone(), transport, shaders: ShaderArgs { folders: Vec::new() } };
        entrants.push(Entrant { name, document: args.document()?, settings });
    }
    Ok(entrants)
}

fn short(graph: &str, settings: &[String]) -> String {
    let stem = Path::new(graph).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    settings.iter().fold(stem, |name, setting| name + "," + setting)
}

fn unique(name: String, others: &[Entrant]) -> String {
    let taken = |name: &str| others.iter().any(|other| other.name == name);
    let numbered = |number: u32| format!("{name}#{number}");
    if !taken(&name) { name } else { (2..).map(numbered).find(|name| !taken(name)).unwrap_or(name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_differ_and_say_what_was_set() {
        let typed = ["restir_di", "restir_di", "restir_di,spatial.taps=3"].map(String::from);
        let found = entrants(&typed, &["spatial.radius=8.0".into()], None).unwrap();
        let names: Vec<_> = found.iter().map(|entrant| entrant.name.as_str()).collect();
        assert_eq!(names, ["restir_di", "restir_di#2", "restir_di,spatial.taps=3"]);
        assert_eq!(found[2].settings, ["spatial.radius=8.0", "spatial.taps=3"]);
        assert!(entrants(&["restir_di,taps".into()], &[], None).is_err());
    }
}
