//! Graphs as they are typed: a name or a file, with settings after commas.

use crate::{failure::Failure, source::GraphArgs, source::ShaderArgs, value};
use aquifer_graph::{Source, Transport, nearest};
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
        let name = unique(short(&graph, &own), '#', |name| entrants.iter().any(|other| other.name == name));
        let settings: Vec<String> = settings.iter().cloned().chain(own).collect();
        let args = GraphArgs { graph, settings: settings.clone(), transport, shaders: ShaderArgs::default() };
        entrants.push(Entrant { name, document: args.document()?, settings });
    }
    Ok(entrants)
}

fn short(graph: &str, settings: &[String]) -> String {
    let stem = Path::new(graph).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    settings.iter().fold(stem, |name, setting| name + "," + setting)
}

/// The name, or where it is taken the name with a number after the mark.
pub fn unique(name: String, mark: char, taken: impl Fn(&str) -> bool) -> String {
    let numbered = |number: u32| format!("{name}{mark}{number}");
    if !taken(&name) { name } else { (2..).map(numbered).find(|name| !taken(name)).unwrap_or(name) }
}

/// Every graph with every combination of the values that are swept: `spatial.radius=4,8,16`. A key that a graph has no pass for leaves that
/// graph as it is; one that no graph has is refused.
pub fn swept(entrants: Vec<Entrant>, sweeps: &[String]) -> Result<Vec<Entrant>, Failure> {
    let mut all = entrants;
    for sweep in sweeps {
        let (key, values) = sweep.split_once('=').unwrap_or((sweep, ""));
        let values: Vec<&str> = values.split(',').map(str::trim).filter(|value| !value.is_empty()).collect();
        if values.is_empty() {
            return Err(Failure::new(format!("sweep `{sweep}` has no values: write KEY=VALUE,VALUE,…")));
        }
        let pass = key.split('.').next().unwrap_or_default();
        let suits = |entrant: &Entrant| pass == "slots" || entrant.document.pass.keys().any(|known| known.value == pass);
        if !all.iter().any(suits) {
            let known: Vec<&str> = all.iter().flat_map(|entrant| entrant.document.pass.keys()).map(|known| known.value.as_str()).collect();
            let cure = nearest(pass, known.iter().copied()).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            return Err(Failure::new(format!("no graph has a pass `{pass}` for the sweep of `{key}`{cure}")));
        }
        let mut next = Vec::new();
        for entrant in all {
            if !suits(&entrant) {
                next.push(entrant);
                continue;
            }
            for value in &values {
                let setting = format!("{key}={value}");
                let mut document = entrant.document.clone();
                document.apply([Source::new("--sweep", &setting)])?;
                let settings = entrant.settings.iter().cloned().chain([setting.clone()]).collect();
                next.push(Entrant { name: format!("{},{setting}", entrant.name), document, settings });
            }
        }
        all = next;
    }
    Ok(all)
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

    #[test]
    fn sweeps_combine_and_unknown_keys_are_refused() {
        let graphs = entrants(&["light_sampling".into(), "restir_di".into()], &[], None).unwrap();
        let sweeps = ["spatial.radius=4.0,8.0", "spatial.taps=3,5"].map(String::from);
        let found = swept(graphs.clone(), &sweeps).unwrap();
        let names: Vec<_> = found.iter().map(|entrant| entrant.name.as_str()).collect();
        assert_eq!(names[..2], ["light_sampling", "restir_di,spatial.radius=4.0,spatial.taps=3"]);
        assert_eq!(names.len(), 5);
        for wrong in ["spatail.radius=4.0", "spatial.radius=", "spatial.radius"] {
            assert!(swept(graphs.clone(), &[wrong.to_owned()]).is_err(), "{wrong}");
        }
    }
}
