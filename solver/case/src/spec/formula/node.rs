//! `Node`: a part of an expression, and what it is evaluated with.

use std::collections::BTreeMap;

use super::function::Function;

/// The numbers of `[define]`, by their names.
pub type Definitions = BTreeMap<String, f64>;

/// Where and when an expression is evaluated: x, y, z (m) and t (s).
pub type Place = [f64; 4];

/// A part of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    Number(f64),
    /// x, y, z or t by its number, or one of other variables.
    Variable(usize),
    Call(Function, Vec<Node>),
}

impl Node {
    /// Its value by those of the variables.
    #[inline]
    pub fn at(&self, place: &[f64]) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Variable(which) => place.get(*which).copied().unwrap_or(f64::NAN),
            Self::Call(function, parts) => {
                let value = |nth: usize| parts.get(nth).map_or(f64::NAN, |part| part.at(place));
                function.value(value)
            }
        }
    }

    /// The numbers of all variables it depends on are added to these.
    pub fn collect(&self, variables: &mut Vec<usize>) {
        match self {
            Self::Number(_) => {}
            Self::Variable(which) => variables.push(*which),
            Self::Call(_, parts) => parts.iter().for_each(|part| part.collect(variables)),
        }
    }

    /// It with other numbers for its variables.
    pub fn renumber(&mut self, number: &impl Fn(usize) -> usize) {
        match self {
            Self::Number(_) => {}
            Self::Variable(which) => *which = number(*which),
            Self::Call(_, parts) => parts.iter_mut().for_each(|part| part.renumber(number)),
        }
    }

    /// Whether it depends on one of these, by their numbers.
    pub fn has(&self, variables: &[usize]) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Variable(which) => variables.contains(which),
            Self::Call(_, parts) => parts.iter().any(|part| part.has(variables)),
        }
    }
}
