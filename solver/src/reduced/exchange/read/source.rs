//! Elements of a file with their lines: attributes as numbers, and what is said of an element.

use std::fmt;

use nalgebra::Vector3;
use roxmltree::Node;

/// What is said of an element: why it is refused, or what of it is left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// Line of the file, from 1.
    pub line: u32,
    /// The element with its name, `<joint name="tail">`; none of the whole file.
    pub element: Option<String>,
    /// What is said.
    pub what: String,
    /// What would be accepted, of what is refused.
    pub help: Option<String>,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.line)?;
        if let Some(element) = &self.element {
            write!(f, "{element}: ")?;
        }
        f.write_str(&self.what)?;
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// What comes of reading.
pub(super) type Read<T> = Result<T, Remark>;

/// What an element is called in messages.
fn label(node: Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    match ["name", "class", "joint", "site"]
        .iter()
        .find_map(|key| Some((*key, node.attribute(*key)?)))
    {
        Some((key, value)) => {
            let short: String = value.chars().filter(|c| !c.is_control()).take(60).collect();
            format!("<{tag} {key}=\"{short}\">")
        }
        None => format!("<{tag}>"),
    }
}

/// Something said of an element.
pub(super) fn remark(node: Node<'_, '_>, what: impl Into<String>) -> Remark {
    let line = node.document().text_pos_at(node.range().start).row;
    Remark { line, element: Some(label(node)), what: what.into(), help: None }
}

/// An element that is refused.
pub(super) fn refuse<T>(
    node: Node<'_, '_>,
    what: impl Into<String>,
    help: impl Into<String>,
) -> Read<T> {
    Err(Remark { help: Some(help.into()), ..remark(node, what) })
}

/// Numbers of an attribute's text.
///
/// # Errors
/// When a word is no finite number.
pub(super) fn numbers(node: Node<'_, '_>, name: &str, text: &str) -> Read<Vec<f64>> {
    let mut values = Vec::new();
    for word in text.split_whitespace() {
        match word.parse::<f64>().ok().filter(|value| value.is_finite()) {
            Some(value) => values.push(value),
            None => {
                let short: String = word.chars().take(40).collect();
                let what = format!("`{name}` has \"{short}\"");
                return refuse(node, what, "finite numbers with spaces between them");
            }
        }
    }
    Ok(values)
}

/// As many numbers as are asked for.
///
/// # Errors
/// When there are others, or more, or fewer.
pub(super) fn exactly<const N: usize>(
    node: Node<'_, '_>,
    name: &str,
    text: &str,
) -> Read<[f64; N]> {
    let values = numbers(node, name, text)?;
    let n = values.len();
    match <[f64; N]>::try_from(values) {
        Ok(values) => Ok(values),
        Err(_) => {
            let numbers = |n: usize| format!("{n} number{}", if n == 1 { "" } else { "s" });
            let what = format!("`{name}` has {}", numbers(n));
            refuse(node, what, format!("{} with spaces between them", numbers(N)))
        }
    }
}

/// A number of 0 or more.
///
/// # Errors
/// When it is below 0.
pub(super) fn not_negative(node: Node<'_, '_>, name: &str, value: f64) -> Read<f64> {
    if value < 0.0 {
        return refuse(node, format!("`{name}` is {value}"), "a number of 0 or more");
    }
    Ok(value)
}

/// A unit vector along one of any length.
///
/// # Errors
/// When its length is zero.
pub(super) fn unit(node: Node<'_, '_>, name: &str, vector: [f64; 3]) -> Read<Vector3<f64>> {
    let vector = Vector3::from(vector);
    match vector.try_normalize(1e-12) {
        // A unit vector stays as it is to the last bit
        Some(_) if (vector.norm_squared() - 1.0).abs() < 4.0 * f64::EPSILON => Ok(vector),
        Some(unit) => Ok(unit),
        None => refuse(node, format!("`{name}` has the length zero"), "a direction"),
    }
}

/// The elements below one, without texts and comments.
pub(super) fn children<'a, 'i: 'a>(
    node: Node<'a, 'i>,
) -> impl Iterator<Item = Node<'a, 'i>> + use<'a, 'i> {
    node.children().filter(Node::is_element)
}
