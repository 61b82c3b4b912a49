//! What the user changed, for keeping: as a graph file that says no more than that, and as a command line.

use crate::{
    Recipe,
    session::{Moment, Picture},
};
use aquifer_graph::{Graph, Literal, Param, Value};
use glam::Vec3;
use std::{collections::BTreeMap, fmt::Write as _, path::Path};

/// The value of a parameter as a setting writes it.
pub fn written(param: &Param, value: Value) -> String {
    param.literal(value).to_string()
}

/// The key of a parameter: `spatial.taps`.
pub fn param_key(pass: &str, param: &str) -> String {
    format!("{pass}.{param}")
}

/// The key of a slot: `slots.mis`.
pub fn slot_key(slot: &str) -> String {
    format!("slots.{slot}")
}

/// A graph file that extends the recipe's and says what differs from it, and nothing else; to be put into `folder`.
pub fn diff(recipe: &Recipe, graph: &Graph, written: &Graph, folder: &Path) -> String {
    let mut text = format!("extends = {}\n", quoted(&extended(&recipe.graph, folder)));
    let title = if recipe.settings.is_empty() { graph.title().to_owned() } else { format!("{}, changed", written.title()) };
    let _ = writeln!(text, "title   = {}", quoted(&title));
    if graph.transport() != written.transport() {
        let _ = writeln!(text, "transport = {}", quoted(&graph.transport().to_string()));
    }
    let mut tables: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (key, value) in &recipe.settings {
        let path: Vec<&str> = key.split('.').collect();
        match path.as_slice() {
            ["slots", slot] => tables.entry("slots".to_owned()).or_default().push(format!("{slot} = {}", text_value(value))),
            [pass, "slots", slot] => {
                tables.entry(format!("pass.{pass}")).or_default().push(format!("slots.{slot} = {}", text_value(value)))
            }
            [pass, param] if !same(graph, written, pass, param) => {
                tables.entry(format!("pass.{pass}")).or_default().push(format!("set.{param} = {value}"));
            }
            _ => {}
        }
    }
    // `slots` comes before the passes, as in the files of the project.
    for (table, lines) in tables.iter().rev() {
        let _ = write!(text, "\n[{table}]\n{}\n", lines.join("\n"));
    }
    text
}

/// Does the parameter have the same value in both?
fn same(graph: &Graph, written: &Graph, pass: &str, param: &str) -> bool {
    let value = |graph: &Graph| graph.nodes().iter().find(|node| node.pass == pass)?.params.get(param).copied();
    value(graph) == value(written)
}

/// How a file in `folder` names the graph that it extends.
fn extended(graph: &str, folder: &Path) -> String {
    let path = Path::new(graph);
    if !path.is_file() {
        return if graph.ends_with(".toml") { graph.to_owned() } else { format!("{graph}.toml") };
    }
    let full = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    full.strip_prefix(&folder).unwrap_or(&full).to_string_lossy().into_owned()
}

fn quoted(text: &str) -> String {
    Literal::Text(text.to_owned()).to_string()
}

/// Fillings are texts, also where the setting has no quotes.
fn text_value(value: &str) -> String {
    if value.starts_with('"') || value == "false" { value.to_owned() } else { quoted(value) }
}

/// The command that renders a side's picture again.
pub fn render_command(recipe: &Recipe, scene: &str, options: &[String], seed: u64, picture: &Picture) -> String {
    let [width, height] = picture.film.size;
    let mut words = vec!["aquifer".to_owned(), "render".to_owned(), recipe.graph.clone()];
    words.extend(settings(recipe));
    words.extend(["--scene".to_owned(), scene.to_owned()]);
    words.extend(options.iter().cloned());
    match &picture.moment.name {
        Some(name) => words.extend(["--camera".to_owned(), name.clone()]),
        None => words.extend(["--look".to_owned(), look(&picture.moment)]),
    }
    if picture.moment.time != 0.0 {
        words.extend(["--animation-time".to_owned(), picture.moment.time.to_string()]);
    }
    words.extend(["--size".to_owned(), format!("{width}x{height}"), "--seed".to_owned(), seed.to_string()]);
    words.extend(["--first-frame".to_owned(), picture.first.to_string(), "--frames".to_owned(), picture.frames.to_string()]);
    words.extend(["-o".to_owned(), "out.exr".to_owned()]);
    words.iter().map(|word| shell(word)).collect::<Vec<_>>().join(" ")
}

fn settings(recipe: &Recipe) -> impl Iterator<Item = String> {
    recipe.settings.iter().flat_map(|(key, value)| ["--set".to_owned(), format!("{key}={value}")])
}

/// Where a camera stands and what it looks at, in the scene's own world, as `--look` takes it.
fn look(Moment { camera, origin, .. }: &Moment) -> String {
    let (from, ahead) = (camera.position(), -Vec3::from(camera.to_world.matrix3.z_axis));
    let place = |near: Vec3| {
        // Floats that were not moved are written as floats: they have fewer digits.
        let axis =
            |axis: usize| if origin[axis] == 0.0 { near[axis].to_string() } else { (f64::from(near[axis]) + origin[axis]).to_string() };
        [0, 1, 2].map(axis).join(",")
    };
    format!("{}:{}", place(from), place(from + ahead))
}

/// A word as a POSIX shell takes it.
fn shell(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn cameras_are_told_in_the_scenes_own_world() {
        let to_world = glam::Affine3A::from_translation(Vec3::new(0.1, 2.5, -3.0));
        let camera = aquifer_scene::Camera { to_world, vertical_fov: 0.7, near: 0.1 };
        let seen = |origin: DVec3| look(&Moment { camera, origin, name: None, time: 0.0 });
        assert_eq!(seen(DVec3::ZERO), "0.1,2.5,-3:0.1,2.5,-4");
        assert_eq!(seen(DVec3::new(0.0, -1024.0, 1e6 * 1024.0)), "0.1,-1021.5,1023999997:0.1,-1021.5,1023999996");
    }

    #[test]
    fn words_survive_the_shell() {
        assert_eq!(shell("spatial.taps=5"), "spatial.taps=5");
        assert_eq!(shell("a b's"), r"'a b'\''s'");
        assert_eq!(shell(""), "''");
    }
}
