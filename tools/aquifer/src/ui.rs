//! Where words go: data to stdout, messages to stderr, colour only where it is wanted.

use crate::failure::Failure;
use anstream::{AutoStream, ColorChoice as StreamChoice};
use clap::{
    ColorChoice,
    builder::styling::{AnsiColor, Style},
};
use serde::Serialize;
use std::io::{self, IsTerminal as _, Write as _};
use tracing_subscriber::EnvFilter;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Green.on_default().bold();

/// The way to the user.
#[derive(Debug)]
pub struct Ui {
    color: bool,
}

impl Ui {
    /// Decides on colour and on how much is said.
    pub fn new(choice: ColorChoice, verbose: u8) -> Self {
        let choice = match choice {
            ColorChoice::Auto => StreamChoice::Auto,
            ColorChoice::Always => StreamChoice::AlwaysAnsi,
            ColorChoice::Never => StreamChoice::Never,
        };
        choice.write_global();
        let color = AutoStream::choice(&io::stderr()) != StreamChoice::Never;
        listen_to_libraries(verbose, color);
        Self { color }
    }

    /// May messages be coloured?
    pub fn color(&self) -> bool {
        self.color
    }

    /// Can a bar be drawn over and over?
    pub fn is_terminal(&self) -> bool {
        io::stderr().is_terminal()
    }

    /// Data: lines for stdout.
    pub fn print(&self, text: &str) -> Result<(), Failure> {
        let mut out = io::stdout().lock();
        let newline = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
        match write!(out, "{text}{newline}").and_then(|()| out.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::ReaderGone),
            Err(error) => Err(Failure::new(format!("cannot write to stdout: {error}"))),
            Ok(()) => Ok(()),
        }
    }

    /// Data for other programs.
    pub fn json(&self, value: &impl Serialize) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(value).map_err(|error| Failure::Failed(error.into()))?;
        self.print(&text)
    }

    /// A message about what was done.
    pub fn note(&self, text: &str) {
        anstream::eprintln!("{NOTE}aquifer{NOTE:#}: {text}");
    }

    /// A message about what may be wrong.
    pub fn warn(&self, text: &str) {
        anstream::eprintln!("{WARNING}warning{WARNING:#}: {text}");
    }

    /// A message about what is wrong.
    pub fn error(&self, text: &str) {
        anstream::eprintln!("{ERROR}error{ERROR:#}: {text}");
    }

    /// A message that is laid out already.
    pub fn raw(&self, text: &str) {
        anstream::eprint!("{text}");
    }
}

/// Messages of the framework. The environment variable AQUIFER_LOG says more finely what is wanted.
fn listen_to_libraries(verbose: u8, color: bool) {
    let level = match verbose {
        0 => "warn",
        1 => {
            "warn,aquifer=info,aquifer_graph=info,aquifer_shader=info,aquifer_scene=info,aquifer_render=info,aquifer_passes=info,aquifer_lab=info,aquifer_viewer=info"
        }
        _ => "debug",
    };
    let filter = EnvFilter::try_from_env("AQUIFER_LOG").unwrap_or_else(|_| EnvFilter::new(level));
    let format = tracing_subscriber::fmt().with_writer(io::stderr).with_ansi(color).with_env_filter(filter).with_target(verbose > 1);
    // A second subscriber in one process can only come from tests; the first one stays.
    let _ = if verbose > 1 { format.try_init() } else { format.without_time().try_init() };
}
