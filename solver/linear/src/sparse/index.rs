//! Checked conversions from sizes in memory to the narrower integers that index tables store.

/// An index as tables store it: in half the memory of a `usize`.
///
/// # Panics
/// When it takes more than 32 bits. Numbers of unknowns, and of entries of a matrix or a front, come
/// close to that only where the factors would take terabytes.
#[inline(always)]
#[track_caller]
pub(crate) fn to_u32(index: usize) -> u32 {
    u32::try_from(index).expect("indices of unknowns and of entries take at most 32 bits")
}

/// An index among the unknowns of one cell.
///
/// # Panics
/// When a cell has more than 65 536 unknowns.
#[inline(always)]
#[track_caller]
pub(crate) fn to_u16(index: usize) -> u16 {
    u16::try_from(index).expect("indices among the unknowns of a cell take at most 16 bits")
}

/// An index among the few groups of unknowns of one cell, below 255.
///
/// # Panics
/// When there are more.
#[inline(always)]
#[track_caller]
pub(crate) fn to_u8(index: usize) -> u8 {
    let index = u8::try_from(index).ok().filter(|index| *index < u8::MAX);
    index.expect("a cell has fewer than 255 groups of unknowns")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_kept() {
        assert_eq!(to_u32(u32::MAX as usize), u32::MAX);
        assert_eq!(to_u16(usize::from(u16::MAX)), u16::MAX);
        assert_eq!(to_u8(254), 254);
    }

    #[test]
    #[should_panic(expected = "at most 32 bits")]
    fn an_index_is_never_cut_off() {
        let _ = to_u32(1 << 32);
    }
}
