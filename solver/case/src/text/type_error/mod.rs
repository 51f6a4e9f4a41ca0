//! `TypeError`: why a value of a case cannot be typed, where it is, and what is accepted.

mod examples;

use std::collections::HashSet;
use std::fmt::{self, Display};

use serde::de::{self, Expected, Unexpected};

use self::examples::{array_example, broken, number_example, whole_example};
use crate::text::meant::{Meant, meant};
use crate::text::nearest::nearest;
use crate::text::source::Origin;

/// The alternative that a file becomes.
pub const KNOTS_OF_A_FILE: &str = "cubic";

/// What a file with a period becomes.
pub const CYCLE_OF_A_FILE: &str = "cycle";

/// What a value cannot be typed for.
#[derive(Debug)]
pub enum Mismatch {
    /// A key no table of this kind has.
    UnknownKey {
        /// The key.
        key: String,
        /// Those it may have.
        accepted: Vec<String>,
    },
    /// None of the alternatives.
    UnknownAlternative {
        /// What is there.
        found: String,
        /// What may be there.
        accepted: Vec<String>,
    },
    /// A key that must be given is not.
    MissingKey(String),
    /// A value of another type.
    WrongType {
        /// What is there.
        found: String,
        /// What is wanted.
        wanted: String,
    },
    /// A value that is no alternative, or several at once.
    NoAlternative {
        /// What is wrong.
        message: String,
        /// What may be there.
        accepted: Vec<String>,
    },
    /// The name alone of an alternative that has values of its own.
    NoContent(String),
    /// Anything else: what is wrong, and what to do.
    Other(String, String),
}

/// A mismatch, and where it is written.
#[derive(Debug)]
pub struct TypeError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    mismatch: Mismatch,
    origin: Option<Origin>,
    /// Steps from the value up to the root.
    path: Vec<String>,
}

impl TypeError {
    pub fn new(mismatch: Mismatch) -> Self {
        Self(Box::new(Inner { mismatch, origin: None, path: Vec::new() }))
    }

    /// Says where, unless that is known more exactly already.
    pub fn at(mut self, origin: &Origin) -> Self {
        self.0.origin.get_or_insert_with(|| origin.clone());
        self
    }

    /// Says that an array of another length is one of texts.
    pub fn of_texts(mut self) -> Self {
        if self.0.path.is_empty()
            && let Mismatch::WrongType { wanted, .. } = &mut self.0.mismatch
        {
            *wanted = wanted.replace(" numbers", " texts");
        }
        self
    }

    /// Says by which step the value is reached from the table or array around it.
    pub fn below(mut self, step: impl Into<String>) -> Self {
        self.0.path.push(step.into());
        self
    }

    /// What is wrong.
    pub fn mismatch(&self) -> &Mismatch {
        &self.0.mismatch
    }

    /// The same, taken out.
    pub fn into_mismatch(self) -> Mismatch {
        self.0.mismatch
    }

    /// Where it is.
    pub fn origin(&self) -> Option<&Origin> {
        self.0.origin.as_ref()
    }

    /// The value, or for unknown and missing keys their table, by keys joined with dots.
    pub fn path(&self) -> String {
        self.0.path.iter().rev().cloned().collect::<Vec<_>>().join(".")
    }

    /// The table of an unknown or missing key, as a reader would call it.
    fn table(&self) -> String {
        let path = self.path();
        if path.is_empty() { "at the top of the case".to_owned() } else { format!("in `{path}`") }
    }

    /// What is wrong, in one line.
    pub fn message(&self) -> String {
        let path = self.path();
        match self.mismatch() {
            Mismatch::UnknownKey { key, .. } => format!("unknown key `{key}` {}", self.table()),
            Mismatch::UnknownAlternative { found, .. } => {
                format!("`{path}` cannot be `{found}`")
            }
            Mismatch::MissingKey(key) => format!("missing key `{key}` {}", self.table()),
            Mismatch::WrongType { found, wanted } if broken(found, wanted).is_some() => {
                format!("`{path}` is {found} where a whole number is wanted")
            }
            Mismatch::WrongType { found, wanted } => {
                format!("`{path}` is {found} where {wanted} is wanted")
            }
            Mismatch::NoContent(name) => format!("`{path}`: `{name}` needs values of its own"),
            Mismatch::NoAlternative { message, .. } | Mismatch::Other(message, _) => {
                format!("`{path}`: {message}")
            }
        }
    }

