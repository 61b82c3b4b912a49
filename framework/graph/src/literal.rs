//! Values as a graph file writes them, before anything is known of what they set.

use std::fmt;

/// A plain TOML value.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    /// `true`
    Bool(bool),
    /// `20`
    Integer(i64),
    /// `30.0`
    Float(f64),
    /// `"aces"`
    Text(String),
}

impl Literal {
    /// The type, as people say it, with its article.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Literal::Bool(_) => "true or false",
            Literal::Integer(_) => "a whole number",
            Literal::Float(_) => "a number with a point",
            Literal::Text(_) => "text",
        }
    }
}

/// As TOML writes it.
impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Literal::Bool(value) => write!(f, "{value}"),
            Literal::Integer(value) => write!(f, "{value}"),
            // Debug keeps the point: 30.0, not 30; TOML has no capitals in nan.
            Literal::Float(value) if value.is_nan() => f.write_str("nan"),
            Literal::Float(value) => write!(f, "{value:?}"),
            Literal::Text(value) => write!(f, "{}", toml::Value::from(value.as_str())),
        }
    }
}
