//! The comparison of two images by their block means.

use super::{Blocks, Grid, Plane};
use crate::stats::{Difference, Rule, Verdict, multiple};
use std::fmt;

/// What a comparison asks. All bands and errors are relative: 0.01 is 1 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockTest {
    /// Largest difference of the whole image's means.
    pub overall_band: f64,
    /// When the whole counts as within its band.
    pub overall_rule: Rule,
    /// Largest combined standard error at which the whole counts as resolved.
    pub overall_error: f64,
    /// Largest difference of a block's means.
    pub block_band: f64,
    /// When a block counts as within its band. p-values are adjusted by Holm's procedure over all resolved blocks.
    pub block_rule: Rule,
    /// Largest combined standard error at which a block counts as resolved.
    pub block_error: f64,
    /// A block is lit when it is brighter, in either image, than this share of the reference's mean.
    pub lit_above: f64,
    /// Least share of lit blocks that must be resolved.
    pub resolved_share: f64,
}

impl Default for BlockTest {
    /// Agreement of two independent renderers: means within 0.5 %, blocks within 2 % where resolved to 0.7 %, 90 % of them resolved.
    fn default() -> Self {
        Self {
            overall_band: 0.005,
            overall_rule: Rule::Estimate,
            overall_error: 0.005 / 3.3,
            block_band: 0.02,
            block_rule: Rule::Estimate,
            block_error: 0.007,
            lit_above: 0.02,
            resolved_share: 0.9,
        }
    }
}

/// What a comparison found.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockComparison {
    /// Failed when anything resolved is outside its band, or anything at all beyond doubt; else not resolved when too little is; else passed.
    pub verdict: Verdict,
    /// One for each averaged quantity.
    pub planes: Vec<PlaneComparison>,
    /// What was asked.
    pub test: BlockTest,
}

/// What was found in one averaged quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneComparison {
    /// `luminance`, `red`, …
    pub name: &'static str,
    /// Of the whole, in units of the reference's mean.
    pub overall: Difference,
    /// On the whole.
    pub overall_verdict: Verdict,
    /// How many blocks are lit.
    pub lit: usize,
    /// Those of them that are resolved, the most different first.
    pub resolved: Vec<BlockDifference>,
    /// The others, the surest to be outside their band first. They pass nothing, but fail where they are outside beyond doubt.
    pub unresolved: Vec<BlockDifference>,
}

/// What was found in one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockDifference {
    /// Top left pixel.
    pub corner: [u32; 2],
    /// In units of the reference's mean over the block (of ours, where only ours is lit).
    pub difference: Difference,
    /// On the block.
    pub verdict: Verdict,
}

/// The images were cut differently.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq, Eq)]
#[error("the images differ in size, block size or averaged quantity")]
pub struct GridsDiffer;

/// Compares two images by their block means.
pub fn compare_blocks(ours: &Blocks, reference: &Blocks, test: &BlockTest) -> Result<BlockComparison, GridsDiffer> {
    if ours.grid != reference.grid || ours.planes.len() != reference.planes.len() {
        return Err(GridsDiffer);
    }
    let (pairs, grid) = (ours.planes.iter().zip(&reference.planes), &ours.grid);
    let mut planes: Vec<_> = pairs.map(|(a, b)| compare_planes(grid, a, b, test)).collect();
    judge_blocks(&mut planes, test);
    for plane in &mut planes {
        plane.resolved.sort_by(|a, b| b.difference.value.abs().total_cmp(&a.difference.value.abs()));
        let outside = |block: &BlockDifference| block.difference.p_outside(test.block_band);
        plane.unresolved.sort_by(|a, b| outside(a).total_cmp(&outside(b)));
    }
    Ok(BlockComparison { verdict: verdict(&planes, test), planes, test: *test })
}

