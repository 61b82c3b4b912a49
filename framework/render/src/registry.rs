//! Every kind of pass, with its contract.

use crate::{KernelPass, Pass, PassError, PassKind, contract::contract};
use aquifer_graph::{Contract, ContractError, Contracts, Slots, Step};
use aquifer_shader::{Composed, Library, ShaderError, Specialisation};
use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    sync::{Arc, Mutex, PoisonError},
};

/// The folder of the library whose files are kinds by themselves.
const FOLDER: &str = "pass";

/// Kinds of passes: an explicit list, then every file of the library's folder `pass`. Shaders are composed once for each filling of slots.
#[derive(Debug)]
pub struct Registry {
    library: Arc<Library>,
    kinds: Vec<PassKind>,
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
    /// Kinds with host code of their own, over the library's files; `features` are the facts of the scene that shaders are specialised for.
    pub fn new(library: Arc<Library>, kinds: &[PassKind], features: BTreeSet<String>) -> Self {
        let (slots, defaults) = (library.slots(), library.default_slots());
        Registry { library, kinds: kinds.to_vec(), features, slots, defaults, composed: Mutex::default() }
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
        let shader = format!("{FOLDER}/{name}");
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
        let mut contract =
            contract(&composed.interface).map_err(|message| ContractError::Shader(format!("{}.wgsl: {message}", kind.shader)))?;
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

/// A kind, wherever it came from.
pub(crate) struct Kind {
    pub shader: String,
    pub about: &'static str,
    pub build: fn(&Step) -> Result<Box<dyn Pass>, PassError>,
}

impl Contracts for Registry {
    fn kinds(&self) -> Vec<String> {
        let listed = self.kinds.iter().map(|kind| kind.name.to_owned());
        let all: BTreeSet<String> = listed.chain(self.library.modules(FOLDER)).collect();
        all.into_iter().collect()
    }

    fn slots(&self) -> BTreeMap<String, Vec<String>> {
        self.slots.clone()
    }

    fn contract(&self, kind: &str, slots: &Slots) -> Result<Contract, ContractError> {
        Ok(self.known(kind, slots)?.contract.clone())
    }
}
