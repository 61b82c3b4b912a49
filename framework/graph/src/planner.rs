//! From a [`Graph`] to a [`Plan`]: leave out, cull, order, allot.

mod leave_out;

use crate::{
    Binding, Direction, Graph, Kept, LeftOut, Life, Needs, Node, Plan, PortId, Resource, ResourceHalf, Step, When, Wire,
    flow::{Flow, Home, Link, home, home_of_wire},
    graph::port_name,
    nearest,
};
use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, BinaryHeap},
};

/// Why a checked graph has no plan.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum PlanError {
    /// A resource to be kept does not exist.
    #[error("there is no resource `{name}`{}", near.as_ref().map(|near| format!("; did you mean `{near}`?")).unwrap_or_default())]
    UnknownResource {
        /// As asked.
        name: String,
        /// The most likely name.
        near: Option<String>,
    },
    /// A resource to be kept is rewritten before the frame ends.
    #[error("`{name}` is rewritten in place by `{writer}` before the frame ends; keep `{instead}`")]
    Rewritten {
        /// As asked.
        name: String,
        /// The pass that rewrites it.
        writer: String,
        /// What can be kept.
        instead: String,
    },
    /// The pass that makes the output is left out, and no other resource stands in.
    #[error("pass `{node}` makes the output, but does not run: {reason}")]
    NoOutput {
        /// The pass.
        node: String,
        /// Why it does not run.
        reason: String,
    },
    /// A stand-in is no input of its pass, or holds something else than the output.
    #[error("`{input}` cannot stand in for `{node}.{port}`: it is no input that holds the same")]
    StandIn {
        /// The pass.
        node: String,
        /// The output.
        port: String,
        /// What should stand in.
        input: String,
    },
    /// Without the passes that are left out, the wires clash.
    #[error("without {} {conflict}", nodes.join(", "))]
    Clash {
        /// Passes left out, with the reasons.
        nodes: Vec<String>,
        /// What clashes.
        conflict: String,
    },
}

impl Graph {
    /// What to run for a scene. `keep` names resources (`pass.port`) that can be read back beside the output; their passes run too.
    pub fn plan(&self, needs: &dyn Needs, keep: &[&str]) -> Result<Plan, PlanError> {
        let kept = keep.iter().map(|name| self.find_port(name)).collect::<Result<Vec<PortId>, _>>()?;
        let mut goals = vec![self.output];
        goals.extend(&kept);
        let left = leave_out::leave_out(self.nodes.clone(), &goals, needs)?;
        let output = left.goals[0].filter(|wire| wire.when == When::This).ok_or_else(|| self.no_output(&left.left_out))?;
        let needed = reachable(&left.nodes, &left.goals, &left.runs);
        let allotter = Allotter::new(&left.nodes, &needed);
        left.refuse_clash(&needed)?;
        let mut plan = allotter.plan(self, output, &left.goals[1..], keep)?;
        plan.left_out = self.verdicts(&left.left_out, &needed);
        debug_assert_eq!(plan.verify(), Ok(()));
        Ok(plan)
    }

    /// The nodes that the output needs when every pass runs.
    pub(crate) fn needed(&self) -> BTreeSet<usize> {
        let output = Wire { from: self.output, when: When::This };
        reachable(&self.nodes, &[Some(output)], &vec![true; self.nodes.len()])
    }

    /// The port named `node.port`; the name of a repeated pass means its last round.
    fn find_port(&self, name: &str) -> Result<PortId, PlanError> {
        let find = |(node, port): (&str, &str)| {
            let index = self.nodes.iter().rposition(|known| known.name == node || known.pass == node)?;
            let port = self.nodes[index].port_index(port).filter(|&port| self.nodes[index].port(port).direction != Direction::In)?;
            Some(PortId { node: index, port })
        };
        let port = name.rsplit_once('.').and_then(find).ok_or_else(|| self.unknown_resource(name))?;
        let all = |_| true;
        match Flow::new(&self.nodes, &all).rewriter(Wire { from: port, when: When::This }) {
            None => Ok(port),
            Some(writer) => {
                let (writer, instead) = (self.nodes[writer.node].name.clone(), port_name(&self.nodes, writer));
                Err(PlanError::Rewritten { name: name.to_owned(), writer, instead })
            }
        }
    }

