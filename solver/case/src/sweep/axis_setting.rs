//! A setting of the command line that gives a key several values: `KEY=a:b:n[:log]`, `KEY=a,b,c`.

use std::sync::Arc;

use super::range::{MOST_POINTS, Range};
use super::spec::{Block, SweptKey};
use crate::text::setting;
use crate::text::source::{Origin, Source};
use crate::text::tree;
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// Reads a setting that sweeps its key; `None` if it is one that sets it once.
///
/// # Errors
/// When it is neither, or a range that is none.
pub fn read(text: &str) -> Result<Option<Block>, TreeError> {
    let Some((path, raw)) = text.split_once('=') else { return Ok(None) };
    let source = setting::source(text);
    let written_at = |span| Origin { source: Arc::clone(&source), span };
    let refused = |message: String| TreeError {
        origin: written_at(path.len() + 1..text.len()),
        message,
        help: "write KEY=FROM:TO:N, KEY=FROM:TO:N:log, or values with commas: KEY=1,2,5".to_owned(),
    };
    let values = match range(raw) {
        Some(range) => range.map_err(refused)?,
        None => match list(raw) {
            Some(values) => values,
            None => return Ok(None),
        },
    };
    let path = path.trim().to_owned();
    if path.is_empty() {
        return Err(refused("no key is named before the =".to_owned()));
    }
    let key = written_at(0..text.len());
    let origin = written_at(path.len() + 1..text.len());
    let row = |value| {
        let mut node = TomlNode { key: key.clone(), origin: origin.clone(), value };
        node.relocate(&origin);
        vec![node]
    };
    let rows = values.into_iter().map(row).collect();
    Ok(Some(Block { keys: vec![SweptKey { path, origin: key }], rows }))
}

/// The values of `a:b:n` or `a:b:n:scale`; `None` if it does not look like that.
fn range(raw: &str) -> Option<Result<Vec<TomlValue>, String>> {
    let parts: Vec<&str> = raw.split(':').map(str::trim).collect();
    let number = |part: &&str| part.parse::<f64>().ok().filter(|value| value.is_finite());
    let [Some(from), Some(to)] = [parts.first(), parts.get(1)].map(|part| part.and_then(number))
    else {
        return None;
    };
    let [_, _, n, ref scale @ ..] = parts[..] else {
        return Some(Err(format!("`{}` does not say how many values it has", raw.trim())));
    };
    let is_log = match scale {
        [] | ["linear"] => false,
        ["log"] => true,
        _ => return Some(Err(format!("`{}` is no scale: linear or log", scale.join(":")))),
    };
    let Some(n) = n.parse().ok().filter(|n| (2..=MOST_POINTS).contains(n)) else {
        return Some(Err(format!("`{n}` is no number of values from 2 to {MOST_POINTS}")));
    };
    let Some(range) = Range::new(from, to, is_log) else {
        return Some(Err("by equal factors a range goes from and to numbers above 0".to_owned()));
    };
    let is_integer = |part: &str| part.parse::<i64>().is_ok();
    let is_whole = is_integer(parts[0]) && is_integer(parts[1]);
    Some(Ok((if is_whole { range.of_whole_numbers() } else { range }).values(n)))
}

/// The values of `a,b,c`; `None` if there are not several.
fn list(raw: &str) -> Option<Vec<TomlValue>> {
    let text = format!("[{raw}]");
    let source = Arc::new(Source { name: String::new(), directory: None, text });
    if let Ok(TomlNode { value: TomlValue::Array(items), .. }) = tree::parse_value(&source, 0) {
        return (items.len() > 1).then(|| items.into_iter().map(|item| item.value).collect());
    }
    let words: Vec<&str> = raw.split(',').collect();
    let is_word = |word: &&str| {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        !word.is_empty() && word.chars().all(is_plain)
    };
    let are_words = words.len() > 1 && words.iter().all(is_word);
    let value = |word: &str| {
        let number = || word.parse().ok().map(TomlValue::Float);
        let whole = word.parse().ok().map(TomlValue::Integer);
        whole.or_else(number).unwrap_or_else(|| TomlValue::String(word.to_owned()))
    };
    are_words.then(|| words.into_iter().map(value).collect())
}
