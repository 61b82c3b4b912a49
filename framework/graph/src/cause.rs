//! Every way in which a graph file can be wrong: one variant a cause, with the message it prints.

use crate::ReadError;

/// What is wrong. Names are as written in the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each field is named in the message above it")]
pub enum Cause {
    // Reading.
    /// The text is no TOML.
    #[error("{message}")]
    Syntax { message: String },
    /// A file cannot be read.
    #[error("{0}")]
    Read(ReadError),
    /// Files extend each other in a ring.
    #[error("`extends` goes round in a circle: {}", chain.join(" → "))]
    ExtendsLoop { chain: Vec<String> },
    /// More files build on each other than anyone needs.
    #[error("more than {most} files extend each other")]
    ExtendsTooDeep { most: usize },
    /// A key that means nothing there.
    #[error("{place} has no key `{key}`")]
    UnknownKey { key: String, place: String },
    /// A key that must be there.
    #[error("the graph has no `{key}`")]
    MissingKey { key: &'static str },
    /// A value of another type.
    #[error("{what} must be {expected}, not {found}")]
    WrongType { what: String, expected: String, found: String },
    /// A pass name that wires could not name.
    #[error("`{name}` is no name for a pass")]
    BadName { name: String },
    /// A wire's text does not follow its grammar.
    #[error("`{text}` names no output")]
    BadWire { text: String },
    /// An edit's text does not follow its grammar.
    #[error("`{text}` sets nothing")]
    BadEdit { text: String },
    /// A pass is removed and described at once.
    #[error("pass `{pass}` is removed here, so nothing else can be said of it")]
    RemovedAndSet { pass: String },

    // Naming.
    /// The transport's text.
    #[error("{0}")]
    BadTransport(crate::TransportError),
    /// Passes bring other light paths into the picture than the transport says.
    #[error("transport `{transport}` is {wanted}, and the passes make {made}")]
    OtherPaths { transport: String, wanted: String, made: String },
    /// A pass that is not in the graph.
    #[error("there is no pass `{pass}`")]
    UnknownPass { pass: String },
    /// A kind of pass that does not exist.
    #[error("there is no pass of kind `{kind}`")]
    UnknownKind { kind: String },
    /// A shader that does not compose.
    #[error("the shader of pass `{pass}` does not compose: {message}")]
    Shader { pass: String, message: String },
    /// A slot that no shader has.
    #[error("there is no slot `{slot}`")]
    UnknownSlot { slot: String },
    /// A module that cannot fill its slot.
    #[error("there is no module `{filling}` for slot `{slot}`")]
    UnknownFilling { slot: String, filling: String },
    /// A slot that a pass reaches and nothing fills.
    #[error("nothing fills slot `{slot}` of pass `{pass}`")]
    UnfilledSlot { slot: String, pass: String },
    /// A slot is filled and nobody asks for it.
    #[error("{} slot `{slot}`, so filling it does nothing", nobody(by.as_deref()))]
    UnusedSlot { slot: String, by: Option<String> },

    // Values.
    /// A parameter that the pass does not have.
    #[error("pass `{pass}` has no parameter `{param}`")]
    UnknownParam { pass: String, param: String },
    /// A parameter that the graph fills itself.
    #[error("parameter `{param}` is filled from the graph's transport")]
    ReservedParam { param: String },
    /// A number outside its limits.
    #[error("{what} must be from {least} to {most}, not {found}")]
    OutOfRange { what: String, least: String, most: String, found: String },
    /// A name that is not among a parameter's choices.
    #[error("`{choice}` is no choice of parameter `{param}`")]
    UnknownChoice { param: String, choice: String },
    /// Infinity, or not a number.
    #[error("parameter `{param}` must be a finite number, not {found}")]
    NotFinite { param: String, found: String },
    /// The budget's knob cannot be turned.
    #[error("`{knob}` is no knob: {reason}")]
    BadKnob { knob: String, reason: String },

    // Wires.
    /// A port that the pass does not have.
    #[error("pass `{pass}` has no {what} `{port}`")]
    UnknownPort { pass: String, port: String, what: &'static str },
    /// A wire into a port that is only written.
    #[error("`{pass}.{port}` is an output: nothing can be wired into it")]
    NotAnInput { pass: String, port: String },
    /// A wire from a port that is only read.
    #[error("`{pass}.{port}` is an input: nothing can be wired from it")]
    NotAnOutput { pass: String, port: String },
    /// A port that must be wired.
    #[error("input `{port}` of pass `{pass}` is not wired")]
    UnwiredInput { pass: String, port: String },
    /// The ends hold different things.
    #[error("`{from}` holds {given}, and `{to}` takes {taken}")]
    TypeMismatch { from: String, to: String, given: String, taken: String },
    /// The ends hold different numbers of the same thing.
    #[error("`{from}` holds {given}, and `{to}` takes {taken}")]
    ExtentMismatch { from: String, to: String, given: String, taken: String },
    /// The graph's output is last frame's.
    #[error("the output cannot be last frame's `{port}`")]
    OutputOfLastFrame { port: String },

    // Order.
    /// Passes wait for each other.
    #[error("passes wait for each other in a circle: {}", chain.join(" → "))]
    Cycle { chain: Vec<String> },
    /// Two passes rewrite one version in place.
    #[error("`{first}` and `{second}` both rewrite `{resource}`")]
    TwoWriters { resource: String, first: String, second: String },
    /// A version is read after another pass rewrote it.
    #[error("`{reader}` reads `{resource}` after `{writer}` rewrote it")]
    StaleRead { resource: String, reader: String, writer: String },
    /// One pass rewrites what it also reads through another port.
    #[error("pass `{pass}` reads and rewrites `{resource}` through two ports")]
    SharedPorts { pass: String, resource: String },
    /// History of history.
    #[error("`{port}` lives in last frame's half already: there is no frame before it")]
    TwoFramesBack { port: String },
    /// An in-out port whose content nothing ever makes.
    #[error("nothing makes `{port}`: it only rewrites its own past")]
    NoOrigin { port: String },

    // Rounds.
    /// Rounds that would all compute the same.
    #[error("pass `{pass}` is repeated, but no round is fed by the one before it")]
    RepeatWithoutFeed { pass: String },
    /// A feed without rounds.
    #[error("pass `{pass}` has `feed`, but no `repeat`")]
    FeedWithoutRepeat { pass: String },
}

impl Cause {
    /// A stable name for machines, e.g. `unknown-pass`.
    pub fn code(&self) -> &'static str {
        match self {
            Cause::Syntax { .. } => "syntax",
            Cause::Read(_) => "missing-file",
            Cause::ExtendsLoop { .. } => "extends-loop",
            Cause::ExtendsTooDeep { .. } => "extends-too-deep",
            Cause::UnknownKey { .. } => "unknown-key",
            Cause::MissingKey { .. } => "missing-key",
            Cause::WrongType { .. } => "wrong-type",
            Cause::BadName { .. } => "bad-name",
            Cause::BadWire { .. } => "bad-wire",
            Cause::BadEdit { .. } => "bad-edit",
            Cause::RemovedAndSet { .. } => "removed-and-set",
            Cause::BadTransport(_) => "bad-transport",
            Cause::OtherPaths { .. } => "other-paths",
            Cause::UnknownPass { .. } => "unknown-pass",
            Cause::UnknownKind { .. } => "unknown-kind",
            Cause::Shader { .. } => "shader",
            Cause::UnknownSlot { .. } => "unknown-slot",
            Cause::UnknownFilling { .. } => "unknown-filling",
            Cause::UnfilledSlot { .. } => "unfilled-slot",
            Cause::UnusedSlot { .. } => "unused-slot",
            Cause::UnknownParam { .. } => "unknown-param",
            Cause::ReservedParam { .. } => "reserved-param",
            Cause::OutOfRange { .. } => "out-of-range",
            Cause::UnknownChoice { .. } => "unknown-choice",
            Cause::NotFinite { .. } => "not-finite",
            Cause::BadKnob { .. } => "bad-knob",
            Cause::UnknownPort { .. } => "unknown-port",
            Cause::NotAnInput { .. } => "not-an-input",
            Cause::NotAnOutput { .. } => "not-an-output",
            Cause::UnwiredInput { .. } => "unwired-input",
            Cause::TypeMismatch { .. } => "type-mismatch",
            Cause::ExtentMismatch { .. } => "extent-mismatch",
            Cause::OutputOfLastFrame { .. } => "output-of-last-frame",
            Cause::Cycle { .. } => "cycle",
            Cause::TwoWriters { .. } => "two-writers",
            Cause::StaleRead { .. } => "stale-read",
            Cause::SharedPorts { .. } => "shared-ports",
            Cause::TwoFramesBack { .. } => "two-frames-back",
            Cause::NoOrigin { .. } => "no-origin",
            Cause::RepeatWithoutFeed { .. } => "repeat-without-feed",
            Cause::FeedWithoutRepeat { .. } => "feed-without-repeat",
        }
    }
}

fn nobody(pass: Option<&str>) -> String {
    pass.map_or_else(|| "no pass reaches".to_owned(), |pass| format!("pass `{pass}` does not reach"))
}
