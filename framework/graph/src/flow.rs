//! Who reads what, who rewrites it, and what must therefore come first.
//!
//! A *version* is what one port left behind, this frame or last frame. An in-out port rewrites the version that it is wired to and makes
//! a new one in the same memory, so the readers of the old version come before it. Last frame's half is the exception: it is rewritten
//! before all of its readers, which therefore see the new content whether they name it or not.

use crate::{
    Direction, Node, PortId, When, Wire,
    graph::{port_name, wire_name},
};
use petgraph::{
    algo::tarjan_scc,
    graph::{DiGraph, NodeIndex},
    visit::EdgeRef,
};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Where a version lives: the port whose memory it is, and the half.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Home {
    pub root: PortId,
    pub half: When,
}

/// Why a version lives nowhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Homeless {
    /// The history of what is history already.
    TwoFramesBack(PortId),
    /// In-out ports that only feed each other.
    NoOrigin(PortId),
}

/// The home of what a port leaves behind this frame.
pub(crate) fn home(nodes: &[Node], port: PortId) -> Result<Home, Homeless> {
    let mut halves = vec![];
    let mut at = port;
    let mut seen = BTreeSet::new();
    while let (Direction::InOut, Some(wire)) = (nodes[at.node].port(at.port).direction, nodes[at.node].wires[at.port]) {
        if !seen.insert(at) {
            return Err(Homeless::NoOrigin(port));
        }
        if wire.when == When::Previous {
            halves.push(wire.from);
        }
        at = wire.from;
    }
    match halves.as_slice() {
        [] => Ok(Home { root: at, half: When::This }),
        [_] => Ok(Home { root: at, half: When::Previous }),
        [later, ..] => Err(Homeless::TwoFramesBack(*later)),
    }
}

/// The home of what a wire brings.
pub(crate) fn home_of_wire(nodes: &[Node], wire: Wire) -> Result<Home, Homeless> {
    let home = home(nodes, wire.from)?;
    match (wire.when, home.half) {
        (When::This, _) => Ok(home),
        (When::Previous, When::This) => Ok(Home { half: When::Previous, ..home }),
        (When::Previous, When::Previous) => Err(Homeless::TwoFramesBack(wire.from)),
    }
}

/// One node must run before another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Link {
    pub first: usize,
    pub then: usize,
    pub why: Why,
}

/// Why one node must run before another. Ports are of the node that runs later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Why {
    /// It reads what the first one made.
    Reads { port: usize },
    /// It rewrites in place what the first one reads.
    Rewrites { port: usize },
    /// It reads last frame's half, which the first one rewrites.
    ReadsRewritten { port: usize },
}

/// Something that no order of the nodes can make right.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Hazard {
    /// A wire that brings nothing.
    Homeless { user: PortId, lost: Homeless },
    /// Two in-out ports on one version.
    TwoWriters { version: Wire, first: PortId, second: PortId },
    /// Last frame's content of a version that was rewritten since.
    StaleHistory { reader: PortId, writer: PortId },
    /// One node, one memory, two ports, one of them writing.
    SharedPorts { one: PortId, other: PortId },
    /// Nodes that wait for each other.
    Cycle(Vec<Link>),
}

/// Readers and rewriters of every version among the nodes that run.
pub(crate) struct Flow<'a> {
    nodes: &'a [Node],
    runs: &'a dyn Fn(usize) -> bool,
    /// Input ports by the version that they are wired to.
    users: BTreeMap<Wire, Vec<PortId>>,
}

impl<'a> Flow<'a> {
    pub(crate) fn new(nodes: &'a [Node], runs: &'a dyn Fn(usize) -> bool) -> Self {
        let mut users: BTreeMap<Wire, Vec<PortId>> = BTreeMap::new();
        for (user, wire) in wires(nodes).filter(|(user, _)| runs(user.node)) {
            users.entry(wire).or_default().push(user);
        }
        Flow { nodes, runs, users }
    }

    /// The in-out ports on a version.
    fn rewriters(&self, version: Wire) -> impl Iterator<Item = PortId> {
        let users = self.users.get(&version).map_or(&[][..], Vec::as_slice);
        users.iter().copied().filter(|&user| self.direction(user) == Direction::InOut)
    }

    /// The in-out port that rewrites a version first, if one does.
    pub(crate) fn rewriter(&self, version: Wire) -> Option<PortId> {
        self.rewriters(version).next()
    }

