//! `Defaults`: classes of MJCF, and an element with the attributes that its class has for it.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use roxmltree::Node;

use super::source::{Read, children, exactly, not_negative, numbers, refuse};

/// The class of all that names none.
const MAIN: &str = "main";

/// Most classes, which may be one below the other.
const MOST_CLASSES: usize = 1000;

/// A class: its elements by their tags, and the class it refines.
struct Class<'a, 'i> {
    above: Option<String>,
    elements: BTreeMap<&'a str, Node<'a, 'i>>,
}

/// All classes of a file.
pub(super) struct Defaults<'a, 'i> {
    classes: BTreeMap<String, Class<'a, 'i>>,
    /// Elements that were read.
    n_read: usize,
}

impl<'a, 'i> Defaults<'a, 'i> {
    /// Those of a file without any.
    pub fn none() -> Self {
        Self { classes: BTreeMap::new(), n_read: 0 }
    }

    /// Reads a `<default>` with those below it.
    ///
    /// # Errors
    /// When one below another has no name.
    pub fn add(&mut self, node: Node<'a, 'i>, above: Option<&str>) -> Read<()> {
        let name = match (node.attribute("class"), above) {
            (Some(name), _) => name,
            (None, None) => MAIN,
            (None, Some(_)) => {
                return refuse(node, "a class below another has no name", "class=\"NAME\"");
            }
        };
        self.n_read += 1;
        if self.n_read > MOST_CLASSES {
            return refuse(
                node,
                "the file has too many classes",
                format!("at most {MOST_CLASSES}"),
            );
        }
        let fresh = || Class { above: above.map(str::to_owned), elements: BTreeMap::new() };
        // Several parts of a file may add to one class
        self.classes.entry(name.to_owned()).or_insert_with(fresh);
        for child in children(node) {
            if child.has_tag_name("default") {
                self.add(child, Some(name))?;
            } else if let Some(class) = self.classes.get_mut(name) {
                class.elements.insert(child.tag_name().name(), child);
            }
        }
        Ok(())
    }

    /// An element of a file within a body of a class.
    ///
    /// # Errors
    /// When its class is not there.
    pub fn of<'d>(&'d self, node: Node<'a, 'i>, class: &'d str) -> Read<Element<'d, 'a, 'i>> {
        let own = node.attribute("class");
        if let Some(own) = own.filter(|own| *own != MAIN && !self.classes.contains_key(*own)) {
            let names: Vec<&str> = self.classes.keys().map(String::as_str).collect();
            let what = format!("there is no class \"{own}\"");
            return refuse(node, what, format!("classes: {}", names.join(", ")));
        }
        let class = own.map_or_else(|| class.to_owned(), str::to_owned);
        Ok(Element { node, class, defaults: self })
    }

    fn find(&self, class: &str, tag: &str, name: &str) -> Option<&'a str> {
        let mut at = Some(class);
        // A class above another is another one: as many steps as there are classes
        for _ in 0..=self.classes.len() {
            let class = self.classes.get(at?)?;
            let found = class.elements.get(tag).and_then(|node| node.attribute(name));
            if found.is_some() {
                return found;
            }
            at = class.above.as_deref();
        }
        None
    }
}

/// The class of what is outside of all bodies.
pub(super) const OUTSIDE: &str = MAIN;

/// An element with what its class has for it.
pub(super) struct Element<'d, 'a, 'i> {
    pub node: Node<'a, 'i>,
    class: String,
    defaults: &'d Defaults<'a, 'i>,
}

impl<'a> Element<'_, 'a, '_> {
    /// An attribute.
    pub fn text(&self, name: &str) -> Option<&'a str> {
        let tag = self.node.tag_name().name();
        self.node.attribute(name).or_else(|| self.defaults.find(&self.class, tag, name))
    }

    /// A number, or what stands for it.
    ///
    /// # Errors
    /// When it is none.
    pub fn number(&self, name: &str, absent: f64) -> Read<f64> {
        match self.text(name) {
            Some(text) => exactly::<1>(self.node, name, text).map(|[value]| value),
            None => Ok(absent),
        }
    }

    /// A number of 0 or more, or what stands for one that is absent.
    ///
    /// # Errors
    /// When it is none, or below 0.
    pub fn not_negative(&self, name: &str, absent: f64) -> Read<f64> {
        not_negative(self.node, name, self.number(name, absent)?)
    }

    /// Numbers, as many as there are.
    ///
    /// # Errors
    /// When one is none.
    pub fn numbers(&self, name: &str) -> Read<Option<Vec<f64>>> {
        self.text(name).map(|text| numbers(self.node, name, text)).transpose()
    }

    /// As many numbers as are asked for.
    ///
    /// # Errors
    /// When there are others, or more, or fewer.
    pub fn exactly<const N: usize>(&self, name: &str) -> Read<Option<[f64; N]>> {
        self.text(name).map(|text| exactly::<N>(self.node, name, text)).transpose()
    }

    /// A vector, zero where there is none.
    ///
    /// # Errors
    /// When it has not three numbers.
    pub fn vector(&self, name: &str) -> Read<Vector3<f64>> {
        Ok(self.exactly::<3>(name)?.map_or_else(Vector3::zeros, Vector3::from))
    }
}
