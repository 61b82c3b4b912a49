//! Films as OpenEXR files: a single part with dotted layers, facts as attributes.

mod attributes;
mod order;

use super::{Film, FilmError, channels};
use exr::{
    meta::MetaData,
    prelude::{
        AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, ReadChannels as _,
        ReadLayers as _, WritableImage as _,
    },
};
use std::{
    fs::File,
    io::{Cursor, Seek},
    path::Path,
};

/// Bytes of pixels that a byte of a file can stand for. Deflate makes 1,032 of one at most; other compressions need some 100 bytes for each block of 32
/// rows, however black it is.
const LARGEST_RATIO: u64 = 1 << 16;

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// How samples are stored; nothing is lost either way.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Packing {
    /// ZIP16.
    Packed,
    /// As they are: for films that are noise, which are a third larger then and written at once.
    Plain,
}

/// The bytes of a file; equal films make equal ones. Errors name `path`.
pub(super) fn encode(film: &Film, path: &Path, packing: Packing) -> Result<Vec<u8>, FilmError> {
    let failed = |source| FilmError::Exr { path: path.to_owned(), source };
    let image = Image::from_layer(layer(film, path, packing)?);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(failed)?;
    let mut bytes = bytes.into_inner();
    order::sort_attributes(&mut bytes);
    Ok(bytes)
}

