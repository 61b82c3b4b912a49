//! Elements of resources in words and numbers, by the layout that reflection gave them.

use aquifer_graph::WireType;

/// How the names of reservoirs begin.
pub const RESERVOIR: &str = "Reservoir<";

/// One number of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Members from the outside in: `sample.light`, `weight`, `normal.x`.
    pub path: String,
    offset: usize,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Float,
    Signed,
    Unsigned,
}

/// One element of a resource.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The resource.
    pub resource: String,
    /// Its element, as people read it.
    pub element: String,
    /// Member and value.
    pub values: Vec<(String, f64)>,
}

impl Record {
    /// Reads an element of that type.
    pub fn new(resource: String, ty: &WireType, bytes: &[u8]) -> Self {
        let values = leaves(&ty.layout).iter().map(|leaf| (leaf.path.clone(), leaf.number(bytes))).collect();
        Self { resource, element: ty.element.clone(), values }
    }

    /// A value by the last word of its path.
    pub fn value(&self, member: &str) -> Option<f64> {
        self.values.iter().find(|(path, _)| path.rsplit('.').next() == Some(member) || path == member).map(|(_, value)| *value)
    }
}

impl Leaf {
    /// The number in an element; NaN where the element is shorter than its layout.
    pub fn number(&self, element: &[u8]) -> f64 {
        let Some(word) = element.get(self.offset..self.offset + 4).and_then(|word| word.try_into().ok()) else { return f64::NAN };
        match self.kind {
            Kind::Float => f64::from(f32::from_le_bytes(word)),
            Kind::Signed => f64::from(i32::from_le_bytes(word)),
            Kind::Unsigned => f64::from(u32::from_le_bytes(word)),
        }
    }
}

/// Is an element of this layout a colour?
pub fn is_color(layout: &str) -> bool {
    matches!(layout, "vec3<f32>" | "vec4<f32>")
}

/// The numbers of an element, from a layout's canonical text: `Moments{mean@0:vec3<f32>,count@12:u32}/16`. Members of types that hold
/// no plain numbers are left out.
pub fn leaves(layout: &str) -> Vec<Leaf> {
    let mut found = Vec::new();
    walk(layout, "", 0, &mut found);
    found
}

fn walk(layout: &str, path: &str, offset: usize, found: &mut Vec<Leaf>) {
    if let Some((element, count)) = layout.strip_prefix("array<").and_then(|rest| rest.strip_suffix('>')?.rsplit_once(", ")) {
        let (Ok(count), Some(stride)) = (count.parse::<usize>(), stride(element)) else { return };
        (0..count).for_each(|index| walk(element, &format!("{path}[{index}]"), offset + index * stride, found));
        return;
    }
    if let Some((_, rest)) = layout.split_once('{') {
        let Some((members, _)) = rest.rsplit_once('}') else { return };
        for member in split(members) {
            let Some((name, (place, ty))) = member.split_once('@').and_then(|(name, rest)| Some((name, rest.split_once(':')?))) else {
                continue;
            };
            let Ok(place) = place.parse::<usize>() else { continue };
            let path = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
            walk(ty, &path, offset + place, found);
        }
        return;
    }
    let kind = |scalar: &str| match scalar {
        "f32" => Some(Kind::Float),
        "i32" => Some(Kind::Signed),
        "u32" => Some(Kind::Unsigned),
        _ => None,
    };
    if let Some(kind) = kind(layout) {
        let path = if path.is_empty() { "value" } else { path }.to_owned();
        found.push(Leaf { path, offset, kind });
        return;
    }
    let vector = layout.strip_prefix("vec").and_then(|rest| rest.strip_suffix('>')?.split_once('<'));
    let Some((Ok(count), Some(kind))) = vector.map(|(count, scalar)| (count.parse::<usize>(), kind(scalar))) else { return };
    for (index, axis) in ["x", "y", "z", "w"].into_iter().take(count).enumerate() {
        let path = if path.is_empty() { axis.to_owned() } else { format!("{path}.{axis}") };
        found.push(Leaf { path, offset: offset + 4 * index, kind });
    }
}

/// Bytes from one element of an array to the next, for those whose layout tells.
fn stride(element: &str) -> Option<usize> {
    match element.rsplit_once("}/") {
        Some((_, size)) => size.parse().ok(),
        None => matches!(element, "f32" | "i32" | "u32").then_some(4),
    }
}

/// At the commas that lie in no brackets.
fn split(members: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0_usize, 0, Vec::new());
    for (at, letter) in members.char_indices() {
        match letter {
            '{' | '<' => depth += 1,
            '}' | '>' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push(&members[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&members[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_graph::Extent;

    #[test]
    fn nested_members_are_found_at_their_places() {
        let layout = "Reservoir{sample@0:Sample{light@0:u32,uv@8:vec2<f32>}/16,weight@16:f32,odd@20:array<f32, 2>,confidence@28:i32}/32";
        let mut bytes = vec![0; 32];
        bytes[0..4].copy_from_slice(&7_u32.to_le_bytes());
        bytes[12..16].copy_from_slice(&0.25_f32.to_le_bytes());
        bytes[16..20].copy_from_slice(&2.5_f32.to_le_bytes());
        bytes[28..32].copy_from_slice(&(-3_i32).to_le_bytes());
        let ty = WireType { element: "Reservoir<di>".into(), layout: layout.into(), stride: 32, extent: Extent::Pixels };
        let record = Record::new("spatial.reservoir".into(), &ty, &bytes);
        let expected = [
            ("sample.light", 7.0),
            ("sample.uv.x", 0.0),
            ("sample.uv.y", 0.25),
            ("weight", 2.5),
            ("odd[0]", 0.0),
            ("odd[1]", 0.0),
            ("confidence", -3.0),
        ];
        assert_eq!(record.values, expected.map(|(path, value)| (path.to_owned(), value)));
        assert_eq!((record.value("light"), record.value("confidence"), record.value("none")), (Some(7.0), Some(-3.0), None));
    }

    #[test]
    fn arrays_of_records_are_unrolled() {
        let found = leaves("T{count@0:u32,events@4:array<E{kind@0:u32,first@4:f32}/8, 2>}/20");
        let paths: Vec<(&str, usize)> = found.iter().map(|leaf| (leaf.path.as_str(), leaf.offset)).collect();
        assert_eq!(paths, [("count", 0), ("events[0].kind", 4), ("events[0].first", 8), ("events[1].kind", 12), ("events[1].first", 16)]);
    }

    #[test]
    fn plain_elements_have_numbers_too() {
        assert_eq!(leaves("f32").len(), 1);
        let paths: Vec<String> = leaves("vec3<u32>").into_iter().map(|leaf| leaf.path).collect();
        assert_eq!(paths, ["x", "y", "z"]);
        assert!(leaves("mat3x3<f32>").is_empty());
        assert!(leaves("f32")[0].number(&[0, 0]).is_nan());
    }
}
