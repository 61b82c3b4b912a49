//! Why a shader does not compose.

/// One variant per cause. Paths are module paths (`pass/temporal`), which are file paths without `.wgsl`.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum ShaderError {
    /// The library holds no module of that path.
    #[error("no shader module `{path}`{}", near(nearest))]
    NoModule {
        /// As asked.
        path: String,
        /// The most similar path there is.
        nearest: Option<String>,
    },
    /// A module imports a slot that the specialisation does not fill.
    #[error("slot `{slot}`, imported by {by}, is not filled")]
    UnfilledSlot {
        /// The slot.
        slot: String,
        /// The module that imports it.
        by: String,
    },
    /// A text that is no shader: the linker, naga or the host refuses it.
    #[error("{place}: {message}{excerpt}")]
    Invalid {
        /// `pass/temporal.wgsl:12:5 in combine`, or the file alone.
        place: String,
        /// What is wrong, and the cure where there is one.
        message: String,
        /// The line, with a caret, each on a line of its own; empty without a line.
        excerpt: String,
    },
    /// Two modules declare an `override` of the same name, which a graph file could not tell apart.
    #[error("override `{name}` is declared in both {first} and {second}")]
    OverrideTwice {
        /// The name.
        name: String,
        /// One module.
        first: String,
        /// The other.
        second: String,
    },
    /// A file or folder cannot be read.
    #[error("{path}: {why}")]
    Read {
        /// The file.
        path: String,
        /// The system's words.
        why: String,
    },
    /// A folder whose shaders nobody would look for.
    #[error("{folder}: {why}")]
    NoShaders {
        /// The folder.
        folder: String,
        /// What is wrong and what would do.
        why: String,
    },
}

fn near(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
