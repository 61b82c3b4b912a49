//! What must hold for graphs that nobody thought of.

mod fake;

use aquifer_graph::{
    Contract, ContractError, Contracts, Direction, Document, Extent, Faults, Files, Graph, Life, MAX_FILES, Needs, NeedsAll, Node, Plan,
    Port, ReadError, Shelf, Slots, Source, StandIn, Verdict, When, WireType,
};
use proptest::prelude::*;
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write,
};

fn check(text: &str, contracts: &dyn Contracts) -> Result<Graph, Faults> {
    let document = Document::parse(Source::new("random.toml", text), &Shelf::default())?;
    Graph::check(&document, contracts)
}

/// The kind `n210` has two inputs, one optional input, no in-out port, and always the output `out`.
struct Numbers;

impl Contracts for Numbers {
    fn kinds(&self) -> Vec<String> {
        Vec::new()
    }

    fn slots(&self) -> BTreeMap<String, Vec<String>> {
        BTreeMap::new()
    }

    fn contract(&self, kind: &str, _: &Slots) -> Result<Contract, ContractError> {
        let digits: Vec<usize> = kind.chars().skip(1).map(|c| c.to_digit(10).unwrap_or(0) as usize).collect();
        let ty = || WireType { element: "f32".into(), layout: "f32".into(), stride: 4, extent: Extent::Pixels };
        let port = |name: String, direction, optional| Port { name, direction, ty: ty(), optional, doc: String::new() };
        let mut ports: Vec<Port> = (0..digits[0]).map(|i| port(format!("in{i}"), Direction::In, false)).collect();
        ports.extend((0..digits[1]).map(|i| port(format!("maybe{i}"), Direction::In, true)));
        ports.extend((0..digits[2]).map(|i| port(format!("both{i}"), Direction::InOut, true)));
        ports.push(port("out".into(), Direction::Out, false));
        Ok(Contract { ports, ..Contract::default() })
    }
}

/// One pass of a random graph.
#[derive(Clone, Debug)]
struct Draft {
    inputs: Vec<(usize, bool)>,
    maybe: Option<(usize, bool)>,
    /// What its in-out port rewrites.
    both: Option<(usize, bool)>,
    rounds: u32,
}

fn draft() -> impl Strategy<Value = Draft> {
    let wire = || (any::<usize>(), prop::bool::weighted(0.3));
    (
        prop::collection::vec(wire(), 0..3),
        prop::option::of(wire()),
        prop::option::weighted(0.2, wire()),
        prop_oneof![4 => Just(1u32), 1 => 2..4u32],
    )
        .prop_map(|(inputs, maybe, both, rounds)| Draft { inputs, maybe, both, rounds })
}

/// The text of a graph of these passes. Wires of this frame reach back only, so that there is no cycle of wires.
fn graph_text(drafts: &[Draft]) -> String {
    let mut text = format!("transport = \"full:2\"\noutput = \"p{}.out\"\n", drafts.len() - 1);
    for (index, draft) in drafts.iter().enumerate() {
        let wire = |(to, previous): (usize, bool)| match (previous, index) {
            (false, 1..) => format!("\"p{}.out\"", to % index),
            _ => format!("\"p{}.out@prev\"", to % drafts.len()),
        };
        let _ = writeln!(text, "[pass.p{index}]\nkind = \"n{}1{}\"", draft.inputs.len(), u8::from(draft.both.is_some()));
        for (i, &input) in draft.inputs.iter().enumerate() {
            let _ = writeln!(text, "in.in{i} = {}", wire(input));
        }
        for (name, end) in [("maybe0", draft.maybe), ("both0", draft.both)] {
            if let Some(end) = end {
                let _ = writeln!(text, "in.{name} = {}", wire(end));
            }
        }
        if draft.rounds > 1 {
            let _ = writeln!(text, "repeat = {}\nfeed.maybe0 = \"out\"", draft.rounds);
        }
    }
    text
}

/// Leaves out the passes whose bit is set; their first input stands in where they have one.
struct Bits(u64);

impl Needs for Bits {
    fn verdict(&self, node: &Node) -> Verdict {
        let index: u32 = node.pass[1..].parse().expect("passes are numbered");
        if self.0 >> (index % 64) & 1 == 0 {
            return Verdict::Run;
        }
        let stand_in = node.port_index("in0").map_or(StandIn::Zeros, |_| StandIn::Input("in0".into()));
        Verdict::LeaveOut { reason: "its bit is set".into(), stand_in: BTreeMap::from([("out".into(), stand_in)]) }
    }
}

/// Every input of this frame was written by an earlier step, told from the names alone.
fn assert_order(graph: &Graph, plan: &Plan) {
    let place: BTreeMap<&str, usize> = plan.steps.iter().enumerate().map(|(index, step)| (step.node.as_str(), index)).collect();
    for node in graph.nodes() {
        let Some(&then) = place.get(node.name.as_str()) else { continue };
        for wire in node.wires.iter().flatten().filter(|wire| wire.when == When::This) {
            let first = place[graph.nodes()[wire.from.node].name.as_str()];
            assert!(first < then, "{} runs before {}", node.name, graph.nodes()[wire.from.node].name);
        }
    }
}

/// At no step do two resources that are alive share a block.
fn assert_no_aliasing(plan: &Plan, size: [u32; 2]) {
    let blocks = plan.blocks(size);
    for step in 0..plan.steps.len() {
        let alive = plan
            .resources
            .iter()
            .zip(&blocks.of)
            .filter(|(resource, _)| matches!(resource.life, Life::Transient { first, last } if first <= step && step <= last));
        let mut taken = BTreeSet::new();
        for (resource, block) in alive {
            let block = block.expect("transients have a block");
            assert!(taken.insert(block), "{} shares block {block} at step {step}", resource.name);
            assert!(blocks.sizes[block] >= resource.bytes(size));
        }
    }
    assert!(blocks.total() <= blocks.unshared);
}

