//! What helps where a text is not TOML: the slip that most often is behind it.

use std::ops::Range;

/// Units of angles as they may be written, and as cases have them.
const ANGLES: [(&str, &str); 7] = [
    ("deg", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("°", "deg"),
    ("rad", "rad"),
    ("radian", "rad"),
    ("radians", "rad"),
];

/// Why a text is not TOML, and what helps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TomlHelp {
    /// In words of a case where the slip is known, else those of the reader of TOML.
    pub reason: String,
    /// What helps.
    pub help: String,
}

/// What helps where a text cannot be read, with the reason the reader of TOML gives.
pub fn toml_help(text: &str, at: Range<usize>, reason: &str) -> TomlHelp {
    let told = |help: String| TomlHelp { reason: reason.to_owned(), help };
    if reason.contains("duplicate key") {
        return told("it is given above already: keep one of the two".to_owned());
    }
    let line = line_at(text, at.start);
    let value = line.split_once('=').map(|(_, value)| value.trim());
    if let Some(help) = typographic(line).or_else(|| decimal_comma(line)) {
        return told(help);
    }
    // What stands behind the key is the slip, and the reader of TOML says what it would have made of its start
    if let Some(value) = value
        && let Some(help) = with_unit(value).or_else(|| bare_word(value))
    {
        let shown = value.split([',', '#', '}']).next().unwrap_or(value).trim();
        let reason = format!("`{shown}` is neither a number nor a text in quotes");
        return TomlHelp { reason, help };
    }
    told(other_help(text, at, line))
}

/// What helps with other slips.
fn other_help(text: &str, at: Range<usize>, line: &str) -> String {
    expression(text, at.start).or_else(|| no_key(line)).unwrap_or_else(|| {
        "strings stand in quotes, arrays in [ ], tables in { } or under a [header]".to_owned()
    })
}

/// Arithmetic where a number stands.
fn expression(text: &str, at: usize) -> Option<String> {
    let line = line_at(text, at);
    let is_part = |c: char| c.is_ascii_digit() || "+-*/.()^e ".contains(c);
    let values = line.split(['=', ',', '[', ']', '{', '}']).map(str::trim);
    let mut found = values.filter(|value| {
        value.chars().all(is_part)
            && value.starts_with(|c: char| c.is_ascii_digit() || c == '(')
            && value.contains(['*', '/', '^'])
    });
    let found = found.next_back()?;
    Some(format!("`{found}` is not evaluated: write the number itself"))
}

/// The line that a byte of a text is in; at an end of a line the one that ends there.
fn line_at(text: &str, byte: usize) -> &str {
    let mut start = byte.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let begin = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[start..].find('\n').map_or(text.len(), |length| start + length);
    text[begin..end].trim()
}

/// Quotes that a word processor makes of straight ones.
fn typographic(line: &str) -> Option<String> {
    let found = line.chars().find(|c| "“”„‟‘’‚«»″′".contains(*c))?;
    Some(format!("`{found}` is no quote of TOML: write straight ones, \"...\""))
}

/// A number with a comma where a point is wanted, outside of arrays.
fn decimal_comma(line: &str) -> Option<String> {
    let mut depth = 0_usize;
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '[') => depth += 1,
            (None, ']') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                let (before, after) = (&line[..at], &line[at + 1..]);
                let is_digit = |c: &char| c.is_ascii_digit();
                let whole = before.len() - before.trim_end_matches(|c| is_digit(&c)).len();
                let rest = after.chars().take_while(is_digit).count();
                if whole > 0 && rest > 0 {
                    let number = format!("{}.{}", &before[at - whole..], &after[..rest]);
                    return Some(format!("numbers have a decimal point: {number}"));
                }
            }
            _ => {}
        }
    }
    None
}

