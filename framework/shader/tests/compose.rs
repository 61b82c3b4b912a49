//! Linking, slots, reflection and error places, on small modules.

use aquifer_shader::*;
use std::collections::{BTreeMap, BTreeSet};

fn library(modules: &[(&str, &str)]) -> Library {
    let mut library = Library::new();
    for (path, text) in modules {
        library.insert(*path, *text, format!("{path}.wgsl"));
    }
    library
}

fn of(entry: &str, slots: &[(&str, &str)], features: &[&str]) -> Specialisation {
    Specialisation {
        entry: entry.into(),
        slots: slots.iter().map(|(slot, filling)| (slot.to_string(), filling.to_string())).collect::<BTreeMap<_, _>>(),
        features: features.iter().map(|name| name.to_string()).collect::<BTreeSet<_>>(),
    }
}

const RESERVOIR: &str = "import package::slot::domain::{Sample};\nstruct Reservoir { sample: Sample, weight: f32, count: u32 }\n";
const DI: &str = "struct Sample { light: u32, uv: vec2<f32> }\nfn draw() -> Sample { return Sample(1u, vec2<f32>(0.5)); }\n";
const GI: &str = "/// Cells of the grid.\n/// @extent fixed 64\n@group(1) @binding(0) var<storage, read> cells: array<vec4<f32>>;\n\
    struct Sample { point: vec3<f32>, radiance: vec3<f32> }\nfn draw() -> Sample { return Sample(cells[0].xyz, vec3<f32>(0.0)); }\n";
const INITIAL: &str = "//! Draws one sample.\n//! bias: it is a test\n//! bias (bright): it dazzles\n\
    //! bias (domain = gi): it is remembered\n\
    import package::restir::reservoir::{Reservoir};\nimport package::slot::domain::{draw};\nimport package::scene::light::{lights};\n\
    struct Params {\n    /// Scale of it all.\n    /// @default 0.5\n    scale: f32,\n    taps1: u32,\n}\n\
    @group(1) @binding(0) var<uniform> params: Params;\n\
    /// What was drawn.\n@group(1) @binding(1) var<storage, read_write> reservoir: array<Reservoir>;\n\
    @group(1) @binding(2) var<storage, read_write> unused: array<f32>;\n\
    /// How many.\n/// @range 1 64\noverride candidates: u32 = 32u;\n\
    @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
    var weight = params.scale * f32(candidates + params.taps1);\n\
    @if(bright) { weight = weight + lights[id.x]; }\n\
    reservoir[id.x] = Reservoir(draw(), weight, 1u);\n}\n";
const LIGHT: &str = "@group(0) @binding(7) var<storage, read> lights: array<f32>;\n";

fn all() -> Library {
    library(&[("restir/reservoir", RESERVOIR), ("domain/di", DI), ("domain/gi", GI), ("pass/initial", INITIAL), ("scene/light", LIGHT)])
}

#[test]
fn ports_come_from_use_and_slots() {
    let di = all().compose(&of("pass/initial", &[("domain", "di")], &[])).unwrap().interface;
    let names: Vec<_> = di.bindings.iter().map(|b| (b.group, b.binding, b.name.as_str(), b.read, b.written)).collect();
    assert_eq!(names, [(1, 0, "params", true, false), (1, 1, "reservoir", false, true)]);
    let note = |why: &str, given: Option<&str>| {
        let given = given.map(str::to_owned);
        BiasNote { module: "pass/initial".into(), why: why.into(), given, ..BiasNote::default() }
    };
    assert_eq!(di.bias, [note("it is a test", None), note("it dazzles", Some("bright"))]);
    assert_eq!(di.manual, "Draws one sample.\n");
    assert_eq!(di.slots, [("domain".to_owned(), "domain/di".to_owned())]);

    let gi = all().compose(&of("pass/initial", &[("domain", "gi")], &["bright"])).unwrap().interface;
    assert_eq!(gi.bias, [note("it is a test", None), note("it dazzles", Some("bright")), note("it is remembered", None)]);
    let cells = gi.bindings.iter().find(|b| b.name == "cells").unwrap();
    assert_eq!((cells.module.as_str(), cells.tags[0].1.as_str(), cells.doc.as_str()), ("domain/gi", "fixed 64", "Cells of the grid."));
    assert!(gi.bindings.iter().any(|b| b.group == 0 && b.module == "scene/light" && b.name == "lights"));
    let mut numbers: Vec<_> = gi.bindings.iter().filter(|b| b.group == 1).map(|b| b.binding).collect();
    numbers.dedup();
    assert_eq!(numbers, [0, 1, 2]);
}