    /// The last in-out port of the chain that begins at a version.
    fn last_rewriter(&self, version: Wire) -> Option<PortId> {
        let mut last = self.rewriter(version)?;
        let mut seen = BTreeSet::from([last]);
        while let Some(next) = self.rewriter(Wire { from: last, when: When::This }) {
            if !seen.insert(next) {
                break;
            }
            last = next;
        }
        Some(last)
    }

    fn direction(&self, port: PortId) -> Direction {
        self.nodes[port.node].port(port.port).direction
    }

    /// The node whose rewriting of last frame's half a wire's reader sees.
    pub(crate) fn rewriter_of_history(&self, reader: PortId, wire: Wire) -> Option<PortId> {
        let last = (wire.when == When::Previous).then(|| self.last_rewriter(wire)).flatten()?;
        (self.direction(reader) == Direction::In).then_some(last)
    }

    /// Everything that orders the nodes.
    pub(crate) fn links(&self) -> Vec<Link> {
        let mut links = Vec::new();
        for (&version, users) in &self.users {
            for &user in users {
                self.links_of(version, user, &mut links);
            }
        }
        links.retain(|link| (self.runs)(link.first) && (self.runs)(link.then));
        links.sort_unstable();
        links
    }

    fn links_of(&self, version: Wire, user: PortId, links: &mut Vec<Link>) {
        if version.when == When::This {
            links.push(Link { first: version.from.node, then: user.node, why: Why::Reads { port: user.port } });
        }
        if self.direction(user) != Direction::In {
            return;
        }
        let rewriter = match version.when {
            When::This => self.rewriter(version),
            When::Previous => self.last_rewriter(version),
        };
        // A node that does both is a fault of its own, not a cycle.
        let Some(rewriter) = rewriter.filter(|rewriter| rewriter.node != user.node) else { return };
        links.push(match version.when {
            When::This => Link { first: user.node, then: rewriter.node, why: Why::Rewrites { port: rewriter.port } },
            When::Previous => Link { first: rewriter.node, then: user.node, why: Why::ReadsRewritten { port: user.port } },
        });
    }

    /// Everything that is wrong, whatever the order.
    pub(crate) fn hazards(&self) -> Vec<Hazard> {
        let mut hazards: Vec<Hazard> = self.homeless().collect();
        hazards.extend(self.two_writers());
        hazards.extend(self.stale_histories());
        hazards.extend(self.shared_ports());
        hazards.extend(cycles(self.nodes.len(), &self.links()).into_iter().map(Hazard::Cycle));
        hazards
    }

    /// Each lost version once, at the wire that loses it.
    fn homeless(&self) -> impl Iterator<Item = Hazard> {
        self.uses().filter_map(|(user, wire)| {
            let lost = match home(self.nodes, wire.from) {
                Ok(_) => home_of_wire(self.nodes, wire).err()?,
                Err(Homeless::NoOrigin(_)) if self.closes_a_loop(user) => Homeless::NoOrigin(user),
                Err(_) => return None,
            };
            Some(Hazard::Homeless { user, lost })
        })
    }

    /// The port is the first of a ring of in-out ports that passes through last frame (without that it is a cycle, and reported as one).
    fn closes_a_loop(&self, port: PortId) -> bool {
        let (mut at, mut through_history) = (port, false);
        for _ in 0..self.users.len() + 1 {
            let Some(wire) = self.nodes[at.node].wires[at.port].filter(|_| self.direction(at) == Direction::InOut) else { return false };
            through_history |= wire.when == When::Previous;
            at = wire.from;
            if at <= port {
                return at == port && through_history;
            }
        }
        false
    }

    fn two_writers(&self) -> impl Iterator<Item = Hazard> {
        self.users.keys().filter_map(|&version| {
            let mut rewriters = self.rewriters(version);
            let (first, second) = (rewriters.next()?, rewriters.next()?);
            Some(Hazard::TwoWriters { version, first, second })
        })
    }

    fn stale_histories(&self) -> impl Iterator<Item = Hazard> {
        self.uses().filter(|(_, wire)| wire.when == When::Previous).filter_map(|(reader, wire)| {
            let writer = self.rewriter(Wire { when: When::This, ..wire })?;
            Some(Hazard::StaleHistory { reader, writer })
        })
    }

