//! Equal time: what a graph must run so that its time is the budget's.
//!
//! A graph turns its knob, and where its frames are independent it takes more of them: as few as the knob's range allows, since every frame
//! pays for its first surfaces. Both are whole numbers, times are not. So the run below the budget and the run above it are both made, and
//! their squared errors averaged with the weights at which their times make the budget.

use super::subject::KnobRange;

/// One way to run a graph.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Offer {
    /// Value of the knob; `None` leaves the graph as written.
    pub knob: Option<f64>,
    /// Frames averaged.
    pub frames: u32,
}

/// How often the bracket may move before the nearest is taken: times are nearly linear in the knob.
const MOVES: u32 = 6;
/// Where steps of the knob are fine, both runs are so far from the budget, as a share of it, that the median times of the rounds still lie on either
/// side: times settle to a few percent. An error that falls as 1/time comes out too large by at most the square of this, a thousandth.
const ROOM: f64 = 0.03;

/// The offers around `budget` milliseconds: one where it is met at the end of what can be set, else two. `measure` gives the milliseconds
/// of one frame at a value of the knob.
pub fn around<E>(
    budget: f64,
    knob: Option<KnobRange>,
    independent: bool,
    mut measure: impl FnMut(Option<f64>) -> Result<f64, E>,
) -> Result<Vec<Offer>, E> {
    let Some(knob) = knob else {
        let frames = if independent { budget / measure(None)? } else { 1.0 };
        return Ok(frames_around(None, frames));
    };
    let least = measure(Some(knob.least))?;
    if budget <= least {
        return Ok(vec![Offer { knob: Some(knob.least), frames: 1 }]);
    }
    let mut known = Line::new(knob, least);
    let mut frames = 1;
    if independent && known.at(budget, &mut measure)? > knob.most {
        let most = measure(Some(knob.most))?;
        frames = (budget / most).ceil().max(1.0) as u32;
    }
    known.bracket(budget / f64::from(frames), &mut measure, frames)
}

fn frames_around(knob: Option<f64>, frames: f64) -> Vec<Offer> {
    let below = frames.floor().max(1.0);
    let above = frames.ceil().max(1.0);
    let offer = |frames: f64| Offer { knob, frames: frames as u32 };
    if below == above { vec![offer(below)] } else { vec![offer(below), offer(above)] }
}

/// Time as a line in the knob, through the smallest value and the latest one.
struct Line {
    knob: KnobRange,
    least: f64,
    slope: Option<f64>,
}

impl Line {
    fn new(knob: KnobRange, least: f64) -> Self {
        Self { knob, least, slope: None }
    }

    /// The knob's value at which a frame takes `budget`; may lie beyond its range.
    fn at<E>(&mut self, budget: f64, measure: &mut impl FnMut(Option<f64>) -> Result<f64, E>) -> Result<f64, E> {
        let slope = match self.slope {
            Some(slope) => slope,
            None => {
                let second = self.second();
                let slope = (measure(Some(second))? - self.least) / (second - self.knob.least);
                *self.slope.insert(slope)
            }
        };
        let more = (budget - self.least) / slope;
        // A knob that costs nothing measurable can be turned all the way.
        Ok(if more.is_finite() && more > 0.0 { self.knob.least + more } else { self.knob.most + 1.0 })
    }

    /// A second value to measure at: as written where that differs.
    fn second(&self) -> f64 {
        let KnobRange { least, most, now, .. } = self.knob;
        if now > least { now } else { (least + 3.0).min(most) }
    }

    fn bracket<E>(&mut self, budget: f64, measure: &mut impl FnMut(Option<f64>) -> Result<f64, E>, frames: u32) -> Result<Vec<Offer>, E> {
        let KnobRange { least, most, whole, .. } = self.knob;
        let offer = |knob: f64| Offer { knob: Some(knob), frames };
        let guess = self.at(budget, measure)?.clamp(least, most);
        if !whole {
            return Ok(vec![offer(guess)]);
        }
        let mut below = guess.floor();
        for _ in 0..MOVES {
            let above = (below + 1.0).min(most);
            if below > least && measure(Some(below))? > budget {
                below -= 1.0;
            } else if above < most && measure(Some(above))? < budget {
                below += 1.0;
            } else {
                break;
            }
        }
        let room = self.slope.filter(|slope| *slope > 0.0).map_or(0.0, |slope| (ROOM * budget / slope).floor());
        let above = (below + 1.0 + room).min(most);
        below = (below - room).max(least);
        Ok(if below == above { vec![offer(below)] } else { vec![offer(below), offer(above)] })
    }
}

