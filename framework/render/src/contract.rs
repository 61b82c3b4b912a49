//! From what reflection found to what the graph may know: ports, parameters, bias.

use crate::{
    params::{LIVE, STAGE, number},
    targets::outputs,
};
use aquifer_graph::{Bias, Contract, Direction, Extent, Param, Port, Value, WireType, nearest};
use aquifer_shader::{Binding, Interface, Layout, Member, Override, ResourceKind, Scalar};
use std::collections::BTreeSet;

/// Tags that may stand above a port. `display_of` is for people: it says of which port an image is the picture.
const PORT_TAGS: &[&str] = &["optional", "extent", "display_of"];

/// Tags that may stand above a parameter.
const PARAM_TAGS: &[&str] = &["default", "range", "choices", "unbiased", "unless", "why"];

/// What is wrong in a shader, and beside which declaration.
#[derive(Debug)]
pub(crate) struct Wrong {
    /// The declaration's module; `None`: the pass's own.
    pub module: Option<String>,
    /// `taps`, or `Params.exposure`.
    pub name: String,
    /// The tag above it that is to blame.
    pub tag: Option<String>,
    pub message: String,
}

/// The contract of a shader in a scene of these facts.
pub(crate) fn contract(interface: &Interface, facts: &BTreeSet<String>) -> Result<Contract, Wrong> {
    let own = interface.bindings.iter().filter(|binding| binding.group == 1);
    let drawn: Vec<&str> = outputs(interface).iter().map(|output| output.name.as_str()).collect();
    let mut contract = Contract {
        about: first_sentence(&interface.manual),
        slots: interface.slots.iter().map(|(slot, _)| slot.clone()).collect(),
        needs: interface.needs.clone(),
        ..Contract::default()
    };
    if let Some(text) = interface.paths.first() {
        let wrong = |message| Wrong { module: None, name: String::new(), tag: None, message };
        if interface.paths.iter().any(|other| other != text) {
            return Err(wrong(format!("its modules say different `@paths`: {}", interface.paths.join(", "))));
        }
        let unread = |_| wrong(format!("`@paths {text}`: write a number of scatterings, or the fewest: `2..`"));
        contract.paths = Some(text.parse().map_err(unread)?);
    }
    for note in &interface.bias {
        let slot = slot_of(interface, &note.module);
        let given = note.given.clone().filter(|fact| !facts.contains(fact));
        let (why, without) = (note.why.clone(), note.without.clone());
        contract.bias.push(Bias { slot, why, given, without, ..Bias::default() });
    }
    for binding in own {
        match &binding.resource {
            ResourceKind::Uniform { ty } if binding.name == LIVE => {
                live_params(ty, &binding.module, slot_of(interface, &binding.module), &mut contract)?;
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
        Some(name) => {
            let message = format!("two modules declare a port or parameter `{name}`, which a graph file could not tell apart");
            Err(Wrong { module: None, name: name.to_owned(), tag: None, message })
        }
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

/// The first tag that nothing reads there.
fn unknown<'a>(tags: &'a [(String, String)], known: &[&str], what: &str) -> Option<(&'a str, String)> {
    let (tag, _) = tags.iter().find(|(tag, _)| !known.contains(&tag.as_str()))?;
    let cure = nearest(tag, known.iter().copied()).map(|near| format!("did you mean `@{near}`?"));
    let cure = cure.unwrap_or_else(|| format!("there are `@{}`", known.join("`, `@")));
    Some((tag, format!("{what} has no tag `@{tag}`; {cure}")))
}

fn port(binding: &Binding) -> Result<Port, Wrong> {
    let wrong = |tag: Option<&str>, message| Wrong {
        module: Some(binding.module.clone()),
        name: binding.name.clone(),
        tag: tag.map(str::to_owned),
        message,
    };
    if let Some((tag, message)) = unknown(&binding.tags, PORT_TAGS, "a port") {
        return Err(wrong(Some(tag), message));
    }
    let (ty, stride, natural) = match &binding.resource {
        ResourceKind::StorageArray { ty, stride, .. } => (ty, *stride, Extent::Pixels),
        ResourceKind::Storage { ty, .. } => (ty, ty.size.next_multiple_of(ty.align.max(1)), Extent::Fixed(1)),
        _ => {
            let message = format!(
                "`{}` in group 1 is no port: ports are storage buffers, the one uniform is `{LIVE}`, and textures are what a fragment \
                 entry point of the same shader gives under the same name",
                binding.name
            );
            return Err(wrong(None, message));
        }
    };
    let extent = tag(&binding.tags, "extent").map_or(Ok(natural), |text| {
        extent(text).ok_or_else(|| {
            wrong(Some("extent"), format!("`@extent {text}` of `{}` is none of `pixels`, `tiles W H`, `fixed N`", binding.name))
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

fn live_params(ty: &Layout, module: &str, slot: Option<String>, contract: &mut Contract) -> Result<(), Wrong> {
    // The name of a type that belongs to a slot goes on with `<`.
    let structure = ty.name.split('<').next().unwrap_or_default();
    // Names that begin with `_` are padding.
    for member in ty.members.iter().filter(|member| !member.name.starts_with('_')) {
        let Member { name, tags, doc, .. } = member;
        let wrong = |(tag, message): (Option<&str>, String)| Wrong {
            module: Some(module.to_owned()),
            name: format!("{structure}.{name}"),
            tag: tag.map(str::to_owned),
            message,
        };
        let scalar = scalar(&member.ty.name)
            .ok_or_else(|| wrong((None, format!("member `{name}` of `{LIVE}` is {}: parameters are f32, i32 or u32", member.ty.name))))?;
        add_param(Declared { name, scalar, default: None, tags, doc, live: true, slot: slot.clone() }, contract).map_err(wrong)?;
    }
    Ok(())
}

fn baked_param(known: &Override, slot: Option<String>, contract: &mut Contract) -> Result<(), Wrong> {
    let Override { name, ty, default, doc, tags, .. } = known;
    if default.is_none() && tag(tags, "default").is_none() {
        // Computed from other overrides: nothing to set.
        return Ok(());
    }
    let declared = Declared { name, scalar: *ty, default: *default, tags, doc, live: false, slot };
    add_param(declared, contract).map_err(|(tag, message)| Wrong {
        module: Some(known.module.clone()),
        name: name.clone(),
        tag: tag.map(str::to_owned),
        message,
    })
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

/// An error has the tag that is to blame.
fn add_param<'a>(declared: Declared<'a>, contract: &mut Contract) -> Result<(), (Option<&'a str>, String)> {
    let Declared { name, scalar, default, tags, doc, live, slot } = declared;
    if let Some((tag, message)) = unknown(tags, PARAM_TAGS, "a parameter") {
        return Err((Some(tag), message));
    }
    let wrong = |tag, text: &str| (Some(tag), format!("`@{tag} {text}` of parameter `{name}` cannot be understood"));
    let choices: Vec<String> = tag(tags, "choices").unwrap_or_default().split_whitespace().map(str::to_owned).collect();
    let default = match (tag(tags, "default"), default) {
        (Some(text), _) => parse(text, scalar, &choices).ok_or_else(|| wrong("default", text))?,
        (None, number) => from_number(number.unwrap_or(0.0), scalar),
    };
    let range = tag(tags, "range").map(|text| range(text).ok_or_else(|| wrong("range", text))).transpose()?;
    if let Some(why) = impossible(default, range, choices.len()) {
        let (blamed, said) = match tag(tags, "default") {
            Some(text) => (Some("default"), text.to_owned()),
            None => (None, number(default).to_string()),
        };
        return Err((blamed, format!("parameter `{name}` begins as {said}, which {why}: say another `@default`")));
    }
    if let Some(value) = tag(tags, "unbiased") {
        parse(value, scalar, &choices).ok_or_else(|| wrong("unbiased", value))?;
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

/// Why a graph file could not set this value.
fn impossible(default: Value, range: Option<(f64, f64)>, choices: usize) -> Option<String> {
    let value = number(default);
    if !value.is_finite() {
        return Some("is no finite number".to_owned());
    }
    if let Some((low, high)) = range.filter(|(low, high)| value < f64::from(*low as f32) || value > f64::from(*high as f32)) {
        return Some(format!("is outside of its range from {low} to {high}"));
    }
    (choices > 0 && value >= choices as f64).then(|| format!("is none of its {choices} choices"))
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
        let refused =
            |binding| contract(&Interface { bindings: vec![binding], ..Interface::default() }, &BTreeSet::new()).unwrap_err().message;
        let texture = ResourceKind::Texture { ty: "texture_2d<f32>".to_owned() };
        assert!(refused(binding("image", texture, (true, false), &[])).contains("`image` in group 1 is no port"));
        for text in ["tiles 0 8", "fixed", "fixed -1", "rows"] {
            let message = refused(binding("a", array("u32"), (true, false), &[("extent", text)]));
            assert!(message.contains(text) && message.contains("`a`"), "{message}");
        }
    }

    #[test]
    fn tags_that_nothing_reads_and_defaults_that_cannot_be_are_refused() {
        let refused = |ty: &str, list: &[(&str, &str)]| {
            let member = Member { name: "width".to_owned(), offset: 0, ty: layout(ty, 4), doc: String::new(), tags: tags(list) };
            let params = Layout { members: vec![member], ..layout("Params", 4) };
            let bindings = vec![binding("params", ResourceKind::Uniform { ty: params }, (true, false), &[])];
            contract(&Interface { bindings, ..Interface::default() }, &BTreeSet::new()).map(|_| ())
        };
        let found = |ty, list: &[(&str, &str)]| {
            let wrong = refused(ty, list).unwrap_err();
            assert_eq!((wrong.module.as_deref(), wrong.name.as_str()), (Some("pass/x"), "Params.width"));
            (wrong.tag, wrong.message)
        };
        let said = |tag: Option<&str>, message: &str| (tag.map(str::to_owned), message.to_owned());
        let misspelt = "a parameter has no tag `@defalt`; did you mean `@default`?";
        assert_eq!(found("f32", &[("range", "0 8"), ("defalt", "1")]), said(Some("defalt"), misspelt));
        let misplaced = found("f32", &[("optional", "")]).1;
        assert!(misplaced.contains("`@default`, `@range`"), "{misplaced}");
        let outside = "parameter `width` begins as 99, which is outside of its range from 0 to 8: say another `@default`";
        assert_eq!(found("f32", &[("default", "99"), ("range", "0 8")]), said(Some("default"), outside));
        let unsaid = "parameter `width` begins as 0, which is outside of its range from 1 to 8: say another `@default`";
        assert_eq!(found("u32", &[("range", "1 8")]), said(None, unsaid));
        for text in ["nan", "infinity", "1e50"] {
            let message = format!("parameter `width` begins as {text}, which is no finite number: say another `@default`");
            assert_eq!(found("f32", &[("default", text)]), said(Some("default"), &message));
        }
        let choice = "parameter `width` begins as 2, which is none of its 2 choices: say another `@default`";
        assert_eq!(found("u32", &[("choices", "a b"), ("default", "2")]), said(Some("default"), choice));
        assert_eq!(found("u32", &[("choices", "a b"), ("unbiased", "c")]).0.as_deref(), Some("unbiased"));
        assert!(refused("f32", &[("default", "0.1"), ("range", "0.1 1")]).is_ok(), "the end of a range is within it");

        let port = binding("a", array("u32"), (true, false), &[("optionl", "")]);
        let wrong = contract(&Interface { bindings: vec![port], ..Interface::default() }, &BTreeSet::new()).unwrap_err();
        assert_eq!((wrong.name.as_str(), wrong.tag.as_deref()), ("a", Some("optionl")));
        assert_eq!(wrong.message, "a port has no tag `@optionl`; did you mean `@optional`?");
    }
}
