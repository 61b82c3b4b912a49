//! Every `cases/*.toml` with the `.expect` beside it: what is wrong with the graph, or the plan that it gives.
//!
//! A case's first lines may be directives, the arguments of a command line:
//! `# --set temporal.cap=3`, `# --keep temporal.reservoir`, `# --leave-out temporal reservoir=current`.
//! `AQUIFER_BLESS=1` writes the expectations anew; read each one before it is committed.

mod fake;

use aquifer_graph::{Binding, Document, Extent, Graph, Life, Needs, Node, Plan, ResourceHalf, Shelf, Source, StandIn, Verdict, When};
use std::{collections::BTreeMap, fmt::Write, fs, path::Path};

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases"))
}

/// Files of the case folder, named relative to it so that expectations are the same on every machine.
fn shelf() -> Shelf {
    let texts = |under: &str| -> Vec<(String, String)> {
        let entries = fs::read_dir(folder().join(under)).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let names = entries.filter(|name| name.ends_with(".toml")).map(|name| format!("{under}{name}"));
        names.map(|name| (name.clone(), fs::read_to_string(folder().join(name)).unwrap())).collect()
    };
    Shelf::new("", texts("").into_iter().chain(texts("lib/")))
}

/// Leaves out the passes that the directives name.
struct Directed(BTreeMap<String, BTreeMap<String, StandIn>>);

impl Needs for Directed {
    fn verdict(&self, node: &Node) -> Verdict {
        match self.0.get(&node.pass) {
            None => Verdict::Run,
            Some(stand_in) => Verdict::LeaveOut { reason: "the case says so".into(), stand_in: stand_in.clone() },
        }
    }
}

fn directives<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    text.lines().filter_map(|line| line.strip_prefix("# ")?.strip_prefix(name)?.strip_prefix(' ')).collect()
}

fn leave_out(directive: &str) -> (String, BTreeMap<String, StandIn>) {
    let mut words = directive.split(' ');
    let pass = words.next().expect("a pass").to_owned();
    let stand_in = words.filter_map(|word| word.split_once('=')).map(|(port, input)| {
        let stand_in = if input == "zeros" { StandIn::Zeros } else { StandIn::Input(input.into()) };
        (port.to_owned(), stand_in)
    });
    (pass, stand_in.collect())
}

/// Everything that people would see of a case.
fn outcome(shelf: &Shelf, name: &str, text: &str) -> String {
    let edits = directives(text, "--set").into_iter().map(|edit| Source::new("--set", edit));
    let checked = Document::load(name, shelf).and_then(|document| Graph::check_with(document, edits, &fake::Fakes));
    let graph = match checked {
        Ok(graph) => graph,
        Err(faults) => return faults.to_string(),
    };
    assert_eq!(rewritten(&graph, shelf, name, text), graph.digest(), "{name}: written out, it is the same graph");
    let needs = Directed(directives(text, "--leave-out").into_iter().map(leave_out).collect());
    match graph.plan(&needs, &directives(text, "--keep")) {
        Err(error) => format!("no plan: {error}"),
        Ok(plan) => {
            plan.verify().expect("a plan does not contradict itself");
            describe(&graph, &plan)
        }
    }
}

/// The digest of the graph whose file is what this one's document writes.
fn rewritten(graph: &Graph, shelf: &Shelf, name: &str, text: &str) -> String {
    let mut document = Document::load(name, shelf).expect("it was read before");
    document.apply(directives(text, "--set").into_iter().map(|edit| Source::new("--set", edit))).expect("they were applied before");
    let written =
        Document::parse(Source::new("written.toml", document.to_toml()), &Shelf::default()).unwrap_or_else(|faults| panic!("{faults}"));
    let again = Graph::check(&written, &fake::Fakes).unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!((again.title(), again.about(), again.knob()), (graph.title(), graph.about(), graph.knob()));
    again.digest()
}

fn describe(graph: &Graph, plan: &Plan) -> String {
    let mut text = format!("{}: {}\n\n", plan.title, plan.transport);
    for step in &plan.steps {
        let bindings: Vec<String> = step.bindings.iter().map(|binding| bound(plan, binding)).collect();
        let _ = writeln!(text, "{:12} {}", step.node, bindings.join(", "));
        let set: Vec<String> =
            step.params.iter().map(|(name, value)| format!("{name} = {}", serde_json::to_string(value).expect("a number"))).collect();
        if !set.is_empty() {
            let _ = writeln!(text, "{:12} {}", "", set.join(", "));
        }
    }
    let _ = writeln!(text, "output       {}", plan.resources[plan.output].name);
    for kept in &plan.kept {
        let _ = writeln!(text, "kept         {} = {}", kept.name, kept.resource.map_or("zeros".into(), |half| half_name(plan, half)));
    }
    for left in &plan.left_out {
        let _ = writeln!(text, "left out     {}: {}", left.node, left.reason);
    }
    describe_memory(&mut text, plan);
    for finding in graph.bias() {
        let _ = writeln!(text, "biased       {}: {}: {}, {}", finding.place, finding.pass, finding.what, finding.why);
    }
    text
}

fn describe_memory(text: &mut String, plan: &Plan) {
    let blocks = plan.blocks([100, 10]);
    let _ = writeln!(text);
    for (resource, block) in plan.resources.iter().zip(&blocks.of) {
        let life = match resource.life {
            Life::Transient { first, last } => format!("steps {first} to {last}, block {}", block.expect("transients have blocks")),
            Life::History => "history".into(),
            Life::Output => "output".into(),
        };
        let extent = match resource.extent() {
            Extent::Pixels => "pixels".into(),
            Extent::Tiles(width, height) => format!("tiles {width}x{height}"),
            Extent::Fixed(count) => count.to_string(),
        };
        let clear = if resource.clear { ", cleared" } else { "" };
        let _ = writeln!(text, "{:22} {:14} {extent}, {life}{clear}", resource.name, resource.ty.element);
    }
    let _ = writeln!(text, "blocks {:?}, unshared {}", blocks.sizes, blocks.unshared);
}

fn bound(plan: &Plan, binding: &Binding) -> String {
    format!("{} = {}", binding.port, binding.resource.map_or("zeros".into(), |half| half_name(plan, half)))
}

fn half_name(plan: &Plan, half: ResourceHalf) -> String {
    let mark = if half.when == When::Previous { "@prev" } else { "" };
    format!("{}{mark}", plan.resources[half.resource].name)
}

#[test]
fn every_case_comes_out_as_expected() {
    let bless = std::env::var_os("AQUIFER_BLESS").is_some();
    let mut names: Vec<String> =
        fs::read_dir(folder()).unwrap().filter_map(|entry| entry.unwrap().file_name().into_string().ok()).collect();
    names.retain(|name| name.ends_with(".toml"));
    names.sort();
    let shelf = shelf();
    let mut failures = String::new();
    for name in &names {
        let text = fs::read_to_string(folder().join(name)).unwrap();
        let outcome = outcome(&shelf, name, &text).trim_end().to_owned() + "\n";
        let expect = folder().join(name).with_extension("expect");
        if bless {
            fs::write(&expect, &outcome).unwrap();
            continue;
        }
        let expected = fs::read_to_string(&expect).unwrap_or_default();
        if outcome != expected {
            let _ = writeln!(failures, "==== {name}\n---- expected\n{expected}---- came out\n{outcome}");
        }
    }
    assert!(names.len() >= 60, "only {} cases were found", names.len());
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn every_expectation_has_its_case() {
    let lonely: Vec<_> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "expect") && !path.with_extension("toml").exists())
        .collect();
    assert!(lonely.is_empty(), "{lonely:?}");
}
