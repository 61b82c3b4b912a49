//! Every kind of pass, with its contract.

use crate::{KernelPass, Pass, PassError, PassKind, contract::contract};
use aquifer_graph::{Contract, ContractError, Contracts, Needs, Node, Slots, Step, Verdict};
use aquifer_scene::Features;
use aquifer_shader::{Composed, Cut, Library, PASSES, Piece, ShaderError, Specialisation};
use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    sync::{Arc, Mutex, PoisonError},
};

/// Kinds of passes: an explicit list, then every file of the library's folder `pass`. Shaders are composed once for each filling of slots.
///
/// A pass has the same contract in every scene. What of it a scene does not need is said there too: its text is cut by `@if`, the ports that go with it
/// are [absent](Contract::absent), and as [`Needs`] the registry lets passes go that would make nothing.
#[derive(Debug)]
pub struct Registry {
    library: Arc<Library>,
    kinds: Vec<PassKind>,
    /// What holds of the scene.
    facts: BTreeSet<String>,
    /// What shaders are composed for: the facts, or more to leave less out.
    features: BTreeSet<String>,
    /// Every slot with its fillings, and what fills it when nothing is said.
    slots: BTreeMap<String, Vec<String>>,
    defaults: Slots,
    composed: Mutex<HashMap<Specialisation, Arc<Known>>>,
}

/// A composed shader and the contract that follows from it.
#[derive(Debug)]
pub struct Known {
    /// The shader.
    pub composed: Composed,
    /// What the graph knows of it.
    pub contract: Contract,
}

impl Registry {
    /// Kinds with host code of their own, over the library's files; `facts` are those of the scene that shaders are cut to.
    pub fn new(library: Arc<Library>, kinds: &[PassKind], facts: BTreeSet<String>) -> Self {
        let (slots, defaults) = (library.slots(), library.default_slots());
        Registry { library, kinds: kinds.to_vec(), features: facts.clone(), facts, slots, defaults, composed: Mutex::default() }
    }

    /// Cuts shaders to these features instead, be they facts of the scene or not.
    pub fn keeping(self, features: &Features) -> Self {
        Registry { features: owned(features), ..self }
    }

    /// The library.
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// The kind of that name, a bare kernel if it is only a file.
    pub(crate) fn kind(&self, name: &str) -> Result<Kind, ContractError> {
        if let Some(kind) = self.kinds.iter().find(|kind| kind.name == name) {
            return Ok(Kind { shader: kind.shader.to_owned(), about: kind.about, build: kind.build });
        }
        let shader = format!("{PASSES}/{name}");
        match self.library.text(&shader) {
            Some(_) => Ok(Kind { shader, about: "", build: KernelPass::build }),
            None => Err(ContractError::UnknownKind { kind: name.to_owned(), known: self.kinds() }),
        }
    }

    /// The shader of a kind, its slots filled, and its contract.
    ///
    /// # Errors
    /// See [`ContractError`].
    pub fn known(&self, name: &str, slots: &Slots) -> Result<Arc<Known>, ContractError> {
        let kind = self.kind(name)?;
        self.check_fillings(slots)?;
        let mut filled = self.defaults.clone();
        filled.extend(slots.clone());
        let what = Specialisation { entry: kind.shader.clone(), slots: filled, features: self.features.clone() };
        let memo = || self.composed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = memo().get(&what) {
            return Ok(known.clone());
        }
        let composed = self.library.compose(&what).map_err(|error| self.refused(name, error))?;
        let read = |composed: &Composed| {
            contract(&composed.interface, &self.facts).map_err(|wrong| {
                let module = wrong.module.as_deref().unwrap_or(&kind.shader);
                self.refused(name, self.library.fault(module, &wrong.name, wrong.tag.as_deref(), wrong.message))
            })
        };
        let mut contract = read(&composed)?;
        if composed.cuts.iter().any(is_port) {
            let here = std::mem::take(&mut contract);
            let whole = Specialisation { features: owned(&Features::ALL), ..what.clone() };
            contract = read(&self.library.compose(&whole).map_err(|error| self.refused(name, error))?)?;
            contract.absent = absent(&contract, &here, &composed.cuts);
        }
        if !kind.about.is_empty() {
            contract.about = kind.about.to_owned();
        }
        let known = Arc::new(Known { composed, contract });
        memo().insert(what, known.clone());
        Ok(known)
    }

