//! The resolution scale that keeps the window interactive.

/// No picture is smaller than this.
pub const LEAST: [u32; 2] = [96, 54];

/// Steps of the scale: the full size divided by these.
const DIVISORS: [f64; 14] = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0];

/// Milliseconds between pictures to aim at: half of what is still interactive (5 pictures a second for one graph, 2.5 for two), so that
/// there is room for what else the machine does.
const AIM: [f64; 2] = [100.0, 200.0];
/// Updates that are looked at before the scale goes up.
const LOOKS: u32 = 3;
/// Updates in a row that must be too slow before it goes down.
const PATIENCE: u32 = 4;

/// Who chooses the scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Choice {
    /// The fastest that is interactive.
    #[default]
    Automatic,
    /// The user: full size divided by this.
    Fixed(f64),
}

/// The sizes there are, and the one in use.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    full: [u32; 2],
    /// From small to large.
    sizes: Vec<[u32; 2]>,
    at: usize,
    choice: Choice,
    looks: u32,
    slow: u32,
    /// Goes up no further: a picture that gets better must not begin anew for no reason that the user knows.
    settled: bool,
}

impl Scale {
    /// Begins with the smallest.
    pub fn new(full: [u32; 2]) -> Self {
        let full = [0, 1].map(|axis| full[axis].max(LEAST[axis]));
        let mut sizes: Vec<[u32; 2]> = DIVISORS.iter().map(|divisor| divided(full, *divisor)).collect();
        sizes.sort_by_key(pixels);
        sizes.dedup();
        Self { full, sizes, at: 0, choice: Choice::Automatic, looks: 0, slow: 0, settled: false }
    }

    /// Pixels across and down.
    pub fn size(&self) -> [u32; 2] {
        match self.choice {
            Choice::Automatic => self.sizes[self.at],
            Choice::Fixed(divisor) => divided(self.full, divisor),
        }
    }

    /// Who chooses.
    pub fn choose(&mut self, choice: Choice) {
        self.choice = choice;
        self.look_again();
    }

    /// Something changed that the scale may depend on.
    pub fn look_again(&mut self) {
        (self.looks, self.slow, self.settled) = (0, 0, false);
    }

    /// Takes note of an update with so many graphs; true when the size is now another.
    pub fn note(&mut self, milliseconds: f64, graphs: usize) -> bool {
        if self.choice != Choice::Automatic {
            return false;
        }
        let aim = AIM[graphs.clamp(1, 2) - 1];
        self.looks += 1;
        self.slow = if milliseconds > 2.0 * aim { self.slow + 1 } else { 0 };
        let fits = |at: usize| milliseconds * pixels(&self.sizes[at]) as f64 / pixels(&self.size()) as f64 <= aim;
        let best = (0..self.sizes.len()).rfind(|&at| fits(at)).unwrap_or(0);
        let goes_up = !self.settled && self.looks >= LOOKS && best > self.at;
        let goes_down = self.slow >= PATIENCE && best < self.at;
        // Upwards once, downwards whenever it must.
        self.settled |= self.looks >= LOOKS;
        if goes_up || goes_down {
            (self.at, self.slow) = (best, 0);
        }
        goes_up || goes_down
    }
}

fn pixels(size: &[u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1])
}

/// The size divided, but not below [`LEAST`].
fn divided(full: [u32; 2], divisor: f64) -> [u32; 2] {
    let [across, down] = [0, 1].map(|axis| f64::from(full[axis]) / f64::from(LEAST[axis]));
    let divisor = divisor.min(across.min(down));
    full.map(|side| (f64::from(side) / divisor).round() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Milliseconds of an update at `scale`, for a machine that renders so many pixels in a millisecond.
    fn play(scale: &mut Scale, speed: f64, graphs: usize, updates: usize) -> Vec<[u32; 2]> {
        let mut seen = vec![scale.size()];
        for _ in 0..updates {
            if scale.note(pixels(&scale.size()) as f64 / speed, graphs) {
                seen.push(scale.size());
            }
        }
        seen
    }

    #[test]
    fn no_size_is_below_the_least_whatever_the_shape() {
        for full in [[1280, 720], [1920, 1080], [640, 640], [10, 10], [3000, 100]] {
            let scale = Scale::new(full);
            assert!(scale.sizes.iter().all(|size| size[0] >= LEAST[0] && size[1] >= LEAST[1]), "{full:?} {:?}", scale.sizes);
        }
        assert_eq!(Scale::new([1280, 720]).size(), LEAST);
    }

    #[test]
    fn it_goes_up_once_and_stays() {
        let mut fast = Scale::new([1280, 720]);
        assert_eq!(play(&mut fast, 1e5, 1, 50), [[96, 54], [1280, 720]]);
        let mut slow = Scale::new([1280, 720]);
        assert_eq!(play(&mut slow, 10.0, 1, 50), [[96, 54]], "half a second an update at the least size");
        let mut between = Scale::new([1280, 720]);
        let seen = play(&mut between, 300.0, 1, 50);
        assert_eq!(seen.len(), 2, "{seen:?}");
        assert!(pixels(&seen[1]) as f64 / 300.0 <= AIM[0]);
    }

    #[test]
    fn it_goes_down_when_updates_stay_slow_and_two_graphs_may_take_twice_as_long() {
        let mut scale = Scale::new([1280, 720]);
        play(&mut scale, 1e5, 1, 10);
        assert_eq!(play(&mut scale, 1e3, 2, 3).len(), 1, "one slow update is no reason");
        assert!(pixels(&play(&mut scale, 1e3, 2, 10)[1]) as f64 / 1e3 <= AIM[1]);
    }

    #[test]
    fn the_user_has_the_last_word() {
        let mut scale = Scale::new([1280, 720]);
        scale.choose(Choice::Fixed(2.0));
        assert_eq!(play(&mut scale, 1.0, 1, 20), [[640, 360]]);
    }
}