    /// What to do, in one line.
    pub fn help(&self) -> String {
        match self.mismatch() {
            Mismatch::UnknownKey { key, accepted } => {
                renamed(key, accepted).unwrap_or_else(|| suggestion(key, accepted))
            }
            Mismatch::UnknownAlternative { found, accepted } => suggestion(found, accepted),
            Mismatch::MissingKey(key) => format!("add `{key} = ...` there"),
            Mismatch::WrongType { found, wanted } => {
                if let Some(value) = broken(found, wanted) {
                    whole_example(value)
                } else if wanted.starts_with("an array") {
                    array_example(found, wanted)
                } else if wanted.contains("number")
                    && let Some(text) = found.strip_prefix("the string ")
                {
                    number_example(text.trim_matches('"'))
                } else if found == "an array" && wanted.contains("number") {
                    "write one number there, without brackets of its own".to_owned()
                } else if wanted == "true or false" {
                    "write true or false, without quotes".to_owned()
                } else {
                    String::new()
                }
            }
            Mismatch::NoAlternative { accepted, .. } => {
                format!("give one of: {}", accepted.join(", "))
            }
            Mismatch::NoContent(name) => format!("write {{ {name} = ... }} instead of \"{name}\""),
            Mismatch::Other(_, help) => help.clone(),
        }
    }
}

/// How a key is called here that formulae, other programs or earlier versions call otherwise.
fn renamed(key: &str, accepted: &[String]) -> Option<String> {
    let Meant { word, how } = meant(key, accepted)?;
    let how = if how.is_empty() { String::new() } else { format!(", {how}") };
    Some(format!("write `{word} = ...`{how}"))
}

/// Most words a suggestion lists.
const MOST_WORDS: usize = 100;

/// "did you mean ...? accepted: ..." for a word that is not known.
pub fn suggestion<S: AsRef<str>>(found: &str, accepted: &[S]) -> String {
    let mut words: Vec<&str> = Vec::new();
    let mut seen = HashSet::new();
    // What is offered twice, such as a body and the swimmer it is, is one word
    words.extend(accepted.iter().map(AsRef::as_ref).filter(|word| seen.insert(*word)));
    let more = words.len().saturating_sub(MOST_WORDS);
    words.truncate(MOST_WORDS);
    let mut list = words.join(", ");
    if more > 0 {
        list += &format!(" and {more} more");
    }
    let how = |how: &str| if how.is_empty() { String::new() } else { format!(" ({how})") };
    match (meant(found, accepted), nearest(found, accepted)) {
        (Some(it), _) => format!("did you mean `{}`{}? accepted: {list}", it.word, how(it.how)),
        (None, Some(word)) => format!("did you mean `{word}`? accepted: {list}"),
        (None, None) => format!("accepted: {list}"),
    }
}

impl Display for TypeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message())
    }
}

impl std::error::Error for TypeError {}

/// The alternatives of a value, and the file that may stand for one: it has become knots before the value
/// is typed.
pub fn with_file(alternatives: &[&str]) -> Vec<String> {
    let mut words = owned(alternatives);
    if alternatives.contains(&KNOTS_OF_A_FILE) {
        words.push("file".to_owned());
    }
    words
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

impl de::Error for TypeError {
    fn custom<T: Display>(message: T) -> Self {
        Self::new(Mismatch::Other(message.to_string(), String::new()))
    }

    fn invalid_type(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::new(Mismatch::WrongType { found: describe(found), wanted: plain(wanted) })
    }

    fn invalid_value(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::invalid_type(found, wanted)
    }

    fn invalid_length(length: usize, wanted: &dyn Expected) -> Self {
        let found = format!("an array of {length}");
        Self::new(Mismatch::WrongType { found, wanted: plain(wanted) })
    }

    fn unknown_field(key: &str, accepted: &'static [&'static str]) -> Self {
        Self::new(Mismatch::UnknownKey { key: key.to_owned(), accepted: owned(accepted) })
    }

    fn unknown_variant(found: &str, accepted: &'static [&'static str]) -> Self {
        let (found, accepted) = (found.to_owned(), with_file(accepted));
        Self::new(Mismatch::UnknownAlternative { found, accepted })
    }

    fn missing_field(key: &'static str) -> Self {
        Self::new(Mismatch::MissingKey(key.to_owned()))
    }
}

