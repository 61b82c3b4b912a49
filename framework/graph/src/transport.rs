//! Which light paths an image holds.

use std::{fmt, str::FromStr};

/// Light paths, counted in scatterings between camera and emitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// camera – emitter.
    Emission,
    /// camera – x1 – emitter.
    Direct,
    /// One to N further bounces: camera – x1 – x2 – emitter is `indirect:1`.
    Indirect(u32),
    /// emission + direct + indirect:N.
    Full(u32),
}

/// The longest N that `indirect:N` and `full:N` take.
pub const MAX_BOUNCES: u32 = 64;

impl Transport {
    /// Fewest and most scatterings: 0 is emission seen directly, 1 is direct light. Handed to shaders as the overrides
    /// `transport_min` and `transport_max`.
    pub fn scatterings(self) -> (u32, u32) {
        match self {
            Transport::Emission => (0, 0),
            Transport::Direct => (1, 1),
            Transport::Indirect(n) => (2, n + 1),
            Transport::Full(n) => (0, n + 1),
        }
    }
}

impl serde::Serialize for Transport {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for Transport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Transport::Emission => f.write_str("emission"),
            Transport::Direct => f.write_str("direct"),
            Transport::Indirect(n) => write!(f, "indirect:{n}"),
            Transport::Full(n) => write!(f, "full:{n}"),
        }
    }
}

/// The text names no transport.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("`{0}` is no transport: write emission, direct, indirect:N (N from 1 to 64) or full:N (N from 0 to 64)")]
pub struct TransportError(pub String);

impl FromStr for Transport {
    type Err = TransportError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || TransportError(text.to_owned());
        let count = |digits: &str, least: u32| digits.parse::<u32>().ok().filter(|n| (least..=MAX_BOUNCES).contains(n)).ok_or_else(wrong);
        match text.split_once(':') {
            None if text == "emission" => Ok(Transport::Emission),
            None if text == "direct" => Ok(Transport::Direct),
            Some(("indirect", n)) => Ok(Transport::Indirect(count(n, 1)?)),
            Some(("full", n)) => Ok(Transport::Full(count(n, 0)?)),
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_value_agree() {
        for (text, range) in [
            ("emission", (0, 0)),
            ("direct", (1, 1)),
            ("indirect:1", (2, 2)),
            ("indirect:3", (2, 4)),
            ("full:0", (0, 1)),
            ("full:4", (0, 5)),
        ] {
            let transport: Transport = text.parse().unwrap();
            assert_eq!(transport.scatterings(), range);
            assert_eq!(transport.to_string(), text);
        }
        for text in ["", "indirect", "indirect:0", "full:65", "full:-1", "direct:1", "emission:0"] {
            assert!(text.parse::<Transport>().is_err(), "{text}");
        }
    }
}
