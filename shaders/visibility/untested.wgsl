//! Fills slot `visibility`: nobody asks whether a reused sample is seen. The fewest rays: none beyond those that drew the samples
//! (Ouyang et al. 2021, alg. 4 without lines 12 and 13). Of direct light: what the pixel that drew a sample sees is stored with it, for all who take
//! it over, in this frame and in later ones.
//! bias [visibility = in_target]: light comes through walls as far as samples travel: shadows fade or smear

/// Contribution weight; its type says what its reservoir's target holds, so that a graph cannot wire it to a reader that assumes otherwise.
struct Weight { value: f32 }

/// Does a ray test what `initial` keeps?
const TEST_CANDIDATE = true;
/// Does p̂ hold visibility, in merging and in every MIS weight?
const IN_TARGET = false;
/// Does a ray test what is shaded?
const TEST_SHADED = false;
