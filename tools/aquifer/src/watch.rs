//! How far a comparison is: a bar on a terminal, now and then a line elsewhere.

use crate::{interrupt, ui::Ui};
use aquifer_lab::compare::observer::Observer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// Lines come at most this often.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Tells the user, and listens for Ctrl-C.
pub struct Watch<'a> {
    ui: &'a Ui,
    bar: Option<ProgressBar>,
    last: Instant,
    warnings: Vec<String>,
}

impl<'a> Watch<'a> {
    /// Nothing done yet.
    pub fn new(ui: &'a Ui) -> Self {
        interrupt::listen();
        let bar = ui.is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(4));
            bar.set_style(ProgressStyle::with_template("{msg} {bar:24} {pos}/{len}").expect("the template is a constant"));
            bar
        });
        Self { ui, bar, last: Instant::now(), warnings: Vec::new() }
    }

    /// Clears the bar away; what was warned of on the way.
    pub fn finish(self) -> Vec<String> {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
        self.warnings
    }
}

impl Observer for Watch<'_> {
    fn progress(&mut self, what: &str, done: u64, of: u64) {
        if let Some(bar) = &self.bar {
            bar.set_length(of.max(1));
            bar.set_position(done);
            bar.set_message(what.to_owned());
        } else if self.last.elapsed() >= LINE_EVERY {
            self.last = Instant::now();
            self.ui.note(&if of > 0 { format!("{what}, {done} of {of}") } else { what.to_owned() });
        }
    }

    fn warn(&mut self, text: &str) {
        self.ui.warn(text);
        self.warnings.push(text.to_owned());
    }

    fn stop(&self) -> bool {
        interrupt::asked()
    }
}
