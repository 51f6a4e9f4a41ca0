//! `Index`: a point by its number from 1, or several in a row.

use std::ops::Range;
use std::str::FromStr;

use crate::cli::exit::{Exit, Failure};

/// A point, or several in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Index {
    first: usize,
    last: usize,
    is_single: bool,
}

impl FromStr for Index {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<usize>().ok();
        let index = match text.split_once('-') {
            None => number(text).map(|first| Self { first, last: first, is_single: true }),
            Some((first, last)) => number(first).zip(number(last)).map(|(first, last)| Self {
                first,
                last,
                is_single: false,
            }),
        };
        index.filter(|index| index.first <= index.last).ok_or_else(|| {
            "write the number of a point, counted from 1, or two of them: 7 or 5-8".to_owned()
        })
    }
}

impl Index {
    /// The index from 0 of the one point that is named; `None` if several may be.
    pub fn single(self) -> Option<usize> {
        self.is_single.then(|| self.first.saturating_sub(1))
    }

    /// The indices from 0 of the points, of which there are so many.
    pub fn range(self, n_points: usize) -> Result<Range<usize>, Failure> {
        if self.first == 0 || self.last > n_points {
            let wrong = if self.first == 0 { 0 } else { self.last };
            let reason = format!("--index: there is no point {wrong}; accepted: 1 to {n_points}");
            return Err(Failure::new(Exit::Usage, reason));
        }
        Ok(self.first - 1..self.last)
    }
}

#[cfg(test)]
mod tests {
    use super::Index;

    #[test]
    fn points_are_counted_from_one() {
        let range = |text: &str, n| text.parse::<Index>().unwrap().range(n).ok();
        assert_eq!(range("7", 7), Some(6..7));
        assert_eq!(range("5-8", 10), Some(4..8));
        assert_eq!(
            [range("0", 7), range("8", 7), range("5-8", 7), range("0-3", 7)],
            [const { None }; 4]
        );
        for wrong in ["", "a", "-1", "8-5", "1-", "1-2-3", "1.5"] {
            assert!(wrong.parse::<Index>().is_err(), "{wrong}");
        }
        assert_eq!("7".parse::<Index>().unwrap().single(), Some(6));
        assert_eq!("7-7".parse::<Index>().unwrap().single(), None);
    }
}
