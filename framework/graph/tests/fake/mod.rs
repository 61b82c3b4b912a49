//! Contracts without shaders: a small world of passes that the cases are written in.
//!
//! | kind | inputs (`?` optional, `*` in-out) | outputs | parameters |
//! |---|---|---|---|
//! | `gbuffer` | | surface, motion | jitter |
//! | `initial` | surface, history?* | reservoir | candidates, every, transport_min, transport_max |
//! | `temporal` | surface, previous_surface, motion, current, history | reservoir | cap, boiling |
//! | `spatial` | surface, current, own_history? | reservoir | taps, radius |
//! | `shade` | surface, reservoir, extra? | color | |
//! | `accumulate` | color, history | mean | |
//! | `blur` | color* | | width |
//! | `guided_blur` | guide, color* | | |
//! | `mix` | first, second? | color | share |
//! | `tonemap` | color | image | operator, exposure, dither |
//! | `roulette` | | tiles | survivors |
//! | `tile_view` | tiles | color | |
//! | `meter` | color | level | |
//! | `old_shade` | reservoir, of another layout | color | |
//! | `broken` | does not compose | | |
//!
//! Slots: `domain` (di, gi), `mis` (constant, balance, pairwise), `proposal` (uniform, power), `lights` (scene), reached by nobody.

use aquifer_graph::{Bias, Contract, ContractError, Contracts, Direction, Extent, Param, Port, Slots, Value, WireType};
use std::collections::BTreeMap;

pub struct Fakes;

const KINDS: [&str; 15] = [
    "accumulate",
    "blur",
    "broken",
    "gbuffer",
    "guided_blur",
    "initial",
    "meter",
    "mix",
    "old_shade",
    "roulette",
    "shade",
    "spatial",
    "temporal",
    "tile_view",
    "tonemap",
];

impl Contracts for Fakes {
    fn kinds(&self) -> Vec<String> {
        KINDS.map(str::to_owned).to_vec()
    }

    fn slots(&self) -> BTreeMap<String, Vec<String>> {
        let slots: [(&str, &[&str]); 4] = [
            ("domain", &["di", "gi"]),
            ("mis", &["constant", "balance", "pairwise"]),
            ("proposal", &["uniform", "power"]),
            ("lights", &["scene"]),
        ];
        slots.iter().map(|(slot, modules)| ((*slot).to_owned(), modules.iter().map(|&module| module.to_owned()).collect())).collect()
    }

