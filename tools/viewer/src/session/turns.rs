//! Equal time: whose turn it is.
//!
//! The side that has spent less renders the next frame. So what the sides have spent never differs by more than the dearest frame, whatever
//! their frames cost, and the ratio goes to 1.

/// The most frames between two pictures, so that a graph that is very fast beside the other does not stop the window.
const MOST_FRAMES: u32 = 64;

/// What each side has spent since the beginning, and what it did in this update.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turns {
    spent: [f64; 2],
    frames: [u32; 2],
}

impl Turns {
    /// Begins an update.
    pub fn begin(&mut self) {
        self.frames = [0; 2];
    }

    /// Forgets what was spent: from here on, both begin anew.
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    /// The side that renders the next frame; `None` when every side that lives has a new picture.
    pub fn next(&self, lives: [bool; 2]) -> Option<usize> {
        let done = (0..2).all(|side| !lives[side] || self.frames[side] > 0);
        if done || self.frames.iter().sum::<u32>() >= MOST_FRAMES {
            return None;
        }
        match lives {
            [true, true] => Some(usize::from(self.spent[1] < self.spent[0])),
            [true, false] => Some(0),
            [false, true] => Some(1),
            [false, false] => None,
        }
    }

    /// A side rendered a frame that took so long.
    pub fn rendered(&mut self, side: usize, milliseconds: f64) {
        self.spent[side] += milliseconds;
        self.frames[side] += 1;
    }

    /// Frames of this update.
    pub fn frames(&self) -> [u32; 2] {
        self.frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs updates of sides whose frames cost `cost`, and returns the turns.
    fn after(updates: usize, cost: [f64; 2]) -> Turns {
        let mut turns = Turns::default();
        for _ in 0..updates {
            turns.begin();
            while let Some(side) = turns.next([true; 2]) {
                turns.rendered(side, cost[side]);
            }
        }
        turns
    }

    #[test]
    fn both_spend_the_same_whatever_frames_cost() {
        for cost in [[10.0, 10.0], [300.0, 10.0], [7.0, 100.0], [0.3, 33.0]] {
            let [a, b] = after(100, cost).spent;
            assert!((a - b).abs() <= cost[0].max(cost[1]), "{cost:?}: {a} {b}");
            assert!(a > 10.0 * cost[0], "{cost:?}: the dearer side goes on");
        }
    }

    #[test]
    fn an_update_ends_even_beside_a_graph_that_costs_next_to_nothing() {
        let turns = after(3, [1000.0, 1e-6]);
        assert_eq!(turns.frames()[1], MOST_FRAMES);
    }

    #[test]
    fn one_side_alone_renders_one_frame_an_update() {
        let mut turns = Turns::default();
        turns.begin();
        assert_eq!(turns.next([false, true]), Some(1));
        turns.rendered(1, 5.0);
        assert_eq!(turns.next([false, true]), None);
        assert_eq!(turns.next([false; 2]), None);
    }
}
