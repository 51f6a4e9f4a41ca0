//! `Input`: numbers and lines of a file, as text or binary, with the place of each.

use super::error::{MshError, Place};

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Numbers {
    Text,
    LittleEndian,
    BigEndian,
}

/// A file that is being read.
#[derive(Debug)]
pub struct Input<'a> {
    bytes: &'a [u8],
    at: usize,
    numbers: Numbers,
    is_binary: bool,
}

/// Longest piece of a file that a message shows.
const SHOWN: usize = 40;

impl<'a> Input<'a> {
    /// The beginning of a file.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, numbers: Numbers::Text, is_binary: false }
    }

    /// From now on sections have binary numbers; the file says by the bytes of the integer 1 in which
    /// order.
    pub fn set_binary(&mut self) -> Result<(), MshError> {
        let one: [u8; 4] = self.take()?;
        self.is_binary = true;
        match (i32::from_le_bytes(one), i32::from_be_bytes(one)) {
            (1, _) => self.numbers = Numbers::LittleEndian,
            (_, 1) => self.numbers = Numbers::BigEndian,
            _ => return Err(self.refuse("no integer 1 after the version", "the binary number 1")),
        }
        Ok(())
    }

    /// From now on numbers are text, which they are in some sections of a binary file, too.
    pub fn as_text<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, MshError>,
    ) -> Result<T, MshError> {
        let numbers = std::mem::replace(&mut self.numbers, Numbers::Text);
        let result = read(self);
        self.numbers = numbers;
        result
    }

    /// Whether nothing is left but white space.
    pub fn is_at_end(&mut self) -> bool {
        self.skip_space();
        self.at == self.bytes.len()
    }

    fn place_of(&self, at: usize) -> Place {
        if self.is_binary {
            return Place::Byte(at);
        }
        let before = &self.bytes[..at.min(self.bytes.len())];
        Place::Line(before.iter().filter(|byte| **byte == b'\n').count() + 1)
    }

    /// The number of the next byte.
    pub fn at(&self) -> usize {
        self.at
    }

    /// An error at the next byte.
    pub fn refuse(&self, found: impl Into<String>, accepted: &str) -> MshError {
        self.refuse_at(self.at, found, accepted)
    }

    /// An error at a byte.
    pub fn refuse_at(&self, at: usize, found: impl Into<String>, accepted: &str) -> MshError {
        let place = self.place_of(at);
        MshError { place, found: found.into(), accepted: accepted.to_owned() }
    }

    fn skip_space(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// The rest of the line, without white space around it; goes behind its end.
    pub fn line(&mut self) -> Result<&'a str, MshError> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
        let Ok(text) = std::str::from_utf8(&rest[..length]) else {
            return Err(self.refuse("what is no text in UTF-8", "a line of text"));
        };
        self.at = (self.at + length + 1).min(self.bytes.len());
        Ok(text.trim())
    }

    /// The next word of a text.
    fn word(&mut self, accepted: &str) -> Result<&'a str, MshError> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        if length == 0 {
            return Err(self.refuse("the end of the file", accepted));
        }
        let Ok(word) = std::str::from_utf8(&rest[..length]) else {
            return Err(self.refuse("what is no text in UTF-8", accepted));
        };
        self.at += length;
        Ok(word)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], MshError> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(bytes) => {
                self.at += N;
                Ok(*bytes)
            }
            None => Err(self.refuse("the end of the file", &format!("{N} bytes of a number"))),
        }
    }

    fn parse<T: std::str::FromStr>(&mut self, accepted: &str) -> Result<T, MshError> {
        let word = self.word(accepted)?;
        let start = self.at - word.len();
        word.parse().map_err(|_| self.refuse_at(start, format!("`{}`", shown(word)), accepted))
    }

    /// An integer of 32 bits.
    pub fn integer(&mut self) -> Result<i32, MshError> {
        match self.numbers {
            Numbers::Text => self.parse("an integer"),
            Numbers::LittleEndian => self.take().map(i32::from_le_bytes),
            Numbers::BigEndian => self.take().map(i32::from_be_bytes),
        }
    }

    /// A count or a tag of 64 bits, not negative.
    pub fn number(&mut self) -> Result<u64, MshError> {
        match self.numbers {
            Numbers::Text => self.parse("a number from 0 on"),
            Numbers::LittleEndian => self.take().map(u64::from_le_bytes),
            Numbers::BigEndian => self.take().map(u64::from_be_bytes),
        }
    }

    /// Whether numbers are binary.
    pub fn is_binary(&self) -> bool {
        self.is_binary
    }

    /// A tag of 32 bits, not negative.
    pub fn tag(&mut self) -> Result<u64, MshError> {
        let start = self.at;
        let found = self.integer()?;
        u64::try_from(found)
            .map_err(|_| self.refuse_at(start, format!("the tag {found}"), "tags are not negative"))
    }

    /// A count of 32 bits, never more than the file can hold.
    pub fn small(&mut self, what: &str) -> Result<usize, MshError> {
        let start = self.at;
        let found = self.integer()?;
        match usize::try_from(found) {
            Ok(count) if count <= self.bytes.len() - self.at => Ok(count),
            _ => {
                let found = format!("{found} {what}");
                Err(self.refuse_at(start, found, "the file is damaged or cut off"))
            }
        }
    }

    /// A count that is text on a line of its own, as in binary files of version 2.2.
    pub fn count_in_line(&mut self, what: &str, least_bytes: usize) -> Result<usize, MshError> {
        let count = self.as_text(|input| input.count(what, least_bytes))?;
        if self.is_binary && self.bytes.get(self.at) == Some(&b'\r') {
            self.at += 1;
        }
        if self.is_binary && self.bytes.get(self.at) == Some(&b'\n') {
            self.at += 1;
        }
        Ok(count)
    }

    /// A floating-point number, which is finite.
    pub fn float(&mut self) -> Result<f64, MshError> {
        let value: f64 = match self.numbers {
            Numbers::Text => self.parse("a number")?,
            Numbers::LittleEndian => self.take().map(f64::from_le_bytes)?,
            Numbers::BigEndian => self.take().map(f64::from_be_bytes)?,
        };
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.refuse(format!("the number {value}"), "a finite one is needed"))
    }

    /// A count of things, each of which takes some bytes in the file at least: never more than the file
    /// can hold.
    pub fn count(&mut self, what: &str, least_bytes: usize) -> Result<usize, MshError> {
        let start = self.at;
        let count = self.number()?;
        let left = self.bytes.len() - self.at;
        match usize::try_from(count) {
            Ok(count) if count <= left / least_bytes.max(1) + 1 => Ok(count),
            _ => {
                let found = format!("{count} {what}, but {left} bytes are left");
                Err(self.refuse_at(start, found, "the file is damaged or cut off"))
            }
        }
    }

    /// The name of the next section, as in `$Nodes`.
    pub fn section(&mut self) -> Result<&'a str, MshError> {
        self.skip_space();
        let start = self.at;
        let line = self.line()?;
        line.strip_prefix('$').ok_or_else(|| {
            let expected = "the beginning of a section is expected, such as $Nodes";
            self.refuse_at(start, format!("`{}`", shown(line)), expected)
        })
    }

    /// The end of a section.
    pub fn end_of(&mut self, section: &str) -> Result<(), MshError> {
        self.skip_space();
        let start = self.at;
        let line = self.line()?;
        if line.strip_prefix("$End") == Some(section) {
            return Ok(());
        }
        let expected = format!("$End{section} is expected");
        Err(self.refuse_at(start, format!("`{}`", shown(line)), &expected))
    }

    /// Goes behind the end of a section that does not matter.
    pub fn skip(&mut self, section: &str) -> Result<(), MshError> {
        let end = format!("$End{section}");
        let rest = &self.bytes[self.at..];
        match rest.windows(end.len()).position(|window| window == end.as_bytes()) {
            Some(length) => {
                self.at += length;
                self.end_of(section)
            }
            None => Err(self.refuse(format!("no end of ${section}"), &format!("{end} is missing"))),
        }
    }
}

/// The beginning of a text, for a message.
fn shown(text: &str) -> String {
    let text: String = text.chars().filter(|c| !c.is_control()).collect();
    if text.chars().count() <= SHOWN {
        return text;
    }
    let start: String = text.chars().take(SHOWN).collect();
    format!("{start}...")
}
