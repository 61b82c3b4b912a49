//! Values as they are typed.

use aquifer_graph::Transport;
use aquifer_lab::film::Format;
use std::{
    ops::Range,
    path::{Path, PathBuf},
};

/// The longest side of an image. A guard against slips of the finger; the adapter's own limits are checked later.
const LONGEST_SIDE: u32 = 32_768;

/// `256x144`
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or("write WIDTHxHEIGHT, e.g. 640x360")?;
    let side = |digits: &str| match digits.trim().parse::<u32>() {
        Ok(0) => Err("an image needs at least one pixel".to_owned()),
        Ok(side) if side <= LONGEST_SIDE => Ok(side),
        _ => Err(format!("`{digits}` is no number of pixels from 1 to {LONGEST_SIDE}")),
    };
    Ok([side(width)?, side(height)?])
}

/// `X,Y,Z:X,Y,Z`: where a camera stands, and what it looks at.
pub fn look(text: &str) -> Result<[[f32; 3]; 2], String> {
    let refused = || "write FROM:AT, each as X,Y,Z, e.g. 0,1,5:0,1,0".to_owned();
    let point = |text: &str| -> Option<[f32; 3]> {
        let numbers: Vec<f32> =
            text.split(',').map(|number| number.trim().parse().ok().filter(|n: &f32| n.is_finite())).collect::<Option<_>>()?;
        numbers.try_into().ok()
    };
    let (from, at) = text.split_once(':').ok_or_else(refused)?;
    Ok([point(from).ok_or_else(refused)?, point(at).ok_or_else(refused)?])
}

/// Seconds, more than none.
pub fn seconds(text: &str) -> Result<f64, String> {
    match text.trim_end_matches('s').trim().parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(seconds),
        _ => Err("write a number of seconds above 0".to_owned()),
    }
}

/// Milliseconds, more than none.
pub fn milliseconds(text: &str) -> Result<f64, String> {
    match text.trim_end_matches("ms").trim().parse::<f64>() {
        Ok(milliseconds) if milliseconds.is_finite() && milliseconds > 0.0 => Ok(milliseconds),
        _ => Err("write a number of milliseconds above 0".to_owned()),
    }
}

/// A mean square error, more than none.
pub fn error(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(error) if error.is_finite() && error > 0.0 => Ok(error),
        _ => Err("write an error above 0, e.g. 1e-3".to_owned()),
    }
}

/// A share of a whole, more than none.
pub fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err("write a share above 0 and at most 1, e.g. 0.1".to_owned()),
    }
}

/// Frames to render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Frames {
    /// So many, into one image.
    Count(u32),
    /// These of an animation, into an image each.
    Range(Range<u32>),
}

/// `64` or `0..48`
pub fn frames(text: &str) -> Result<Frames, String> {
    let number = |digits: &str| digits.trim().parse::<u32>().map_err(|_| format!("`{digits}` is no number of a frame"));
    let Some((first, end)) = text.split_once("..") else {
        return match number(text)? {
            0 => Err("at least one frame is needed".to_owned()),
            count => Ok(Frames::Count(count)),
        };
    };
    let range = number(first)?..number(end)?;
    if range.is_empty() { Err(format!("no frame lies in {text}: the last number is not included")) } else { Ok(Frames::Range(range)) }
}

/// Frames in a second.
pub fn rate(text: &str) -> Result<f32, String> {
    match text.trim().parse::<f32>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 => Ok(rate),
        _ => Err("write a number of frames a second, above 0".to_owned()),
    }
}

/// Which light paths.
pub fn transport(text: &str) -> Result<Transport, String> {
    text.parse().map_err(|error: aquifer_graph::TransportError| error.to_string())
}

/// A `key=value` of the graph; what it means is checked with the graph.
pub fn setting(text: &str) -> Result<String, String> {
    match text.split_once('=') {
        Some((key, _)) if !key.trim().is_empty() => Ok(text.to_owned()),
        _ => Err("write PASS.PARAMETER=VALUE, e.g. spatial.taps=5".to_owned()),
    }
}

/// An image file to write.
pub fn image(text: &str) -> Result<PathBuf, String> {
    let path = Path::new(text);
    Format::of(path).map_err(|error| error.to_string())?;
    Ok(path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("256x144"), Ok([256, 144]));
        assert_eq!(size("1920×1080"), Ok([1920, 1080]));
        for wrong in ["", "256", "0x144", "256x0", "-1x2", "1x2x3", "99999x1", "ax b", "1.5x2"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_and_ranges_of_frames() {
        assert_eq!((frames("64"), frames("0..48")), (Ok(Frames::Count(64)), Ok(Frames::Range(0..48))));
        for wrong in ["", "0", "-1", "3..3", "4..3", "..", "1..", "1..x", "1.5", "0..99999999999"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
        assert_eq!(rate("23.976"), Ok(23.976));
        assert!(rate("0").is_err() && rate("-1").is_err() && rate("NaN").is_err());
    }

    #[test]
    fn times_and_settings() {
        assert_eq!((seconds("2.5"), seconds("10 s")), (Ok(2.5), Ok(10.0)));
        for wrong in ["0", "-1", "inf", "NaN", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
        assert_eq!(share("0.1"), Ok(0.1));
        for wrong in ["0", "-1", "1.5", "inf", "NaN", ""] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
        assert!(setting("spatial.taps=5").is_ok() && setting("spatial.taps").is_err() && setting("=5").is_err());
        assert!(image("a/b.EXR").is_ok() && image("a.png").is_ok() && image("a.jpg").is_err() && image("exr").is_err());
    }
}
