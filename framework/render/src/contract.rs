//! From what reflection found to what the graph may know: ports, parameters, bias.

use crate::{
    params::{LIVE, STAGE},
    targets::outputs,
};
use aquifer_graph::{Bias, Contract, Direction, Extent, Param, Port, Value, WireType};
use aquifer_shader::{Binding, Interface, Layout, Member, Override, ResourceKind, Scalar};
use std::collections::BTreeSet;

/// The contract of a shader in a scene of these facts; the text of an error names what is wrong in it.
pub(crate) fn contract(interface: &Interface, facts: &BTreeSet<String>) -> Result<Contract, String> {
    let own = interface.bindings.iter().filter(|binding| binding.group == 1);
    let drawn: Vec<&str> = outputs(interface).iter().map(|output| output.name.as_str()).collect();
    let mut contract = Contract {
        about: first_sentence(&interface.manual),
        slots: interface.slots.iter().map(|(slot, _)| slot.clone()).collect(),
        needs: interface.needs.clone(),
        ..Contract::default()
    };
    for note in &interface.bias {
        let slot = slot_of(interface, &note.module);
        let given = note.given.clone().filter(|fact| !facts.contains(fact));
        let (why, without) = (note.why.clone(), note.without.clone());
        contract.bias.push(Bias { slot, why, given, without, ..Bias::default() });
    }
    for binding in own {
        match &binding.resource {
            ResourceKind::Uniform { ty } if binding.name == LIVE => {
                live_params(ty, slot_of(interface, &binding.module), &mut contract)?;
            }
            // An image of the pass's own, which its fragment entry points draw.
            ResourceKind::Texture { .. } if drawn.contains(&binding.name.as_str()) => {}
            _ => contract.ports.push(port(binding)?),
        }
    }
    for known in interface.overrides.iter().filter(|known| known.name != STAGE) {
        baked_param(known, slot_of(interface, &known.module), &mut contract)?;
    }
    match repeated(&contract) {
        None => Ok(contract),
        Some(name) => Err(format!("two modules declare a port or parameter `{name}`, which a graph file could not tell apart")),
    }
}

/// The slot that a module fills.
fn slot_of(interface: &Interface, module: &str) -> Option<String> {
    interface.slots.iter().find(|(_, filling)| filling == module).map(|(slot, _)| slot.clone())
}

fn repeated(contract: &Contract) -> Option<&str> {
    let first_repeat = |names: Vec<&'_ str>| {
        let mut seen = std::collections::BTreeSet::new();
        names.into_iter().position(|name| !seen.insert(name))
    };
    let ports: Vec<&str> = contract.ports.iter().map(|port| port.name.as_str()).collect();
    let params: Vec<&str> = contract.params.iter().map(|param| param.name.as_str()).collect();
    first_repeat(ports.clone()).map(|index| ports[index]).or_else(|| first_repeat(params.clone()).map(|index| params[index]))
}

fn first_sentence(manual: &str) -> String {
    let paragraph = manual.split("\n\n").map(str::trim).find(|part| !part.is_empty() && !part.starts_with('#')).unwrap_or_default();
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.find(". ") {
        Some(end) => line[..=end].to_owned(),
        None => line,
    }
}

fn tag<'a>(tags: &'a [(String, String)], name: &str) -> Option<&'a str> {
    tags.iter().find(|(tag, _)| tag == name).map(|(_, value)| value.as_str())
}

fn port(binding: &Binding) -> Result<Port, String> {
    let (ty, stride, natural) = match &binding.resource {
        ResourceKind::StorageArray { ty, stride, .. } => (ty, *stride, Extent::Pixels),
        ResourceKind::Storage { ty, .. } => (ty, ty.size.next_multiple_of(ty.align.max(1)), Extent::Fixed(1)),
        _ => {
            return Err(format!(
                "{}: `{}` in group 1 is no port: ports are storage buffers, the one uniform is `{LIVE}`, and textures are what a fragment \
                 entry point of the same shader gives under the same name",
                binding.module, binding.name
            ));
        }
    };
    let extent = tag(&binding.tags, "extent").map_or(Ok(natural), |text| {
        extent(text).ok_or_else(|| {
            format!("{}: `@extent {text}` of `{}` is none of `pixels`, `tiles W H`, `fixed N`", binding.module, binding.name)
        })
    })?;
    Ok(Port {
        name: binding.name.clone(),
        direction: direction(binding),
        ty: WireType { element: ty.name.clone(), layout: ty.canonical(), stride, extent },
        optional: tag(&binding.tags, "optional").is_some(),
        doc: binding.doc.clone(),
    })
}

