//! Passes and ports that a scene does not need, and the wires round the gaps that they leave.

use super::PlanError;
use crate::{Direction, LeftOut, Needs, Node, PortId, StandIn, Verdict, When, Wire, flow::Flow};
use std::collections::{BTreeMap, BTreeSet};

/// Nodes with the gaps closed.
pub(super) struct Left {
    pub nodes: Vec<Node>,
    pub runs: Vec<bool>,
    /// What must be made; `None` where zeros stand in.
    pub goals: Vec<Option<Wire>>,
    pub left_out: Vec<LeftOut>,
    /// A wire that would have to read two frames back.
    too_far_back: Option<String>,
}

/// Takes out every port that is not there and every node that need not run, one after the other.
pub(super) fn leave_out(nodes: Vec<Node>, goals: &[PortId], needs: &dyn Needs) -> Result<Left, PlanError> {
    let goals = goals.iter().map(|&from| Some(Wire { from, when: When::This })).collect();
    let runs = vec![true; nodes.len()];
    let mut left = Left { nodes, runs, goals, left_out: Vec::new(), too_far_back: None };
    for node in 0..left.nodes.len() {
        left.take_out_ports(node)?;
        if let Verdict::LeaveOut { reason, stand_in } = needs.verdict(&left.nodes[node]) {
            left.take_out(node, &stand_in)?;
            left.left_out.push(LeftOut { node: left.nodes[node].name.clone(), port: None, reason });
        }
    }
    Ok(left)
}

impl Left {
    fn take_out(&mut self, node: usize, stand_in: &BTreeMap<String, StandIn>) -> Result<(), PlanError> {
        self.runs[node] = false;
        let ports = 0..self.nodes[node].contract.ports.len();
        let stands_in: Vec<Option<Wire>> = ports.map(|port| self.stand_in(node, port, stand_in)).collect::<Result<_, _>>()?;
        stands_in.into_iter().enumerate().for_each(|(port, wire)| self.bypass(PortId { node, port }, wire));
        Ok(())
    }

    /// The ports that a pass does without in this scene: what it would write is zeros, and what it would read is not asked for.
    fn take_out_ports(&mut self, node: usize) -> Result<(), PlanError> {
        let absent = self.nodes[node].contract.absent.clone();
        for (name, reason) in absent {
            let Some(port) = self.nodes[node].port_index(&name) else { continue };
            let wire = self.stand_in(node, port, &BTreeMap::new())?;
            self.bypass(PortId { node, port }, wire);
            self.nodes[node].wires[port] = None;
            self.left_out.push(LeftOut { node: self.nodes[node].name.clone(), port: Some(name), reason });
        }
        Ok(())
    }

    /// Readers of a port that is gone get what stands in for it.
    fn bypass(&mut self, gone: PortId, stands_in: Option<Wire>) {
        let mut too_far = None;
        for (index, reader) in self.nodes.iter_mut().enumerate() {
            for port in 0..reader.wires.len() {
                if let Some(wire) = reader.wires[port].filter(|wire| wire.from == gone) {
                    reader.wires[port] = follow(wire, stands_in).unwrap_or_else(|| {
                        too_far.get_or_insert(PortId { node: index, port });
                        None
                    });
                }
            }
        }
        for wire in self.goals.iter_mut().filter(|goal| goal.is_some_and(|wire| wire.from == gone)) {
            *wire = wire.and_then(|wire| follow(wire, stands_in).flatten());
        }
        if let Some(port) = too_far {
            self.too_far_back.get_or_insert(format!("`{}` would have to read two frames back", crate::graph::port_name(&self.nodes, port)));
        }
    }

    /// What the readers of a port get instead.
    fn stand_in(&self, node: usize, port: usize, stand_in: &BTreeMap<String, StandIn>) -> Result<Option<Wire>, PlanError> {
        let of = &self.nodes[node];
        let elsewhere = |wire: Option<Wire>| wire.filter(|wire| wire.from.node != node);
        match (of.port(port).direction, stand_in.get(&of.port(port).name)) {
            (Direction::In, _) | (Direction::Out, None | Some(StandIn::Zeros)) => Ok(None),
            (Direction::InOut, _) => Ok(elsewhere(of.wires[port])),
            (Direction::Out, Some(StandIn::Input(input))) => {
                let same = |&index: &usize| of.port(index).direction != Direction::Out && of.port(index).ty == of.port(port).ty;
                let wrong = || PlanError::StandIn { node: of.name.clone(), port: of.port(port).name.clone(), input: input.clone() };
                let index = of.port_index(input).filter(same).ok_or_else(wrong)?;
                // A pass that would stand in for itself has nothing to hand on: its history stays empty.
                Ok(elsewhere(of.wires[index]))
            }
        }
    }

    /// With passes gone, what was two resources may be one; what the check forbids must not come back that way.
    pub(super) fn refuse_clash(&self, needed: &BTreeSet<usize>) -> Result<(), PlanError> {
        if self.left_out.is_empty() {
            return Ok(());
        }
        let runs = |node: usize| needed.contains(&node);
        let hazard = || Flow::new(&self.nodes, &runs).hazards().first().map(|hazard| hazard.describe(&self.nodes));
        let goal = || self.goals.iter().flatten().find_map(|goal| self.rewritten(*goal, &runs));
        match self.too_far_back.clone().or_else(hazard).or_else(goal) {
            None => Ok(()),
            Some(conflict) => {
                let name = |left: &LeftOut| left.port.iter().fold(left.node.clone(), |node, port| format!("{node}.{port}"));
                let nodes = self.left_out.iter().map(|left| format!("`{}` ({})", name(left), left.reason)).collect();
                Err(PlanError::Clash { nodes, conflict })
            }
        }
    }

    fn rewritten(&self, goal: Wire, runs: &dyn Fn(usize) -> bool) -> Option<String> {
        let writer = Flow::new(&self.nodes, runs).rewriter(goal)?;
        Some(format!(
            "`{}` would rewrite `{}` before it is read back",
            self.nodes[writer.node].name,
            crate::graph::wire_name(&self.nodes, goal)
        ))
    }
}

/// A wire to a port that is gone, led on to what stands in: `None` when that lies two frames back.
fn follow(wire: Wire, stands_in: Option<Wire>) -> Option<Option<Wire>> {
    match (wire.when, stands_in) {
        (_, None) => Some(None),
        (When::This, Some(next)) => Some(Some(next)),
        (When::Previous, Some(next)) if next.when == When::This => Some(Some(Wire { when: When::Previous, ..next })),
        (When::Previous, Some(_)) => None,
    }
}
