//! Sizes that the host sets from the loaded scene.

/// Entries of the traversal stack: no less than the levels of both hierarchies together.
const STACK: u32 = 64u;
