//! How far a render is: a bar on a terminal, now and then a line elsewhere.

use crate::ui::Ui;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// Lines come at most this often.
const LINE_EVERY: Duration = Duration::from_secs(5);
/// The bar's steps: fine enough for any terminal.
const STEPS: u64 = 1000;

/// When a render is finished: at whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Frames.
    pub frames: Option<u64>,
    /// Seconds.
    pub seconds: Option<f64>,
}

/// How far a render is.
#[derive(Clone, Copy, Debug)]
pub struct State {
    /// Frames done.
    pub frames: u64,
    /// Seconds since the first frame began.
    pub seconds: f64,
}

impl Goal {
    /// Is there nothing left to do?
    pub fn is_reached(&self, state: State) -> bool {
        self.frames.is_some_and(|goal| state.frames >= goal) || self.seconds.is_some_and(|goal| state.seconds >= goal)
    }

    /// Seconds left, once a first frame says how fast it goes.
    fn left(&self, state: State) -> Option<f64> {
        let by_frames = self.frames.filter(|_| state.frames > 0).map(|goal| {
            let per_frame = state.seconds / state.frames as f64;
            goal.saturating_sub(state.frames) as f64 * per_frame
        });
        let by_time = self.seconds.map(|goal| (goal - state.seconds).max(0.0));
        [by_frames, by_time].into_iter().flatten().reduce(f64::min)
    }

    fn share(&self, state: State) -> f64 {
        match self.left(state) {
            Some(left) if left + state.seconds > 0.0 => state.seconds / (left + state.seconds),
            _ => 0.0,
        }
    }
}

/// Shows how far a render is.
pub struct Progress<'a> {
    ui: &'a Ui,
    goal: Goal,
    bar: Option<ProgressBar>,
    last: Instant,
}

impl<'a> Progress<'a> {
    /// Nothing done yet.
    pub fn new(ui: &'a Ui, goal: Goal) -> Self {
        let bar = ui.is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr_with_hz(10));
            bar.set_style(style(ui.color()));
            bar
        });
        Self { ui, goal, bar, last: Instant::now() }
    }

    /// Shows the state, if it is time to.
    pub fn update(&mut self, state: State) {
        if let Some(bar) = &self.bar {
            bar.set_position((self.goal.share(state) * STEPS as f64) as u64);
            bar.set_message(sentence(self.goal, state));
        } else if self.last.elapsed() >= LINE_EVERY {
            self.last = Instant::now();
            self.ui.note(&sentence(self.goal, state));
        }
    }

    /// Clears the bar away; what was done is told elsewhere.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

fn style(color: bool) -> ProgressStyle {
    let template = if color { "{bar:32.green/dim} {msg}" } else { "{bar:32} {msg}" };
    ProgressStyle::with_template(template).expect("the template is a constant that a test tries").progress_chars("━╸─")
}

fn sentence(goal: Goal, state: State) -> String {
    let of = goal.frames.map(|goal| format!(" of {goal}")).unwrap_or_default();
    let mut text = format!("{}{of} frames", state.frames);
    if state.frames > 0 && state.seconds > 0.0 {
        text += &format!(", {:.3} frames/s", Significant(state.frames as f64 / state.seconds));
    }
    if let Some(left) = goal.left(state) {
        text += &format!(", {} left", duration(left));
    }
    text
}

/// Three digits, whatever the size.
struct Significant(f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(3) as i32;
        let whole = self.0.abs().max(1e-9).log10().floor() as i32 + 1;
        write!(f, "{:.*}", (digits - whole).clamp(0, 6) as usize, self.0)
    }
}

/// `42 s`, `3 min 20 s`, `2 h 5 min`.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_and_time_left() {
        let goal = Goal { frames: Some(64), seconds: None };
        assert_eq!(sentence(goal, State { frames: 0, seconds: 0.5 }), "0 of 64 frames");
        assert_eq!(sentence(goal, State { frames: 16, seconds: 4.0 }), "16 of 64 frames, 4.00 frames/s, 12 s left");
        let timed = Goal { frames: None, seconds: Some(600.0) };
        assert_eq!(sentence(timed, State { frames: 3, seconds: 200.0 }), "3 frames, 0.0150 frames/s, 6 min 40 s left");
        let both = Goal { frames: Some(64), seconds: Some(5.0) };
        assert_eq!(sentence(both, State { frames: 16, seconds: 4.0 }), "16 of 64 frames, 4.00 frames/s, 1 s left");
    }

    #[test]
    fn whichever_comes_first() {
        let goal = Goal { frames: Some(64), seconds: Some(5.0) };
        assert!(!goal.is_reached(State { frames: 63, seconds: 4.9 }));
        assert!(goal.is_reached(State { frames: 64, seconds: 1.0 }));
        assert!(goal.is_reached(State { frames: 1, seconds: 5.0 }));
    }

    #[test]
    fn the_bar_can_be_drawn() {
        style(true);
        style(false);
        assert_eq!([duration(0.4), duration(59.7), duration(7500.0)], ["0 s", "1 min 0 s", "2 h 5 min"]);
    }
}
