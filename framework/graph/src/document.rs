//! A graph file, read but not yet checked against what its passes offer.

use crate::{Literal, Sources, Spanned};
use indexmap::IndexMap;

/// A table of a graph file, in the order of the text.
pub type Keys<T> = IndexMap<Spanned<String>, T>;

/// A graph as written, with everything that it extends and every edit already laid over each other.
///
/// # The file
/// ```toml
/// extends   = "restir_di.toml"          # optional: start from that file; relative to this one
/// title     = "ReSTIR DI, pairwise"
/// about     = "What the experiment is about."
/// transport = "direct"                  # which light paths the output holds
/// output    = "tonemap.image"           # pass.port
///
/// [slots]                               # modules for every pass that asks for them
/// mis = "pairwise"
///
/// [budget]
/// knob = "initial.candidates"           # the parameter that spends spare time
///
/// [pass.spatial]                        # `kind` is the pass's name unless said
/// kind         = "spatial"
/// in.surface   = "gbuffer.surface"      # a wire: this frame's
/// in.history   = "spatial.reservoir@prev" # a wire: last frame's
/// set.taps     = 5                      # a parameter
/// slots.mis    = "balance"              # for this pass alone
/// repeat       = 2                      # two rounds …
/// feed.current = "reservoir"            # … the second reads the first one's `reservoir`
/// ```
/// # Extending
/// A file lays its keys over those of the file that it extends, one by one. To take something away it writes
/// `in.x = false` (unwire), `feed.x = false`, `slots.x = false`, `budget.knob = false`, or for a whole pass `remove = true`;
/// `replace = true` forgets what was said of the pass before and goes on from nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Every text that it came from; the first is the file asked for.
    pub sources: Sources,
    /// The file it extends, as written there.
    pub extends: Option<Spanned<String>>,
    /// One line.
    pub title: Option<Spanned<String>>,
    /// A few sentences.
    pub about: Option<Spanned<String>>,
    /// Which light paths the output holds.
    pub transport: Option<Spanned<String>>,
    /// `pass.port`
    pub output: Option<Spanned<String>>,
    /// Fillings for every pass.
    pub slots: Keys<Spanned<Option<String>>>,
    /// The parameter that spends spare time: `pass.param`, or `false`.
    pub knob: Option<Spanned<Option<String>>>,
    /// The passes by name.
    pub pass: Keys<Entry>,
    /// Passes that were removed, for the faults of wires that still name them.
    pub removed: Keys<()>,
}

/// One pass as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Which kind, when it is not the pass's name.
    pub kind: Option<Spanned<String>>,
    /// Wires by input port; `None` is `false`: not wired.
    pub inputs: Keys<Spanned<Option<String>>>,
    /// Parameters by name.
    pub set: Keys<Spanned<Literal>>,
    /// Fillings for this pass alone; `None` is `false`: as the graph says.
    pub slots: Keys<Spanned<Option<String>>>,
    /// How many rounds.
    pub repeat: Option<Spanned<u32>>,
    /// Output ports of the round before, by input port; `None` is `false`.
    pub feed: Keys<Spanned<Option<String>>>,
    /// The pass of the extended file is dropped.
    pub remove: Option<Spanned<bool>>,
    /// What the extended file says of the pass is dropped.
    pub replace: Option<Spanned<bool>>,
}

/// The most rounds that `repeat` takes.
pub const MAX_ROUNDS: u32 = 64;
