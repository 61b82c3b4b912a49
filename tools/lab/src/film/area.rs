//! Which pixels of an image count.

use super::{Film, luminance};
use std::{fmt, str::FromStr};

/// A rectangle of pixels, written `X,Y,WIDTHxHEIGHT`; the top left pixel is 0,0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left and top.
    pub corner: [u32; 2],
    /// Pixels across and down.
    pub size: [u32; 2],
}

/// Why no pixels can be chosen.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum AreaError {
    /// The text is no region.
    #[error("`{0}` is no region: write X,Y,WIDTHxHEIGHT, e.g. 100,40,64x64")]
    NoRegion(String),
    /// A region leaves the image.
    #[error("region {region} leaves the image of {}×{}", size[0], size[1])]
    Outside {
        /// The region.
        region: Region,
        /// Of the image.
        size: [u32; 2],
    },
    /// A mask of another size.
    #[error("the mask has {}×{} pixels, the image {}×{}", mask[0], mask[1], size[0], size[1])]
    MaskSize {
        /// Of the mask.
        mask: [u32; 2],
        /// Of the image.
        size: [u32; 2],
    },
    /// No pixel is left.
    #[error("no pixel is left: the mask is black there")]
    Empty,
}

impl FromStr for Region {
    type Err = AreaError;

    fn from_str(text: &str) -> Result<Self, AreaError> {
        let no_region = || AreaError::NoRegion(text.to_owned());
        let mut numbers = [0_u32; 4];
        let mut parts = text.split([',', 'x', '×']);
        for number in &mut numbers {
            *number = parts.next().and_then(|part| part.trim().parse().ok()).ok_or_else(no_region)?;
        }
        let [x, y, width, height] = numbers;
        if parts.next().is_some() || width == 0 || height == 0 {
            return Err(no_region());
        }
        Ok(Self { corner: [x, y], size: [width, height] })
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}x{}", self.corner[0], self.corner[1], self.size[0], self.size[1])
    }
}

/// Pixels of an image, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Area {
    size: [u32; 2],
    /// Numbers of pixels, row by row from the top.
    pixels: Vec<usize>,
}

impl Area {
    /// Every pixel.
    pub fn whole(size: [u32; 2]) -> Self {
        Self { size, pixels: (0..size[0] as usize * size[1] as usize).collect() }
    }

    /// The pixels of a region.
    pub fn region(size: [u32; 2], region: Region) -> Result<Self, AreaError> {
        let fits = (0..2).all(|i| u64::from(region.corner[i]) + u64::from(region.size[i]) <= u64::from(size[i]));
        if !fits {
            return Err(AreaError::Outside { region, size });
        }
        let [left, top] = region.corner.map(|c| c as usize);
        let [width, height] = region.size.map(|side| side as usize);
        let row = |y: usize| y * size[0] as usize + left..y * size[0] as usize + left + width;
        Ok(Self { size, pixels: (top..top + height).flat_map(row).collect() })
    }

    /// Those of its pixels where the mask's luminance is at least one half.
    pub fn masked(self, mask: &Film) -> Result<Self, AreaError> {
        if mask.size != self.size {
            return Err(AreaError::MaskSize { mask: mask.size, size: self.size });
        }
        let lit = |&i: &usize| luminance(mask.color[i].map(f64::from)) >= 0.5;
        let pixels: Vec<usize> = self.pixels.into_iter().filter(lit).collect();
        if pixels.is_empty() { Err(AreaError::Empty) } else { Ok(Self { size: self.size, pixels }) }
    }

    /// Size of the image.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How many pixels.
    pub fn count(&self) -> usize {
        self.pixels.len()
    }

    /// Their numbers.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.pixels.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_written_and_read() {
        let region = Region { corner: [3, 4], size: [5, 6] };
        assert_eq!((region.to_string().parse(), "3, 4, 5×6".parse()), (Ok(region), Ok(region)));
        for wrong in ["", "1,2", "1,2,3", "1,2,0x3", "-1,2,3x4", "1,2,3x4x5", "a,b,cxd"] {
            assert_eq!(wrong.parse::<Region>(), Err(AreaError::NoRegion(wrong.into())));
        }
    }

    #[test]
    fn pixels_by_hand() {
        let area = Area::region([4, 3], "1,1,2x2".parse().unwrap()).unwrap();
        assert_eq!(area.pixels().collect::<Vec<_>>(), [5, 6, 9, 10]);
        let mut mask = Film::new([4, 3], vec![[0.0; 3]; 12]).unwrap();
        assert_eq!(area.clone().masked(&mask), Err(AreaError::Empty));
        (mask.color[6], mask.color[0]) = ([1.0; 3], [1.0; 3]);
        assert_eq!(area.clone().masked(&mask).unwrap().pixels().collect::<Vec<_>>(), [6]);
        assert!(area.masked(&Film::new([1, 1], vec![[1.0; 3]]).unwrap()).is_err());
        for outside in ["3,0,2x1", "0,3,1x1", "4294967295,0,2x1"] {
            assert!(matches!(Area::region([4, 3], outside.parse().unwrap()), Err(AreaError::Outside { .. })));
        }
    }
}