    fn unknown_resource(&self, name: &str) -> PlanError {
        let outputs = |node: &Node| -> Vec<String> {
            let ports = node.contract.ports.iter().filter(|port| port.direction != Direction::In);
            ports.map(|port| format!("{}.{}", node.pass, port.name)).collect()
        };
        let names: Vec<String> = self.nodes.iter().flat_map(outputs).collect();
        PlanError::UnknownResource { name: name.to_owned(), near: nearest(name, names.iter().map(String::as_str)).map(str::to_owned) }
    }

    fn no_output(&self, left_out: &[LeftOut]) -> PlanError {
        let node = &self.nodes[self.output.node].name;
        let reason = left_out.iter().find(|left| left.node == *node).map_or("no resource of this frame stands in", |left| &left.reason);
        PlanError::NoOutput { node: node.clone(), reason: reason.to_owned() }
    }

    /// Everything that does not run, in the order of the file; of what runs, the ports that it does without.
    fn verdicts(&self, left_out: &[LeftOut], needed: &BTreeSet<usize>) -> Vec<LeftOut> {
        let verdict = |(index, node): (usize, &Node)| -> Vec<LeftOut> {
            let of_node = |left: &&LeftOut| left.node == node.name;
            if let Some(told) = left_out.iter().filter(of_node).find(|left| left.port.is_none()) {
                return vec![told.clone()];
            }
            if !needed.contains(&index) {
                return vec![LeftOut { node: node.name.clone(), port: None, reason: CULLED.to_owned() }];
            }
            left_out.iter().filter(of_node).cloned().collect()
        };
        self.nodes.iter().enumerate().flat_map(verdict).collect()
    }
}

const CULLED: &str = "nothing that runs needs what it makes";

/// The nodes that the goals need, this frame or in frames to come.
fn reachable(nodes: &[Node], goals: &[Option<Wire>], runs: &[bool]) -> BTreeSet<usize> {
    let running = |node: usize| runs[node];
    let flow = Flow::new(nodes, &running);
    let mut needed = BTreeSet::new();
    let mut open: Vec<usize> = goals.iter().flatten().map(|wire| wire.from.node).collect();
    while let Some(node) = open.pop() {
        if !needed.insert(node) {
            continue;
        }
        for (port, wire) in nodes[node].wires.iter().enumerate() {
            let Some(wire) = *wire else { continue };
            open.push(wire.from.node);
            open.extend(flow.rewriter_of_history(PortId { node, port }, wire).map(|rewriter| rewriter.node));
        }
    }
    needed
}

/// The first possible order in which nearest to the order of the file comes first.
fn order(needed: &BTreeSet<usize>, links: &[Link]) -> Vec<usize> {
    let links: BTreeSet<(usize, usize)> = links.iter().map(|link| (link.first, link.then)).collect();
    let mut waits: BTreeMap<usize, usize> = needed.iter().map(|&node| (node, 0)).collect();
    for (_, then) in &links {
        waits.entry(*then).and_modify(|count| *count += 1);
    }
    let mut ready: BinaryHeap<Reverse<usize>> = waits.iter().filter(|(_, count)| **count == 0).map(|(node, _)| Reverse(*node)).collect();
    let mut order = Vec::with_capacity(needed.len());
    while let Some(Reverse(node)) = ready.pop() {
        order.push(node);
        for (_, then) in links.range((node, 0)..=(node, usize::MAX)) {
            if let Some(count) = waits.get_mut(then) {
                *count -= 1;
                if *count == 0 {
                    ready.push(Reverse(*then));
                }
            }
        }
    }
    order
}

/// Gives every port of every step its memory.
struct Allotter<'a> {
    nodes: &'a [Node],
    order: Vec<usize>,
    resources: Vec<Resource>,
    /// Resources by the port whose memory they are.
    by_root: BTreeMap<PortId, usize>,
}

impl<'a> Allotter<'a> {
    fn new(nodes: &'a [Node], needed: &BTreeSet<usize>) -> Self {
        let runs = |node: usize| needed.contains(&node);
        let order = order(needed, &Flow::new(nodes, &runs).links());
        Allotter { nodes, order, resources: Vec::new(), by_root: BTreeMap::new() }
    }