fn direction(binding: &Binding) -> Direction {
    match (binding.read, binding.written) {
        (_, false) => Direction::In,
        (false, true) => Direction::Out,
        (true, true) => Direction::InOut,
    }
}

fn extent(text: &str) -> Option<Extent> {
    let count = |text: &str| text.parse().ok().filter(|&n: &u32| n > 0);
    match text.split_whitespace().collect::<Vec<_>>()[..] {
        ["pixels"] => Some(Extent::Pixels),
        ["tiles", w, h] => Some(Extent::Tiles(count(w)?, count(h)?)),
        ["fixed", n] => Some(Extent::Fixed(count(n)?)),
        _ => None,
    }
}

fn live_params(ty: &Layout, slot: Option<String>, contract: &mut Contract) -> Result<(), String> {
    // Names that begin with `_` are padding.
    for member in ty.members.iter().filter(|member| !member.name.starts_with('_')) {
        let Member { name, tags, doc, .. } = member;
        let scalar = scalar(&member.ty.name)
            .ok_or_else(|| format!("member `{name}` of `{LIVE}` is {}: parameters are f32, i32 or u32", member.ty.name))?;
        add_param(Declared { name, scalar, default: None, tags, doc, live: true, slot: slot.clone() }, contract)?;
    }
    Ok(())
}

fn baked_param(known: &Override, slot: Option<String>, contract: &mut Contract) -> Result<(), String> {
    let Override { name, ty, default, doc, tags, .. } = known;
    if default.is_none() && tag(tags, "default").is_none() {
        // Computed from other overrides: nothing to set.
        return Ok(());
    }
    add_param(Declared { name, scalar: *ty, default: *default, tags, doc, live: false, slot }, contract)
}

struct Declared<'a> {
    name: &'a str,
    scalar: Scalar,
    default: Option<f64>,
    tags: &'a [(String, String)],
    doc: &'a str,
    live: bool,
    slot: Option<String>,
}

fn add_param(declared: Declared<'_>, contract: &mut Contract) -> Result<(), String> {
    let Declared { name, scalar, default, tags, doc, live, slot } = declared;
    let wrong = |tag: &str, text: &str| format!("`@{tag} {text}` of parameter `{name}` cannot be understood");
    let choices: Vec<String> = tag(tags, "choices").unwrap_or_default().split_whitespace().map(str::to_owned).collect();
    let default = match (tag(tags, "default"), default) {
        (Some(text), _) => parse(text, scalar, &choices).ok_or_else(|| wrong("default", text))?,
        (None, number) => from_number(number.unwrap_or(0.0), scalar),
    };
    let range = tag(tags, "range").map(|text| range(text).ok_or_else(|| wrong("range", text))).transpose()?;
    if let Some(value) = tag(tags, "unbiased") {
        let why = tag(tags, "why").unwrap_or(doc).to_owned();
        let unless_slot = tag(tags, "unless").map(|text| pair(text).ok_or_else(|| wrong("unless", text))).transpose()?;
        contract.bias.push(Bias {
            slot,
            param: Some(name.to_owned()),
            unless: Some(value.to_owned()),
            unless_slot,
            why,
            ..Bias::default()
        });
    }
    contract.params.push(Param { name: name.to_owned(), default, range, choices, live, doc: doc.to_owned() });
    Ok(())
}

fn scalar(name: &str) -> Option<Scalar> {
    match name {
        "f32" => Some(Scalar::F32),
        "i32" => Some(Scalar::I32),
        "u32" => Some(Scalar::U32),
        _ => None,
    }
}

fn parse(text: &str, scalar: Scalar, choices: &[String]) -> Option<Value> {
    if let Some(index) = choices.iter().position(|choice| choice == text) {
        return Some(from_number(index as f64, scalar));
    }
    match scalar {
        Scalar::Bool => text.parse().ok().map(Value::Bool),
        Scalar::I32 => text.trim_end_matches('i').parse().ok().map(Value::I32),
        Scalar::U32 => text.trim_end_matches('u').parse().ok().map(Value::U32),
        Scalar::F32 => text.trim_end_matches('f').parse().ok().map(Value::F32),
    }
}

fn from_number(number: f64, scalar: Scalar) -> Value {
    match scalar {
        Scalar::Bool => Value::Bool(number != 0.0),
        Scalar::I32 => Value::I32(number as i32),
        Scalar::U32 => Value::U32(number as u32),
        Scalar::F32 => Value::F32(number as f32),
    }
}

/// A slot and its filling.
fn pair(text: &str) -> Option<(String, String)> {
    let (slot, filling) = text.split_once(char::is_whitespace)?;
    Some((slot.to_owned(), filling.trim().to_owned()))
}

