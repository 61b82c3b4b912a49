//! Runs the program.

use std::process::{Command, Output};

/// What a run gave.
pub struct Run {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// Runs `aquifer` with these arguments.
pub fn aquifer(args: &[&str]) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aquifer"));
    command.args(args).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").env_remove("AQUIFER_LOG");
    finish(command.output().expect("the program was built with this test"))
}

/// As [`aquifer`], with one variable in the environment.
pub fn aquifer_with(variable: (&str, &str), args: &[&str]) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_aquifer"));
    command.args(args).env(variable.0, variable.1);
    finish(command.output().expect("the program was built with this test"))
}

fn finish(output: Output) -> Run {
    Run {
        code: output.status.code().expect("the program was not ended by a signal"),
        out: String::from_utf8(output.stdout).expect("stdout is UTF-8"),
        err: String::from_utf8(output.stderr).expect("stderr is UTF-8"),
    }
}

impl Run {
    /// Asserts success with nothing to complain about.
    #[track_caller]
    pub fn succeeds(self) -> Self {
        assert_eq!(self.code, 0, "stdout:\n{}\nstderr:\n{}", self.out, self.err);
        self
    }

    /// Asserts this exit code, and words on stderr; data were not printed, and nothing panicked.
    #[track_caller]
    pub fn fails(self, code: i32, words: &str) -> Self {
        assert_eq!(self.code, code, "stdout:\n{}\nstderr:\n{}", self.out, self.err);
        assert!(self.err.contains(words), "`{words}` is not in\n{}", self.err);
        assert!(self.out.is_empty(), "a failure printed data:\n{}", self.out);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        self
    }
}

/// Names in a folder, sorted.
pub fn names(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder exists");
    let mut names: Vec<_> = entries.map(|entry| entry.expect("the entry can be read").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}