    fn plan(mut self, graph: &Graph, output: Wire, kept: &[Option<Wire>], names: &[&str]) -> Result<Plan, PlanError> {
        self.make_resources();
        let steps: Vec<Step> = self.order.iter().map(|&node| self.step(node)).collect();
        let output = self.half(output).ok_or_else(|| graph.no_output(&[]))?;
        let kept: Vec<Kept> = names
            .iter()
            .zip(kept)
            .map(|(name, wire)| Kept { name: (*name).to_owned(), resource: wire.and_then(|wire| self.half(wire)) })
            .collect();
        if output.when == When::Previous {
            return Err(graph.no_output(&[]));
        }
        let read_back: BTreeSet<ResourceHalf> = kept.iter().filter_map(|kept| kept.resource).chain([output]).collect();
        self.set_lives(&steps, &read_back);
        let (title, transport) = (graph.title.clone(), graph.transport);
        Ok(Plan { title, transport, steps, resources: self.resources, output: output.resource, kept, left_out: Vec::new() })
    }

    /// One resource for every out port, and for every in-out port that starts from nothing; in the order of their writers.
    fn make_resources(&mut self) {
        for &node in &self.order {
            for (index, port) in self.nodes[node].contract.ports.iter().enumerate() {
                if self.nodes[node].contract.absent.contains_key(&port.name) {
                    continue;
                }
                let clear = port.direction == Direction::InOut && self.nodes[node].wires[index].is_none();
                if port.direction == Direction::Out || clear {
                    let root = PortId { node, port: index };
                    self.by_root.insert(root, self.resources.len());
                    let life = Life::Transient { first: 0, last: 0 };
                    self.resources.push(Resource { name: port_name(self.nodes, root), ty: port.ty.clone(), life, clear });
                }
            }
        }
    }

    fn step(&self, index: usize) -> Step {
        let node = &self.nodes[index];
        Step {
            node: node.name.clone(),
            pass: node.pass.clone(),
            kind: node.kind.clone(),
            slots: node.slots.clone(),
            params: node.params.clone(),
            bindings: (0..node.contract.ports.len()).map(|port| self.binding(PortId { node: index, port })).collect(),
            contract: node.contract.clone(),
        }
    }

    fn binding(&self, port: PortId) -> Binding {
        let node = &self.nodes[port.node];
        let resource = match node.port(port.port).direction {
            Direction::In => node.wires[port.port].and_then(|wire| self.half(wire)),
            Direction::Out | Direction::InOut => self.half(Wire { from: port, when: When::This }),
        };
        Binding { port: node.port(port.port).name.clone(), resource }
    }

    fn half(&self, wire: Wire) -> Option<ResourceHalf> {
        let Home { root, half } = match wire.when {
            When::This => home(self.nodes, wire.from).ok()?,
            When::Previous => home_of_wire(self.nodes, wire).ok()?,
        };
        Some(ResourceHalf { resource: *self.by_root.get(&root)?, when: half })
    }

    fn set_lives(&mut self, steps: &[Step], read_back: &BTreeSet<ResourceHalf>) {
        for (index, resource) in self.resources.iter_mut().enumerate() {
            resource.life = life(index, steps, read_back);
        }
    }
}

fn life(resource: usize, steps: &[Step], read_back: &BTreeSet<ResourceHalf>) -> Life {
    let touches = |step: &Step, when: When| step.bindings.iter().any(|binding| binding.resource == Some(ResourceHalf { resource, when }));
    let has_history = |when| steps.iter().any(|step| touches(step, when)) || read_back.contains(&ResourceHalf { resource, when });
    if has_history(When::Previous) {
        return Life::History;
    }
    if read_back.contains(&ResourceHalf { resource, when: When::This }) {
        return Life::Output;
    }
    let mut touching = (0..steps.len()).filter(|&step| touches(&steps[step], When::This));
    let first = touching.next().unwrap_or_default();
    Life::Transient { first, last: touching.next_back().unwrap_or(first) }
}
