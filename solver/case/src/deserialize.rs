//! Typing a `TomlNode`: serde over the tree, with errors that say where and what is accepted.

use std::collections::btree_map;
use std::fmt::{self, Display};
use std::slice;

use serde::de::value::StrDeserializer;
use serde::de::{self, DeserializeSeed, Expected, IntoDeserializer, Unexpected, Visitor};
use serde::forward_to_deserialize_any;

use super::nearest::nearest;
use super::source::Origin;
use super::tree::{TomlNode, TomlValue};

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
    /// Anything else: what is wrong, and what to do.
    Other(String, String),
}

/// A mismatch, with its place.
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
    fn new(mismatch: Mismatch) -> Self {
        Self(Box::new(Inner { mismatch, origin: None, path: Vec::new() }))
    }

    /// Says where, unless that is known more exactly already.
    fn at(mut self, origin: &Origin) -> Self {
        self.0.origin.get_or_insert_with(|| origin.clone());
        self
    }

    fn below(mut self, step: impl Into<String>) -> Self {
        self.0.path.push(step.into());
        self
    }

    /// What is wrong.
    pub fn mismatch(&self) -> &Mismatch {
        &self.0.mismatch
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
            Mismatch::WrongType { found, wanted } => {
                format!("`{path}` is {found} where {wanted} is wanted")
            }
            Mismatch::Other(message, _) => format!("`{path}`: {message}"),
        }
    }

    /// What to do, in one line.
    pub fn help(&self) -> String {
        match self.mismatch() {
            Mismatch::UnknownKey { key: found, accepted }
            | Mismatch::UnknownAlternative { found, accepted } => suggestion(found, accepted),
            Mismatch::MissingKey(key) => format!("add `{key} = ...` there"),
            Mismatch::WrongType { found, wanted } => {
                if found.starts_with("the string") && wanted.contains("number") {
                    "write the number without quotes and without its unit".to_owned()
                } else {
                    String::new()
                }
            }
            Mismatch::Other(_, help) => help.clone(),
        }
    }
}

/// Most words a suggestion lists.
const MOST_WORDS: usize = 100;

/// "did you mean ...? accepted: ..." for a word that is not known.
pub fn suggestion<S: AsRef<str>>(found: &str, accepted: &[S]) -> String {
    let words: Vec<&str> = accepted.iter().take(MOST_WORDS).map(AsRef::as_ref).collect();
    let mut list = words.join(", ");
    if accepted.len() > MOST_WORDS {
        list += &format!(" and {} more", accepted.len() - MOST_WORDS);
    }
    match nearest(found, accepted) {
        Some(word) => format!("did you mean `{word}`? accepted: {list}"),
        None => format!("accepted: {list}"),
    }
}

impl Display for TypeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message())
    }
}

impl std::error::Error for TypeError {}

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
        Self::new(Mismatch::UnknownAlternative {
            found: found.to_owned(),
            accepted: owned(accepted),
        })
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
        "usize" => "a whole number of 0 or more".to_owned(),
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

/// The alternative that a plain number stands for.
const CONSTANT: &str = "constant";

