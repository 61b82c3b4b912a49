//! Two films of the same thing as one.

use super::{Facts, Film, Overlap};

/// Why two films cannot be merged.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum MergeError {
    /// One of the films does not say what made it.
    #[error("the {which} film does not say what made it: only films rendered by Aquifer can be merged")]
    NoFacts {
        /// `first` or `second`.
        which: &'static str,
    },
    /// The films are of different things.
    #[error("the films differ in {attribute}: {first} and {second}")]
    Differ {
        /// What differs.
        attribute: &'static str,
        /// In the first film.
        first: String,
        /// In the second film.
        second: String,
    },
    /// Some frames are in both films.
    #[error(transparent)]
    Overlap(#[from] Overlap),
    /// A film without frames has no mean.
    #[error("the {which} film holds no frames")]
    Empty {
        /// `first` or `second`.
        which: &'static str,
    },
}

/// The film that one render of all frames of `a` and `b` would have given.
///
/// Means and variances of the mean are combined by the parallel formula of Chan, Golub and LeVeque (1979), in double precision. The frame
/// is the sample of the variance. A plane that only one film has is left out, except the variance, which must be in both or neither.
pub fn merge(a: &Film, b: &Film) -> Result<Film, MergeError> {
    let first = a.facts.as_ref().ok_or(MergeError::NoFacts { which: "first" })?;
    let second = b.facts.as_ref().ok_or(MergeError::NoFacts { which: "second" })?;
    check_same(a, b, first, second)?;
    let facts = merge_facts(first, second)?;
    let frames = Frames::new(first, second)?;
    Ok(Film {
        size: a.size,
        color: frames.means(&a.color, &b.color),
        variance: a.variance.as_ref().zip(b.variance.as_ref()).map(|(va, vb)| frames.variances([&a.color, &b.color], [va, vb])),
        albedo: a.albedo.as_ref().zip(b.albedo.as_ref()).map(|(a, b)| frames.means(a, b)),
        normal: a.normal.as_ref().zip(b.normal.as_ref()).map(|(a, b)| frames.means(a, b)),
        depth: a.depth.as_ref().zip(b.depth.as_ref()).map(|(a, b)| a.iter().zip(b).map(|(&a, &b)| frames.mean(a, b)).collect()),
        facts: Some(facts),
    })
}

fn check_same(a: &Film, b: &Film, first: &Facts, second: &Facts) -> Result<(), MergeError> {
    let per_frame = |facts: &Facts| format!("{}/{}", facts.samples_per_pixel, facts.runs.frames());
    let equal_rate = u64::from(first.samples_per_pixel) * second.runs.frames() == u64::from(second.samples_per_pixel) * first.runs.frames();
    let none = || "none".to_owned();
    let yes_no = |film: &Film| if film.variance.is_some() { "present".to_owned() } else { "absent".to_owned() };
    let pairs = [
        ("size", format!("{}×{}", a.size[0], a.size[1]), format!("{}×{}", b.size[0], b.size[1])),
        ("graph", first.graph.hash.clone(), second.graph.hash.clone()),
        ("scene", first.scene.clone(), second.scene.clone()),
        ("environment", first.environment.clone().unwrap_or_else(none), second.environment.clone().unwrap_or_else(none)),
        ("camera", first.camera.clone(), second.camera.clone()),
        ("animation time", first.animation_time.to_string(), second.animation_time.to_string()),
        ("transport", first.transport.clone(), second.transport.clone()),
        ("variance", yes_no(a), yes_no(b)),
    ];
    for (attribute, first, second) in pairs {
        if first != second {
            return Err(MergeError::Differ { attribute, first, second });
        }
    }
    match equal_rate {
        true => Ok(()),
        false => Err(MergeError::Differ { attribute: "samples per frame", first: per_frame(first), second: per_frame(second) }),
    }
}

fn merge_facts(first: &Facts, second: &Facts) -> Result<Facts, MergeError> {
    let both = |a: &str, b: &str| if a == b { a.to_owned() } else { format!("{a} + {b}") };
    Ok(Facts {
        samples_per_pixel: first.samples_per_pixel.saturating_add(second.samples_per_pixel),
        render_seconds: first.render_seconds + second.render_seconds,
        runs: first.runs.union(&second.runs)?,
        adapter: both(&first.adapter, &second.adapter),
        version: both(&first.version, &second.version),
        ..first.clone()
    })
}

/// How many frames each film holds.
struct Frames {
    a: f64,
    b: f64,
}

impl Frames {
    fn new(first: &Facts, second: &Facts) -> Result<Self, MergeError> {
        for (facts, which) in [(first, "first"), (second, "second")] {
            if facts.runs.frames() == 0 {
                return Err(MergeError::Empty { which });
            }
        }
        Ok(Self { a: first.runs.frames() as f64, b: second.runs.frames() as f64 })
    }

    fn mean(&self, a: f32, b: f32) -> f32 {
        ((self.a * f64::from(a) + self.b * f64::from(b)) / (self.a + self.b)) as f32
    }

