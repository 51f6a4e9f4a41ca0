//! `Markup`: elements and attributes as the text of XML.

use nalgebra::{Matrix3, Vector3};

/// What rounding leaves of zero beside numbers of the size of one.
const ROUNDING: f64 = 1e-15;

/// What rounding leaves of a rotation that is none: some of the last digits of a quaternion of 15.
const TURNED: f64 = 1e-14;

/// XML in the making, an element a line.
#[derive(Debug, Default)]
pub(super) struct Markup {
    text: String,
    open: Vec<&'static str>,
}

/// An element with its attributes, in order.
#[derive(Debug, Clone)]
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<[String; 2]>,
}

impl Element {
    pub fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new() }
    }

    /// The same with another attribute.
    pub fn with(mut self, name: &str, value: impl Into<String>) -> Self {
        self.attributes.push([name.to_owned(), value.into()]);
        self
    }

    /// The same with numbers.
    pub fn numbers(self, name: &str, values: &[f64]) -> Self {
        self.with(name, numbers(values))
    }

    /// The same with a vector, unless it is the one that is taken where none is written.
    pub fn unless(self, name: &str, value: &Vector3<f64>, absent: [f64; 3]) -> Self {
        let off = value - Vector3::from(absent);
        if off.amax() == 0.0 { self } else { self.numbers(name, value.as_slice()) }
    }

    /// The same with a number, unless it is zero.
    pub fn unless_zero(self, name: &str, value: f64) -> Self {
        if value == 0.0 { self } else { self.numbers(name, &[value]) }
    }
}

/// A number that is read back as itself to 1e-15 of it: the digits that rounding has made are left out.
pub(super) fn number(value: f64) -> String {
    let rounded = format!("{value:.14e}").parse().unwrap_or(value);
    // Of 0 and -0 the first
    let plain = if rounded == 0.0 { 0.0 } else { rounded };
    let (short, long) = (format!("{plain:e}"), format!("{plain}"));
    if long.len() <= short.len() + 6 { long } else { short }
}

/// Numbers as words. One that is nothing beside the others, 1e-15 of the largest, is what rounding has left of zero.
pub(super) fn words(values: &[f64]) -> Vec<String> {
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let word = |value: &f64| number(if value.abs() < ROUNDING * largest { 0.0 } else { *value });
    values.iter().map(word).collect()
}

/// Numbers with spaces between them.
pub(super) fn numbers(values: &[f64]) -> String {
    words(values).join(" ")
}

/// Whether a frame has the axes of another but for rounding.
pub(super) fn is_unturned(rotation: &Matrix3<f64>) -> bool {
    (rotation - Matrix3::identity()).amax() < TURNED
}

/// A text as part of XML: what marks elements and attributes is written by name, what XML 1.0 has no character for is a
/// question mark.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            '\t' => out.push_str("&#9;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('?'),
            c => out.push(c),
        }
    }
    out
}

impl Markup {
    /// XML that begins with remarks, a line each.
    pub fn new(remarks: &[String]) -> Self {
        let mut text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n".to_owned();
        for remark in remarks {
            // Two hyphens would end a comment
            let mut plain = escaped(remark);
            while plain.contains("--") {
                plain = plain.replace("--", "- -");
            }
            text += &format!("<!-- {plain} -->\n");
        }
        Self { text, open: Vec::new() }
    }

    fn begin(&mut self, element: &Element) {
        for _ in 0..self.open.len() {
            self.text.push_str("  ");
        }
        self.text.push('<');
        self.text.push_str(element.name);
        for [name, value] in &element.attributes {
            self.text += &format!(" {name}=\"{}\"", escaped(value));
        }
    }

    /// An element without others in it.
    pub fn put(&mut self, element: &Element) {
        self.begin(element);
        self.text.push_str("/>\n");
    }

    /// Begins an element with others in it, which [`Self::close`] ends.
    pub fn open(&mut self, element: &Element) {
        self.begin(element);
        self.text.push_str(">\n");
        self.open.push(element.name);
    }

    /// Ends the element that was begun last.
    pub fn close(&mut self) {
        let Some(name) = self.open.pop() else { return };
        for _ in 0..self.open.len() {
            self.text.push_str("  ");
        }
        self.text += &format!("</{name}>\n");
    }

    /// The text, with all elements ended.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::{Element, Markup, number};

    #[test]
    fn numbers_come_back_without_the_digits_of_rounding() {
        for value in [0.0, 1.0, -2.5, 0.1 + 0.2, 1e-300, 6.02e23, 1.0 / 3.0, -1e5] {
            let text = number(value);
            let back: f64 = text.parse().expect("it is a number");
            assert!((back - value).abs() <= 1e-14 * value.abs(), "{value} {text}");
        }
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-0.0), "0");
    }

    #[test]
    fn texts_stay_within_their_attribute_and_comment() {
        let mut markup = Markup::new(&["a --- b <c> --".to_owned()]);
        markup.open(&Element::new("a").with("name", "\"<&>'\u{1}"));
        markup.put(&Element::new("b"));
        let text = markup.finish();
        assert!(text.contains("name=\"&quot;&lt;&amp;&gt;'?\""), "{text}");
        assert!(text.contains("<!-- a - - - b &lt;c&gt; - - -->"), "{text}");
        assert!(text.ends_with("  <b/>\n</a>\n"), "{text}");
    }
}