#[test]
fn wires_of_two_domains_differ_in_name_and_layout() {
    let element = |filling: &str| {
        let interface = all().compose(&of("pass/initial", &[("domain", filling)], &[])).unwrap().interface;
        let binding = interface.bindings.into_iter().find(|b| b.name == "reservoir").unwrap();
        let ResourceKind::StorageArray { ty, stride, writable: true } = binding.resource else { panic!("no array") };
        (ty.name.clone(), ty.canonical(), stride)
    };
    let (di, gi) = (element("di"), element("gi"));
    assert_eq!(di.0, "Reservoir<di>");
    assert_eq!(gi.0, "Reservoir<gi>");
    assert_ne!(di.1, gi.1);
    assert_eq!(di.2, 24);
    assert_eq!(di.1, "Reservoir<di>{sample@0:Sample<di>{light@0:u32,uv@8:vec2<f32>}/16,weight@16:f32,count@20:u32}/24");
}

#[test]
fn params_carry_their_comments() {
    let interface = all().compose(&of("pass/initial", &[("domain", "di")], &[])).unwrap().interface;
    let candidates = &interface.overrides[0];
    assert_eq!((candidates.name.as_str(), candidates.default, candidates.ty), ("candidates", Some(32.0), Scalar::U32));
    assert_eq!(candidates.tags, [("range".to_owned(), "1 64".to_owned())]);
    let ResourceKind::Uniform { ty } = &interface.bindings[0].resource else { panic!("no uniform") };
    assert_eq!(ty.members[0].tags, [("default".to_owned(), "0.5".to_owned())]);
    assert_eq!((ty.members[1].name.as_str(), ty.members[1].offset), ("taps1", 4));
}

#[test]
fn faults_point_at_sources() {
    let missing = all().compose(&of("pass/inital", &[], &[])).unwrap_err();
    assert_eq!(missing.to_string(), "no shader module `pass/inital`; did you mean `pass/initial`?");

    let unfilled = all().compose(&of("pass/initial", &[], &[])).unwrap_err();
    assert!(matches!(&unfilled, ShaderError::UnfilledSlot { slot, .. } if slot == "domain"), "{unfilled}");

    let mut wrong_type = all();
    wrong_type.insert("domain/di", "struct Sample { light: u32, uv: vec2<f32> }\n\nfn draw() -> Sample {\n    let x = 1u + vec3<f32>(0.0);\n    return Sample(1u, vec2<f32>(0.5));\n}\n", "mine/di.wgsl");
    let fault = wrong_type.compose(&of("pass/initial", &[("domain", "di")], &[])).unwrap_err().to_string();
    assert!(fault.starts_with("mine/di.wgsl:4:13 in draw: "), "{fault}");

    let mut broken = all();
    broken.insert("domain/di", "struct Sample { light: u32 }\nfn draw( -> Sample {}\n", "mine/di.wgsl");
    let fault = broken.compose(&of("pass/initial", &[("domain", "di")], &[])).unwrap_err().to_string();
    assert!(fault.starts_with("mine/di.wgsl:2:10: unexpected token `->`"), "{fault}");

    let mut twice = all();
    twice.insert("domain/di", format!("override candidates: u32 = 1u;\n{}", DI.replace("1u, v", "candidates, v")), "domain/di.wgsl");
    let fault = twice.compose(&of("pass/initial", &[("domain", "di")], &[])).unwrap_err();
    assert!(matches!(&fault, ShaderError::OverrideTwice { name, .. } if name == "candidates"), "{fault}");
}

#[test]
fn slots_list_what_can_fill_them() {
    assert_eq!(all().slots(), BTreeMap::from([("domain".to_owned(), vec!["di".to_owned(), "gi".to_owned()])]));
    assert_eq!(all().modules("pass"), ["initial"]);
}
