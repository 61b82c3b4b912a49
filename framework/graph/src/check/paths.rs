//! Do the passes make the light paths that the transport says?

use super::Checker;
use crate::{Cause, Fault, Graph, Transport, nearest::list};
use std::collections::BTreeSet;

impl Checker<'_> {
    /// A picture without some of its paths, or with others, would be compared with references of what it is not. Emission that the camera sees is
    /// not asked: passes that show surfaces show it.
    pub(super) fn paths(&mut self, graph: &Graph) {
        let Some(text) = &self.document.transport else { return };
        let (least, most) = graph.transport.scatterings();
        let mut sources = graph.needed().into_iter().filter_map(|node| graph.nodes[node].contract.paths).peekable();
        if sources.peek().is_none() {
            return;
        }
        let made: BTreeSet<u32> = sources
            .flat_map(|paths| match paths.most {
                Some(most) => paths.fewest..=most,
                None => paths.fewest.max(least)..=most,
            })
            .filter(|&scatterings| scatterings > 0)
            .collect();
        let wanted: BTreeSet<u32> = (least.max(1)..=most).collect();
        if made == wanted {
            return;
        }
        let cause = Cause::OtherPaths { transport: text.value.clone(), wanted: told(&wanted), made: told(&made) };
        let fault = Fault::at(text.span, "", cause);
        self.faults.push(match transport_of(&made) {
            Some(transport) => fault.help(format!("these passes make `transport = \"{transport}\"`")),
            None => fault.help("other passes, or domains of samples, make other paths"),
        });
    }
}

/// "paths of 1, 2 or 3 scatterings".
fn told(scatterings: &BTreeSet<u32>) -> String {
    match (scatterings.first(), scatterings.last()) {
        (Some(1), Some(1)) => "direct light".into(),
        (Some(first), Some(last)) if (last - first) as usize + 1 == scatterings.len() && last > first => {
            format!("paths of {first} to {last} scatterings")
        }
        (Some(_), Some(_)) => format!("paths of {} scatterings", list(&scatterings.iter().map(u32::to_string).collect::<Vec<_>>())),
        _ => "no scattered light".into(),
    }
}

fn transport_of(scatterings: &BTreeSet<u32>) -> Option<Transport> {
    let (&first, &last) = (scatterings.first()?, scatterings.last()?);
    let all = [Transport::Direct, Transport::Indirect(last.max(2) - 1), Transport::Full(last - 1)];
    all.into_iter().find(|transport| {
        let (least, most) = transport.scatterings();
        (least.max(1), most) == (first, last) && (last - first) as usize + 1 == scatterings.len()
    })
}

#[cfg(test)]
mod tests {
    use crate::{Contract, ContractError, Contracts, Direction, Document, Extent, Graph, Port, Shelf, Slots, Source, WireType};
    use std::collections::BTreeMap;

    /// Passes `direct`, `indirect`, `any` and `none` with an output each, and `sum` of two inputs.
    struct Lights;

    impl Contracts for Lights {
        fn kinds(&self) -> Vec<String> {
            ["direct", "indirect", "any", "none", "sum"].map(str::to_owned).to_vec()
        }

        fn slots(&self) -> BTreeMap<String, Vec<String>> {
            BTreeMap::new()
        }

        fn contract(&self, kind: &str, _: &Slots) -> Result<Contract, ContractError> {
            let color = WireType { element: "vec4<f32>".into(), layout: "vec4<f32>".into(), stride: 16, extent: Extent::Pixels };
            let port =
                |name: &str, direction| Port { name: name.into(), direction, ty: color.clone(), optional: false, doc: String::new() };
            let inputs = if kind == "sum" { vec![port("a", Direction::In), port("b", Direction::In)] } else { Vec::new() };
            let paths = match kind {
                "direct" => Some("1"),
                "indirect" => Some("2.."),
                "any" => Some("0.."),
                _ => None,
            };
            let ports = inputs.into_iter().chain([port("color", Direction::Out)]).collect();
            Ok(Contract { ports, paths: paths.map(|text| text.parse().expect("a range")), ..Contract::default() })
        }
    }

    fn fault(transport: &str, body: &str) -> Option<String> {
        let text = format!("transport = '{transport}'\noutput = 'out.color'\n{body}");
        let document =
            Document::parse(Source::new("test.toml", text), &Shelf::new("", Vec::<(String, String)>::new())).expect("it can be read");
        Graph::check(&document, &Lights)
            .err()
            .map(|faults| faults.list.iter().map(|fault| format!("{} ({:?})", fault.cause, fault.help)).collect())
    }

    const SUM: &str =
        "[pass.d]\nkind = 'direct'\n[pass.i]\nkind = 'indirect'\n[pass.out]\nkind = 'sum'\nin.a = 'd.color'\nin.b = 'i.color'\n";

    #[test]
    fn passes_make_what_the_transport_says() {
        let one = |kind: &str| format!("[pass.out]\nkind = '{kind}'\n");
        for (transport, body) in [
            ("direct", one("direct")),
            ("indirect:3", one("indirect")),
            ("full:8", one("any")),
            ("emission", one("any")),
            ("full:2", SUM.to_owned()),
            ("full:0", SUM.to_owned()),
            ("full:8", one("none")),
            // What nobody needs brings nothing.
            ("direct", one("direct") + "[pass.i]\nkind = 'indirect'\n"),
        ] {
            assert_eq!(fault(transport, &body), None, "{transport}");
        }
    }

    #[test]
    fn other_paths_than_the_transport_says_are_a_fault() {
        let one = |kind: &str| format!("[pass.out]\nkind = '{kind}'\n");
        let says = |transport: &str, body: &str, words: [&str; 2]| {
            let found = fault(transport, body).unwrap_or_else(|| panic!("{transport}: no fault"));
            assert!(words.iter().all(|word| found.contains(word)), "{found}");
        };
        says(
            "full:4",
            &one("direct"),
            ["`full:4` is paths of 1 to 5 scatterings, and the passes make direct light", "transport = \\\"direct\\\""],
        );
        says("indirect:2", &one("direct"), ["paths of 2 to 3 scatterings", "direct light"]);
        says("direct", &one("indirect"), ["no scattered light", "other passes"]);
        says("full:2", &one("indirect"), ["the passes make paths of 2 to 3 scatterings", "indirect:2"]);
        says("indirect:2", SUM, ["the passes make paths of 1 to 3 scatterings", "full:2"]);
        says("emission", SUM, ["is no scattered light", "direct"]);
    }
}