fn describe(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Str(text) => format!("the string \"{text}\""),
        Unexpected::Bool(value) => format!("`{value}`"),
        Unexpected::Signed(value) => format!("`{value}`"),
        Unexpected::Unsigned(value) => format!("`{value}`"),
        Unexpected::Float(value) => format!("`{value:?}`"),
        Unexpected::Seq => "an array".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        other => other.to_string(),
    }
}

/// serde's words for a type in those of TOML.
fn plain(wanted: &dyn Expected) -> String {
    let words = wanted.to_string();
    match words.as_str() {
        "f64" => "a number".to_owned(),
        "usize" | "u64" => "a whole number of 0 or more".to_owned(),
        "u8" => format!("a whole number from 0 to {}", u8::MAX),
        "u16" => format!("a whole number from 0 to {}", u16::MAX),
        "u32" => format!("a whole number from 0 to {}", u32::MAX),
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "an array".to_owned(),
        "a map" => "a table".to_owned(),
        _ if words.starts_with("struct ") => "a table".to_owned(),
        _ => match words.strip_prefix("an array of length ") {
            Some(length) => format!("an array of {length} numbers"),
            None => words,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_offered_once() {
        let accepted = ["swimmer.x", "swimmer.y", "swimmer.x"];
        assert_eq!(suggestion("q", &accepted), "accepted: swimmer.x, swimmer.y");
        let close = suggestion("swimmer.z", &accepted);
        assert!(close.ends_with("accepted: swimmer.x, swimmer.y"), "{close}");
    }

    #[test]
    fn whole_numbers_are_called_so_whatever_holds_them() {
        for kind in ["u8", "u16", "u32", "u64", "usize", "i8", "i16", "i32", "i64", "isize"] {
            let plain = plain(&kind);
            assert!(plain.starts_with("a whole number"), "{kind}: {plain}");
        }
        assert_eq!(plain(&"u8"), "a whole number from 0 to 255");
    }

    #[test]
    fn a_number_with_a_point_is_told_the_whole_ones_beside_it() {
        for (found, wanted, message, help) in [
            ("`6.5`", "usize", "where a whole number is wanted", "write 6 or 7"),
            ("`6.0`", "u8", "where a whole number is wanted", "write it without a point: 6"),
            ("`1e300`", "u64", "where a whole number is wanted", "write a whole number, without"),
            (
                "`-0.5`",
                "usize",
                "where a whole number is wanted",
                "write a whole number of 0 or more",
            ),
            ("`-3`", "usize", "where a whole number of 0 or more is wanted", ""),
        ] {
            let mismatch = Mismatch::WrongType { found: found.to_owned(), wanted: plain(&wanted) };
            let error = TypeError::new(mismatch).below("elements");
            assert_eq!(error.message(), format!("`elements` is {found} {message}"));
            assert!(error.help().starts_with(help), "{found}: {}", error.help());
            assert!(!help.is_empty() || error.help().is_empty(), "{found}: {}", error.help());
        }
    }

    #[test]
    fn an_array_is_shown_by_an_example() {
        let help = |found: &str, wanted: &str| {
            let (found, wanted) = (found.to_owned(), wanted.to_owned());
            TypeError::new(Mismatch::WrongType { found, wanted }).help()
        };
        let of_number = "write numbers in brackets: [x, y], such as [3.0, 0.0]";
        assert_eq!(help("`3.0`", "an array"), of_number);
        assert_eq!(help("the string \"x\"", "an array"), "write it in brackets: [\"x\"]");
        assert_eq!(help("`3.0`", "a table"), "");
    }

    #[test]
    fn an_array_of_another_length_is_one_of_what_is_in_it() {
        let error = <TypeError as de::Error>::invalid_length(2, &"an array of length 3");
        let error = error.of_texts().below("markers");
        assert_eq!(
            error.message(),
            "`markers` is an array of 2 where an array of 3 texts is wanted"
        );
        assert_eq!(error.help(), "write 3 texts in brackets, with commas between them");
        // That of an entry stays
        let error = <TypeError as de::Error>::invalid_length(2, &"an array of length 3");
        let error = error.below("0").of_texts();
        assert_eq!(error.message(), "`0` is an array of 2 where an array of 3 numbers is wanted");
    }

    #[test]
    fn a_stroke_may_come_from_a_file() {
        let error = <TypeError as de::Error>::unknown_variant("fil", &["sine", "cubic"]);
        assert_eq!(error.help(), "did you mean `file`? accepted: sine, cubic, file");
        let error = <TypeError as de::Error>::unknown_variant("fil", &["sine", "table"]);
        assert!(!error.help().contains("file"), "{}", error.help());
    }
}
