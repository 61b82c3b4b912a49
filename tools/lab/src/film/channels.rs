//! Planes of a film as named EXR channels: the one place that knows the names.

use super::Film;

/// Names of the three channels of each colour-like plane.
const COLOR: [&str; 3] = ["R", "G", "B"];
const VARIANCE: [&str; 3] = ["Variance.R", "Variance.G", "Variance.B"];
const ALBEDO: [&str; 3] = ["Albedo.R", "Albedo.G", "Albedo.B"];
const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];
const DEPTH: &str = "Z";

/// One named channel.
pub(super) type Channel = (&'static str, Vec<f32>);

/// Every channel of `film`.
pub(super) fn split(film: &Film) -> Vec<Channel> {
    let triples =
        [(COLOR, Some(&film.color)), (VARIANCE, film.variance.as_ref()), (ALBEDO, film.albedo.as_ref()), (NORMAL, film.normal.as_ref())];
    let mut channels = Vec::new();
    for (names, plane) in triples {
        for (component, name) in names.into_iter().enumerate() {
            channels.extend(plane.map(|plane| (name, plane.iter().map(|pixel| pixel[component]).collect())));
        }
    }
    channels.extend(film.depth.as_ref().map(|depth| (DEPTH, depth.clone())));
    channels
}

/// A film from channels found by name; `Err` names the colour channel that is missing. A plane with only some of its channels
/// is another program's business, and left out.
pub(super) fn join(size: [u32; 2], mut take: impl FnMut(&str) -> Option<Vec<f32>>) -> Result<Film, &'static str> {
    let mut planes = COLOR.map(|name| (name, take(name)));
    if let Some((name, _)) = planes.iter().find(|(_, plane)| plane.is_none()) {
        return Err(name);
    }
    let color = interleave(planes.each_mut().map(|(_, plane)| plane.take())).unwrap_or_default();
    Ok(Film {
        size,
        color,
        variance: interleave(VARIANCE.map(&mut take)),
        albedo: interleave(ALBEDO.map(&mut take)),
        normal: interleave(NORMAL.map(&mut take)),
        depth: take(DEPTH),
        facts: None,
    })
}

fn interleave(planes: [Option<Vec<f32>>; 3]) -> Option<Vec<[f32; 3]>> {
    let [Some(x), Some(y), Some(z)] = planes else { return None };
    Some(x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect())
}
