//! Radiance to what a screen shows, for pictures that lie on the host: the curves of `pass/tonemap`, held against them by a test.

use aquifer_lab::film::{Film, encode};

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// Clips.
    #[default]
    Linear,
    /// L / (1 + L) on luminance.
    Reinhard,
    /// Hill's fit of ACES.
    Aces,
    /// Wrensch's fit of AgX.
    Agx,
}

impl Curve {
    /// In the order of the shader's choices, with their names.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Linear, "linear"), (Self::Reinhard, "reinhard"), (Self::Aces, "aces"), (Self::Agx, "agx")];

    /// As the shader names it.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// How radiance is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Developing {
    /// In stops.
    pub exposure: f32,
    /// The curve.
    pub curve: Curve,
}

/// Red, green, blue, opaque, in 8 bits for the screen.
pub fn bytes(film: &Film, how: Developing) -> Vec<u8> {
    let scale = how.exposure.exp2();
    let pixel = |color: &[f32; 3]| {
        let [r, g, b] = shown(color.map(|c| c.max(0.0) * scale), how.curve).map(encode);
        [r, g, b, u8::MAX]
    };
    film.color.iter().flat_map(pixel).collect()
}

/// Display-referred, linear, in 0 to 1.
pub fn shown(color: [f32; 3], curve: Curve) -> [f32; 3] {
    let shown = match curve {
        Curve::Linear => color,
        Curve::Reinhard => {
            let [r, g, b] = color;
            let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            color.map(|c| c / (1.0 + luminance))
        }
        Curve::Aces => aces(color),
        Curve::Agx => agx(color),
    };
    shown.map(|c| c.clamp(0.0, 1.0))
}

/// A matrix, column by column, times a vector.
fn times(columns: [[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|row| columns[0][row] * v[0] + columns[1][row] * v[1] + columns[2][row] * v[2])
}

fn aces(color: [f32; 3]) -> [f32; 3] {
    let to = [[0.59719, 0.07600, 0.02840], [0.35458, 0.90834, 0.13383], [0.04823, 0.01566, 0.83777]];
    let back = [[1.60475, -0.10208, -0.00327], [-0.53108, 1.10813, -0.07276], [-0.07367, -0.00605, 1.07602]];
    times(back, times(to, color).map(|v| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081)))
}

fn agx(color: [f32; 3]) -> [f32; 3] {
    let to =
        [[0.842_479_05, 0.042_328_242, 0.042_375_655], [0.078_433_6, 0.878_468_64, 0.078_433_6], [0.079_223_745, 0.079_166_13, 0.879_143]];
    let back = [
        [1.196_879, -0.052_896_85, -0.052_971_635],
        [-0.098_020_88, 1.151_903_1, -0.098_043_45],
        [-0.099_029_74, -0.098_961_18, 1.151_073_7],
    ];
    let curve = times(to, color).map(|c| {
        let x = (c.max(1e-10).log2().clamp(-12.473_93, 4.026_069) + 12.473_93) / 16.5;
        let (x2, x4) = (x * x, x * x * x * x);
        15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232
    });
    times(back, curve).map(|c| c.max(0.0).powf(2.2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_render::{Context, ContextOptions, Data, Once, run_once};

    /// What the shader shows of these colours, or nothing where there is no adapter.
    fn by_the_shader(colors: &[[f32; 3]], exposure: f32, curve: Curve) -> Option<Vec<[f32; 3]>> {
        let context = match Context::new(&ContextOptions::default()) {
            Ok(context) => context,
            Err(error) if std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none() => {
                eprintln!("skipped: {error}");
                return None;
            }
            Err(error) => panic!("{error}"),
        };
        let registry = aquifer_lab::stage::registry(None, &[]).unwrap();
        let known = registry.known("tonemap", &Default::default()).unwrap();
        let input: Vec<u8> = colors.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]).flat_map(f32::to_le_bytes).collect();
        let params: Vec<u8> = [exposure.to_le_bytes(), (curve as u32).to_le_bytes(), [0; 4], [0; 4]].concat();
        let extent = [colors.len() as u32, 1];
        let mut frame: Vec<u8> = extent.iter().flat_map(|side| side.to_le_bytes()).collect();
        frame.resize(1024, 0);
        let buffers = [
            ("params", Data::In(&params)),
            ("frame", Data::In(&frame)),
            ("color", Data::In(&input)),
            ("image", Data::Out(input.len() as u64)),
        ];
        let workgroups = [extent[0].div_ceil(8), 1, 1];
        let once = Once { shader: &known.composed, entry: "main", constants: &[], buffers: &buffers, workgroups };
        let bytes = run_once(&context, &once).unwrap().remove(0);
        let number = |word: &[u8]| f32::from_le_bytes(word.try_into().unwrap());
        Some(bytes.chunks_exact(16).map(|pixel| [0, 4, 8].map(|at| number(&pixel[at..at + 4]))).collect())
    }

    #[test]
    fn every_curve_is_the_shaders() {
        let colors: Vec<[f32; 3]> = (0..64).map(|i| [0.002 * 1.15_f32.powi(i), 0.01 * i as f32, 3.0 / (1.0 + i as f32)]).collect();
        for (curve, name) in Curve::ALL {
            let exposure = 0.5_f32;
            let Some(expected) = by_the_shader(&colors, exposure, curve) else { return };
            for (color, expected) in colors.iter().zip(expected) {
                let found = shown(color.map(|c| c * exposure.exp2()), curve);
                let close = (0..3).all(|channel| (found[channel] - expected[channel]).abs() < 2e-4);
                assert!(close, "{name} of {color:?}: {found:?}, by the shader {expected:?}");
            }
        }
    }

    #[test]
    fn exposure_counts_in_stops() {
        let film = Film::new([1, 1], vec![[0.25; 3]]).unwrap();
        let [dark, bright] = [0.0, 2.0].map(|exposure| bytes(&film, Developing { exposure, curve: Curve::Linear }));
        assert_eq!(bright, [255; 4]);
        assert_eq!(dark, [137, 137, 137, 255], "sRGB of a quarter");
    }
}