fn compare_planes(grid: &Grid, ours: &Plane, reference: &Plane, test: &BlockTest) -> PlaneComparison {
    let overall = Difference::welch(ours.overall, reference.overall).relative_to(reference.overall.mean);
    let threshold = test.lit_above * reference.overall.mean;
    let (mut lit, mut resolved, mut unresolved) = (0, Vec::new(), Vec::new());
    for (block, (a, b)) in ours.blocks.iter().zip(&reference.blocks).enumerate() {
        if a.mean.max(b.mean) <= threshold {
            continue;
        }
        lit += 1;
        let scale = if b.mean > threshold { b.mean } else { a.mean };
        let difference = Difference::welch(*a, *b).relative_to(scale);
        let kind = if difference.standard_error <= test.block_error { &mut resolved } else { &mut unresolved };
        kind.push(BlockDifference { corner: grid.corner(block), difference, verdict: Verdict::NotResolved });
    }
    PlaneComparison { name: ours.name, overall, overall_verdict: judge_overall(&overall, test), lit, resolved, unresolved }
}

/// The p-value at which what is not resolved is outside its band nevertheless.
const BEYOND_DOUBT: f64 = 1e-3;

/// A difference far beyond its band is one even where the means are not resolved.
fn judge_overall(overall: &Difference, test: &BlockTest) -> Verdict {
    if overall.standard_error <= test.overall_error || overall.value.is_nan() {
        overall.judge(test.overall_band, test.overall_rule)
    } else if overall.p_outside(test.overall_band) <= BEYOND_DOUBT {
        Verdict::Failed
    } else {
        Verdict::NotResolved
    }
}

/// All resolved blocks of all planes are one family of tests, the others another.
fn judge_blocks(planes: &mut [PlaneComparison], test: &BlockTest) {
    let mut blocks: Vec<&mut BlockDifference> = planes.iter_mut().flat_map(|plane| &mut plane.resolved).collect();
    let adjusted = |p: fn(&Difference, f64) -> f64| {
        multiple::adjusted(&blocks.iter().map(|block| p(&block.difference, test.block_band)).collect::<Vec<_>>())
    };
    let (outside, equivalent) = (adjusted(Difference::p_outside), adjusted(Difference::p_equivalent));
    for ((block, outside), equivalent) in blocks.iter_mut().zip(outside).zip(equivalent) {
        block.verdict = block.difference.judge_by(test.block_band, test.block_rule, outside, equivalent);
    }
    let mut others: Vec<&mut BlockDifference> = planes.iter_mut().flat_map(|plane| &mut plane.unresolved).collect();
    let outside = multiple::adjusted(&others.iter().map(|block| block.difference.p_outside(test.block_band)).collect::<Vec<_>>());
    for (block, outside) in others.iter_mut().zip(outside) {
        if outside <= BEYOND_DOUBT || block.difference.value.is_nan() {
            block.verdict = Verdict::Failed;
        }
    }
}

fn verdict(planes: &[PlaneComparison], test: &BlockTest) -> Verdict {
    let every = |is: fn(Verdict) -> bool| {
        planes.iter().all(|plane| is(plane.overall_verdict) && plane.resolved.iter().all(|block| is(block.verdict)))
    };
    let beyond_doubt = planes.iter().flat_map(|plane| &plane.unresolved).any(|block| block.verdict == Verdict::Failed);
    if beyond_doubt || !every(|verdict| verdict != Verdict::Failed) {
        Verdict::Failed
    } else if every(|verdict| verdict == Verdict::Passed) && planes.iter().all(|plane| plane.is_resolved(test)) {
        Verdict::Passed
    } else {
        Verdict::NotResolved
    }
}

impl PlaneComparison {
    /// Share of lit blocks that are resolved; 1 where nothing is lit.
    pub fn share(&self) -> f64 {
        if self.lit == 0 { 1.0 } else { self.resolved.len() as f64 / self.lit as f64 }
    }

    fn is_resolved(&self, test: &BlockTest) -> bool {
        self.share() >= test.resolved_share
    }

    /// Blocks with this verdict, resolved ones first.
    pub fn blocks(&self, verdict: Verdict) -> impl Iterator<Item = &BlockDifference> {
        self.resolved.iter().chain(&self.unresolved).filter(move |block| block.verdict == verdict)
    }

