//! Help, usage, colour, completions.

use crate::run::{aquifer, aquifer_with};

#[test]
fn help_is_data_and_wrong_use_is_not() {
    let help = aquifer(&["--help"]).succeeds();
    for command in ["render", "check", "dot", "passes", "graphs", "scenes", "adapters", "merge", "diff"] {
        assert!(help.out.contains(&format!("  {command} ")), "{command} is not in\n{}", help.out);
    }
    assert!(!help.out.contains("completions"), "hidden commands stay hidden");
    aquifer(&[]).fails(2, "Usage");
    aquifer(&["rendr"]).fails(2, "render");
    aquifer(&["render", "path_tracer"]).fails(2, "--output");
    assert!(aquifer(&["--version"]).succeeds().out.starts_with("aquifer "));
}

#[test]
fn wrong_values_are_usage() {
    let render = |option: &str, value: &str| aquifer(&["render", "path_tracer", "-o", "never.exr", option, value]);
    render("--size", "0x10").fails(2, "at least one pixel");
    render("--size", "huge").fails(2, "WIDTHxHEIGHT");
    render("--frames", "0").fails(2, "--frames");
    render("--time", "-3").fails(2, "seconds above 0");
    render("--transport", "indirect:0").fails(2, "no transport");
    render("--set", "taps").fails(2, "PASS.PARAMETER=VALUE");
    render("-o", "picture.jpg").fails(2, "neither .exr nor .png");
    assert!(!std::path::Path::new("never.exr").exists());
}

#[test]
fn colour_is_a_choice() {
    let wrong = ["scenes", "show", "cornel"];
    assert!(!aquifer(&wrong).err.contains('\u{1b}'), "stderr is no terminal here");
    let always = ["--color", "always", "scenes", "show", "cornel"];
    assert!(aquifer(&always).err.contains('\u{1b}'));
    assert!(!aquifer_with(("NO_COLOR", "1"), &wrong).err.contains('\u{1b}'));
    assert!(!aquifer_with(("CLICOLOR_FORCE", "1"), &["--color", "never", "scenes", "show", "cornel"]).err.contains('\u{1b}'));
}

#[test]
fn completions_and_pages_are_made() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(aquifer(&["completions", shell]).succeeds().out.contains("aquifer"), "{shell}");
    }
    assert!(aquifer(&["man"]).succeeds().out.contains(".TH aquifer 1"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    aquifer(&["man", "--folder", &folder.path().to_string_lossy()]).succeeds();
    let pages = crate::run::names(folder.path());
    assert!(pages.contains(&"aquifer.1".to_owned()) && pages.contains(&"aquifer-render.1".to_owned()), "{pages:?}");
}

#[cfg(all(feature = "viewer", target_os = "linux"))]
#[test]
fn without_a_display_the_viewer_names_what_works() {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_aquifer"));
    let output =
        command.arg("view").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().expect("the program was built with this test");
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("aquifer compare") && words.contains("DISPLAY"), "{words}");
}
