//! What is wrong in somebody's own pass is told with file, line, column and cause.

use aquifer_shader::*;
use std::{collections::BTreeMap, fs, path::Path};

const FRAME: &str = "struct Frame { extent: vec2<u32> }\n@group(0) @binding(0) var<uniform> frame: Frame;\n\
    fn index_of(id: vec2<u32>) -> u32 { return id.y * frame.extent.x + id.x; }\n\
    fn inside(id: vec2<u32>) -> bool { return all(id < frame.extent); }\n";

/// The pass of `docs/own_pass.md`, in short.
const PASS: &str = "//! Darkens the corners.
//! @needs textures
import package::frame::frame::{frame, index_of, inside};
import package::slot::mis::{weigh};

struct Params {
    /// @default 1
    width: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var<storage, read> color: array<vec4<f32>>;
@group(1) @binding(2) var<storage, read_write> image: array<vec4<f32>>;

fn cosine(p: vec2<f32>) -> f32 {
    @if(textures) { if (p.x > 9.0) { return 0.0; } }
    return inverseSqrt(
        1.0 + dot(p, p)
    );
}

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; } // leaves
    let p = vec2<f32>(id.xy) / f32(frame.extent.x) * params.width;
    image[index_of(id.xy)] = vec4<f32>(color[index_of(id.xy)].rgb * cosine(p) * weigh(), 1.0);
}
";

fn library(pass: &str) -> Library {
    let mut library = Library::new();
    library.know_facts(&["textures", "glossy"]);
    library.insert("frame/frame", FRAME, "built-in:frame/frame.wgsl");
    library.insert("mis/power", "fn weigh() -> f32 { return 1.0; }\n", "built-in:mis/power.wgsl");
    library.insert("pass/vignette", pass, "mine/pass/vignette.wgsl");
    library
}

fn compose(library: &Library) -> Result<Composed, ShaderError> {
    let slots = BTreeMap::from([("mis".to_owned(), "power".to_owned())]);
    library.compose(&Specialisation { entry: "pass/vignette".into(), slots, ..Specialisation::default() })
}

/// What is said of the pass with `right` written as `wrong`.
fn fault(right: &str, wrong: &str) -> String {
    assert_eq!(PASS.matches(right).count(), 1, "{right}");
    compose(&library(&PASS.replace(right, wrong))).unwrap_err().to_string()
}

/// The fault begins so, and shows its line with a caret in its column.
fn told(fault: &str, expected: &str) {
    assert!(fault.starts_with(&format!("mine/pass/vignette.wgsl:{expected}")), "{fault}");
    let column: usize = expected.split(':').nth(1).and_then(|text| text.split(' ').next()?.parse().ok()).unwrap();
    assert!(fault.ends_with(&format!("\n  | {}^", " ".repeat(column - 1))), "{fault}");
}

#[test]
fn the_pass_is_right() {
    compose(&library(PASS)).unwrap();
}

#[test]
fn faults_of_the_pass_itself_have_a_place() {
    told(&fault("inverseSqrt", "inverseSqr"), "17:12 in cosine: no definition in scope for identifier: `inverseSqr`");
    told(&fault("width: f32", "width: f33"), "8:12 in Params: no definition in scope for identifier: `f33`");
    told(&fault("].rgb", "].rgq"), "25:63 in main: invalid field accessor `rgq`");
    told(&fault("(8, 8)", "(8, 0)"), "22:2 in main: Entry point main at Compute is invalid: ");
    told(&fault("let p =", "let p: f32 ="), "24:9 in main: the type of `p` is expected to be `f32`");
}

#[test]
fn imports_are_told_where_they_stand() {
    told(
        &fault("frame, index_of, inside}", "frame, index_off, inside}"),
        "3:39: module `frame/frame` has no `index_off`; did you mean `index_of`?",
    );
    told(&fault("package::frame::frame::", "package::frme::frame::"), "3:17: no shader module `frme/frame`; did you mean `frame/frame`?");
    told(&fault("import package::frame", "import frame"), "3:8: imports begin with `package::`, this one with `frame`");
    told(&fault("!inside(", "!package::frame::frame::insid("), "23:33: module `frame/frame` has no `insid`; did you mean `inside`?");
    told(&fault("{weigh}", "{weight}"), "4:29: module `mis/power`, which fills slot `mis`, has no `weight`; did you mean `weigh`?");
}

