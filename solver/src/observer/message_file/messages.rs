//! `Messages`: the messages of a `run.mcap`, up to its end or to its first damage.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io;

use mcap::read::parse_record;
use mcap::records::{ChunkHeader, MessageHeader, Record, op};
use mcap::{MAGIC, Schema};

/// Longest chunk that is unpacked (bytes): a chunk ends with the message in which it gets too long.
const LONGEST_CHUNK: u64 = 1 << 28;
/// Bytes in front of a record: what it is, and its length.
const FRAME: usize = 9;

/// A schema.
#[derive(Debug, Clone)]
pub struct OwnSchema {
    /// Its name.
    pub name: String,
    /// How it is written.
    pub encoding: String,
    /// What it says.
    pub data: Vec<u8>,
}

impl OwnSchema {
    /// The same for a writer.
    pub fn to_mcap(&self) -> Schema<'_> {
        Schema {
            id: 0,
            name: self.name.clone(),
            encoding: self.encoding.clone(),
            data: Cow::Borrowed(&self.data),
        }
    }
}

/// One message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnMessage {
    /// What it is about.
    pub topic: String,
    /// Its schema, by its number in [`Messages::schemas`].
    pub schema: u16,
    /// Simulated time (ns).
    pub time: u64,
    /// Its content.
    pub data: Vec<u8>,
}

/// What can be read of a file.
#[derive(Debug, Default)]
pub struct Messages {
    /// The schemas by their numbers.
    pub schemas: BTreeMap<u16, OwnSchema>,
    /// The messages of all whole chunks before the first damage.
    pub all: Vec<OwnMessage>,
    /// What is damaged, if anything is. A file that only stops, as that of a process that was killed, is not.
    pub damage: Option<String>,
    topics: BTreeMap<u16, Topic>,
    /// Number of the next message.
    sequence: u32,
}

#[derive(Debug)]
struct Topic {
    name: String,
    schema: u16,
}

impl Messages {
    /// Those in the bytes of a file. Numbers of messages, lengths and checksums are checked; what comes after the
    /// first that is wrong is left out, with the whole chunk it is in.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Self {
        let mut messages = Self::default();
        if let Err(error) = messages.read_file(bytes) {
            messages.damage = Some(error.to_string());
        }
        messages
    }

    fn read_file(&mut self, bytes: &[u8]) -> io::Result<()> {
        // A file that ends within its first bytes was killed then
        let Some(mut rest) = bytes.strip_prefix(MAGIC) else {
            let is_begun = MAGIC.starts_with(bytes);
            return if is_begun {
                Ok(())
            } else {
                Err(damaged("it does not begin as an MCAP file"))
            };
        };
        while let Some(record) = next_record(&mut rest) {
            match record.kind {
                op::CHUNK => self.read_chunk(record.body)?,
                op::DATA_END => return Ok(()),
                op::HEADER | op::ATTACHMENT | op::METADATA | op::MESSAGE_INDEX => {}
                other => return Err(damaged(&format!("a record is of the unknown kind {other}"))),
            }
        }
        Ok(())
    }

    fn read_chunk(&mut self, body: &[u8]) -> io::Result<()> {
        let Record::Chunk { header, data } = parse_record(op::CHUNK, body).map_err(no_record)?
        else {
            return Err(damaged("a chunk is none"));
        };
        let content = unpack(&header, &data)?;
        let mut rest = content.as_slice();
        while let Some(record) = next_record(&mut rest) {
            if !matches!(record.kind, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
                return Err(damaged("a chunk holds what does not belong there"));
            }
            self.take(parse_record(record.kind, record.body).map_err(no_record)?)?;
        }
        if rest.is_empty() { Ok(()) } else { Err(damaged("a chunk ends within a record")) }
    }

    fn take(&mut self, record: Record<'_>) -> io::Result<()> {
        match record {
            Record::Schema { header, data } => {
                let (name, encoding, data) = (header.name, header.encoding, data.into_owned());
                self.schemas.insert(header.id, OwnSchema { name, encoding, data });
            }
            Record::Channel(channel) => {
                let topic = Topic { name: channel.topic, schema: channel.schema_id };
                self.topics.insert(channel.id, topic);
            }
            Record::Message { header, data } => self.take_message(&header, data.into_owned())?,
            _ => {}
        }
        Ok(())
    }

    fn take_message(&mut self, header: &MessageHeader, data: Vec<u8>) -> io::Result<()> {
        let topic = self.topics.get(&header.channel_id);
        let topic = topic.ok_or_else(|| damaged("a message belongs to no topic"))?;
        if header.sequence != self.sequence {
            return Err(damaged("messages are missing"));
        }
        self.sequence = self.sequence.wrapping_add(1);
        let (topic, schema) = (topic.name.clone(), topic.schema);
        self.all.push(OwnMessage { topic, schema, time: header.log_time, data });
        Ok(())
    }
}

/// A record as it lies in a file.
struct Framed<'a> {
    kind: u8,
    body: &'a [u8],
}

/// The next whole record; nothing at the end, or where a record is not whole.
fn next_record<'a>(rest: &mut &'a [u8]) -> Option<Framed<'a>> {
    let (frame, after) = rest.split_at_checked(FRAME)?;
    let length = frame[1..].iter().rev().fold(0_u64, |sum, byte| (sum << 8) | u64::from(*byte));
    let (body, after) = after.split_at_checked(usize::try_from(length).ok()?)?;
    *rest = after;
    Some(Framed { kind: frame[0], body })
}

/// The content of a chunk, with the checksum it should have.
fn unpack(header: &ChunkHeader, data: &[u8]) -> io::Result<Vec<u8>> {
    if header.uncompressed_size > LONGEST_CHUNK {
        return Err(damaged("a chunk is too long"));
    }
    let size = usize::try_from(header.uncompressed_size).map_err(io::Error::other)?;
    let content = match header.compression.as_str() {
        "zstd" => zstd::bulk::decompress(data, size)?,
        other => return Err(damaged(&format!("a chunk is compressed by `{other}`"))),
    };
    if content.len() != size || crc32fast::hash(&content) != header.uncompressed_crc {
        return Err(damaged("the checksum of a chunk is not that of its content"));
    }
    Ok(content)
}

fn no_record(error: mcap::McapError) -> io::Error {
    damaged(&error.to_string())
}

fn damaged(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.to_owned())
}
