//! Typing a `TomlNode`: serde over the tree, with errors that say where and what is accepted.

use std::collections::{BTreeMap, btree_map};
use std::slice;

use serde::de::value::StrDeserializer;
use serde::de::{self, DeserializeSeed, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

use super::angle::{ANGULAR, in_radians};
use super::source::Origin;
use super::tree::{TomlNode, TomlValue};
use super::type_error::{Mismatch, TypeError, with_file};

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
            TomlValue::Date(date) => Err(no_date(&date.to_string())),
            TomlValue::Array(items) => {
                let mut access = ItemAccess { items: items.iter(), index: 0 };
                let value = visitor.visit_seq(&mut access);
                let value = match (value, access.index) {
                    (Ok(_), seen) if seen < items.len() => Err(too_long(items.len(), seen)),
                    (value, _) => value,
                };
                // Texts that are there were taken: only their number is wrong
                let is_text = |item: &TomlNode| matches!(item.value, TomlValue::String(_));
                let has_texts = !items.is_empty() && items.iter().all(is_text);
                value.map_err(|error| if has_texts { error.of_texts() } else { error })
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
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        if name == ANGULAR {
            return visitor.visit_newtype_struct(&in_radians(self)?);
        }
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        alternatives: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        match &self.value {
            TomlValue::String(text) => {
                visitor.visit_enum(Alternative { tag: text, at: &self.origin, content: None })
            }
            TomlValue::Table(entries) => match (entries.len(), entries.iter().next()) {
                (1, Some((tag, content))) => visitor.visit_enum(Alternative {
                    tag,
                    at: &content.key,
                    content: Some(content),
                }),
                _ => Err(not_one_alternative(entries, alternatives)),
            },
            // What may change in time may be a plain number, too
            TomlValue::Integer(_) | TomlValue::Float(_) if alternatives.contains(&CONSTANT) => {
                let content = Some(self);
                visitor.visit_enum(Alternative { tag: CONSTANT, at: &self.origin, content })
            }
            _ => Err(no_alternative(alternatives)),
        }
        .map_err(|error| error.at(&self.origin))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TypeError> {
        self.refuse_array()?;
        self.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl TomlNode {
    /// Refuses an array for a table, which would be taken as its values in the order of its keys.
    fn refuse_array(&self) -> Result<(), TypeError> {
        match self.value {
            TomlValue::Array(_) => Err(no_table().at(&self.origin)),
            _ => Ok(()),
        }
    }
}

// Errors of the functions above, which are compiled again for each type of a case; these are not.

fn no_date(date: &str) -> TypeError {
    TypeError::new(Mismatch::Other(
        format!("it is the date {date}"),
        "no key of a case takes a date: put text in quotes".to_owned(),
    ))
}

fn no_table() -> TypeError {
    let (found, wanted) = ("an array".to_owned(), "a table".to_owned());
    TypeError::new(Mismatch::WrongType { found, wanted })
}

fn too_long(length: usize, wanted: usize) -> TypeError {
    let wanted = format!("an array of length {wanted}");
    de::Error::invalid_length(length, &wanted.as_str())
}

fn not_one_alternative(entries: &BTreeMap<String, TomlNode>, alternatives: &[&str]) -> TypeError {
    let found = match entries.keys().cloned().collect::<Vec<_>>().join("`, `") {
        keys if keys.is_empty() => "the table is empty".to_owned(),
        keys => format!("it has `{keys}`"),
    };
    alternatives_error(format!("{found} where exactly one alternative is wanted"), alternatives)
}

fn no_alternative(alternatives: &[&str]) -> TypeError {
    alternatives_error("this is not one of its alternatives".to_owned(), alternatives)
}

fn alternatives_error(message: String, alternatives: &[&str]) -> TypeError {
    TypeError::new(Mismatch::NoAlternative { message, accepted: with_file(alternatives) })
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
        self.content.ok_or_else(|| TypeError::new(Mismatch::NoContent(tag.to_owned())).at(self.at))
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
        content
            .refuse_array()
            .and_then(|()| de::Deserializer::deserialize_any(content, visitor))
            .map_err(|error| error.below(self.tag))
    }
}
