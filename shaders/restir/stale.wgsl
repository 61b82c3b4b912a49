//! Whose history must go. `initial` finds out by validation, sample by sample (Ouyang et al. 2021, § 5).
//!
//! A sample that still holds may come with a weight that does not: W = Σw / p̂ counts all the light that was merged, whichever sample was kept. One pixel
//! of that kind outweighs all around it that have begun anew, and gives them back the light that is gone. So a pixel may let its history go where
//! pixels around it have lost theirs.

@if(moving_lights || moving_objects) import package::frame::frame::{frame, index_of, pixel_of};
@if(moving_lights || moving_objects) import package::restir::neighbour::{on_film};

/// Pixels from here to each of the eight around whose lost history takes this pixel's along; 0: only its own.
/// @range 0 64
override spread: u32 = 0u;

/// 1 where the pixel's history must go; `initial` finds out by validation.
/// @optional
@if(moving_lights || moving_objects) @group(1) @binding(2) var<storage, read> stale: array<u32>;

fn is_stale(pixel: u32) -> bool {
    @if(moving_lights || moving_objects) {
        if (stale[pixel] != 0u) { return true; }
        if (spread == 0u) { return false; }
        let here = vec2<i32>(pixel_of(pixel));
        for (var i = 0u; i < 9u; i++) {
            let there = here + i32(spread) * (vec2<i32>(i32(i % 3u), i32(i / 3u)) - 1);
            if (on_film(there, frame.extent) && stale[index_of(vec2<u32>(there))] != 0u) { return true; }
        }
    }
    return false;
}
