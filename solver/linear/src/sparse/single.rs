//! The conversion to single precision, in which preconditioners are kept.

/// The nearest number in single precision, infinite for what is too large.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_rounded_and_sizes_kept() {
        assert_eq!(single(0.5), 0.5);
        assert_eq!(single(1.0 + 1e-9), 1.0);
        assert!(single(1e60).is_infinite() && single(f64::NAN).is_nan());
    }
}
