//! Parameters on their way to a shader: baked ones as pipeline constants, live ones packed by reflected offsets.

use crate::Error;
use aquifer_graph::{Step, Value};
use aquifer_shader::{Interface, Layout, ResourceKind};
use std::{collections::BTreeMap, iter};

/// The name of the uniform that holds live parameters.
pub(crate) const LIVE: &str = "params";

/// The override that tells the random numbers of nodes apart. It is made from the node's name, so that a pass keeps its numbers when passes
/// around it come and go; a graph file cannot set it.
pub(crate) const STAGE: &str = "random_stage";

/// The constants of one step's pipelines, by declared name.
pub(crate) fn constants<'a>(step: &Step, interface: &'a Interface) -> Vec<(&'a str, f64)> {
    let value = |name: &str| match name {
        STAGE => Some(f64::from(stage(&step.node))),
        name => step.params.get(name).map(|&value| number(value)),
    };
    interface.overrides.iter().filter_map(|known| Some((known.name.as_str(), value(&known.name)?))).collect()
}

fn stage(node: &str) -> u32 {
    let hash = blake3::hash(node.as_bytes());
    let [a, b, c, d, ..] = *hash.as_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// A value as pipeline constants take it.
pub(crate) fn number(value: Value) -> f64 {
    match value {
        Value::Bool(value) => f64::from(u8::from(value)),
        Value::I32(value) => value.into(),
        Value::U32(value) => value.into(),
        Value::F32(value) => value.into(),
    }
}

/// The type of the uniform that holds live parameters, where the shader has one.
pub(crate) fn live_layout(interface: &Interface) -> Option<&Layout> {
    interface.bindings.iter().find_map(|binding| match &binding.resource {
        ResourceKind::Uniform { ty } if binding.group == 1 && binding.name == LIVE => Some(ty),
        _ => None,
    })
}

/// Live parameters of one step, as bytes.
#[derive(Debug)]
pub(crate) struct LiveParams {
    layout: Layout,
    bytes: Vec<u8>,
    changed: bool,
}

impl LiveParams {
    /// Zeros with the values laid over them; values of other names belong to overrides.
    pub fn new(layout: &Layout, values: &BTreeMap<String, Value>) -> Result<Self, Error> {
        let mut live = LiveParams { bytes: iter::repeat_n(0, layout.size as usize).collect(), layout: layout.clone(), changed: true };
        for (name, value) in values {
            if live.has(name) {
                live.set(name, *value)?;
            }
        }
        Ok(live)
    }

    pub fn has(&self, name: &str) -> bool {
        self.layout.members.iter().any(|member| member.name == name)
    }

    pub fn names(&self) -> Vec<String> {
        self.layout.members.iter().map(|member| member.name.clone()).collect()
    }

    /// Writes one value, if there is a member of that name.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), Error> {
        let Some(member) = self.layout.members.iter().find(|member| member.name == name) else { return Ok(()) };
        let bytes = encoded(&member.ty.name, value).map_err(|expected| Error::WrongValue {
            name: name.to_owned(),
            expected,
            value: format!("{value:?}"),
        })?;
        let begin = member.offset as usize;
        self.bytes[begin..begin + bytes.len()].copy_from_slice(&bytes);
        self.changed = true;
        Ok(())
    }

    /// The bytes, when they changed since the last call.
    pub fn take_changes(&mut self) -> Option<&[u8]> {
        std::mem::take(&mut self.changed).then_some(&self.bytes)
    }

    pub fn size(&self) -> u64 {
        self.bytes.len() as u64
    }
}

/// The value as the bytes of a member of type `ty`, or the type that it should have had. Whole numbers fit any type that can hold them.
fn encoded(ty: &str, value: Value) -> Result<[u8; 4], &'static str> {
    match (ty, value) {
        ("f32", Value::F32(value)) => Ok(value.to_le_bytes()),
        ("f32", Value::I32(value)) => Ok((value as f32).to_le_bytes()),
        ("f32", Value::U32(value)) => Ok((value as f32).to_le_bytes()),
        ("f32", Value::Bool(_)) => Err("f32"),
        ("i32", Value::I32(value)) => Ok(value.to_le_bytes()),
        ("i32", Value::U32(value)) => i32::try_from(value).map(i32::to_le_bytes).map_err(|_| "i32"),
        ("i32", _) => Err("i32"),
        ("u32", Value::U32(value)) => Ok(value.to_le_bytes()),
        ("u32", Value::I32(value)) => u32::try_from(value).map(u32::to_le_bytes).map_err(|_| "u32"),
        ("u32", Value::Bool(value)) => Ok(u32::from(value).to_le_bytes()),
        ("u32", Value::F32(_)) => Err("u32"),
        _ => Err("f32, i32 or u32"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_shader::Member;

    fn layout() -> Layout {
        let scalar = |name: &str| Layout { name: name.to_owned(), size: 4, align: 4, members: vec![] };
        let member = |name: &str, offset, ty| Member { name: name.to_owned(), offset, ty: scalar(ty), doc: String::new(), tags: vec![] };
        let members = vec![member("exposure", 0, "f32"), member("taps", 8, "u32"), member("shift", 12, "i32")];
        Layout { name: "Params".to_owned(), size: 16, align: 4, members }
    }

    #[test]
    fn values_land_at_reflected_offsets_and_changes_are_told_once() {
        let values = BTreeMap::from([("taps".to_owned(), Value::U32(5)), ("baked".to_owned(), Value::F32(1.0))]);
        let mut live = LiveParams::new(&layout(), &values).unwrap();
        assert_eq!(live.take_changes().unwrap(), [0, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0]);
        assert!(live.take_changes().is_none());
        live.set("exposure", Value::I32(2)).unwrap();
        live.set("shift", Value::I32(-1)).unwrap();
        let bytes = live.take_changes().unwrap();
        assert_eq!(bytes[0..4], 2.0f32.to_le_bytes());
        assert_eq!(bytes[8..16], [5, 0, 0, 0, 255, 255, 255, 255]);
    }

    #[test]
    fn a_value_that_would_change_its_meaning_is_refused() {
        let mut live = LiveParams::new(&layout(), &BTreeMap::new()).unwrap();
        assert!(live.set("taps", Value::I32(-1)).is_err());
        assert!(live.set("taps", Value::F32(1.5)).is_err());
        assert!(live.set("exposure", Value::Bool(true)).is_err());
        let text = live.set("shift", Value::U32(u32::MAX)).unwrap_err().to_string();
        assert_eq!(text, "parameter `shift` takes i32, not U32(4294967295)");
    }
}
