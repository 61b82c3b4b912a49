//! Numbers and facts as people write them.

use crate::compare::report::{Cell, Protocol};
use minijinja::HtmlEscape;

/// Three significant digits; very small and large numbers as powers of ten.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "undefined".into() } else { "∞".into() };
    }
    if value == 0.0 {
        return "0".into();
    }
    let text = format!("{value:.2e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = match exponent {
        -3..=1 => format!("{value:.*}", (2 - exponent) as usize),
        2..=4 => format!("{value:.0}"),
        _ => format!("{mantissa}·10{}", superscript(exponent)),
    };
    text.replace('-', "−")
}

fn superscript(exponent: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    exponent.to_string().chars().map(raised).collect()
}

/// A share as percent with its sign.
pub(super) fn signed_percent(share: f64) -> String {
    let sign = if share < 0.0 { "−" } else { "+" };
    format!("{sign}{} %", number(100.0 * share.abs()))
}

/// Text for the page, what stands between backticks as code.
pub(super) fn prose(text: &str) -> String {
    let escaped = HtmlEscape(text).to_string();
    let parts = escaped.split('`').enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() }).collect()
}

/// `12,345`
pub(super) fn thousands(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `2026-11-25 03:04 UTC`, of seconds since 1970 (days to date after Hinnant, *chrono-compatible low-level date algorithms*).
pub(super) fn date(unix: u64) -> String {
    let (days, second) = (unix / 86_400, unix % 86_400);
    let z = days + 719_468;
    let (era, day_of_era) = (z / 146_097, z % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let (day, month) = (day_of_year - (153 * shifted + 2) / 5 + 1, if shifted < 10 { shifted + 3 } else { shifted - 9 });
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02} {:02}:{:02} UTC", second / 3600, second / 60 % 60)
}

/// Words of a command, quoted where a shell would cut or change them.
pub(super) fn command(words: &[String]) -> String {
    let safe = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    let quote = |word: &String| match !word.is_empty() && word.chars().all(safe) {
        true => word.clone(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    };
    words.iter().map(quote).collect::<Vec<_>>().join(" ")
}

/// How often and with which knob a cell's graph was run.
pub(super) fn run_as(cell: &Cell) -> String {
    let used: Vec<_> = cell.variants.iter().filter(|variant| variant.weight > 0.0).collect();
    let variants = used.iter().map(|variant| {
        let run = match variant.knob {
            Some(knob) => format!("knob {}", number(knob)),
            None if variant.frames == 1 => "1 frame".into(),
            None => format!("{} frames", variant.frames),
        };
        if used.len() == 1 { run } else { format!("{} % {run}", number(100.0 * variant.weight)) }
    });
    variants.collect::<Vec<_>>().join(" + ")
}

/// What was measured.
pub(super) fn protocol(protocol: &Protocol) -> String {
    let seeds = |seeds: u32| format!("{seeds} independent seeds");
    let jitter = |centred: bool| if centred { "; every film samples the middle of the pixel" } else { "" };
    match *protocol {
        Protocol::Frame { warm_up, seeds: n, centred } => {
            format!("one frame after {warm_up} frames of warm-up (graphs without history need none); {}{}", seeds(n), jitter(centred))
        }
        Protocol::Accumulate { warm_up, frames, seeds: n, centred } => {
            format!("the mean of up to {frames} frames after {warm_up} frames of warm-up; {}{}", seeds(n), jitter(centred))
        }
        Protocol::Trace { frames, step, seeds: n, centred } => {
            format!("the error of each of {frames} frames, {step:.4} s apart; {}{}", seeds(n), jitter(centred))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::report::Variant;

    #[test]
    fn numbers() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.00"),
            (-12.345, "−12.3"),
            (123.45, "123"),
            (0.012_345, "0.0123"),
            (0.001_234_5, "0.00123"),
            (1.2345e-4, "1.23·10⁻⁴"),
            (98_765.0, "98765"),
            (1.5e6, "1.50·10⁶"),
            (9.999, "10.0"),
            (f64::NAN, "undefined"),
            (f64::INFINITY, "∞"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!((signed_percent(-0.0123), thousands(1_234_567), thousands(12)), ("−1.23 %".into(), "1,234,567".into(), "12".into()));
    }

    #[test]
    fn runs_that_count() {
        let variant = |frames, weight| Variant { frames, weight, ..Variant::default() };
        let run = |variants: Vec<Variant>| run_as(&Cell { variants, ..Cell::default() });
        assert_eq!(run(vec![variant(2, 1.0), variant(3, 0.0)]), "2 frames");
        assert_eq!(run(vec![variant(1, 0.25), variant(2, 0.75)]), "25.0 % 1 frame + 75.0 % 2 frames");
    }

    #[test]
    fn backticks_are_code() {
        assert_eq!(prose("`a<b>` is & stays"), "<code>a&lt;b&gt;</code> is &amp; stays");
    }

    #[test]
    fn dates_and_commands() {
        assert_eq!([0, 951_782_400, 1_795_575_845].map(date), ["1970-01-01 00:00 UTC", "2000-02-29 00:00 UTC", "2026-11-25 03:04 UTC"]);
        let words = ["aquifer", "compare", "a b", "it's", "x=1,2"].map(String::from);
        assert_eq!(command(&words), r"aquifer compare 'a b' 'it'\''s' x=1,2");
    }
}
