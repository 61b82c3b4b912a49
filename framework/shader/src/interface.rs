//! What a composed shader asks of its host, by name.

/// What reflection found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interface {
    /// The text above the first declaration of the entry file: its manual page (Markdown).
    pub manual: String,
    /// Entry points, in order of declaration.
    pub entries: Vec<Entry>,
    /// Bindings that some entry point reaches, in order of group and number.
    pub bindings: Vec<Binding>,
    /// `override`s that some entry point reaches.
    pub overrides: Vec<Override>,
    /// Slots reached, with the module path that fills each (`domain` → `domain/di`).
    pub slots: Vec<(String, String)>,
    /// `//! @needs` of the entry file: facts of which a scene must have one for the shader to make anything.
    pub needs: Vec<String>,
    /// `//! @paths` of every module reached: which light paths it brings into the picture, by scatterings.
    pub paths: Vec<String>,
    /// `//! bias:` lines of every module reached, less those of slots filled otherwise.
    pub bias: Vec<BiasNote>,
}

/// One entry point.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name in the text and in the naga module.
    pub name: String,
    /// Which stage.
    pub stage: Stage,
    /// Workgroup size as declared; an override-sized one is filled in by the pipeline.
    pub workgroup_size: [u32; 3],
    /// Indices into [`Interface::bindings`] that it reaches.
    pub bindings: Vec<usize>,
    /// What a fragment entry point gives, in order of declaration; builtins are not listed.
    pub outputs: Vec<Output>,
}

/// One value that a fragment entry point gives for its pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// Name of the member of the returned struct.
    pub name: String,
    /// Its `@location`.
    pub location: u32,
    /// Its type, e.g. `vec2<u32>`.
    pub ty: String,
}

/// Pipeline stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Compute.
    Compute,
    /// Vertex.
    Vertex,
    /// Fragment.
    Fragment,
}

/// One bound variable. Group 0 is the frame's and the scene's, bound by qualified name; group 1 is the pass's own: its ports and `params`.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// 0 or 1.
    pub group: u32,
    /// Number given by the composer: dense within the group.
    pub binding: u32,
    /// Name as declared, e.g. `reservoir`.
    pub name: String,
    /// Module path of the declaration, e.g. `scene/geometry`.
    pub module: String,
    /// What is bound.
    pub resource: ResourceKind,
    /// Read by some entry point.
    pub read: bool,
    /// Written by some entry point.
    pub written: bool,
    /// `///` text above the declaration, without its `@` lines.
    pub doc: String,
    /// `/// @name value` lines above the declaration, e.g. (`optional`, ``), (`extent`, `tiles 64 32`).
    pub tags: Vec<(String, String)>,
}

/// What a binding holds.
#[derive(Clone, Debug, PartialEq)]
pub enum ResourceKind {
    /// `var<uniform>`.
    Uniform {
        /// Its type.
        ty: Layout,
    },
    /// `var<storage>` of a runtime-sized array: `ty` is the element's.
    StorageArray {
        /// Element type.
        ty: Layout,
        /// Bytes from one element to the next.
        stride: u32,
        /// Declared `read_write`.
        writable: bool,
    },
    /// `var<storage>` of a sized type.
    Storage {
        /// Its type.
        ty: Layout,
        /// Declared `read_write`.
        writable: bool,
    },
    /// A sampled texture.
    Texture {
        /// As WGSL writes it, e.g. `texture_2d_array<f32>`.
        ty: String,
    },
    /// A sampler.
    Sampler,
}

/// A host-shareable type.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// As people read it, slot fillings included: `Reservoir<di>`, `vec4<f32>`.
    pub name: String,
    /// Bytes.
    pub size: u32,
    /// Alignment in bytes.
    pub align: u32,
    /// Members of a struct; empty for other types.
    pub members: Vec<Member>,
}

/// One member of a struct.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Bytes from the start of the struct.
    pub offset: u32,
    /// Its type.
    pub ty: Layout,
    /// `///` text above it, without its `@` lines.
    pub doc: String,
    /// `/// @default 0.5`, `/// @range 0 1`, `/// @choices linear reinhard`.
    pub tags: Vec<(String, String)>,
}

/// One `override`.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// Name as declared, unique within a composed shader.
    pub name: String,
    /// The key that the pipeline's constants take.
    pub key: String,
    /// Module path of the declaration.
    pub module: String,
    /// Scalar type.
    pub ty: Scalar,
    /// Initial value, where it is a literal.
    pub default: Option<f64>,
    /// `///` text, without its `@` lines.
    pub doc: String,
    /// `/// @range 1 64`, `/// @choices a b`, `/// @unbiased true`.
    pub tags: Vec<(String, String)>,
}

/// Scalar types of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// bool
    Bool,
    /// i32
    I32,
    /// u32
    U32,
    /// f32
    F32,
}

/// `//! bias (condition) [slot = filling]: why` of a module; a condition is a fact of the scene, or `slot = filling`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BiasNote {
    /// Module path.
    pub module: String,
    /// Why.
    pub why: String,
    /// The fact of the scene that it takes.
    pub given: Option<String>,
    /// A slot and the filling that is without this bias.
    pub without: Option<(String, String)>,
}

impl Layout {
    /// Canonical text of names, types and offsets: equal texts mean equal meaning of bytes.
    pub fn canonical(&self) -> String {
        if self.members.is_empty() {
            return self.name.clone();
        }
        let members: Vec<String> = self.members.iter().map(|m| format!("{}@{}:{}", m.name, m.offset, m.ty.canonical())).collect();
        format!("{}{{{}}}/{}", self.name, members.join(","), self.size)
    }
}
