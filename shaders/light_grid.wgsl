//! Where in the world the presampled light samples of `pass/regir` stand, for the pass that draws them and the proposal that hands them out.
//!
//! The scene's bounds are cut into at most 512 nearly cubic cells of 128 slots. A receiver looks into the cell of a point that is moved by up to half a
//! cell along each axis, so that no edge shows; a cell's samples must therefore serve everything within one cell's size of its centre.

import package::base::math::{max3};
import package::scene::bounds::{bounds};

/// A point of a light, with its contribution weight; weight 0 where nothing was found.
struct Presampled { light: u32, u: f32, v: f32, weight: f32 }

const SLOTS: u32 = 128u;
/// Along the longest axis at most this many cells would fit were the scene a cube.
const SIDE: f32 = 8.0;

struct Grid { low: vec3<f32>, cell: vec3<f32>, count: vec3<u32> }

fn light_grid() -> Grid {
    let extent = bounds.high - bounds.low;
    // No axis shorter than one cell: the product of all counts then stays below SIDE³.
    let room = max(extent, vec3<f32>(max3(extent) / SIDE));
    let side = pow(room.x * room.y * room.z, 1.0 / 3.0) / SIDE;
    let count = clamp(floor(room / side), vec3<f32>(1.0), vec3<f32>(SIDE * SIDE * SIDE));
    return Grid(0.5 * (bounds.low + bounds.high - room), room / count, vec3<u32>(count));
}

fn cells(g: Grid) -> u32 {
    return g.count.x * g.count.y * g.count.z;
}

fn is_in_grid(g: Grid, point: vec3<f32>) -> bool {
    return all(point >= g.low) && all(point <= g.low + g.cell * vec3<f32>(g.count));
}

/// The cell that a point is in, or the nearest.
fn cell_of(g: Grid, point: vec3<f32>) -> u32 {
    let at = vec3<u32>(clamp(floor((point - g.low) / g.cell), vec3<f32>(0.0), vec3<f32>(g.count - 1u)));
    return at.x + g.count.x * (at.y + g.count.y * at.z);
}

fn centre_of(g: Grid, cell: u32) -> vec3<f32> {
    let at = vec3<u32>(cell % g.count.x, cell / g.count.x % g.count.y, cell / (g.count.x * g.count.y));
    return g.low + g.cell * (vec3<f32>(at) + 0.5);
}

/// Radius of the ball around a cell's centre that holds every receiver which may look into it.
fn reach_of(g: Grid) -> f32 {
    return length(g.cell);
}