    fn shared_ports(&self) -> Vec<Hazard> {
        let mut hazards = Vec::new();
        for node in (0..self.nodes.len()).filter(|&node| (self.runs)(node)) {
            let mut seen: BTreeMap<Home, PortId> = BTreeMap::new();
            for port in (0..self.nodes[node].wires.len()).map(|port| PortId { node, port }) {
                let Some(home) = self.home_of_port(port) else { continue };
                match seen.get(&home) {
                    // A port wired to its own node is a cycle, and reported as one.
                    Some(&one) if [one, port].into_iter().any(|port| self.waits_for_itself(port)) => {}
                    Some(&one) if [one, port].into_iter().any(|port| self.direction(port) != Direction::In) => {
                        hazards.push(Hazard::SharedPorts { one, other: port });
                    }
                    _ => {
                        seen.insert(home, port);
                    }
                }
            }
        }
        hazards
    }

    fn waits_for_itself(&self, port: PortId) -> bool {
        self.nodes[port.node].wires[port.port].is_some_and(|wire| wire.from.node == port.node && wire.when == When::This)
    }

    /// The memory that a port touches.
    fn home_of_port(&self, port: PortId) -> Option<Home> {
        match (self.direction(port), self.nodes[port.node].wires[port.port]) {
            (Direction::In, wire) => home_of_wire(self.nodes, wire?).ok(),
            (Direction::Out | Direction::InOut, _) => home(self.nodes, port).ok(),
        }
    }

    /// Every wire with the port that it feeds.
    fn uses(&self) -> impl Iterator<Item = (PortId, Wire)> {
        wires(self.nodes).filter(|(user, _)| (self.runs)(user.node))
    }
}

/// Every wire with the port that it feeds.
pub(crate) fn wires(nodes: &[Node]) -> impl Iterator<Item = (PortId, Wire)> {
    nodes
        .iter()
        .enumerate()
        .flat_map(|(node, of)| of.wires.iter().enumerate().filter_map(move |(port, wire)| Some((PortId { node, port }, (*wire)?))))
}

/// For every knot of nodes that wait for each other, the shortest way round from its first node.
fn cycles(count: usize, links: &[Link]) -> Vec<Vec<Link>> {
    let mut graph = DiGraph::<(), Link>::new();
    let indices: Vec<NodeIndex> = (0..count).map(|_| graph.add_node(())).collect();
    for link in links {
        graph.add_edge(indices[link.first], indices[link.then], *link);
    }
    let mut found: Vec<Vec<Link>> =
        tarjan_scc(&graph).into_iter().filter_map(|knot| shortest_cycle(&graph, knot.into_iter().min()?)).collect();
    found.sort();
    found
}

/// The shortest way from a node back to itself.
fn shortest_cycle(graph: &DiGraph<(), Link>, start: NodeIndex) -> Option<Vec<Link>> {
    let mut came_by: BTreeMap<NodeIndex, Link> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(at) = queue.pop_front() {
        // petgraph lists the newest edge first.
        let mut edges: Vec<_> = graph.edges(at).map(|edge| (edge.target(), *edge.weight())).collect();
        edges.sort_by_key(|(_, link)| *link);
        for (target, link) in edges {
            if target == start {
                return Some(way_back(link, start, &came_by));
            }
            if let std::collections::btree_map::Entry::Vacant(vacant) = came_by.entry(target) {
                vacant.insert(link);
                queue.push_back(target);
            }
        }
    }
    None
}

fn way_back(last: Link, start: NodeIndex, came_by: &BTreeMap<NodeIndex, Link>) -> Vec<Link> {
    let mut way = vec![last];
    let mut at = last.first;
    while at != start.index() {
        let link = came_by[&NodeIndex::new(at)];
        way.push(link);
        at = link.first;
    }
    way.reverse();
    way
}

impl Hazard {
    /// In words, for people who did not write the wires at fault.
    pub(crate) fn describe(&self, nodes: &[Node]) -> String {
        match self {
            Hazard::Homeless { user, .. } => format!("`{}` would have to read two frames back", port_name(nodes, *user)),
            Hazard::TwoWriters { version, first, second } => {
                format!(
                    "`{}` and `{}` would both rewrite `{}`",
                    nodes[first.node].name,
                    nodes[second.node].name,
                    wire_name(nodes, *version)
                )
            }
            Hazard::StaleHistory { reader, writer } => {
                format!("`{}` would read what `{}` rewrote since", port_name(nodes, *reader), nodes[writer.node].name)
            }
            Hazard::SharedPorts { one, other } => {
                format!("`{}` and `{}` would be one memory, read and written at once", port_name(nodes, *one), port_name(nodes, *other))
            }
            Hazard::Cycle(links) => {
                let chain: Vec<&str> = links.iter().map(|link| nodes[link.first].name.as_str()).collect();
                format!("passes would wait for each other: {}", chain.join(" → "))
            }
        }
    }
}
