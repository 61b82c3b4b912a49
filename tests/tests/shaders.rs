//! Every pass, with every filling of every slot it reaches, for every single fact of the scene, composes and validates. No GPU is needed.

use aquifer_shader::{Library, Specialisation};
use std::collections::{BTreeMap, BTreeSet};

fn library() -> Library {
    let mut library = Library::new();
    for (path, text) in aquifer_shaders::modules() {
        library.insert(path.clone(), text, format!("shaders/{path}.wgsl"));
    }
    library
}

/// None, each alone, all but each, all.
fn feature_sets() -> Vec<BTreeSet<String>> {
    let all: BTreeSet<String> = aquifer_scene::Features::NAMES.iter().map(|name| name.to_string()).collect();
    let mut sets = vec![BTreeSet::new(), all.clone()];
    for name in &all {
        sets.push(BTreeSet::from([name.clone()]));
        sets.push(all.iter().filter(|other| *other != name).cloned().collect());
    }
    // A normal map is a texture.
    for set in sets.iter_mut().filter(|set| set.contains("normal_maps")) {
        set.insert("textures".into());
    }
    sets
}

#[test]
fn every_pass_composes_with_every_filling() {
    let library = library();
    let defaults = library.default_slots();
    let mut tried = 0;
    let mut faults = Vec::new();
    for pass in library.modules("pass") {
        let mut compose = |slots: &BTreeMap<String, String>| {
            let mut reached = BTreeSet::new();
            for features in feature_sets() {
                let what = Specialisation { entry: format!("pass/{pass}"), slots: slots.clone(), features };
                tried += 1;
                match library.compose(&what) {
                    Ok(composed) => reached.extend(composed.interface.slots.into_iter().map(|(slot, _)| slot)),
                    Err(fault) => faults.push(format!("{pass} with {:?} for {:?}:\n{fault}", what.slots, what.features)),
                }
            }
            reached
        };
        // Other fillings of a slot that is not reached would give the same text again.
        let reached = compose(&defaults);
        for slots in fillings(&library, &defaults, &reached) {
            compose(&slots);
        }
    }
    assert!(tried >= 100, "only {tried} specialisations were tried");
    assert!(faults.is_empty(), "{} of {tried} specialisations fail:\n\n{}", faults.len(), faults.join("\n\n"));
}

/// The defaults with one of these slots filled otherwise.
fn fillings(library: &Library, defaults: &BTreeMap<String, String>, of: &BTreeSet<String>) -> Vec<BTreeMap<String, String>> {
    let mut sets = Vec::new();
    for (slot, choices) in library.slots().into_iter().filter(|(slot, _)| of.contains(slot)) {
        for choice in choices {
            let mut set = defaults.clone();
            if set.insert(slot.clone(), choice.clone()).as_ref() != Some(&choice) {
                sets.push(set);
            }
        }
    }
    sets
}
