//! PLY: a header that says what is there, then vertices and polygons, as text or binary.

use super::lines::{at_line, fan};
use super::{SurfaceFault, TriangleMesh, at_most};
use crate::Point;

/// Most corners of a polygon.
const MOST_CORNERS: f64 = 1000.0;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Format {
    Text,
    Little,
    Big,
}

/// The kind of a number: bytes, whether it is floating, whether it has a sign.
#[derive(Debug, Clone, Copy)]
struct Kind {
    bytes: usize,
    is_float: bool,
    is_signed: bool,
}

/// A property of an element; of a list its length comes first.
struct Property {
    name: String,
    length: Option<Kind>,
    kind: Kind,
}

/// A kind of elements.
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// What a file says of itself, and where its data start.
struct Header {
    format: Format,
    elements: Vec<Element>,
    start: usize,
}

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<TriangleMesh, SurfaceFault> {
    let Header { format, elements, start } = header(bytes)?;
    let mut input = Input { bytes, at: start, format };
    let mut mesh = TriangleMesh::default();
    for element in &elements {
        for _ in 0..element.count {
            match element.name.as_str() {
                "vertex" => {
                    let mut at = Point::<3>::repeat(f64::NAN);
                    for property in &element.properties {
                        let value = input.values(property)?;
                        let axis = ["x", "y", "z"].iter().position(|name| *name == property.name);
                        if let (Some(axis), [value]) = (axis, &value[..]) {
                            at[axis] = *value;
                        }
                    }
                    mesh.vertices.push(at);
                }
                "face" => {
                    for property in &element.properties {
                        let values = input.values(property)?;
                        if property.name.starts_with("vertex_ind") {
                            add_polygon(&mut mesh, &values, &input)?;
                        }
                    }
                }
                _ => {
                    for property in &element.properties {
                        input.values(property)?;
                    }
                }
            }
        }
    }
    Ok(mesh)
}

fn add_polygon(
    mesh: &mut TriangleMesh,
    values: &[f64],
    input: &Input<'_>,
) -> Result<(), SurfaceFault> {
    let n = mesh.vertices.len() as f64;
    if values.len() < 3 || values.iter().any(|value| !(0.0..n).contains(value)) {
        return Err(input.refuse("a face is not one of three or more vertices above"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tested above")]
    let polygon: Vec<u32> = values.iter().map(|value| *value as u32).collect();
    mesh.triangles.extend(fan(&polygon));
    at_most(mesh.triangles.len())
}

fn header(bytes: &[u8]) -> Result<Header, SurfaceFault> {
    let (mut format, mut elements): (_, Vec<Element>) = (None, Vec::new());
    let mut start = 0;
    for (nth, line) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
        start += line.len();
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", name, _] => {
                format = match name {
                    "ascii" => Some(Format::Text),
                    "binary_little_endian" => Some(Format::Little),
                    "binary_big_endian" => Some(Format::Big),
                    _ => return Err(at_line(nth, format!("there is no format {name}"))),
                };
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| at_line(nth, "an element has no count"))?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, of, name] => {
                let kinds = kind(length).zip(kind(of));
                let (Some((length, of)), Some(element)) = (kinds, elements.last_mut()) else {
                    return Err(at_line(nth, "this property cannot be read"));
                };
                let (name, length) = (name.to_owned(), Some(length));
                element.properties.push(Property { name, length, kind: of });
            }
            ["property", of, name] => {
                let (Some(of), Some(element)) = (kind(of), elements.last_mut()) else {
                    return Err(at_line(nth, "this property cannot be read"));
                };
                element.properties.push(Property { name: name.to_owned(), length: None, kind: of });
            }
            ["end_header"] => {
                let format = format.ok_or_else(|| at_line(nth, "the header says no format"))?;
                let is_empty = |element: &Element| element.properties.is_empty();
                if elements.iter().any(is_empty) {
                    return Err(at_line(nth, "an element has no properties"));
                }
                return Ok(Header { format, elements, start });
            }
            ["ply"] | ["comment" | "obj_info", ..] | [] => {}
            _ => return Err(at_line(nth, "this is no line of a PLY header")),
        }
    }
    Err(SurfaceFault::File { place: "header".to_owned(), found: "it has no end".to_owned() })
}

fn kind(name: &str) -> Option<Kind> {
    let (bytes, is_float, is_signed) = match name {
        "char" | "int8" => (1, false, true),
        "uchar" | "uint8" => (1, false, false),
        "short" | "int16" => (2, false, true),
        "ushort" | "uint16" => (2, false, false),
        "int" | "int32" => (4, false, true),
        "uint" | "uint32" => (4, false, false),
        "float" | "float32" => (4, true, true),
        "double" | "float64" => (8, true, true),
        _ => return None,
    };
    Some(Kind { bytes, is_float, is_signed })
}

/// The data of a file, number by number.
struct Input<'a> {
    bytes: &'a [u8],
    at: usize,
    format: Format,
}

impl Input<'_> {
    fn refuse(&self, found: &str) -> SurfaceFault {
        SurfaceFault::File { place: format!("byte {}", self.at), found: found.to_owned() }
    }

    /// The values of a property of one element: one, or those of a list.
    fn values(&mut self, property: &Property) -> Result<Vec<f64>, SurfaceFault> {
        let n = match property.length {
            None => 1.0,
            Some(kind) => self.number(kind)?,
        };
        if !(0.0..=MOST_CORNERS).contains(&n) {
            return Err(self.refuse("a list has no such length"));
        }
        (0..crate::whole(n)).map(|_| self.number(property.kind)).collect()
    }

    fn number(&mut self, kind: Kind) -> Result<f64, SurfaceFault> {
        if self.format == Format::Text {
            let rest = &self.bytes[self.at..];
            let space = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let word = rest[space..].split(u8::is_ascii_whitespace).next().unwrap_or_default();
            self.at += space + word.len();
            let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
            return number.ok_or_else(|| self.refuse("here is no number"));
        }
        let Some(bytes) = self.bytes.get(self.at..self.at + kind.bytes) else {
            return Err(self.refuse("the file ends within its data"));
        };
        self.at += kind.bytes;
        let mut eight = [0; 8];
        for (place, byte) in eight.iter_mut().zip(bytes) {
            *place = *byte;
        }
        if self.format == Format::Big {
            eight[..kind.bytes].reverse();
        }
        let bits = u64::from_le_bytes(eight);
        Ok(match (kind.is_float, kind.bytes) {
            (true, 8) => f64::from_bits(bits),
            (true, _) => f64::from(f32::from_le_bytes([eight[0], eight[1], eight[2], eight[3]])),
            (false, bytes) => {
                let value = bits as f64;
                let wrap =
                    256.0_f64.powi(if bytes == 1 { 1 } else { i32::from(bytes == 4) * 2 + 2 });
                if kind.is_signed && value >= 0.5 * wrap { value - wrap } else { value }
            }
        })
    }
}