/// A number with its unit behind it.
fn with_unit(value: &str) -> Option<String> {
    let is_of_number = |c: char| c.is_ascii_digit() || "+-._".contains(c);
    let number = value.split_whitespace().next()?;
    let end = number.find(|c| !is_of_number(c)).unwrap_or(number.len());
    let (number, rest) = value.split_at(end);
    let rest = rest.trim_start();
    let unit = rest.split(|c: char| c.is_whitespace() || ",#}".contains(c)).next()?;
    let is_unit = unit.starts_with(|c: char| c.is_alphabetic() || c == '°');
    if number.parse::<f64>().is_err() || !is_unit {
        return None;
    }
    Some(match ANGLES.iter().find(|(name, _)| *name == unit) {
        Some((_, unit)) => format!("write an angle with its unit in quotes: \"{number} {unit}\""),
        None => format!("leave the unit `{unit}` out: all numbers are in the units of the case"),
    })
}

/// A text without its quotes.
fn bare_word(value: &str) -> Option<String> {
    let word = value.split(|c: char| c.is_whitespace() || ",#}".contains(c)).next()?;
    let lower = word.to_lowercase();
    if ["true", "false"].contains(&lower.as_str()) {
        return (lower != word).then(|| format!("write it in small letters: {lower}"));
    }
    let is_word = |c: char| c.is_alphanumeric() || "-_/.".contains(c);
    let is_text = word.starts_with(char::is_alphabetic) && word.chars().all(is_word);
    (is_text && !["inf", "nan"].contains(&word))
        .then(|| format!("text stands in quotes: \"{word}\""))
}

/// A line that says nothing of a key.
fn no_key(line: &str) -> Option<String> {
    let is_key = line.contains('=') || line.contains(['[', ']', '{', '}', '"', '\'']);
    (!is_key && !line.is_empty())
        .then(|| "a line is `key = value`, a [header], or a comment behind a #".to_owned())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::text::source::Source;
    use crate::text::tree;

    /// What helps with a text that is not TOML.
    fn help(line: &str) -> String {
        let text = format!("title = \"a\"\n{line}\n[fluid]\ndensity = 1.0\n");
        let source = Source { name: "a.toml".to_owned(), directory: None, text };
        let error = tree::parse(&Arc::new(source)).unwrap_err();
        assert_eq!(error.origin.location().line, 2, "{line}: {error:?}");
        error.help
    }

    #[test]
    fn a_value_without_quotes_is_shown_in_place_of_what_a_reader_made_of_its_start() {
        for (line, shown) in [
            ("step = 0.1 s", "0.1 s"),
            ("step = 0.1 s   # of the pump", "0.1 s"),
            ("geometry = planar", "planar"),
        ] {
            let source = Source { name: "a.toml".to_owned(), directory: None, text: line.into() };
            let message = tree::parse(&Arc::new(source)).unwrap_err().message;
            let wanted =
                format!("this is not TOML: `{shown}` is neither a number nor a text in quotes");
            assert_eq!(message, wanted);
        }
    }

    #[test]
    fn the_slip_behind_an_error_is_told() {
        for (line, wanted) in [
            ("viscosity = 1,0", "numbers have a decimal point: 1.0"),
            ("mesh = { size = 0,25, growth = 0.1 }", "numbers have a decimal point: 0.25"),
            ("geometry = “planar”", "`“` is no quote of TOML: write straight ones, \"...\""),
            (
                "length = 30.0 cm",
                "leave the unit `cm` out: all numbers are in the units of the case",
            ),
            (
                "length = 30.0cm",
                "leave the unit `cm` out: all numbers are in the units of the case",
            ),
            ("angle = 45 deg", "write an angle with its unit in quotes: \"45 deg\""),
            ("geometry = planar", "text stands in quotes: \"planar\""),
            ("quick = True", "write it in small letters: true"),
            ("viscosity = 2*0.5", "`2*0.5` is not evaluated: write the number itself"),
            ("center = [1.0, 1/3]", "`1/3` is not evaluated: write the number itself"),
            (".", "a line is `key = value`, a [header], or a comment behind a #"),
            ("planar", "a line is `key = value`, a [header], or a comment behind a #"),
            ("title = \"b\"", "it is given above already: keep one of the two"),
            (
                "center = [1.0; 2.0]",
                "strings stand in quotes, arrays in [ ], tables in { } or under a [header]",
            ),
        ] {
            assert_eq!(help(line), wanted, "{line}");
        }
    }
}
