//! All that the graph knows of a pass.

use serde::Serialize;
use std::collections::BTreeMap;

/// Which module fills which slot, e.g. `domain` → `di`.
pub type Slots = BTreeMap<String, String>;

/// What one kind of pass, with its slots filled, offers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Contract {
    /// First sentence of the manual page.
    pub about: String,
    /// In order of declaration.
    pub ports: Vec<Port>,
    /// In order of declaration.
    pub params: Vec<Param>,
    /// Slots that the pass reaches.
    pub slots: Vec<String>,
    /// What can bias the result.
    pub bias: Vec<Bias>,
    /// Facts of which the scene must have one for the pass to make anything; none: it makes something of every scene.
    pub needs: Vec<String>,
    /// Ports that the pass has only in other scenes, each with what this one lacks.
    pub absent: BTreeMap<String, String>,
    /// The light paths that the pass brings into the picture; `None` where it brings none.
    pub paths: Option<Paths>,
}

/// Light paths, counted in scatterings between camera and emitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Paths {
    /// Fewest scatterings.
    pub fewest: u32,
    /// Most; `None`: the pass takes fewest and most from the graph's transport too.
    pub most: Option<u32>,
}

impl std::str::FromStr for Paths {
    type Err = std::num::ParseIntError;

    /// `1`: that many; `2..`: from there on, within the graph's transport.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.trim().strip_suffix("..") {
            Some(fewest) => Ok(Paths { fewest: fewest.parse()?, most: None }),
            None => text.trim().parse().map(|count| Paths { fewest: count, most: Some(count) }),
        }
    }
}

/// A place for a wire.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Port {
    /// The name of the group-1 binding.
    pub name: String,
    /// From the shader's use.
    pub direction: Direction,
    /// What travels.
    pub ty: WireType,
    /// May stay unwired: it then reads zeros.
    pub optional: bool,
    /// From the shader's doc comment.
    pub doc: String,
}

/// Only read, only written, or both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Read.
    In,
    /// Written, every element.
    Out,
    /// Read and written in place: makes a new version.
    InOut,
}

/// What travels on a wire: two ports may be joined when `element` and `layout` agree.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct WireType {
    /// The element as people read it, slot fillings included: `Reservoir<di>`, `vec4<f32>`.
    pub element: String,
    /// Canonical member names, types and offsets.
    pub layout: String,
    /// Bytes from one element to the next.
    pub stride: u32,
    /// How many elements.
    pub extent: Extent,
}

/// How many elements a resource has.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// One a pixel.
    Pixels,
    /// One a tile of this many pixels across and down, edge tiles included.
    Tiles(u32, u32),
    /// A fixed number.
    Fixed(u32),
}

impl Extent {
    /// Elements for an image of `size` pixels.
    pub fn elements(&self, size: [u32; 2]) -> u64 {
        match *self {
            Extent::Pixels => u64::from(size[0]) * u64::from(size[1]),
            Extent::Tiles(w, h) => u64::from(size[0].div_ceil(w)) * u64::from(size[1].div_ceil(h)),
            Extent::Fixed(n) => u64::from(n),
        }
    }
}

/// A named value that a graph file may set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Param {
    /// The name of the `override`, or of the member of `Params`.
    pub name: String,
    /// What it holds when nothing is said.
    pub default: Value,
    /// Allowed values, both ends included.
    pub range: Option<(f64, f64)>,
    /// Named values of an integer, in order from 0, e.g. `["linear", "reinhard"]`.
    pub choices: Vec<String>,
    /// Changes without a new pipeline.
    pub live: bool,
    /// From the shader's doc comment.
    pub doc: String,
}

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// true or false.
    Bool(bool),
    /// A signed integer.
    I32(i32),
    /// An unsigned integer.
    U32(u32),
    /// A number.
    F32(f32),
}

/// Something that can bias the result, said beside its definition.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Bias {
    /// The slot whose filling brings it in, or `None` when the pass's own file does.
    pub slot: Option<String>,
    /// The parameter whose value brings it in (any value but `unless`), or `None` when the part biases whatever its parameters are.
    pub param: Option<String>,
    /// The value at which `param` does not bias, as it is written in a graph file.
    pub unless: Option<String>,
    /// The slot's filling with which it does not bias.
    pub unless_slot: Option<(String, String)>,
    /// Why.
    pub why: String,
    /// The fact that a scene must have for it; `None` where the scene has it, or where none is asked.
    pub given: Option<String>,
    /// A slot and the filling that is without it.
    pub without: Option<(String, String)>,
}

/// Why a kind of pass has no contract.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum ContractError {
    /// No such kind; `known` are all there are.
    #[error("no pass of kind `{kind}`")]
    UnknownKind {
        /// As asked.
        kind: String,
        /// For the nearest name.
        known: Vec<String>,
    },
    /// A slot names a module that does not exist.
    #[error("no module `{filling}` for slot `{slot}`")]
    UnknownFilling {
        /// The slot.
        slot: String,
        /// As asked.
        filling: String,
        /// For the nearest name.
        known: Vec<String>,
    },
    /// The pass reaches a slot that nothing fills.
    #[error("slot `{slot}` of kind `{kind}` is not filled")]
    UnfilledSlot {
        /// The kind of pass.
        kind: String,
        /// The slot.
        slot: String,
        /// What could fill it.
        known: Vec<String>,
    },
    /// The shader does not compose; the text is ready to be shown.
    #[error("{0}")]
    Shader(String),
}

/// Where contracts come from; implemented by the room that knows shaders.
pub trait Contracts {
    /// Every kind of pass, for the nearest name.
    fn kinds(&self) -> Vec<String>;
    /// Every slot with everything that can fill it.
    fn slots(&self) -> BTreeMap<String, Vec<String>>;
    /// The contract of one kind with these slots.
    fn contract(&self, kind: &str, slots: &Slots) -> Result<Contract, ContractError>;
}
