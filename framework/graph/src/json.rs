//! A graph as plain data, and the one text that names it.

use crate::{Graph, Node, graph::wire_name};
use serde_json::{Map, Value, json};

impl Graph {
    /// Plain data, for other programs: passes with their values and wires, the latter as a graph file writes them.
    pub fn to_json(&self) -> Value {
        json!({
            "title": self.title,
            "about": self.about,
            "transport": self.transport,
            "output": self.port_name(self.output),
            "knob": self.knob,
            "bias": self.bias(),
            "bias_elsewhere": self.bias_elsewhere(),
            "nodes": self.nodes.iter().map(|node| self.node_json(node)).collect::<Vec<Value>>(),
        })
    }

    /// A short name of what the graph computes, the same on every machine: the hash of its passes, values and wires, not of their texts.
    pub fn digest(&self) -> String {
        let mut essence = self.to_json();
        if let Value::Object(members) = &mut essence {
            members.retain(|key, _| matches!(key.as_str(), "transport" | "output" | "nodes"));
        }
        blake3::hash(canonical(&essence).as_bytes()).to_hex()[..16].to_owned()
    }

    fn node_json(&self, node: &Node) -> Value {
        let param = |param: &crate::Param| Some((param.name.clone(), json!(node.params.get(&param.name)?)));
        let ports = node.contract.ports.iter().zip(&node.wires);
        let wires: Map<String, Value> =
            ports.filter_map(|(port, wire)| Some((port.name.clone(), json!(wire_name(&self.nodes, (*wire)?))))).collect();
        let slots = node.contract.slots.iter().filter_map(|slot| Some((slot.clone(), json!(node.slots.get(slot)?))));
        json!({
            "node": node.name,
            "pass": node.pass,
            "kind": node.kind,
            "slots": slots.collect::<Map<String, Value>>(),
            "params": node.contract.params.iter().filter_map(param).collect::<Map<String, Value>>(),
            "wires": wires,
        })
    }
}

/// JSON with sorted keys, whatever order the map type of this build keeps.
fn canonical(value: &Value) -> String {
    match value {
        Value::Object(members) => {
            let mut members: Vec<String> = members.iter().map(|(key, value)| format!("{}:{}", json!(key), canonical(value))).collect();
            members.sort();
            format!("{{{}}}", members.join(","))
        }
        Value::Array(items) => format!("[{}]", items.iter().map(canonical).collect::<Vec<_>>().join(",")),
        plain => plain.to_string(),
    }
}
