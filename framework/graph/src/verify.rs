//! What every plan keeps, checked from the plan alone: a second look that shares no code with the planner.

use crate::{Direction, Life, Plan, Port, ResourceHalf, Step, When};

/// A plan contradicts itself.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum Inconsistent {
    /// The bindings of a step are not the ports of its contract.
    #[error("step `{step}` does not bind the ports of its contract one by one")]
    Ports {
        /// The step.
        step: String,
    },
    /// An index beyond the resources.
    #[error("`{port}` is bound to a resource that does not exist")]
    NoResource {
        /// The port, with its step.
        port: String,
    },
    /// A port that is written has nothing to write to.
    #[error("`{port}` is written and bound to nothing")]
    Unbound {
        /// The port, with its step.
        port: String,
    },
    /// A port is bound to something else than it takes.
    #[error("`{port}` takes something else than `{resource}` holds")]
    Type {
        /// The port, with its step.
        port: String,
        /// The resource.
        resource: String,
    },
    /// Read before anything wrote it this frame.
    #[error("`{port}` reads `{resource}` before it is written")]
    TooEarly {
        /// The port, with its step.
        port: String,
        /// The resource.
        resource: String,
    },
    /// One step reads and writes one memory through two ports.
    #[error("step `{step}` binds `{resource}` twice and writes it")]
    Shared {
        /// The step.
        step: String,
        /// The resource.
        resource: String,
    },
    /// A resource is touched outside of its life.
    #[error("`{resource}` is used by step `{step}`, outside of its life")]
    Life {
        /// The resource.
        resource: String,
        /// The step.
        step: String,
    },
    /// What is read back does not live to the end of the frame.
    #[error("`{resource}` is read back, and does not live to the end of the frame")]
    ReadBack {
        /// The resource.
        resource: String,
    },
}

impl Plan {
    /// Looks for contradictions: ports that are bound to nothing or to the wrong thing, reads before writes, use outside of a life.
    pub fn verify(&self) -> Result<(), Inconsistent> {
        let mut written = vec![false; self.resources.len()];
        for (index, step) in self.steps.iter().enumerate() {
            let ports: Vec<(&Port, Option<ResourceHalf>)> = ports(step)?;
            for (port, half) in &ports {
                self.verify_port(index, step, port, *half, &written)?;
            }
            self.verify_sharing(step, &ports)?;
            for (_, half) in ports.iter().filter(|(port, _)| port.direction != Direction::In) {
                if let Some(half) = half.filter(|half| half.when == When::This) {
                    written[half.resource] = true;
                }
            }
        }
        self.verify_read_back()
    }

    fn verify_port(
        &self,
        index: usize,
        step: &Step,
        port: &Port,
        half: Option<ResourceHalf>,
        written: &[bool],
    ) -> Result<(), Inconsistent> {
        let name = format!("{}.{}", step.node, port.name);
        let Some(half) = half else {
            let may_be = port.direction == Direction::In || step.contract.absent.contains_key(&port.name);
            return if may_be { Ok(()) } else { Err(Inconsistent::Unbound { port: name }) };
        };
        let Some(resource) = self.resources.get(half.resource) else { return Err(Inconsistent::NoResource { port: name }) };
        if resource.ty != port.ty {
            return Err(Inconsistent::Type { port: name, resource: resource.name.clone() });
        }
        let reads = port.direction != Direction::Out && half.when == When::This;
        if reads && !written[half.resource] && !resource.clear {
            return Err(Inconsistent::TooEarly { port: name, resource: resource.name.clone() });
        }
        let lives = match (resource.life, half.when) {
            (Life::Transient { first, last }, When::This) => (first..=last).contains(&index),
            (Life::Output, When::This) | (Life::History, _) => true,
            (Life::Transient { .. } | Life::Output, When::Previous) => false,
        };
        if lives { Ok(()) } else { Err(Inconsistent::Life { resource: resource.name.clone(), step: step.node.clone() }) }
    }

    fn verify_sharing(&self, step: &Step, ports: &[(&Port, Option<ResourceHalf>)]) -> Result<(), Inconsistent> {
        for (index, (port, half)) in ports.iter().enumerate() {
            let clash = |(other, other_half): &(&Port, Option<ResourceHalf>)| {
                half.is_some() && other_half == half && [port.direction, other.direction] != [Direction::In; 2]
            };
            if let Some(half) = half.filter(|_| ports[index + 1..].iter().any(clash)) {
                return Err(Inconsistent::Shared { step: step.node.clone(), resource: self.resources[half.resource].name.clone() });
            }
        }
        Ok(())
    }

    fn verify_read_back(&self) -> Result<(), Inconsistent> {
        let kept = self.kept.iter().filter_map(|kept| kept.resource.map(|half| half.resource));
        for index in kept.chain([self.output]) {
            let resource = self.resources.get(index).ok_or_else(|| Inconsistent::NoResource { port: "output".to_owned() })?;
            if let Life::Transient { .. } = resource.life {
                return Err(Inconsistent::ReadBack { resource: resource.name.clone() });
            }
        }
        Ok(())
    }
}

fn ports(step: &Step) -> Result<Vec<(&Port, Option<ResourceHalf>)>, Inconsistent> {
    let names = step.bindings.iter().map(|binding| &binding.port);
    if !names.eq(step.contract.ports.iter().map(|port| &port.name)) {
        return Err(Inconsistent::Ports { step: step.node.clone() });
    }
    Ok(step.contract.ports.iter().zip(step.bindings.iter().map(|binding| binding.resource)).collect())
}