    fn check_fillings(&self, slots: &Slots) -> Result<(), ContractError> {
        for (slot, filling) in slots {
            // A filling with a `/` is a module path of its own.
            let known = match self.slots.get(slot) {
                _ if filling.contains('/') => self.library.paths().map(str::to_owned).collect(),
                Some(known) => known.clone(),
                None => continue,
            };
            if !known.contains(filling) {
                return Err(ContractError::UnknownFilling { slot: slot.clone(), filling: filling.clone(), known });
            }
        }
        Ok(())
    }

    fn refused(&self, kind: &str, error: ShaderError) -> ContractError {
        match error {
            ShaderError::UnfilledSlot { slot, .. } => {
                let known = self.slots.get(&slot).cloned().unwrap_or_default();
                ContractError::UnfilledSlot { kind: kind.to_owned(), slot, known }
            }
            other => ContractError::Shader(other.to_string()),
        }
    }
}

fn owned(features: &Features) -> BTreeSet<String> {
    features.names().into_iter().map(str::to_owned).collect()
}

fn is_port(cut: &Cut) -> bool {
    matches!(cut.piece, Piece::Binding { group: 1, .. })
}

/// Ports of `whole` that are not `here`, each with what the scene lacks: what the port's own `@if` asks for, or those of the ports that went with it.
fn absent(whole: &Contract, here: &Contract, cuts: &[Cut]) -> BTreeMap<String, String> {
    let gone = whole.ports.iter().filter(|port| here.ports.iter().all(|other| other.name != port.name));
    let reason = |name: &str| {
        let own = |cut: &&Cut| matches!(&cut.piece, Piece::Binding { name: bound, .. } if bound == name);
        let ports = || cuts.iter().filter(|cut| is_port(cut));
        let facts: BTreeSet<&str> = match ports().find(own) {
            Some(cut) => cut.facts().collect(),
            None => ports().flat_map(Cut::facts).collect(),
        };
        lacks(facts)
    };
    gone.map(|port| (port.name.clone(), reason(&port.name))).collect()
}

/// As people read it.
fn lacks<'a>(facts: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = facts.into_iter().map(|fact| fact.replace('_', " ")).collect();
    format!("the scene has no {}", names.join(", no "))
}

impl Needs for Registry {
    fn verdict(&self, node: &Node) -> Verdict {
        let needs = &node.contract.needs;
        if needs.is_empty() || needs.iter().any(|fact| self.features.contains(fact)) {
            return Verdict::Run;
        }
        Verdict::LeaveOut { reason: lacks(needs.iter().map(String::as_str)), stand_in: BTreeMap::new() }
    }
}

/// A kind, wherever it came from.
pub(crate) struct Kind {
    pub shader: String,
    pub about: &'static str,
    pub build: fn(&Step) -> Result<Box<dyn Pass>, PassError>,
}

impl Contracts for Registry {
    fn kinds(&self) -> Vec<String> {
        let listed = self.kinds.iter().map(|kind| kind.name.to_owned());
        let all: BTreeSet<String> = listed.chain(self.library.modules(PASSES)).collect();
        all.into_iter().collect()
    }

    fn slots(&self) -> BTreeMap<String, Vec<String>> {
        self.slots.clone()
    }

    fn contract(&self, kind: &str, slots: &Slots) -> Result<Contract, ContractError> {
        Ok(self.known(kind, slots)?.contract.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_contradicts_itself_is_told_with_its_line() {
        let refused = |tag: &str| {
            let text = format!(
                "struct Params {{\n    /// Width.\n    /// {tag}\n    /// @range 0 8\n    width: f32,\n}}\n\
                 @group(1) @binding(0) var<uniform> params: Params;\n/// @extent rows\n\
                 @group(1) @binding(1) var<storage, read_write> image: array<f32>;\n\
                 @compute @workgroup_size(8, 8) fn main() {{ image[0] = params.width; }}\n"
            );
            let mut library = Library::new();
            library.insert("pass/x", text, "mine/pass/x.wgsl");
            Registry::new(Arc::new(library), &[], BTreeSet::new()).known("x", &Slots::new()).unwrap_err().to_string()
        };
        let outside = refused("@default 99");
        assert!(outside.starts_with("mine/pass/x.wgsl:3:5: parameter `width` begins as 99"), "{outside}");
        assert!(outside.ends_with("\n  |     /// @default 99\n  |     ^"), "{outside}");
        let misspelt = refused("@defalt 1");
        assert!(misspelt.starts_with("mine/pass/x.wgsl:3:5: a parameter has no tag `@defalt`"), "{misspelt}");
        let extent = refused("@default 1");
        assert!(extent.starts_with("mine/pass/x.wgsl:8:1: `@extent rows`"), "{extent}");
    }
}
