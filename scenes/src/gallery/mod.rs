//! The scenes that come with Aquifer, one file each.

mod animated;
mod cornell;
mod door_ajar;
pub mod furnace;
mod glossy;
mod many_lights;
mod million;
mod outdoor;
pub mod plates;
mod point_lights;
mod sun_room;
mod sunlit_wall;
mod textured;
mod veach_mis;

use aquifer_scene::Scene;

/// A scene made in code.
#[derive(Clone, Copy, Debug)]
pub struct Generator {
    /// What the user types.
    pub name: &'static str,
    /// One line for a list.
    pub about: &'static str,
    /// Makes the scene. It still wants the finishing that a loaded one gets.
    pub make: fn() -> Scene,
}

/// Every scene, simple ones first.
pub fn all() -> &'static [Generator] {
    ALL
}

/// The scene of that name, if there is one.
pub fn by_name(name: &str) -> Option<&'static Generator> {
    ALL.iter().find(|generator| generator.name == name)
}

const ALL: &[Generator] = &[
    Generator { name: "cornell", about: "diffuse box, one ceiling light, two blocks", make: cornell::cornell },
    Generator { name: "glossy", about: "metal and dielectric spheres of roughness 0.1 to 0.8", make: glossy::glossy },
    Generator { name: "veach_mis", about: "plates of growing roughness under lights of growing size", make: veach_mis::veach_mis },
    Generator { name: "door_ajar", about: "a room lit only through a door that stands ajar", make: door_ajar::door_ajar },
    Generator { name: "sunlit_wall", about: "a sunlit wall lights a floor that lies in shadow", make: sunlit_wall::sunlit_wall },
    Generator { name: "sun_room", about: "a room with one window: sun, point and spot lights", make: sun_room::sun_room },
    Generator {
        name: "textured",
        about: "brick, tiles, a normal map, a lit sign, cut-out leaves, stained glass",
        make: textured::textured,
    },
    Generator {
        name: "many_lights",
        about: "a hall with 5,120 emissive triangles of widely differing power",
        make: many_lights::many_lights,
    },
    Generator { name: "point_lights", about: "an amphitheatre with 2,000 point lights", make: point_lights::point_lights },
    Generator { name: "animated", about: "camera, objects and lights move, in a loop of four seconds", make: animated::animated },
    Generator { name: "million", about: "a mountain of more than a million triangles in one mesh", make: million::million },
    Generator { name: "outdoor", about: "a valley of instanced trees and rocks under a sky with a sun", make: outdoor::outdoor },
    Generator { name: "furnace", about: "white sphere in a uniformly bright enclosure, for tests", make: furnace::furnace },
    Generator { name: "plates", about: "two unit plates, one shining on the other, for tests", make: plates::plates },
];
