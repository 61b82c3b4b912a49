//! What a pass told of one pixel (`restir/witness_on`): what it looked at, carried and was offered, as one line for every input.

use crate::record::Record;

/// The port that witnesses write to.
pub const TESTIMONY: &str = "testimony";

const LOOKED: u32 = 1;
const CARRIED: u32 = 2;
const OFFERED: u32 = 3;

/// A pixel that was looked at, or whose sample was carried.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tried {
    /// Pixel, from the top left.
    pub pixel: [i32; 2],
    /// Of the frame before.
    pub before: bool,
    /// What spoke against its surface; `None` where nothing did, or nobody asked.
    pub against: Option<&'static str>,
    /// What its sample became.
    pub carried: Option<Carried>,
}

/// A sample at the receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Carried {
    /// Contribution weight W that it came with.
    pub weight: f32,
    /// Jacobian of the shift; 0: the shift does not exist.
    pub jacobian: f32,
    /// Target p̂ at the receiver.
    pub target: f32,
    /// Resampling weight.
    pub resampling: f32,
    /// It took the place of what was kept before.
    pub adopted: bool,
    /// It is what was kept in the end.
    pub kept: bool,
}

/// The lines of a record, in the order in which the pass did what they say.
pub fn lines(record: &Record) -> Vec<Tried> {
    let number = |path: String| record.values.iter().find(|(known, _)| *known == path).map_or(0.0, |(_, value)| *value);
    let mut lines: Vec<Tried> = Vec::new();
    // The line whose sample is about to be offered, and the one whose sample was adopted last.
    let (mut open, mut last): (Option<usize>, Option<usize>) = (None, None);
    for event in 0..number("count".to_owned()) as usize {
        let field = |name: &str| number(format!("events[{event}].{name}"));
        let (kind, place, detail) = (field("kind") as u32, field("place") as u32, field("detail") as u32);
        let (first, second) = (field("first") as f32, field("second") as f32);
        let pixel = [i32::from(place as u16 as i16), i32::from((place >> 16) as u16 as i16)];
        let before = kind >> 8 == 1;
        match kind & 0xff {
            LOOKED => lines.push(Tried { pixel, before, against: against(detail), carried: None }),
            CARRIED => {
                let carried = Some(Carried { weight: first, jacobian: second, ..Carried::default() });
                let known = lines
                    .iter()
                    .position(|line| (line.pixel, line.before) == (pixel, before) && line.against.is_none() && line.carried.is_none());
                match known {
                    Some(at) => lines[at].carried = carried,
                    None => lines.push(Tried { pixel, before, against: None, carried }),
                }
                open = Some(known.unwrap_or(lines.len() - 1));
            }
            OFFERED => {
                let Some(at) = open.take() else { continue };
                if let Some(carried) = &mut lines[at].carried {
                    (carried.target, carried.resampling, carried.adopted) = (first, second, detail == 1);
                }
                last = if detail == 1 { Some(at) } else { last };
            }
            _ => {}
        }
    }
    if let Some(carried) = last.and_then(|at| lines[at].carried.as_mut()) {
        carried.kept = true;
    }
    lines
}

/// The verdicts of `restir/neighbour`, in their order.
fn against(verdict: u32) -> Option<&'static str> {
    match verdict {
        0 => None,
        1 => Some("not on the film, or the pixel itself"),
        2 => Some("no surface"),
        3 => Some("too near or too far"),
        4 => Some("another normal"),
        _ => Some("unknown"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record of these events: (kind, place, detail, first, second).
    fn record(events: &[(u32, u32, u32, f32, f32)]) -> Record {
        let mut values = vec![("count".to_owned(), events.len() as f64)];
        for (index, (kind, place, detail, first, second)) in events.iter().enumerate() {
            let fields = [
                ("kind", f64::from(*kind)),
                ("place", f64::from(*place)),
                ("detail", f64::from(*detail)),
                ("first", f64::from(*first)),
                ("second", f64::from(*second)),
            ];
            values.extend(fields.map(|(name, value)| (format!("events[{index}].{name}"), value)));
        }
        Record { resource: "spatial.testimony".into(), element: "Testimony".into(), values }
    }

    #[test]
    fn each_input_is_one_line_and_the_last_adopted_is_kept() {
        let place = |x: u32, y: u32| x | (y << 16);
        let told = lines(&record(&[
            (LOOKED, place(0xffff, 3), 1, 0.0, 0.0),
            (LOOKED, place(5, 3), 0, 0.0, 0.0),
            (CARRIED, place(4, 3), 0, 2.0, 1.0),
            (OFFERED, 0, 1, 0.5, 1.0),
            (CARRIED, place(5, 3), 0, 3.0, 0.75),
            (OFFERED, 0, 1, 0.25, 0.5),
            (CARRIED | 1 << 8, place(4, 3), 0, 0.0, 0.0),
            (OFFERED, 0, 0, 0.0, 0.0),
        ]));
        assert_eq!(told.len(), 4);
        assert_eq!((told[0].pixel, told[0].against.is_some(), told[0].carried), ([-1, 3], true, None));
        let kept: Vec<bool> = told.iter().map(|line| line.carried.is_some_and(|carried| carried.kept)).collect();
        assert_eq!(kept, [false, true, false, false], "the neighbour's sample took the place of the pixel's own");
        let expected = Carried { weight: 3.0, jacobian: 0.75, target: 0.25, resampling: 0.5, adopted: true, kept: true };
        assert_eq!((told[1].pixel, told[1].carried), ([5, 3], Some(expected)));
        assert!(told[3].before && told[3].carried.is_some_and(|carried| carried.jacobian == 0.0));
    }
}
