//! Fills slot `visibility`: targets hold no visibility; one ray decides at shading.
//!
//! Of direct light unbiased, with the fewest rays of the unbiased fillings; of indirect light biased (see its domains).
//! Samples behind an occluder are carried along and shaded black.
//! @default

/// Contribution weight; its type says what its reservoir's target holds, so that a graph cannot wire it to a reader that assumes otherwise.
struct Weight { value: f32 }

/// Does a ray test what `initial` keeps?
const TEST_CANDIDATE = false;
/// Does p̂ hold visibility, in merging and in every MIS weight?
const IN_TARGET = false;
/// Does a ray test what is shaded?
const TEST_SHADED = true;
