//! Taking turns.

use serde::Serialize;
use std::time::Instant;

/// Something that can be timed.
pub type Contestant<'a, E> = Box<dyn FnMut() -> Result<(), E> + 'a>;

/// Seconds of each contestant in each round: `[contestant][round]`. A round before them, in which drivers compile and caches fill, is not
/// counted.
///
/// # Errors
/// The first of a contestant.
pub fn turns<E>(rounds: u32, contestants: &mut [Contestant<'_, E>]) -> Result<Vec<Vec<f64>>, E> {
    let mut seconds = vec![Vec::new(); contestants.len()];
    for round in 0..=rounds {
        for (contestant, times) in contestants.iter_mut().zip(&mut seconds) {
            let began = Instant::now();
            contestant()?;
            if round > 0 {
                times.push(began.elapsed().as_secs_f64());
            }
        }
    }
    Ok(seconds)
}

/// The middle of some numbers, with the quartiles around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Middle {
    /// A quarter is below.
    pub low: f64,
    /// Half is below.
    pub median: f64,
    /// A quarter is above.
    pub high: f64,
}

impl Middle {
    /// Of at least one number; quantiles between two numbers are interpolated.
    pub fn of(numbers: impl IntoIterator<Item = f64>) -> Option<Middle> {
        let mut sorted: Vec<f64> = numbers.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let quantile = |share: f64| {
            let place = share * last as f64;
            let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
            below + (above - below) * place.fract()
        };
        Some(Middle { low: quantile(0.25), median: quantile(0.5), high: quantile(0.75) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles() {
        assert_eq!(Middle::of([]), None);
        assert_eq!(Middle::of([4.0, 1.0, 3.0, 2.0, 5.0]), Some(Middle { low: 2.0, median: 3.0, high: 4.0 }));
        assert_eq!(Middle::of([1.0, 2.0]), Some(Middle { low: 1.25, median: 1.5, high: 1.75 }));
    }

    #[test]
    fn contestants_take_turns_and_the_first_round_does_not_count() {
        let order = std::cell::RefCell::new(String::new());
        let contestant = |name: char| -> Contestant<'_, ()> {
            let order = &order;
            Box::new(move || {
                order.borrow_mut().push(name);
                Ok(())
            })
        };
        let seconds = turns(2, &mut [contestant('a'), contestant('b')]).unwrap();
        assert_eq!(*order.borrow(), "ababab");
        assert!(seconds.iter().all(|rounds| rounds.len() == 2));
    }
}