/// The memory of a frame, played through: every read finds what its wire names, whoever shares the buffer.
fn assert_reads_find_their_writers(plan: &Plan) {
    let blocks = plan.blocks([8, 8]);
    // The resource whose content each block holds.
    let mut content: BTreeMap<usize, usize> = BTreeMap::new();
    for step in &plan.steps {
        let ports = step.contract.ports.iter().zip(&step.bindings);
        let this: Vec<(Direction, usize)> = ports
            .filter_map(|(port, binding)| Some((port.direction, binding.resource.filter(|half| half.when == When::This)?.resource)))
            .collect();
        for &(direction, resource) in &this {
            if let Some(block) = blocks.of[resource]
                && direction != Direction::Out
                && !plan.resources[resource].clear
            {
                assert_eq!(content.get(&block), Some(&resource), "{} finds its content", step.node);
            }
        }
        for (_, resource) in this.into_iter().filter(|(direction, _)| *direction != Direction::In) {
            content.extend(blocks.of[resource].map(|block| (block, resource)));
        }
    }
}

/// What graph files are made of, and what they should not hold.
const WORDS: &[&str] = &[
    "[pass.shade]",
    "[pass.a]",
    "[slots]",
    "\n",
    "\n",
    "\n",
    "in.surface",
    "in.reservoir",
    "set.taps",
    "slots.domain",
    "kind",
    "repeat",
    "feed.current",
    " = ",
    " = ",
    " = ",
    "\"gbuffer.surface\"",
    "\"a.color@prev\"",
    "\"di\"",
    "\"shade\"",
    "3",
    "-1",
    "1e400",
    "nan",
    "false",
    "{",
    "}",
    "[",
    "]",
    "\t",
    "#",
    "\"",
    "\u{1b}[31m",
    "ü",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}") {
        if let Err(faults) = check(&text, &fake::Fakes) {
            prop_assert!(!faults.list.is_empty());
            prop_assert!(faults.to_string().contains("error["));
        }
    }

    #[test]
    fn words_of_graph_files_in_any_order_are_read_or_refused(words in prop::collection::vec(prop::sample::select(WORDS), 0..40)) {
        if let Err(faults) = check(&words.concat(), &fake::Fakes) {
            let shown = faults.to_string();
            prop_assert!(!shown.contains('\u{1b}'), "no control character reaches the terminal");
        }
    }

    #[test]
    fn any_edit_is_applied_or_refused_whole(edit in "[a-z.= \"0-9ü]{0,40}") {
        let mut document = Document::parse(Source::new("a.toml", "[pass.a]\nset.x = 1"), &Shelf::default()).expect("a good file");
        let before = document.clone();
        if let Err(faults) = document.apply([Source::new("--set", edit)]) {
            prop_assert_eq!(document, before);
            prop_assert!(!faults.list.is_empty());
        }
    }

    #[test]
    fn every_checked_graph_has_a_sound_plan(drafts in prop::collection::vec(draft(), 1..14)) {
        let text = graph_text(&drafts);
        // In-out ports may clash; then it is said, and there is no graph.
        if let Ok(graph) = check(&text, &Numbers) {
            let plan = graph.plan(&NeedsAll, &[]).expect("every checked graph has a plan");
            prop_assert_eq!(plan.verify(), Ok(()), "{}", text);
            prop_assert_eq!(plan.steps.len() + plan.left_out.len(), graph.nodes().len());
            assert_order(&graph, &plan);
            assert_no_aliasing(&plan, [640, 360]);
            assert_reads_find_their_writers(&plan);
            prop_assert_eq!(&plan, &graph.plan(&NeedsAll, &[]).expect("and the same one again"));
            let dot = graph.to_dot();
            prop_assert!(dot.starts_with("digraph"));
        }
    }

    #[test]
    fn graphs_without_in_place_writes_always_check(mut drafts in prop::collection::vec(draft(), 1..14)) {
        for draft in &mut drafts {
            draft.both = None;
        }
        let text = graph_text(&drafts);
        let graph = check(&text, &Numbers);
        prop_assert!(graph.is_ok(), "{}\n{}", text, graph.unwrap_err());
    }

    #[test]
    fn what_is_left_out_leaves_a_sound_plan_or_a_reason(drafts in prop::collection::vec(draft(), 2..14), bits in any::<u64>()) {
        let text = graph_text(&drafts);
        if let Ok(graph) = check(&text, &Numbers)
            && let Ok(plan) = graph.plan(&Bits(bits), &[])
        {
            prop_assert_eq!(plan.verify(), Ok(()), "{}", text);
            assert_no_aliasing(&plan, [640, 360]);
            assert_reads_find_their_writers(&plan);
            let left: BTreeSet<&str> = plan.left_out.iter().map(|left| left.node.as_str()).collect();
            prop_assert!(plan.steps.iter().all(|step| !left.contains(step.node.as_str())));
        }
    }
}

/// Every file extends one that was never seen before.
struct Endless;

impl Files for Endless {
    fn read(&self, path: &str, _: Option<&str>) -> Result<Source, ReadError> {
        Ok(Source::new(path, format!("extends = \"{path}x\"")))
    }
}

#[test]
fn extending_ends() {
    let faults = Document::load("x", &Endless).unwrap_err();
    assert_eq!(faults.list[0].cause.code(), "extends-too-deep");
    assert_eq!(faults.sources.iter().count(), MAX_FILES);
}
