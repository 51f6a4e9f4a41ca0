//! `whole`: the whole part of a number, as a count or an index.

/// The largest count that is not above a value; 0 for negative ones and for what is no number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast keeps whole parts and saturates, which is what is wanted"
)]
pub fn whole(value: f64) -> usize {
    value as usize
}

#[cfg(test)]
mod tests {
    use super::whole;

    #[test]
    fn fractions_are_cut_off_and_values_out_of_range_saturate() {
        assert_eq!([2.0, 2.999, 0.5, -1.0, f64::NAN].map(whole), [2, 2, 0, 0, 0]);
        assert_eq!(whole(f64::INFINITY), usize::MAX);
    }
}
