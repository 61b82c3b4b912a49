//! Bugs seen in public renderers, planted by replacing text of the shaders: each must show at five standard errors.

use crate::toy::{INPUTS, difference, estimates, graph, module, renderer, replaced};
use aquifer_tests::context;

const SHARED: &str = "restir/inputs";

struct Bug {
    name: &'static str,
    module: &'static str,
    what: &'static str,
    by: &'static str,
    rule: &'static str,
    visibility: &'static str,
}

const BUGS: [Bug; 12] = [
    Bug {
        name: "inverted Jacobian",
        module: SHARED,
        what: "r.weight.value * y.jacobian",
        by: "r.weight.value / y.jacobian",
        rule: "pairwise",
        visibility: "at_shading",
    },
    Bug {
        name: "visibility missing in Z",
        module: SHARED,
        what: "let x = move_to(y, at, src);",
        by: "let x = shift(y, at, src);",
        rule: "contribution",
        visibility: "in_target",
    },
    Bug {
        name: "visibility too much in Z",
        module: SHARED,
        what: "let x = move_to(y, at, src);",
        by: "let x = move_to(y, at, src); if (!visible(x.sample, src)) { return 0.0; }",
        rule: "contribution",
        visibility: "at_shading",
    },
    Bug {
        name: "visibility missing in the balance heuristic's denominator",
        module: SHARED,
        what: "let x = move_to(y, at, src);",
        by: "let x = shift(y, at, src);",
        rule: "balance",
        visibility: "in_target",
    },
    Bug {
        name: "a limit that holds one way",
        module: SHARED,
        what: "    if (target_limit <= 0.0) { return false; }\n    let here = p_hat(s, src);\n    return max(there, here) > target_limit * min(there, here);",
        by: "    return there > 1.5 * p_hat(s, src);",
        rule: "contribution",
        visibility: "in_target",
    },
    Bug {
        name: "M counted twice",
        module: SHARED,
        what: "total += (*inputs)[i].confidence;",
        by: "total += (*inputs)[i].confidence + 1.0;",
        rule: "pairwise",
        visibility: "at_shading",
    },
    Bug {
        name: "a reused sample keeps its source's target value",
        module: SHARED,
        what: "return Candidate(y.sample, y.p_hat,",
        by: "return Candidate(y.sample, p_hat(r.sample, src),",
        rule: "pairwise",
        visibility: "at_shading",
    },
    Bug {
        name: "swapped arguments of a MIS weight",
        module: SHARED,
        what: "let x = move_to(y, at, src);",
        by: "let x = move_to(y, src, at);",
        rule: "balance",
        visibility: "at_shading",
    },
    Bug {
        name: "neighbours rejected because of their samples",
        module: "mis/pairwise",
        what: "        sum += (*inputs)[i].confidence * here / (there + here);",
        by: "        if (package::restir::inputs::reservoir_at((*inputs)[i].pixel, (*inputs)[i].when).weight.value <= 0.0) { continue; }\n        sum += (*inputs)[i].confidence * here / (there + here);",
        rule: "pairwise",
        visibility: "at_shading",
    },
    Bug {
        name: "last frame's target taken from today",
        module: SHARED,
        what: "unpack_surface(previous_surface[pixel], when)",
        by: "unpack_surface(previous_surface[pixel], NOW)",
        rule: "pairwise",
        visibility: "at_shading",
    },
    Bug {
        name: "previous frame's camera missing",
        module: "surface",
        what: "normalize(camera_at(when).position - r.position)",
        by: "normalize(camera_at(0u).position - r.position)",
        rule: "balance",
        visibility: "at_shading",
    },
    Bug {
        name: "an MIS denominator with the centre's view direction",
        module: SHARED,
        what: "let x = move_to(y, at, src);",
        by: "var wrong = src; wrong.view = at.view; let x = move_to(y, at, wrong);",
        rule: "balance",
        visibility: "at_shading",
    },
];

#[test]
fn planted_bugs_show() {
    let Some(context) = context() else { return };
    // Few candidates, so that there are empty reservoirs; without a bug, nothing shows.
    let measured = |rule: &str, visibility: &str, shaders: &[(&str, &str)]| {
        let mut renderer = renderer(&context, &graph(rule, visibility, 2), shaders, &[]);
        difference(&estimates(&mut renderer, |all| all[0].count() >= 8 * 32_768)[INPUTS - 3])
    };
    let mut settings: Vec<_> = BUGS.iter().map(|bug| (bug.rule, bug.visibility)).collect();
    settings.sort_unstable();
    settings.dedup();
    for (rule, visibility) in settings {
        let found = measured(rule, visibility, &[]);
        eprintln!("no bug, {rule}, {visibility}: {:+.3} % ± {:.3} %", 100.0 * found.value, 100.0 * found.standard_error);
        assert!(found.score(0.0).abs() < 4.0, "{rule}, {visibility}: something shows without a bug: {found:?}");
    }
    for bug in &BUGS {
        let text = replaced(module(bug.module), bug.what, bug.by);
        let found = measured(bug.rule, bug.visibility, &[(bug.module, &text)]);
        eprintln!("{}: {:+.3} % ± {:.3} %", bug.name, 100.0 * found.value, 100.0 * found.standard_error);
        assert!(found.score(0.0).abs() >= 5.0, "{} does not show", bug.name);
    }
}
