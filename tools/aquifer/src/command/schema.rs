//! `aquifer schema`: a JSON Schema (draft-07) of graph files, from the shaders' own declarations, so that editors complete and explain them.

use crate::{failure::Failure, source::ShaderArgs, ui::Ui};
use aquifer_graph::{Contract, Contracts, Direction, Param, Slots, Value};
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeMap;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    shaders: ShaderArgs,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let registry = args.shaders.registry(None)?;
    ui.json(&schema(&registry)?)
}

/// Every kind of pass is a branch of its own: under `[pass.NAME]` without `kind` the name is the kind, with `kind` any name goes.
fn schema(contracts: &dyn Contracts) -> Result<Json, Failure> {
    let fillings = contracts.slots();
    let (mut by_name, mut branches) = (Map::new(), Vec::new());
    for kind in contracts.kinds() {
        let contract = widest(contracts, &kind, &fillings)?;
        by_name.insert(kind.clone(), pass(&contract, &fillings, None));
        branches.push(pass(&contract, &fillings, Some(&kind)));
    }
    let any_wires = json!({ "type": "object" });
    branches.push(json!({
        "description": "A change to a pass of the extended file.",
        "not": { "required": ["kind"] },
        "properties": { "in": any_wires, "set": any_wires, "slots": slots(&fillings, None), "remove": { "type": "boolean" } },
    }));
    Ok(json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Aquifer render graph",
        "type": "object",
        "additionalProperties": false,
        "properties": {
            "extends": { "type": "string", "description": "The graph file that this one changes: a path beside this file, or a built-in one." },
            "title": { "type": "string" },
            "about": { "type": "string" },
            "transport": {
                "type": "string",
                "description": "Which light paths the output holds.",
                "pattern": "^(emission|direct|indirect:[1-9][0-9]*|full:[0-9]+)$",
            },
            "output": { "type": "string", "description": "What is shown and saved: pass.port.", "pattern": "^[^.]+\\.[^.]+$" },
            "slots": slots(&fillings, None),
            "budget": {
                "type": "object",
                "additionalProperties": false,
                "properties": { "knob": { "description": "The parameter that spends spare time: pass.parameter.", "type": ["string", "boolean"] } },
            },
            "pass": { "type": "object", "properties": by_name, "additionalProperties": { "oneOf": branches } },
        },
    }))
}

/// What a kind offers with every filling of its slots, one changed at a time: a filling may bring ports and parameters of its own.
fn widest(contracts: &dyn Contracts, kind: &str, fillings: &BTreeMap<String, Vec<String>>) -> Result<Contract, Failure> {
    let of = |slots| contracts.contract(kind, &slots).map_err(|error| Failure::new(format!("{kind}: {error}")));
    let mut widest = of(Slots::new())?;
    let choices =
        widest.slots.clone().into_iter().flat_map(|slot| fillings[&slot].iter().map(move |filling| (slot.clone(), filling.clone())));
    for choice in choices {
        // Fillings that do not go together are `check`'s to refuse.
        let Ok(contract) = of(Slots::from([choice])) else { continue };
        for port in contract.ports {
            if !widest.ports.iter().any(|known| known.name == port.name) {
                widest.ports.push(port);
            }
        }
        for param in contract.params {
            if !widest.params.iter().any(|known| known.name == param.name) {
                widest.params.push(param);
            }
        }
        for slot in contract.slots {
            if !widest.slots.contains(&slot) {
                widest.slots.push(slot);
            }
        }
    }
    Ok(widest)
}

fn pass(contract: &Contract, fillings: &BTreeMap<String, Vec<String>>, kind: Option<&str>) -> Json {
    let inputs = contract.ports.iter().filter(|port| port.direction != Direction::Out);
    let wires: Map<String, Json> = inputs
        .map(|port| {
            let text = format!("{} ({}{})", port.doc, port.ty.element, if port.optional { ", optional" } else { "" });
            (port.name.clone(), json!({ "type": ["string", "boolean"], "description": text }))
        })
        .collect();
    let params: Map<String, Json> = contract.params.iter().map(|param| (param.name.clone(), value(param))).collect();
    let wires = json!({ "type": "object", "additionalProperties": false, "properties": wires });
    let mut branch = json!({
        "type": "object",
        "description": contract.about,
        "additionalProperties": false,
        "properties": {
            "kind": { "type": "string" },
            "in": wires,
            "feed": wires,
            "set": { "type": "object", "additionalProperties": false, "properties": params },
            "slots": slots(fillings, Some(&contract.slots)),
            "repeat": { "type": "integer", "minimum": 1, "description": "Rounds; `feed` says which input takes the round before." },
            "remove": { "type": "boolean", "description": "Drops the pass of the extended file." },
            "replace": { "type": "boolean", "description": "Forgets what the extended file says of the pass." },
        },
    });
    if let Some(kind) = kind {
        branch["properties"]["kind"] = json!({ "const": kind });
        branch["required"] = json!(["kind"]);
    }
    branch
}

fn slots(fillings: &BTreeMap<String, Vec<String>>, only: Option<&[String]>) -> Json {
    let wanted = fillings.iter().filter(|(slot, _)| only.is_none_or(|only| only.contains(slot)));
    // A filling with a `/` is a module path of its own; false takes back what the extended file says.
    let choice = |known: &Vec<String>| json!({ "anyOf": [{ "enum": known }, { "type": "string", "pattern": "/" }, { "const": false }] });
    let properties: Map<String, Json> = wanted.map(|(slot, known)| (slot.clone(), choice(known))).collect();
    json!({ "type": "object", "description": "What fills the open modules.", "additionalProperties": false, "properties": properties })
}

fn value(param: &Param) -> Json {
    let (kind, default) = match param.default {
        Value::Bool(default) => ("boolean", json!(default)),
        Value::I32(default) => ("integer", json!(default)),
        Value::U32(default) => ("integer", json!(default)),
        Value::F32(default) => ("number", json!(default)),
    };
    if !param.choices.is_empty() {
        return json!({ "description": param.doc, "anyOf": [{ "enum": param.choices }, { "type": kind }] });
    }
    let mut schema = json!({ "type": kind, "description": param.doc, "default": default });
    if let Some((least, most)) = param.range {
        schema["minimum"] = json!(least);
        schema["maximum"] = json!(most);
    }
    schema
}