fn range(text: &str) -> Option<(f64, f64)> {
    let (low, high) = text.split_once(char::is_whitespace)?;
    let (low, high) = (low.trim().parse().ok()?, high.trim().parse().ok()?);
    (low <= high).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(name: &str, size: u32) -> Layout {
        Layout { name: name.to_owned(), size, align: 4, members: vec![] }
    }

    fn tags(list: &[(&str, &str)]) -> Vec<(String, String)> {
        list.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
    }

    fn binding(name: &str, resource: ResourceKind, (read, written): (bool, bool), list: &[(&str, &str)]) -> Binding {
        let (module, doc) = ("pass/x".to_owned(), String::new());
        Binding { group: 1, binding: 0, name: name.to_owned(), module, resource, read, written, doc, tags: tags(list) }
    }

    fn array(name: &str) -> ResourceKind {
        ResourceKind::StorageArray { ty: layout(name, 16), stride: 16, writable: true }
    }

    #[test]
    fn direction_comes_from_use_and_extent_from_the_type_or_a_tag() {
        let interface = Interface {
            manual: "# Title\n\nDoes one thing.\nThen more.".to_owned(),
            bindings: vec![
                binding("a", array("vec4<f32>"), (true, false), &[("optional", "")]),
                binding("b", array("vec4<f32>"), (false, true), &[("extent", "tiles 64 32")]),
                binding("c", ResourceKind::Storage { ty: layout("u32", 4), writable: true }, (true, true), &[]),
            ],
            ..Interface::default()
        };
        let contract = contract(&interface, &BTreeSet::new()).unwrap();
        assert_eq!(contract.about, "Does one thing.");
        let found: Vec<_> = contract.ports.iter().map(|port| (port.direction, port.ty.extent.clone(), port.optional)).collect();
        assert_eq!(
            found,
            [
                (Direction::In, Extent::Pixels, true),
                (Direction::Out, Extent::Tiles(64, 32), false),
                (Direction::InOut, Extent::Fixed(1), false)
            ]
        );
    }

    #[test]
    fn parameters_carry_their_tags() {
        let member = |name: &str, ty: &str, list: &[(&str, &str)]| Member {
            name: name.to_owned(),
            offset: 0,
            ty: layout(ty, 4),
            doc: String::new(),
            tags: tags(list),
        };
        let mut params = layout("Params", 8);
        params.members = vec![
            member("exposure", "f32", &[("default", "1.5"), ("range", "-8 8")]),
            member(
                "curve",
                "u32",
                &[("choices", "linear aces"), ("default", "aces"), ("unbiased", "linear"), ("unless", "film float"), ("why", "it clips")],
            ),
            member("_pad", "vec2<f32>", &[]),
        ];
        let baked = |name: &str, default| Override {
            name: name.to_owned(),
            key: name.to_owned(),
            module: "pass/x".to_owned(),
            ty: Scalar::U32,
            default,
            doc: String::new(),
            tags: vec![],
        };
        let interface = Interface {
            bindings: vec![binding("params", ResourceKind::Uniform { ty: params }, (true, false), &[])],
            overrides: vec![baked("taps", Some(5.0)), baked("derived", None), baked("random_stage", Some(0.0))],
            ..Interface::default()
        };
        let contract = contract(&interface, &BTreeSet::new()).unwrap();
        let found: Vec<_> = contract.params.iter().map(|param| (param.name.as_str(), param.default, param.live)).collect();
        assert_eq!(found, [("exposure", Value::F32(1.5), true), ("curve", Value::U32(1), true), ("taps", Value::U32(5), false)]);
        assert_eq!(contract.params[0].range, Some((-8.0, 8.0)));
        let unless_slot = Some(("film".into(), "float".into()));
        let bias =
            Bias { param: Some("curve".into()), unless: Some("linear".into()), unless_slot, why: "it clips".into(), ..Bias::default() };
        assert_eq!(contract.bias, [bias]);
    }

    #[test]
    fn what_cannot_be_a_port_or_an_extent_is_refused_by_name() {
        let refused = |binding| contract(&Interface { bindings: vec![binding], ..Interface::default() }, &BTreeSet::new()).unwrap_err();
        let texture = ResourceKind::Texture { ty: "texture_2d<f32>".to_owned() };
        assert!(refused(binding("image", texture, (true, false), &[])).contains("`image` in group 1 is no port"));
        for text in ["tiles 0 8", "fixed", "fixed -1", "rows"] {
            let message = refused(binding("a", array("u32"), (true, false), &[("extent", text)]));
            assert!(message.contains(text) && message.contains("`a`"), "{message}");
        }
    }
}
