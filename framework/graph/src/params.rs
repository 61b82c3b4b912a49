//! From what is written to the value of a parameter: type, range, choices.

use crate::{Cause, Literal, Param, Transport, Value, nearest::cure};
use std::fmt;

/// Parameters that the graph fills itself: the ends of [`Transport::scatterings`].
pub const RESERVED_PARAMS: [&str; 2] = ["transport_min", "transport_max"];

/// A value that does not suit its parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{cause}")]
pub struct ParamError {
    /// What is wrong.
    pub cause: Box<Cause>,
    /// How to cure it.
    pub help: Option<String>,
}

impl Param {
    /// The value that a literal gives this parameter: whole numbers suit number parameters, and a parameter with choices takes the
    /// quoted name or the index.
    pub fn value(&self, literal: &Literal) -> Result<Value, ParamError> {
        let value = match (self.default, literal) {
            (Value::Bool(_), Literal::Bool(value)) => Value::Bool(*value),
            (Value::I32(_) | Value::U32(_), Literal::Text(name)) if !self.choices.is_empty() => self.whole(self.choice(name)?)?,
            (Value::I32(_) | Value::U32(_), Literal::Integer(value)) => self.whole(*value)?,
            (Value::F32(_), Literal::Integer(value)) => self.number(*value as f64, literal)?,
            (Value::F32(_), Literal::Float(value)) => self.number(*value, literal)?,
            _ => return Err(self.wrong_type(literal)),
        };
        self.check_range(value, literal)?;
        Ok(value)
    }

    /// The value as a graph file writes it.
    pub fn literal(&self, value: Value) -> Literal {
        match value {
            Value::Bool(value) => Literal::Bool(value),
            Value::I32(value) => self.name_of(i64::from(value)),
            Value::U32(value) => self.name_of(i64::from(value)),
            // Through the shortest text, so that 0.1 stays 0.1.
            Value::F32(value) => Literal::Float(value.to_string().parse().unwrap_or(f64::from(value))),
        }
    }

    fn name_of(&self, value: i64) -> Literal {
        let name = usize::try_from(value).ok().and_then(|index| self.choices.get(index));
        name.map_or(Literal::Integer(value), |name| Literal::Text(name.clone()))
    }

    fn choice(&self, name: &str) -> Result<i64, ParamError> {
        let index = self.choices.iter().position(|choice| choice == name).map(|index| index as i64);
        index.ok_or_else(|| ParamError {
            cause: Box::new(Cause::UnknownChoice { param: self.name.clone(), choice: name.to_owned() }),
            help: Some(cure(name, &format!("choices of `{}`", self.name), self.choices.iter().map(String::as_str))),
        })
    }

    fn whole(&self, value: i64) -> Result<Value, ParamError> {
        let count = self.choices.len() as i64;
        if count > 0 && !(0..count).contains(&value) {
            return Err(self.out_of_range(0, count - 1, value));
        }
        match self.default {
            Value::I32(_) => i32::try_from(value).map(Value::I32).map_err(|_| self.out_of_range(i32::MIN, i32::MAX, value)),
            _ => u32::try_from(value).map(Value::U32).map_err(|_| self.out_of_range(u32::MIN, u32::MAX, value)),
        }
    }

    fn number(&self, value: f64, literal: &Literal) -> Result<Value, ParamError> {
        let single = value as f32;
        if single.is_finite() {
            return Ok(Value::F32(single));
        }
        let cause = Cause::NotFinite { param: self.name.clone(), found: literal.to_string() };
        let help = value.is_finite().then(|| format!("the largest number is {:e}", f32::MAX));
        Err(ParamError { cause: Box::new(cause), help })
    }

    fn check_range(&self, value: Value, literal: &Literal) -> Result<(), ParamError> {
        let (Some((least, most)), Some(number)) = (self.range, value.as_f64()) else { return Ok(()) };
        // The range's ends are decimal too: 0.1 as f32 lies above 0.1.
        let ends = if let Value::F32(_) = value { (f64::from(least as f32), f64::from(most as f32)) } else { (least, most) };
        if (ends.0..=ends.1).contains(&number) { Ok(()) } else { Err(self.out_of_range(least, most, literal)) }
    }

    /// Beyond the limits given, or the narrower ones of the parameter.
    fn out_of_range(&self, least: impl fmt::Display, most: impl fmt::Display, found: impl fmt::Display) -> ParamError {
        let what = format!("parameter `{}`", self.name);
        let (least, most) = match self.range {
            Some((least, most)) => (least.to_string(), most.to_string()),
            None => (least.to_string(), most.to_string()),
        };
        ParamError { cause: Box::new(Cause::OutOfRange { what, least, most, found: found.to_string() }), help: None }
    }

