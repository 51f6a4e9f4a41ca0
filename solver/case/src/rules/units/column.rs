//! Units in the names of columns.

/// Whether the name of a column has a word in it, such as the unit of `time_ms`, `t [ms]` or `q/deg`.
pub(super) fn has_word(column: &str, words: &[&str]) -> bool {
    let mut parts = column.split(|c: char| !c.is_alphanumeric() && c != '°' && c != 'µ');
    parts.any(|part| words.contains(&part))
}
