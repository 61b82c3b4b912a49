//! Counts the elements of an array that hold a NaN, and those that hold an infinity.

struct Shape {
    /// Words of an element.
    stride: u32,
    /// How many elements.
    elements: u32,
    /// Invocations in a row of the dispatch.
    row: u32,
    /// Where in `found` the array's counts are.
    at: u32,
}

/// 64 bits each, the low half first.
struct Found { nan: array<atomic<u32>, 2>, infinite: array<atomic<u32>, 2> }

@group(1) @binding(0) var<uniform> shape: Shape;
/// Which words of an element are floats.
@group(1) @binding(1) var<storage, read> floats: array<u32>;
@group(1) @binding(2) var<storage, read> words: array<u32>;
@group(1) @binding(3) var<storage, read_write> found: array<Found>;

const EXPONENT: u32 = 0x7f800000u;
const MAGNITUDE: u32 = 0x7fffffffu;

// Bits are looked at as integers: compilers may take it that floats are finite.
@compute @workgroup_size(64) fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    let element = id.y * shape.row + id.x;
    if (element >= shape.elements) { return; }
    var nan = false;
    var infinite = false;
    for (var i = 0u; i < arrayLength(&floats); i++) {
        let magnitude = words[element * shape.stride + floats[i]] & MAGNITUDE;
        nan |= magnitude > EXPONENT;
        infinite |= magnitude == EXPONENT;
    }
    if (nan && atomicAdd(&found[shape.at].nan[0], 1u) == 0xffffffffu) { atomicAdd(&found[shape.at].nan[1], 1u); }
    if (infinite && atomicAdd(&found[shape.at].infinite[0], 1u) == 0xffffffffu) { atomicAdd(&found[shape.at].infinite[1], 1u); }
}