#[test]
fn words_that_nothing_reads_are_refused() {
    told(&fault("@needs textures", "@needs texturs"), "2:12: there is no fact `texturs` of scenes; did you mean `textures`?");
    told(&fault("@if(textures)", "@if(glossy && !txtures)"), "16:20: there is no fact `txtures` of scenes; did you mean `textures`?");
    told(&fault("//! @needs textures", "//! bias (glosy): dull"), "2:11: there is no fact `glosy` of scenes; did you mean `glossy`?");
    told(&fault("//! @needs", "//! @need"), "2:5: there is no tag `@need`; did you mean `@needs`?");
    let mut free = Library::new();
    free.insert("pass/vignette", "@if(anything) const A = 1;\n@compute @workgroup_size(1) fn main() {}\n", "free.wgsl");
    compose(&free).unwrap();
}

#[test]
fn bindings_that_nobody_fills_are_refused() {
    let twice = fault("@group(1) @binding(2)", "@group(1) @binding(1)");
    told(&twice, "13:1: `image` has the group and binding of `color`: numbers of one file must differ");
    told(&fault("@group(1) @binding(2)", "@group(2) @binding(0)"), "13:1: nothing fills group 2 of `image`: group 0 is the frame's");
}

#[test]
fn a_file_without_an_entry_point_is_told() {
    for text in ["", "// nothing yet\n", &PASS.replace("@compute @workgroup_size(8, 8) ", "")] {
        let fault = compose(&library(text)).unwrap_err().to_string();
        assert!(fault.starts_with("mine/pass/vignette.wgsl: there is no entry point: "), "{fault}");
        assert!(!fault.contains('\n'), "{fault}");
    }
}

#[test]
fn syntax_is_told_by_line_and_without_a_title() {
    told(&fault("let p =", "let p"), "24:11: unexpected token `");
    // Filling the slot has moved columns, but no lines.
    told(&fault("{weigh};", "{weigh;"), "4:34: unexpected token `");
}

#[test]
fn folders_of_which_nothing_would_be_used_are_refused() {
    let folder = std::env::temp_dir().join(format!("aquifer-folders-{}", std::process::id()));
    let write = |name: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, PASS).unwrap();
    };
    let add = |folder: &Path| library(PASS).add_folder(folder).map_err(|fault| fault.to_string());
    write("mine/pass/vignette.wgsl");
    write("mine/vignette.toml");
    write("loose/vignette.wgsl");
    write("known/bsdf.wgsl");
    write("empty/notes.txt");
    fs::create_dir_all(folder.join("begun/frame")).unwrap();

    let said = |name: &str| format!("{}: ", folder.join(name).display());
    let mine = folder.join("mine");
    let deep = add(&mine.join("pass")).unwrap_err();
    let expected = "`vignette.wgsl` lies directly in the folder, where nothing looks for it: passes lie in `pass/`; did you mean ";
    assert_eq!(deep, format!("{}{expected}`{}`?", said("mine/pass"), mine.display()));
    let loose = add(&folder.join("loose")).unwrap_err();
    assert!(loose.ends_with("passes lie in `pass/`"), "{loose}");
    let high = add(&folder).unwrap_err();
    assert!(high.contains("lies too deep") || high.contains("lies directly"), "{high}");
    let empty = add(&folder.join("empty")).unwrap_err();
    assert_eq!(empty, said("empty") + "no shader lies in the folder: passes are `pass/NAME.wgsl`");

    add(&mine).unwrap();
    add(&folder.join("begun")).unwrap();
    let mut tree = library(PASS);
    tree.insert("bsdf", "const A = 1;", "built-in:bsdf.wgsl");
    tree.add_folder(&folder.join("known")).unwrap();
    fs::remove_dir_all(&folder).unwrap();
}
