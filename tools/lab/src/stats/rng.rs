//! A small deterministic generator for resampling: no system randomness, so that equal data give equal intervals.

/// SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub struct SplitMix(u64);

impl SplitMix {
    /// A stream of its own for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in \[0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in 0..n, for n > 0. The bias of the multiplication is below n / 2⁶⁴.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Moments, chi_square::goodness_of_fit};

    #[test]
    fn the_published_sequence() {
        let mut rng = SplitMix::new(1_234_567);
        assert_eq!([rng.bits(), rng.bits(), rng.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn distributions_are_what_they_claim() {
        let mut rng = SplitMix::new(1);
        let mut counts = [0_u64; 7];
        let mut normal = Moments::default();
        for _ in 0..20_000 {
            counts[rng.below(7)] += 1;
            normal.push(rng.normal());
        }
        assert!(goodness_of_fit(&counts, &[20_000.0 / 7.0; 7], 0).unwrap().p > 0.001);
        assert!(normal.mean().abs() < 4.0 * normal.standard_error());
        assert!((normal.variance() - 1.0).abs() < 4.0 * (2.0_f64 / 20_000.0).sqrt());
    }
}
