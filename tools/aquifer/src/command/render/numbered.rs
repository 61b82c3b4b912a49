//! Names of files that carry the number of a frame: `shot.####.exr` or `shot.{frame}.exr`.

use crate::failure::Failure;
use std::path::{Path, PathBuf};

/// Digits that `{frame}` is filled up to.
const DIGITS: usize = 4;

/// A name with a place for a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbered {
    before: String,
    digits: usize,
    after: String,
}

impl Numbered {
    /// From what was typed.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let text = path.to_string_lossy();
        let (at, length, digits) = match (text.find("{frame}"), text.find('#')) {
            (Some(at), _) => (at, "{frame}".len(), DIGITS),
            (None, Some(at)) => {
                let count = text[at..].chars().take_while(|&c| c == '#').count();
                (at, count, count)
            }
            (None, None) => {
                let stem = path.with_extension("");
                let example = format!("{}.####.{}", stem.display(), path.extension().unwrap_or_default().to_string_lossy());
                return Err(Failure::new(format!("a sequence needs a number in the name of each image: write `{example}`")));
            }
        };
        Ok(Self { before: text[..at].to_owned(), digits, after: text[at + length..].to_owned() })
    }

    /// The file of one frame.
    pub fn at(&self, frame: u32) -> PathBuf {
        let Self { before, digits, after } = self;
        format!("{before}{frame:0digits$}{after}").into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_where_they_are_asked_for() {
        let at = |name: &str, frame| Numbered::of(Path::new(name)).map(|numbered| numbered.at(frame)).unwrap();
        assert_eq!(at("a/shot.####.exr", 7), Path::new("a/shot.0007.exr"));
        assert_eq!(at("shot_##.png", 12345), Path::new("shot_12345.png"));
        assert_eq!(at("{frame}.exr", 3), Path::new("0003.exr"));
        let Failure::Failed(error) = Numbered::of(Path::new("a/shot.exr")).unwrap_err() else { panic!("it will fail next time too") };
        assert!(error.to_string().contains("`a/shot.####.exr`"), "{error}");
    }
}
