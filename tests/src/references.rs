//! Images of Mitsuba 3, kept in `tests/external/references`; all have 64×36 pixels.

use aquifer_lab::film::Film;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::path::Path;

const SIZE: [u32; 2] = [64, 36];

/// An image by its file name: mean and variance of the mean, from `R G B` and `SE.R SE.G SE.B`.
///
/// # Panics
/// When there is none of that name, or it holds something else.
pub fn mitsuba(name: &str) -> Film {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("external/references").join(name);
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes().from_file(&path);
    let image = image.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let channel = |name: &str| -> Vec<f32> {
        let list = &image.layer_data.channel_data.list;
        let found = list.iter().find(|channel| channel.name.eq(name)).unwrap_or_else(|| panic!("no channel {name}"));
        match &found.sample_data {
            FlatSamples::F32(values) => values.clone(),
            other => panic!("channel {name} holds {other:?}"),
        }
    };
    let three = |names: [&str; 3]| -> Vec<[f32; 3]> {
        let [r, g, b] = names.map(channel);
        (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect()
    };
    let error = three(["SE.R", "SE.G", "SE.B"]);
    let variance = error.into_iter().map(|pixel| pixel.map(|error| error * error)).collect();
    Film { variance: Some(variance), ..Film::new(SIZE, three(["R", "G", "B"])).expect("the reference has 64×36 pixels") }
}