    fn means(&self, a: &[[f32; 3]], b: &[[f32; 3]]) -> Vec<[f32; 3]> {
        a.iter().zip(b).map(|(a, b)| std::array::from_fn(|c| self.mean(a[c], b[c]))).collect()
    }

    fn variances(&self, means: [&[[f32; 3]]; 2], variances: [&[[f32; 3]]; 2]) -> Vec<[f32; 3]> {
        let pixel = |i: usize| std::array::from_fn(|c| self.variance(means.map(|m| m[i][c]), variances.map(|v| v[i][c])));
        (0..means[0].len()).map(pixel).collect()
    }

    /// Variance of the mean of all frames, from the means and variances of the means of both halves.
    fn variance(&self, means: [f32; 2], variances: [f32; 2]) -> f32 {
        let n = self.a + self.b;
        let delta = f64::from(means[1]) - f64::from(means[0]);
        let squares = squares(self.a, variances[0]) + squares(self.b, variances[1]) + delta * delta * self.a * self.b / n;
        (squares / (n * (n - 1.0))) as f32
    }
}

/// Sum of squared deviations of `n` frames. A single frame has none, whatever its variance was stored as.
fn squares(n: f64, variance_of_mean: f32) -> f64 {
    if n <= 1.0 { 0.0 } else { f64::from(variance_of_mean) * n * (n - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::super::{GraphText, Runs};
    use super::*;

    fn value(frame: u64, pixel: u64) -> f64 {
        let mix = (frame * 31 + pixel * 7 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mix >> 40) as f64 / (1_u64 << 24) as f64
    }

    /// What a renderer would have accumulated.
    fn rendered(first_frame: u64, frames: u64) -> Film {
        let n = frames as f64;
        let samples = |pixel: u64| (first_frame..first_frame + frames).map(move |frame| value(frame, pixel));
        let mean = |pixel: u64| samples(pixel).sum::<f64>() / n;
        let variance = |pixel: u64| samples(pixel).map(|x| (x - mean(pixel)).powi(2)).sum::<f64>() / (n * (n - 1.0));
        Film {
            size: [4, 3],
            color: (0..12).map(|pixel| [mean(pixel) as f32, 2.0 * mean(pixel) as f32, 0.0]).collect(),
            variance: Some((0..12).map(|pixel| [variance(pixel) as f32, 4.0 * variance(pixel) as f32, 0.0]).collect()),
            facts: Some(Facts {
                samples_per_pixel: frames as u32,
                render_seconds: n,
                graph: GraphText::new("graph"),
                scene: "cornell".into(),
                environment: None,
                camera: "main".into(),
                animation_time: 0.0,
                transport: "direct".into(),
                runs: Runs::one(5, first_frame, frames),
                adapter: "a".into(),
                version: "1".into(),
            }),
            ..Film::default()
        }
    }

    fn assert_close(a: &[[f32; 3]], b: &[[f32; 3]]) {
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() <= 1e-6 * b.abs(), "{a} {b}");
        }
    }

    #[test]
    fn parts_make_the_whole() {
        let whole = rendered(0, 64);
        for split in [1, 2, 21, 32, 63] {
            let merged = merge(&rendered(0, split), &rendered(split, 64 - split)).unwrap();
            assert_close(&merged.color, &whole.color);
            assert_close(merged.variance.as_ref().unwrap(), whole.variance.as_ref().unwrap());
            assert_eq!(merged.facts, whole.facts);
        }
    }

    #[test]
    fn what_differs_is_named() {
        let changed = |change: fn(&mut Film)| {
            let mut film = rendered(32, 32);
            change(&mut film);
            merge(&rendered(0, 32), &film).unwrap_err().to_string()
        };
        let facts = |film: &mut Film| film.facts.take().unwrap();
        assert!(changed(|f| f.facts.as_mut().unwrap().graph = GraphText::new("other")).contains("differ in graph"));
        assert!(changed(|f| f.facts.as_mut().unwrap().scene = "glossy".into()).contains("differ in scene: cornell and glossy"));
        assert!(changed(|f| f.facts.as_mut().unwrap().transport = "full:2".into()).contains("differ in transport"));
        assert!(changed(|f| f.facts.as_mut().unwrap().animation_time = 0.5).contains("differ in animation time: 0 and 0.5"));
        assert!(changed(|f| f.facts.as_mut().unwrap().camera = "side".into()).contains("differ in camera"));
        assert!(changed(|f| f.facts.as_mut().unwrap().environment = Some("sky".into())).contains("differ in environment: none and sky"));
        assert!(changed(|f| f.facts.as_mut().unwrap().samples_per_pixel = 64).contains("differ in samples per frame"));
        assert!(changed(|f| f.variance = None).contains("differ in variance"));
        assert!(changed(|f| f.size = [3, 4]).contains("differ in size: 4×3 and 3×4"));
        assert_eq!(
            changed(|f| f.facts.as_mut().unwrap().runs = Runs::one(5, 31, 32)),
            "both hold frames of seed 5, frames 0..32 and seed 5, frames 31..63"
        );
        let mut bare = rendered(32, 32);
        facts(&mut bare);
        assert_eq!(merge(&rendered(0, 32), &bare), Err(MergeError::NoFacts { which: "second" }));
    }
}