/// Weights of one or two runs of these times such that together they take `budget`, as near as it goes; they make 1.
pub fn weights(times: &[f64], budget: f64) -> Vec<f64> {
    match *times {
        [below, above] if above > below => {
            let upper = ((budget - below) / (above - below)).clamp(0.0, 1.0);
            vec![1.0 - upper, upper]
        }
        [_, _] => vec![0.5, 0.5],
        _ => vec![1.0; times.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn offers(budget: f64, knob: Option<KnobRange>, independent: bool, time: impl Fn(f64) -> f64) -> Vec<(Option<f64>, u32)> {
        let measure = |knob: Option<f64>| Ok::<f64, Infallible>(time(knob.unwrap_or(1.0)));
        let found = around(budget, knob, independent, measure).unwrap();
        found.iter().map(|offer| (offer.knob, offer.frames)).collect()
    }

    #[test]
    fn frames_alone() {
        assert_eq!(offers(7.5, None, true, |_| 2.0), [(None, 3), (None, 4)]);
        assert_eq!(offers(8.0, None, true, |_| 2.0), [(None, 4)]);
        assert_eq!(offers(1.0, None, true, |_| 2.0), [(None, 1)], "less than a frame cannot be run");
        assert_eq!(offers(8.0, None, false, |_| 2.0), [(None, 1)], "a graph with history has one frame");
    }

    const KNOB: KnobRange = KnobRange { least: 1.0, most: 16.0, now: 1.0, whole: true };

    #[test]
    fn the_knob_first_and_frames_beyond_its_end() {
        let line = |k: f64| 2.0 + 3.0 * k;
        assert_eq!(offers(13.0, Some(KNOB), true, line), [(Some(3.0), 1), (Some(4.0), 1)]);
        assert_eq!(offers(4.0, Some(KNOB), true, line), [(Some(1.0), 1)]);
        // Two frames of up to 50 are needed for 80: each at 40, between 12 and 13.
        assert_eq!(offers(80.0, Some(KNOB), true, line), [(Some(12.0), 2), (Some(13.0), 2)]);
        assert_eq!(offers(80.0, Some(KNOB), false, line), [(Some(16.0), 1)], "a graph with history ends with its knob");
    }

    #[test]
    fn fine_steps_leave_room() {
        let fine = KnobRange { most: 1000.0, ..KNOB };
        let found = offers(100.0, Some(fine), false, |k| 0.5 * k);
        let [(Some(below), 1), (Some(above), 1)] = found[..] else { panic!("{found:?}") };
        assert!((0.5 * below - 97.0).abs() <= 0.5 && (0.5 * above - 103.0).abs() <= 0.5, "{found:?}");
    }

    #[test]
    fn the_bracket_follows_a_curve() {
        let curve = |k: f64| 1.0 + k + 0.05 * k * k;
        let found = offers(12.0, Some(KNOB), true, curve);
        let [(Some(below), 1), (Some(above), 1)] = found[..] else { panic!("{found:?}") };
        assert!(curve(below) <= 12.0 && curve(above) >= 12.0 && above == below + 1.0, "{found:?}");
    }

    #[test]
    fn mixed_times_make_the_budget() {
        let times = [6.0, 8.0];
        let mixed = weights(&times, 7.5);
        assert!((mixed[0] * times[0] + mixed[1] * times[1] - 7.5).abs() < 1e-12 && (mixed[0] + mixed[1] - 1.0).abs() < 1e-12);
        assert_eq!((weights(&times, 5.0), weights(&times, 9.0), weights(&[3.0], 4.0)), (vec![1.0, 0.0], vec![0.0, 1.0], vec![1.0]));
    }
}