fn layer(film: &Film, path: &Path, packing: Packing) -> Result<FlatLayer, FilmError> {
    let mut attributes = LayerAttributes { software_name: Some("Aquifer".into()), ..LayerAttributes::default() };
    if let Some(facts) = &film.facts {
        attributes.other = attributes::from_facts(facts, path)?;
    }
    let channels = channels::split(film).into_iter().map(|(name, plane)| AnyChannel::new(name, FlatSamples::F32(plane)));
    let compression = match packing {
        Packing::Packed => Compression::ZIP16,
        Packing::Plain => Compression::Uncompressed,
    };
    let encoding = Encoding { compression, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let size = (film.size[0] as usize, film.size[1] as usize);
    Ok(Layer::new(size, attributes, encoding, AnyChannels::sort(channels.collect())))
}

/// Reads the first part; other programs' files need `R`, `G` and `B`, in whatever precision.
pub(super) fn read(path: &Path) -> Result<Film, FilmError> {
    let opening = |source| FilmError::Open { path: path.to_owned(), source };
    let mut file = File::open(path).map_err(opening)?;
    check_length(&file, file.metadata().map_err(opening)?.len(), path)?;
    file.rewind().map_err(opening)?;
    let mut layer = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_unbuffered(file)
        .map_err(|source| FilmError::Exr { path: path.to_owned(), source })?
        .layer_data;
    let size = [layer.size.width() as u32, layer.size.height() as u32];
    let facts = attributes::to_facts(&layer.attributes.other, path)?;
    let film = channels::join(size, |name| take(&mut layer, name))
        .map_err(|channel| FilmError::MissingChannel { path: path.to_owned(), channel: channel.to_owned() })?;
    film.check()?;
    Ok(Film { facts, ..film })
}

/// Memory is asked for by what the header says, before the first pixel is read: so a file of a few bytes must not claim gigabytes.
fn check_length(file: &File, bytes: u64, path: &Path) -> Result<(), FilmError> {
    let meta = MetaData::read_from_unbuffered(file, false).map_err(|source| FilmError::Exr { path: path.to_owned(), source })?;
    for header in &meta.headers {
        let (size, bytes_per_pixel) = (header.layer_size, header.channels.bytes_per_pixel);
        let claimed = [size.width(), size.height(), bytes_per_pixel].into_iter().fold(1, |all, part| u64::saturating_mul(all, part as u64));
        if claimed > bytes.saturating_mul(LARGEST_RATIO) {
            return Err(FilmError::TooShort { path: path.to_owned(), bytes, size: [size.width(), size.height()], bytes_per_pixel });
        }
    }
    Ok(())
}

fn take(layer: &mut FlatLayer, name: &str) -> Option<Vec<f32>> {
    let list = &mut layer.channel_data.list;
    let index = list.iter().position(|channel| channel.name.eq(name))?;
    match list.swap_remove(index).sample_data {
        FlatSamples::F32(values) => Some(values),
        other => Some(other.values_as_f32().collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Facts, GraphText, Run, Runs};
    use super::*;

    fn film() -> Film {
        let size = [17, 19];
        let plane = |k: usize| (0..17 * 19).map(|i| [i as f32 * 0.37, (i * k) as f32 * 1e-9, 1e9 + i as f32]).collect::<Vec<_>>();
        Film {
            size,
            color: plane(1),
            variance: Some(plane(2)),
            albedo: Some(plane(3)),
            normal: Some(plane(4)),
            depth: Some((0..17 * 19).map(|i| i as f32).collect()),
            facts: Some(Facts {
                samples_per_pixel: 64,
                render_seconds: 1.25,
                graph: GraphText::new("title = \"Straße – naïve\"\n"),
                scene: "cornell".into(),
                environment: Some("sky.exr 12ab".into()),
                camera: "main".into(),
                animation_time: 0.25,
                transport: "full:4".into(),
                runs: Runs::new(vec![Run { seed: u64::MAX, first_frame: 32, frames: 32 }, Run { seed: 1, first_frame: 0, frames: 32 }])
                    .unwrap(),
                adapter: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
                version: "0.1.0".into(),
            }),
        }
    }

    #[test]
    fn everything_survives_and_bytes_are_deterministic() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.exr"), folder.path().join("b.exr"));
        film().write(&a).unwrap();
        assert_eq!(Film::read(&a).unwrap(), film());
        film().write(&b).unwrap();
        assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
    }

    #[test]
    fn a_short_file_that_claims_gigabytes_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        Film::new([2, 1], vec![[0.5; 3]; 2]).unwrap().write(&path).unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        let window = bytes.windows(11).position(|at| at == b"dataWindow\0").unwrap();
        // Name, type and length, then x and y of the first and the last pixel.
        let last = window + "dataWindow\0box2i\0".len() + 4 + 8;
        for at in [last, last + 4] {
            bytes[at..at + 4].copy_from_slice(&29_999_i32.to_le_bytes());
        }
        std::fs::write(&path, &bytes).unwrap();
        let told = Film::read(&path).unwrap_err().to_string();
        assert!(told.contains("cannot hold 30000×30000 pixels of 12 bytes"), "{told}");
    }

    #[test]
    fn colour_alone_survives() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let plain = Film::new([1, 2], vec![[0.0, 1.0, 2.0], [f32::INFINITY, f32::MIN_POSITIVE, -1.0]]).unwrap();
        plain.write(&path).unwrap();
        assert_eq!(Film::read(&path).unwrap(), plain);
    }

    #[test]
    fn other_programs_files_are_read_or_refused_with_the_channel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        exr::prelude::write_rgb_file(&path, 2, 1, |x, _| (x as f32, exr::prelude::f16::from_f32(0.5), 2.0_f32)).unwrap();
        assert_eq!(Film::read(&path).unwrap().color, [[0.0, 0.5, 2.0], [1.0, 0.5, 2.0]]);
        let depth_only = AnyChannels::sort([AnyChannel::new("Z", FlatSamples::F32(vec![1.0]))].into_iter().collect());
        Image::from_channels((1, 1), depth_only).write().to_file(&path).unwrap();
        assert_eq!(Film::read(&path).unwrap_err().to_string(), format!("`{}` has no channel `R`", path.display()));
    }

    #[test]
    fn rubbish_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        assert!(matches!(Film::read(&path), Err(FilmError::Open { .. })));
        film().write(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        for length in [0, 3, 8, 100, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..length]).unwrap();
            assert!(matches!(Film::read(&path), Err(FilmError::Exr { .. })), "{length}");
        }
    }

    #[test]
    fn a_plane_of_the_wrong_size_is_named() {
        let film = Film { depth: Some(vec![0.0]), ..film() };
        let error = film.write(Path::new("never.exr")).unwrap_err();
        assert_eq!(error.to_string(), "depth holds 1 pixels, an image of 17×19 needs 323");
    }
}
