//! `Formula`: a number, or an expression of x, y, z, t and the numbers of `[define]`.

mod dual;
mod error;
pub mod expressions;
mod function;
mod node;
mod parse;

use std::fmt;

use num_dual::DualNum;
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize};

pub use self::error::FormulaError;
use self::function::Function;
use self::node::Node;
pub use self::node::{Definitions, Place};

/// A number, or an expression as it is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Formula {
    /// The same everywhere and at all times.
    Number(f64),
    /// An expression of x, y, z (m), t (s) and numbers of `[define]`.
    Expression(String),
}

/// A formula whose names are known.
#[derive(Debug, Clone, PartialEq)]
pub struct ParsedFormula {
    root: Node,
}

impl ParsedFormula {
    /// Its value at a place and a time.
    #[must_use]
    pub fn at(&self, place: &Place) -> f64 {
        self.root.at(place)
    }

    /// Its value at what stands for x, y, z and t, with the derivatives these carry.
    #[must_use]
    pub fn dual<D: DualNum<Primitive = f64> + Copy>(&self, place: &[D; 4]) -> D {
        self.root.dual(place)
    }

    /// Whether it changes in time.
    #[must_use]
    pub fn has_time(&self) -> bool {
        self.root.has(&[3])
    }

    /// Whether it is the same everywhere and at all times.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        !self.root.has(&[0, 1, 2, 3])
    }
}

/// An expression of variables with any names, which are in brackets: `[eel.x] - [target.x]`.
///
/// A text that is such a name needs none, nor does a name of letters, digits and _.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    root: Node,
}

impl Expression {
    /// An expression of numbers that a case defines, and of variables.
    ///
    /// # Errors
    /// Where in the text something is not understood, and what would be.
    pub fn parse(
        text: &str,
        definitions: &Definitions,
        variables: &[String],
    ) -> Result<Self, FormulaError> {
        let whole = variables.iter().position(|name| name == text.trim());
        let root = match whole {
            Some(which) => Node::Variable(which),
            None => {
                let known = parse::Known::Names(variables);
                parse::parse(text, definitions, known).or_else(|error| {
                    // A name that nobody has, rather than numbers that are none
                    if !is_dotted(text.trim()) {
                        return Err(error);
                    }
                    parse::parse(&format!("[{}]", text.trim()), definitions, known)
                })?
            }
        };
        Ok(Self { root })
    }

    /// Its value by those of the variables.
    #[inline]
    #[must_use]
    pub fn at(&self, variables: &[f64]) -> f64 {
        self.root.at(variables)
    }

    /// The variables it depends on, by their numbers.
    #[must_use]
    pub fn variables(&self) -> Vec<usize> {
        let mut variables = Vec::new();
        self.root.collect(&mut variables);
        variables
    }

    /// Gives its variables other numbers.
    pub fn renumber(&mut self, number: &impl Fn(usize) -> usize) {
        self.root.renumber(number);
    }
}

impl Formula {
    /// It, with the numbers that a case defines, in a problem of so many dimensions.
    ///
    /// # Errors
    /// Where in the text something is not understood, and what would be.
    pub fn parsed(
        &self,
        definitions: &Definitions,
        dimensions: usize,
    ) -> Result<ParsedFormula, FormulaError> {
        let root = match self {
            Self::Number(value) => Node::Number(*value),
            Self::Expression(text) => {
                parse::parse(text, definitions, parse::Known::Place { dimensions })?
            }
        };
        Ok(ParsedFormula { root })
    }

    /// It, with the numbers that a case defines, where s, which stands for x, and t are known.
    ///
    /// # Errors
    /// As [`Self::parsed`].
    pub fn along_midline(&self, definitions: &Definitions) -> Result<ParsedFormula, FormulaError> {
        let root = match self {
            Self::Number(value) => Node::Number(*value),
            Self::Expression(text) => parse::parse(text, definitions, parse::Known::Midline)?,
        };
        Ok(ParsedFormula { root })
    }

    /// It, if it is written as a number.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Expression(_) => None,
        }
    }
}

/// Whether a text looks like the name of a quantity: `eel-1.velocity.x`.
fn is_dotted(text: &str) -> bool {
    let is_in = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.contains('.')
        && text.chars().all(is_in)
}

/// Numbers, if all of these are written so.
#[must_use]
pub fn numbers(formulas: &[Formula]) -> Option<Vec<f64>> {
    formulas.iter().map(Formula::number).collect()
}

/// Why a name cannot be one of `[define]`; nothing if it can.
#[must_use]
pub fn mistake_in_name(name: &str) -> Option<String> {
    let is_word = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_word {
        return Some("a name has letters, digits and _, a letter first".to_owned());
    }
    let is_taken = parse::VARIABLES.contains(&name)
        || parse::CONSTANTS.iter().any(|(known, _)| *known == name)
        || Function::named(name).is_some();
    is_taken.then(|| "this name has a meaning in expressions already".to_owned())
}

impl fmt::Display for Formula {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(formatter, "{value}"),
            Self::Expression(text) => write!(formatter, "\"{text}\""),
        }
    }
}

