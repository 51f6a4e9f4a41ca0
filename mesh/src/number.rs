//! Conversions of numbers: a whole part as a count, an index in 32 bits.

/// The largest count that is not above a value; 0 for negative ones and for what is no number.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast keeps whole parts and saturates, which is what is wanted"
)]
pub fn whole(value: f64) -> usize {
    value as usize
}

/// An index in 32 bits, which that of any mesh in memory fits (checked in debug builds).
#[expect(clippy::cast_possible_truncation, reason = "4 billion vertices exceed the memory")]
pub(crate) fn index_u32(index: usize) -> u32 {
    debug_assert!(u32::try_from(index).is_ok());
    index as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_counts() {
        assert_eq!([2.0, 2.999, 0.5, -3.0, f64::NAN].map(whole), [2, 2, 0, 0, 0]);
        assert_eq!(whole(f64::INFINITY), usize::MAX);
    }
}