    fn describe(&self, f: &mut fmt::Formatter<'_>, test: &BlockTest) -> fmt::Result {
        let band = percent(test.overall_band);
        write!(f, "{}: mean {} (band {band}, {})", self.name, Signed(self.overall), self.overall_verdict)?;
        write!(f, "; {} of {} lit blocks resolved", self.resolved.len(), self.lit)?;
        if !self.is_resolved(test) {
            write!(f, " (not the {} asked)", percent(test.resolved_share))?;
        }
        if let Some(worst) = self.resolved.first() {
            write!(f, ", the worst {worst} (band {})", percent(test.block_band))?;
        }
        if let Some(furthest) = self.unresolved.first() {
            write!(f, ", of the others {furthest}")?;
        }
        match self.blocks(Verdict::Failed).count() {
            0 => Ok(()),
            1 => f.write_str(", 1 block failed"),
            failed => write!(f, ", {failed} blocks failed"),
        }
    }
}

impl fmt::Display for BlockDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at ({}, {})", Signed(self.difference), self.corner[0], self.corner[1])
    }
}

impl fmt::Display for BlockComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.verdict)?;
        for plane in &self.planes {
            f.write_str("\n  ")?;
            plane.describe(f, &self.test)?;
        }
        Ok(())
    }
}

/// A relative difference in per cent.
struct Signed(Difference);

impl fmt::Display for Signed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:+.3} % ± {:.3} %", 100.0 * self.0.value, 100.0 * self.0.standard_error)
    }
}

fn percent(share: f64) -> String {
    format!("{} %", (share * 1e6).round() / 1e4)
}

#[cfg(test)]
mod tests {
    use super::super::Quantity;
    use super::*;
    use crate::film::Film;
    use crate::stats::{multiple::plausible_count, rng::SplitMix};

    const SIZE: [u32; 2] = [64, 36];