    fn contract(&self, kind: &str, slots: &Slots) -> Result<Contract, ContractError> {
        use Direction::{In, InOut, Out};
        let reservoir = || {
            let domain = self.filling(kind, slots, "domain")?;
            Ok(pixels(&format!("Reservoir<{domain}>"), "sample@0,weight@16", 32))
        };
        let surface = || pixels("Surface", "position@0,normal@16", 48);
        let color = || pixels("vec4<f32>", "vec4<f32>", 16);
        let contract = match kind {
            "gbuffer" => Contract {
                ports: vec![port("surface", Out, surface()), port("motion", Out, pixels("vec2<f32>", "vec2<f32>", 8))],
                params: vec![param("jitter", Value::Bool(true))],
                ..Contract::default()
            },
            "initial" => Contract {
                ports: vec![port("surface", In, surface()), port("reservoir", Out, reservoir()?), optional("history", InOut, reservoir()?)],
                params: vec![
                    ranged("candidates", Value::U32(32), 1.0, 256.0),
                    param("every", Value::U32(0)),
                    param("transport_min", Value::U32(1)),
                    param("transport_max", Value::U32(1)),
                ],
                slots: vec!["domain".into(), "proposal".into()],
                bias: vec![bias(None, Some("every"), Some("0"), "validation empties reservoirs because of what they hold")],
                ..Contract::default()
            },
            "temporal" => Contract {
                ports: vec![
                    port("surface", In, surface()),
                    port("previous_surface", In, surface()),
                    port("motion", In, pixels("vec2<f32>", "vec2<f32>", 8)),
                    port("current", In, reservoir()?),
                    port("history", In, reservoir()?),
                    port("reservoir", Out, reservoir()?),
                ],
                params: vec![ranged("cap", Value::U32(20), 1.0, 500.0), ranged("boiling", Value::F32(0.0), 0.0, 1.0)],
                slots: vec!["domain".into(), "mis".into()],
                bias: self
                    .mis_bias(slots, [bias(None, Some("boiling"), Some("0.0"), "the boiling filter weighs reservoirs by what they hold")]),
                ..Contract::default()
            },
            "spatial" => Contract {
                ports: vec![
                    port("surface", In, surface()),
                    port("current", In, reservoir()?),
                    optional("own_history", In, reservoir()?),
                    port("reservoir", Out, reservoir()?),
                ],
                params: vec![ranged("taps", Value::U32(5), 1.0, 12.0), ranged("radius", Value::F32(30.0), 0.5, 200.0)],
                slots: vec!["domain".into(), "mis".into()],
                bias: self.mis_bias(slots, []),
                ..Contract::default()
            },
            "shade" => Contract {
                ports: vec![
                    port("surface", In, surface()),
                    port("reservoir", In, reservoir()?),
                    optional("extra", In, color()),
                    port("color", Out, color()),
                ],
                slots: vec!["domain".into()],
                ..Contract::default()
            },
            "accumulate" => plain(vec![port("color", In, color()), port("history", In, color()), port("mean", Out, color())]),
            "blur" => Contract {
                params: vec![ranged("width", Value::I32(3), -9.0, 9.0)],
                bias: vec![bias(None, None, None, "neighbouring pixels are mixed")],
                ..plain(vec![port("color", InOut, color())])
            },
            "guided_blur" => plain(vec![port("guide", In, color()), port("color", InOut, color())]),
            "mix" => Contract {
                params: vec![ranged("share", Value::F32(0.5), 0.0, 1.0)],
                ..plain(vec![port("first", In, color()), optional("second", In, color()), port("color", Out, color())])
            },
            "tonemap" => Contract {
                params: vec![
                    Param {
                        choices: ["linear", "reinhard", "aces", "agx"].map(str::to_owned).to_vec(),
                        ..param("operator", Value::U32(0))
                    },
                    param("exposure", Value::F32(0.0)),
                    param("dither", Value::Bool(false)),
                ],
                ..plain(vec![port("color", In, color()), port("image", Out, pixels("u32", "u32", 4))])
            },
            "roulette" => Contract {
                params: vec![ranged("survivors", Value::F32(0.25), 0.0, 1.0)],
                ..plain(vec![port("tiles", Out, WireType { extent: Extent::Tiles(64, 32), ..pixels("u32", "u32", 4) })])
            },
            "tile_view" => plain(vec![
                port("tiles", In, WireType { extent: Extent::Tiles(8, 8), ..pixels("u32", "u32", 4) }),
                port("color", Out, color()),
            ]),
            "meter" => plain(vec![
                port("color", In, color()),
                port("level", Out, WireType { extent: Extent::Fixed(1), ..pixels("f32", "f32", 4) }),
            ]),
            "old_shade" => Contract {
                ports: vec![
                    port("reservoir", In, WireType { layout: "sample@0,weight@12".into(), ..reservoir()? }),
                    port("color", Out, color()),
                ],
                slots: vec!["domain".into()],
                ..Contract::default()
            },
            "broken" => return Err(ContractError::Shader("pass/broken.wgsl:3:9: unknown identifier `reservior`".into())),
            _ => return Err(ContractError::UnknownKind { kind: kind.to_owned(), known: self.kinds() }),
        };
        for slot in &contract.slots {
            self.filling(kind, slots, slot)?;
        }
        Ok(contract)
    }
}

impl Fakes {
    fn filling(&self, kind: &str, slots: &Slots, slot: &str) -> Result<String, ContractError> {
        let known = self.slots()[slot].clone();
        match slots.get(slot) {
            None => Err(ContractError::UnfilledSlot { slot: slot.into(), kind: kind.into(), known }),
            Some(filling) if known.contains(filling) => Ok(filling.clone()),
            Some(filling) => Err(ContractError::UnknownFilling { slot: slot.into(), filling: filling.clone(), known }),
        }
    }

    fn mis_bias<const N: usize>(&self, slots: &Slots, others: [Bias; N]) -> Vec<Bias> {
        let constant = slots.get("mis").is_some_and(|mis| mis == "constant");
        let of_mis = constant.then(|| bias(Some("mis"), None, None, "1/M counts reservoirs that could not have made the sample"));
        others.into_iter().chain(of_mis).collect()
    }
}

fn plain(ports: Vec<Port>) -> Contract {
    Contract { ports, ..Contract::default() }
}

fn pixels(element: &str, layout: &str, stride: u32) -> WireType {
    WireType { element: element.into(), layout: layout.into(), stride, extent: Extent::Pixels }
}

fn port(name: &str, direction: Direction, ty: WireType) -> Port {
    Port { name: name.into(), direction, ty, optional: false, doc: String::new() }
}

fn optional(name: &str, direction: Direction, ty: WireType) -> Port {
    Port { optional: true, ..port(name, direction, ty) }
}

fn param(name: &str, default: Value) -> Param {
    Param { name: name.into(), default, range: None, choices: Vec::new(), live: false, doc: String::new() }
}

fn ranged(name: &str, default: Value, least: f64, most: f64) -> Param {
    Param { range: Some((least, most)), ..param(name, default) }
}

fn bias(slot: Option<&str>, param: Option<&str>, unless: Option<&str>, why: &str) -> Bias {
    let text = |text: Option<&str>| text.map(str::to_owned);
    Bias { slot: text(slot), param: text(param), unless: text(unless), why: why.into(), ..Bias::default() }
}