impl<'de> Deserialize<'de> for Formula {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AsFormula;

        impl Visitor<'_> for AsFormula {
            type Value = Formula;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a number, or an expression such as \"1 - y^2\"")
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Formula, E> {
                Ok(Formula::Number(value))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Formula, E> {
                Ok(Formula::Number(value as f64))
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Formula, E> {
                Ok(Formula::Number(value as f64))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Formula, E> {
                Ok(Formula::Expression(text.to_owned()))
            }
        }

        deserializer.deserialize_any(AsFormula)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, place: Place) -> f64 {
        let definitions = Definitions::from([("Re".to_owned(), 20.0), ("u_max".to_owned(), 1.5)]);
        let formula = Formula::Expression(text.to_owned());
        formula.parsed(&definitions, 3).unwrap_or_else(|error| panic!("{text}: {error}")).at(&place)
    }

    #[test]
    fn expressions_mean_what_they_mean_on_paper() {
        let place = [3.0, 0.5, -2.0, 0.25];
        for (text, wanted) in [
            ("-3^2", -9.0),
            ("-x^2", -9.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("2*-y^2", -0.5),
            ("1e-3 * 1.5E3", 1.5),
            (".5 + 2.", 2.5),
            ("1 - 2 - 3", -4.0),
            ("12 / 2 / 3", 2.0),
            ("(x + y) * z", -7.0),
            ("4*u_max*y*(1 - y)", 1.5),
            ("1/Re", 0.05),
            ("sin(2*pi*t)", 1.0),
            ("max(x, 2, 7) - min(y, 1)", 6.5),
            ("if(x > 2, 1, -1) + if(x < 2, 10, 20)", 21.0),
            ("if(t <= 0.25, 1, 0) + if(t >= 0.26, 1, 0)", 1.0),
            ("atan2(1, 1) * 4 / pi", 1.0),
            ("exp(log(x)) + sqrt(16) + abs(z) + sign(z)", 8.0),
            ("floor(2.7) + tanh(0) + cosh(0)", 3.0),
            ("+x", 3.0),
            ("--3", 3.0),
        ] {
            let found = value(text, place);
            assert!((found - wanted).abs() < 1e-14, "{text} is {found}, not {wanted}");
        }
    }

    #[test]
    fn mistakes_have_their_place() {
        let definitions = Definitions::from([("speed".to_owned(), 1.0)]);
        for (text, column, part) in [
            ("1 - w^2", 5, "`w`"),
            ("sped * y", 1, "speed"),
            ("1 +", 4, "the end"),
            ("", 1, "the end"),
            ("2 x", 3, "`x`"),
            ("(1 + y", 7, "the end"),
            ("1 + y)", 6, "`)`"),
            ("sin y", 5, "`y`"),
            ("sin(y, 2)", 1, "1 argument"),
            ("atan2(y)", 1, "2 arguments"),
            ("y ** 2", 4, "`*`"),
            ("1 $ 2", 3, "`$`"),
            ("sine(y)", 1, "sin"),
            ("y(2)", 2, "`(`"),
            ("1.2.3", 1, "1.2.3"),
            ("1 < 2 < 3", 7, "`<`"),
            ("z", 1, "z"),
        ] {
            let formula = Formula::Expression(text.to_owned());
            let error = formula.parsed(&definitions, 2).expect_err(text);
            assert_eq!(error.column, column, "{text}: {error}");
            assert!(error.to_string().contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn names_of_variables_are_in_brackets() {
        let names = ["eel-1.x", "target.x", "way"].map(str::to_owned);
        let definitions = Definitions::from([("reach".to_owned(), 2.0)]);
        let at = |text: &str| {
            Expression::parse(text, &definitions, &names).map(|found| found.at(&[3.0, 1.0, 5.0]))
        };
        assert_eq!(at("eel-1.x"), Ok(3.0));
        assert_eq!(at("([eel-1.x] - [ target.x ])^reach + way - [way]"), Ok(4.0));
        let wrong = |text: &str| at(text).expect_err(text);
        assert_eq!(wrong("1 + [eel-2.x]").column, 5);
        assert!(wrong("1 + [eel-2.x]").accepted.contains("did you mean `eel-1.x`"));
        assert!(wrong("[way").found.contains("end"));
        assert!(wrong("x").found.contains("there is no `x`"));
        assert_eq!(wrong("way]").column, 4);
    }

    #[test]
    fn deep_nesting_is_refused() {
        let text = format!("{}1{}", "(".repeat(5000), ")".repeat(5000));
        assert!(Formula::Expression(text).parsed(&Definitions::new(), 2).is_err());
        let text = "-".repeat(5000) + "1";
        assert!(Formula::Expression(text).parsed(&Definitions::new(), 2).is_err());
    }

    #[test]
    fn what_an_expression_depends_on_is_known() {
        let parsed = |text: &str| {
            let formula = Formula::Expression(text.to_owned());
            formula.parsed(&Definitions::new(), 3).unwrap()
        };
        assert!(parsed("sin(t)").has_time() && !parsed("x*y").has_time());
        assert!(parsed("2*pi").is_constant() && !parsed("z").is_constant());
    }
}