impl<'de> de::Deserializer<'de> for &TomlNode {
    type Error = TypeError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TypeError> {
        let result = match &self.value {
            TomlValue::String(text) => visitor.visit_str(text),
            TomlValue::Integer(number) => visitor.visit_i64(*number),
            TomlValue::Float(number) => visitor.visit_f64(*number),
            TomlValue::Boolean(value) => visitor.visit_bool(*value),
            TomlValue::Date(date) => Err(TypeError::new(Mismatch::Other(
                format!("it is the date {date}"),
                "no key of a case takes a date: put text in quotes".to_owned(),
            ))),
            TomlValue::Array(items) => {
                let mut access = ItemAccess { items: items.iter(), index: 0 };
                let value = visitor.visit_seq(&mut access);
                match (value, access.index) {
                    (Ok(_), seen) if seen < items.len() => {
                        let wanted = format!("an array of length {seen}");
                        Err(de::Error::invalid_length(items.len(), &wanted.as_str()))
                    }
                    (value, _) => value,
                }
            }
            TomlValue::Table(entries) => {
                visitor.visit_map(EntryAccess { entries: entries.iter(), value: None })
            }
        };
        result.map_err(|error| error.at(&self.origin))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TypeError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        alternatives: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        let other = |message: String, help: String| {
            TypeError::new(Mismatch::Other(message, help)).at(&self.origin)
        };
        match &self.value {
            TomlValue::String(text) => {
                visitor.visit_enum(Alternative { tag: text, at: &self.origin, content: None })
            }
            TomlValue::Table(entries) if entries.len() == 1 => {
                let Some((tag, content)) = entries.iter().next() else {
                    return Err(other("empty table".to_owned(), suggestion("", alternatives)));
                };
                visitor.visit_enum(Alternative { tag, at: &content.key, content: Some(content) })
            }
            TomlValue::Table(entries) => {
                let found = match entries.keys().cloned().collect::<Vec<_>>().join("`, `") {
                    keys if keys.is_empty() => "the table is empty".to_owned(),
                    keys => format!("it has `{keys}`"),
                };
                let list = alternatives.join(", ");
                Err(other(
                    format!("{found} where exactly one alternative is wanted"),
                    format!("give one of: {list}"),
                ))
            }
            // What may change in time may be a plain number, too
            TomlValue::Integer(_) | TomlValue::Float(_) if alternatives.contains(&CONSTANT) => {
                let content = Some(self);
                visitor.visit_enum(Alternative { tag: CONSTANT, at: &self.origin, content })
            }
            _ => Err(other(
                "this is not one of its alternatives".to_owned(),
                format!("give one of: {}", alternatives.join(", ")),
            )),
        }
        .map_err(|error| error.at(&self.origin))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

struct ItemAccess<'a> {
    items: slice::Iter<'a, TomlNode>,
    index: usize,
}

impl<'de> de::SeqAccess<'de> for ItemAccess<'_> {
    type Error = TypeError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, TypeError> {
        let Some(item) = self.items.next() else { return Ok(None) };
        let index = self.index;
        self.index += 1;
        let value = seed.deserialize(item);
        value.map(Some).map_err(|error| error.at(&item.origin).below(index.to_string()))
    }
}

struct EntryAccess<'a> {
    entries: btree_map::Iter<'a, String, TomlNode>,
    value: Option<(&'a String, &'a TomlNode)>,
}

impl<'de> de::MapAccess<'de> for EntryAccess<'_> {
    type Error = TypeError;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, TypeError> {
        self.value = self.entries.next();
        let Some((key, node)) = self.value else { return Ok(None) };
        let deserializer: StrDeserializer<'_, TypeError> = key.as_str().into_deserializer();
        seed.deserialize(deserializer).map(Some).map_err(|error| error.at(&node.key))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, TypeError> {
        let Some((key, node)) = self.value.take() else {
            return Err(de::Error::custom("a value was asked for before its key"));
        };
        seed.deserialize(node).map_err(|error| error.at(&node.origin).below(key.clone()))
    }
}

/// An alternative: its bare name, or its name and what stands in its table.
struct Alternative<'a> {
    tag: &'a str,
    at: &'a Origin,
    content: Option<&'a TomlNode>,
}

impl<'a> Alternative<'a> {
    /// The content; an error that says how to write it if there is none.
    fn content(&self) -> Result<&'a TomlNode, TypeError> {
        let tag = self.tag;
        self.content.ok_or_else(|| {
            TypeError::new(Mismatch::Other(
                format!("`{tag}` needs values of its own"),
                format!("write {{ {tag} = ... }} instead of \"{tag}\""),
            ))
            .at(self.at)
        })
    }
}

impl<'de> de::EnumAccess<'de> for Alternative<'_> {
    type Error = TypeError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), TypeError> {
        let deserializer: StrDeserializer<'_, TypeError> = self.tag.into_deserializer();
        let tag = seed.deserialize(deserializer).map_err(|error| error.at(self.at))?;
        Ok((tag, self))
    }
}

impl<'de> de::VariantAccess<'de> for Alternative<'_> {
    type Error = TypeError;

    fn unit_variant(self) -> Result<(), TypeError> {
        let tag = self.tag;
        match self.content {
            None => Ok(()),
            Some(_) => Err(TypeError::new(Mismatch::Other(
                format!("`{tag}` has no values of its own"),
                format!("write \"{tag}\" alone"),
            ))
            .at(self.at)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, TypeError> {
        let content = self.content()?;
        seed.deserialize(content).map_err(|error| error.at(&content.origin).below(self.tag))
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        _length: usize,
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        let content = self.content()?;
        de::Deserializer::deserialize_any(content, visitor).map_err(|error| error.below(self.tag))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        let content = self.content()?;
        de::Deserializer::deserialize_any(content, visitor).map_err(|error| error.below(self.tag))
    }
}