    /// A picture with a dark quarter, with relative noise of `error` a pixel, times `gain`.
    fn film(rng: &mut SplitMix, error: f64, gain: impl Fn(u32, u32) -> f64) -> Film {
        let (mut color, mut variance) = (Vec::new(), Vec::new());
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let truth = if x < 16 && y < 16 { 1e-4 } else { 0.5 + f64::from(x) / 64.0 };
                let noise = error * truth * rng.normal();
                color.push([(truth * gain(x, y) + noise) as f32; 3]);
                variance.push([(error * truth).powi(2) as f32; 3]);
            }
        }
        Film { variance: Some(variance), ..Film::new(SIZE, color).unwrap() }
    }

    fn compare(ours: &Film, reference: &Film, test: &BlockTest) -> BlockComparison {
        let blocks = |film| Blocks::of_film(film, 8, Quantity::Luminance);
        compare_blocks(&blocks(ours), &blocks(reference), test).unwrap()
    }

    /// Verdicts of 200 comparisons.
    fn verdicts(seed: u64, error: f64, test: &BlockTest, gain: impl Fn(u32, u32) -> f64) -> [u64; 3] {
        let mut rng = SplitMix::new(seed);
        let mut counts = [0; 3];
        for _ in 0..200 {
            let (ours, reference) = (film(&mut rng, error, &gain), film(&mut rng, error, |_, _| 1.0));
            counts[compare(&ours, &reference, test).verdict as usize] += 1;
        }
        counts
    }

    #[test]
    fn equal_expectations_pass() {
        // Errors of 0.02·√2/√32 = 0.5 % in the eight half-height blocks at the lower edge, 4 of which fit into the band: they fail with
        // 6e-5 each, and the others more rarely still.
        let [passed, failed, _] = verdicts(81, 0.02, &BlockTest::default(), |_, _| 1.0);
        assert!(passed + failed == 200 && plausible_count(failed, 200, 5e-4), "{passed} {failed}");
    }

    #[test]
    fn a_planted_bias_fails() {
        // The whole 1 % too bright, against a band of 0.5 %.
        assert_eq!(verdicts(82, 0.03, &BlockTest::default(), |_, _| 1.01), [0, 200, 0]);
        // One block 4 % too dark, which hides in the mean: 2 % beyond the band, 3.8 standard errors.
        let one = |x: u32, y: u32| if x / 8 == 4 && y / 8 == 2 { 0.96 } else { 1.0 };
        let failed = verdicts(83, 0.03, &BlockTest::default(), one)[1];
        assert!(failed >= 198, "{failed}");
    }

    #[test]
    fn noise_is_not_resolved_rather_than_passed() {
        assert_eq!(verdicts(84, 0.2, &BlockTest::default(), |_, _| 1.0)[0], 0);
        let mut rng = SplitMix::new(85);
        let noisy = compare(&film(&mut rng, 0.05, |_, _| 1.0), &film(&mut rng, 0.05, |_, _| 1.0), &BlockTest::default());
        assert_eq!(noisy.verdict, Verdict::NotResolved);
        assert_eq!((noisy.planes[0].lit, noisy.planes[0].resolved.len()), (36, 0));
        assert!(noisy.to_string().contains("0 of 36 lit blocks resolved (not the 90 % asked)"), "{noisy}");
    }

    #[test]
    fn blocks_that_are_not_resolved_fail_beyond_doubt() {
        // The whole is resolved to 0.2 %, hardly a block to 0.7 %; one of the blocks has only half its light.
        let one = |x: u32, y: u32| if x / 8 == 4 && y / 8 == 2 { 0.5 } else { 1.0 };
        let lenient = BlockTest { overall_band: 0.1, ..BlockTest::default() };
        assert_eq!(verdicts(92, 0.06, &lenient, one)[1], 200);
        let failed = verdicts(93, 0.06, &lenient, |_, _| 1.0)[1];
        assert!(plausible_count(failed, 200, 1e-3), "{failed}");
    }

    #[test]
    fn holm_over_blocks() {
        let strict = BlockTest {
            block_rule: Rule::Equivalent { alpha: 0.05 },
            overall_rule: Rule::Equivalent { alpha: 0.05 },
            ..BlockTest::default()
        };
        assert!(verdicts(86, 0.01, &strict, |_, _| 1.0)[0] >= 198);
        assert_eq!(verdicts(87, 0.035, &strict, |_, _| 1.0)[0], 0);
        let lenient = BlockTest { block_rule: Rule::Exceeds { alpha: 0.05 }, ..BlockTest::default() };
        let one = |gain: f64| move |x: u32, y: u32| if x / 8 == 4 && y / 8 == 2 { gain } else { 1.0 };
        // At the edge of the band: at most one false alarm in 20 × 36. Five points beyond: found.
        assert!(verdicts(88, 0.035, &lenient, one(0.98))[1] <= 3);
        assert!(verdicts(89, 0.035, &lenient, one(0.93))[1] >= 195);
    }

    #[test]
    fn light_where_there_should_be_none_is_found() {
        let mut rng = SplitMix::new(90);
        let leak = film(&mut rng, 0.01, |x, y| if x < 8 && y < 8 { 2000.0 } else { 1.0 });
        let found = compare(&leak, &film(&mut rng, 0.01, |_, _| 1.0), &BlockTest { overall_band: 1.0, ..BlockTest::default() });
        assert_eq!(found.verdict, Verdict::Failed);
        assert_eq!(found.planes[0].resolved[0].corner, [0, 0]);
    }

    #[test]
    fn what_is_not_a_number_fails() {
        let mut rng = SplitMix::new(91);
        let mut broken = film(&mut rng, 0.01, |_, _| 1.0);
        broken.color[700] = [f32::NAN; 3];
        assert_eq!(compare(&broken, &film(&mut rng, 0.01, |_, _| 1.0), &BlockTest::default()).verdict, Verdict::Failed);
    }

    #[test]
    fn channels_see_a_shift_of_hue() {
        let reference = Film { variance: Some(vec![[0.0; 3]; 64]), ..Film::new([8, 8], vec![[1.0; 3]; 64]).unwrap() };
        let shifted = Film { color: vec![[1.0, 1.0 - 0.03 * 0.0722 / 0.7152, 1.03]; 64], ..reference.clone() };
        let by = |quantity| {
            let blocks = |film| Blocks::of_film(film, 8, quantity);
            compare_blocks(&blocks(&shifted), &blocks(&reference), &BlockTest::default()).unwrap().verdict
        };
        assert_eq!((by(Quantity::Luminance), by(Quantity::Channels)), (Verdict::Passed, Verdict::Failed));
    }

    #[test]
    fn different_cuts_are_refused() {
        let film = Film::new([8, 8], vec![[1.0; 3]; 64]).unwrap();
        let blocks = |side| Blocks::of_film(&film, side, Quantity::Luminance);
        assert_eq!(compare_blocks(&blocks(8), &blocks(4), &BlockTest::default()), Err(GridsDiffer));
    }
}