    fn wrong_type(&self, literal: &Literal) -> ParamError {
        let what = format!("parameter `{}`", self.name);
        let cause = Cause::WrongType { what, expected: self.type_name(), found: literal.type_name().to_owned() };
        ParamError { cause: Box::new(cause), help: self.retyped(literal).map(|cured| format!("write `{cured}`")) }
    }

    fn type_name(&self) -> String {
        match self.default {
            Value::Bool(_) => "true or false".to_owned(),
            Value::I32(_) | Value::U32(_) if !self.choices.is_empty() => "the quoted name of a choice, or its index".to_owned(),
            Value::I32(_) | Value::U32(_) => "a whole number".to_owned(),
            Value::F32(_) => "a number".to_owned(),
        }
    }

    /// The same value in the type that is wanted, where there is one: 5.0 → 5, "5" → 5, 1 → true.
    fn retyped(&self, literal: &Literal) -> Option<Literal> {
        let other = match (self.default, literal) {
            (Value::I32(_) | Value::U32(_), Literal::Float(value)) if value.fract() == 0.0 && value.abs() < 1e15 => {
                Literal::Integer(*value as i64)
            }
            (Value::I32(_) | Value::U32(_), Literal::Text(text)) => Literal::Integer(text.trim().parse().ok()?),
            (Value::F32(_), Literal::Text(text)) => Literal::Float(text.trim().parse().ok()?),
            (Value::Bool(_), Literal::Integer(value @ 0..=1)) => Literal::Bool(*value == 1),
            (Value::Bool(_), Literal::Text(text)) => Literal::Bool(text.trim().parse().ok()?),
            _ => return None,
        };
        self.value(&other).is_ok().then_some(other)
    }
}

impl Value {
    /// As a number; `None` for true and false.
    pub fn as_f64(self) -> Option<f64> {
        match self {
            Value::Bool(_) => None,
            Value::I32(value) => Some(f64::from(value)),
            Value::U32(value) => Some(f64::from(value)),
            Value::F32(value) => Some(f64::from(value)),
        }
    }

    /// A count in the type of this value.
    fn count(self, count: u32) -> Value {
        match self {
            Value::F32(_) => Value::F32(count as f32),
            Value::I32(_) => Value::I32(count.try_into().unwrap_or(i32::MAX)),
            Value::U32(_) | Value::Bool(_) => Value::U32(count),
        }
    }
}

/// The value of a parameter that the graph fills itself.
pub(crate) fn reserved(param: &Param, transport: Transport) -> Option<Value> {
    let (least, most) = transport.scatterings();
    let count = match param.name.as_str() {
        "transport_min" => least,
        "transport_max" => most,
        _ => return None,
    };
    Some(param.default.count(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn param(default: Value, range: Option<(f64, f64)>, choices: &[&str]) -> Param {
        let choices = choices.iter().map(|&choice| choice.to_owned()).collect();
        Param { name: "p".into(), default, range, choices, live: false, doc: String::new() }
    }

    #[test]
    fn literals_become_values_of_the_parameters_type() {
        let number = param(Value::F32(1.0), Some((0.1, 30.0)), &[]);
        assert_eq!(number.value(&Literal::Integer(3)), Ok(Value::F32(3.0)));
        assert_eq!(number.value(&Literal::Float(0.1)), Ok(Value::F32(0.1)), "an end of the range is inside, rounding or not");
        assert_eq!(number.literal(Value::F32(0.1)), Literal::Float(0.1));
        assert_eq!(number.value(&Literal::Float(30.0)), Ok(Value::F32(30.0)));
        assert!(number.value(&Literal::Float(30.001)).is_err());
        let operator = param(Value::U32(0), None, &["linear", "aces"]);
        assert_eq!(operator.value(&Literal::Text("aces".into())), Ok(Value::U32(1)));
        assert_eq!(operator.value(&Literal::Integer(1)), Ok(Value::U32(1)));
        assert_eq!(operator.literal(Value::U32(1)), Literal::Text("aces".into()));
    }

    #[test]
    fn limits_of_the_machine_types_hold() {
        for wrong in [-1, i64::from(u32::MAX) + 1] {
            assert!(param(Value::U32(0), None, &[]).value(&Literal::Integer(wrong)).is_err());
        }
        for wrong in [f64::NAN, f64::INFINITY, 1e39] {
            let error = param(Value::F32(0.0), None, &[]).value(&Literal::Float(wrong)).unwrap_err();
            assert_eq!(error.cause.code(), "not-finite");
        }
    }
}
