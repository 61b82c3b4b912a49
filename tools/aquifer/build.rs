//! Says which commit the program is built from, as `AQUIFER_VERSION`; outside of a checkout, the version alone.

use std::{env, process::Command};

/// What the program is made of: a change to any of it may make it differ from its commit.
const SOURCES: [&str; 7] = ["Cargo.lock", "framework", "graphs", "passes", "scenes", "shaders", "tools"];

fn main() {
    println!("cargo::rustc-env=AQUIFER_VERSION={}", version());
}

fn version() -> String {
    let number = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    for source in SOURCES {
        println!("cargo::rerun-if-changed=../../{source}");
    }
    // Every commit and every checkout adds a line to this file.
    let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) else { return number };
    println!("cargo::rerun-if-changed={log}");
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else { return number };
    let in_tree = SOURCES.map(|source| format!(":/{source}"));
    let status = ["status", "--porcelain", "--"].into_iter().chain(in_tree.iter().map(String::as_str));
    match git(&status.collect::<Vec<_>>()) {
        Some(changes) if changes.is_empty() => format!("{number} ({commit})"),
        _ => format!("{number} ({commit}, modified)"),
    }
}

/// What git says; nothing where there is no git, or no checkout of it.
fn git(args: &[&str]) -> Option<String> {
    let output = Command::new("git").args(args).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
