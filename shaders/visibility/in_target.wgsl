//! Fills slot `visibility`: every target holds visibility, at the price of a ray for each merge and for each MIS term.
//!
//! Unbiased (Bitterli et al. 2020, § 4.4: with V_j in the normalisation Z). What is shaded was seen when it was made or merged.

/// Contribution weight; its type says what its reservoir's target holds, so that a graph cannot wire it to a reader that assumes otherwise.
struct Weight { value: f32 }

/// Does a ray test what `initial` keeps?
const TEST_CANDIDATE = true;
/// Does p̂ hold visibility, in merging and in every MIS weight?
const IN_TARGET = true;
/// Does a ray test what is shaded?
const TEST_SHADED = false;
