//! Fills slot `visibility`: visibility reuse (Bitterli et al. 2020, § 3.2 and alg. 5): a ray empties an initial reservoir whose sample is blocked, and
//! no merge tests again; what is shaded is tested.
//! bias [visibility = in_target]: samples exist only where the pixel that drew them sees them, which no MIS weight knows: shadow edges darken

/// Contribution weight; its type says what its reservoir's target holds, so that a graph cannot wire it to a reader that assumes otherwise.
struct Weight { value: f32 }

/// Does a ray test what `initial` keeps?
const TEST_CANDIDATE = true;
/// Does p̂ hold visibility, in merging and in every MIS weight?
const IN_TARGET = false;
/// Does a ray test what is shaded?
const TEST_SHADED = true;
