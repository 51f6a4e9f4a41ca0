//! Cells of a line of comma-separated values, with where they stand.

use std::ops::Range;

use csv_core::{ReadFieldResult, Reader};

/// The content of a cell, and its bytes in the line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// The content, without quotes and without spaces around it.
    pub text: String,
    /// Where it stands.
    pub span: Range<usize>,
}

/// The cells of a line; spaces around them count for nothing, before a quote neither.
///
/// # Errors
/// The byte at which a quote opens that nothing closes.
pub fn cells(line: &str) -> Result<Vec<Cell>, usize> {
    let whole = format!("{line}\n");
    let mut reader = Reader::new();
    let mut content = vec![0; whole.len()];
    let mut cells = Vec::new();
    let mut start = 0;
    loop {
        let rest = &whole[start..];
        start += rest.len() - rest.trim_start_matches([' ', '\t']).len();
        let (result, n_read, n_written) =
            reader.read_field(&whole.as_bytes()[start..], &mut content);
        let ReadFieldResult::Field { record_end } = result else { return Err(start) };
        let end = start + n_read;
        let width = whole[start..end - 1].trim_end().len();
        let text = String::from_utf8_lossy(&content[..n_written]).trim().to_owned();
        cells.push(Cell { text, span: start..start + width });
        if record_end {
            return Ok(cells);
        }
        start = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_know_where_they_stand() {
        let line = "a,  bc ,, \"d, \"\"e\"\"\", μ,";
        let found = cells(line).unwrap();
        let texts: Vec<&str> = found.iter().map(|cell| cell.text.as_str()).collect();
        assert_eq!(texts, ["a", "bc", "", "d, \"e\"", "μ", ""]);
        let spans = found.iter().map(|cell| &line[cell.span.clone()]);
        assert_eq!(spans.collect::<Vec<_>>(), ["a", "bc", "", "\"d, \"\"e\"\"\"", "μ", ""]);
        assert_eq!(cells("x").unwrap().len(), 1);
    }

    #[test]
    fn a_quote_that_stays_open_is_found() {
        assert_eq!(cells("a, \"b, c"), Err(3));
        assert!(cells("a, b \" c").is_ok());
    }
}
