//! `aquifer check GRAPH`

use crate::{failure::Failure, source::GraphArgs, ui::Ui};
use aquifer_graph::{BiasFinding, Graph, Plan};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    graph: GraphArgs,
    /// Print the checked graph as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let (graph, registry) = args.graph.check(None)?;
    let plan = graph.plan(&registry, &[])?;
    if args.json { ui.json(&graph.to_json()) } else { ui.print(&report(&graph, &plan)) }
}

fn report(graph: &Graph, plan: &Plan) -> String {
    let mut lines = vec![format!("{} ({})", graph.title(), graph.transport()), String::new()];
    lines.extend(plan.steps.iter().map(|step| format!("  {}", step.node)));
    lines.extend(plan.left_out.iter().map(|left| format!("  {} is left out: {}", left.node, left.reason)));
    lines.push(String::new());
    let bias = graph.bias();
    match bias.as_slice() {
        [] => lines.push("unbiased".to_owned()),
        _ => lines.push("biased, because".to_owned()),
    }
    lines.extend(bias.iter().map(|finding| told(finding, "")));
    lines.extend(elsewhere(graph));
    lines.join("\n")
}

fn told(finding: &BiasFinding, given: &str) -> String {
    format!("  {}: {given}pass `{}`, {}: {}", finding.place, finding.pass, finding.what, finding.why)
}

/// What biases by a fact of the scene: said once for each reason, since no scene is given.
fn elsewhere(graph: &Graph) -> Vec<String> {
    let mut findings = graph.bias_elsewhere();
    let mut seen = std::collections::BTreeSet::new();
    findings.retain(|finding| seen.insert(finding.why.clone()));
    let head = (!findings.is_empty()).then(|| "and in some scenes biased, because".to_owned());
    let line = |finding: &BiasFinding| told(finding, &format!("with `{}`, ", finding.given.as_deref().unwrap_or_default()));
    head.into_iter().chain(findings.iter().map(line)).collect()
}
