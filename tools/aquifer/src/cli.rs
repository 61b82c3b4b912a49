//! What can be typed.

#[cfg(feature = "viewer")]
use crate::command::view;
use crate::{
    command::{
        adapters, bench, check, compare, completions, diff, dot, explain, graphs, man, merge, passes, regress, render, report, scenes,
        schema, stress,
    },
    failure::Failure,
    ui::Ui,
};
use clap::{ArgAction, Args, ColorChoice, Parser, Subcommand};

/// Compare reservoir-based resampling (ReSTIR) honestly: render graphs are text files, and their parts are interchangeable.
#[derive(Debug, Parser)]
#[command(name = "aquifer", version = VERSION, propagate_version = true, max_term_width = 110, after_help = EXIT_CODES)]
pub struct Cli {
    #[command(flatten)]
    pub global: Global,
    #[command(subcommand)]
    pub command: Command,
}

/// The number, and the commit that the program was built from.
pub const VERSION: &str = env!("AQUIFER_VERSION");

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 used wrongly, 75 failed for now (device lost, out of memory: try again).
Data goes to stdout, messages go to stderr. NO_COLOR is honoured.";

/// Options of every command.
#[derive(Debug, Args)]
pub struct Global {
    /// Colour in messages
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", help_heading = "Messages")]
    pub color: ColorChoice,
    /// Say more; twice for everything
    #[arg(short, long, global = true, action = ArgAction::Count, help_heading = "Messages")]
    pub verbose: u8,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene with a graph
    Render(render::Args),
    /// Compare graphs at equal time: who has less error, and by how much
    Compare(compare::Args),
    /// Open a window: one graph, or two at equal time, live
    #[cfg(feature = "viewer")]
    View(view::Args),
    /// Check a graph, and say whether it is unbiased
    Check(check::Args),
    /// Say what a graph leaves out on a scene, because of which fact, and what that saves
    Explain(explain::Args),
    /// Draw a graph in Graphviz's language
    Dot(dot::Args),
    /// List the kinds of passes, or show one's manual page
    Passes(passes::Args),
    /// Print a JSON Schema of graph files, so that editors complete and explain them
    Schema(schema::Args),
    /// List the built-in graphs, or print one
    Graphs(graphs::Args),
    /// List, describe and export scenes
    Scenes(scenes::Args),
    /// List the graphics adapters of this machine
    Adapters(adapters::Args),
    /// Combine renders of the same thing, made with other frames or seeds
    Merge(merge::Args),
    /// Check that graphs still give the pictures that were kept
    Regress(regress::Args),
    /// Try graphs on extreme and stiff scenes: finite, right by statistics, soon right again after a change
    Stress(stress::Args),
    /// Measure how far one image is from another
    Diff(diff::Args),
    /// Measure speed: medians and ratios of contestants that take turns
    Bench(bench::Args),
    /// Make the page of a comparison again from its report.json
    Report(report::Args),
    /// Print completions for a shell
    #[command(hide = true)]
    Completions(completions::Args),
    /// Print the manual page
    #[command(hide = true)]
    Man(man::Args),
}

impl Command {
    /// Does it.
    pub fn run(self, ui: &Ui) -> Result<(), Failure> {
        match self {
            Self::Render(args) => render::run(args, ui),
            Self::Compare(args) => compare::run(args, ui),
            #[cfg(feature = "viewer")]
            Self::View(args) => view::run(args),
            Self::Check(args) => check::run(args, ui),
            Self::Explain(args) => explain::run(args, ui),
            Self::Dot(args) => dot::run(args, ui),
            Self::Passes(args) => passes::run(args, ui),
            Self::Graphs(args) => graphs::run(args, ui),
            Self::Schema(args) => schema::run(args, ui),
            Self::Scenes(args) => scenes::run(args, ui),
            Self::Adapters(args) => adapters::run(args, ui),
            Self::Merge(args) => merge::run(args, ui),
            Self::Regress(args) => regress::run(args, ui),
            Self::Stress(args) => stress::run(args, ui),
            Self::Diff(args) => diff::run(args, ui),
            Self::Bench(args) => bench::run(args, ui),
            Self::Report(args) => report::run(args, ui),
            Self::Completions(args) => completions::run(args, ui),
            Self::Man(args) => man::run(args, ui),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_grammar_is_sound() {
        Cli::command().debug_assert();
    }
}
