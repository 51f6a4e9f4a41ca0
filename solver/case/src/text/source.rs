//! `Origin`: where a piece of a case was written, down to line and column.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A text that was read: a case file, or one `--set` of the command line.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// Name of the file, or `--set`.
    pub name: String,
    /// Where relative paths in it start; a shipped case has none.
    pub directory: Option<PathBuf>,
    /// Its content.
    pub text: String,
}

/// A stretch of a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The text it is in.
    pub source: Arc<Source>,
    /// Its bytes.
    pub span: Range<usize>,
}

impl Origin {
    /// The same in lines and columns.
    #[must_use]
    pub fn location(&self) -> Location {
        let text = &self.source.text;
        let start = floor_char(text, self.span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |length| start + length);
        let end = floor_char(text, self.span.end.clamp(start, line_end));
        Location {
            file: self.source.name.clone(),
            line: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            width: text[start..end].trim_end().chars().count().max(1),
            text: text[line_start..line_end].trim_end().to_owned(),
        }
    }
}

/// The nearest character boundary at or before a byte of a text.
fn floor_char(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte).rev().find(|b| text.is_char_boundary(*b)).unwrap_or(0)
}

/// A location in a text, as an editor counts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Characters it covers in that line, at least 1.
    pub width: usize,
    /// The line.
    pub text: String,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn location(text: &str, span: Range<usize>) -> Location {
        let source = Source { name: "a.toml".into(), directory: None, text: text.into() };
        Origin { source: Arc::new(source), span }.location()
    }

    #[test]
    fn columns_count_characters_and_lines_start_at_one() {
        let found = location("a = 1\nβ = 22\n", 11..13);
        assert_eq!((found.line, found.column, found.width), (2, 5, 2));
        assert_eq!(found.text, "β = 22");
        assert_eq!(found.to_string(), "a.toml:2:5");
    }

    #[test]
    fn a_span_past_the_end_is_at_the_end() {
        assert_eq!(location("a", 7..9).line, 1);
    }
}
