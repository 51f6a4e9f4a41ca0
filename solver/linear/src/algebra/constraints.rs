//! `AffineConstraints`: every raw unknown as a weighted sum of free unknowns plus a value.
//!
//! x = P y + g, with one row of P and one entry of g for each raw unknown. Dirichlet values,
//! periodicity, symmetry planes, the axis and rigid motion (u = U + omega x r + slip) are all of
//! this form, so a system A x = b is solved as P^T A P y = P^T (b - A g) without forming P: the
//! idea of AffineConstraints in deal.II (@bangerth2007).

use crate::sparse::index::to_u32;

/// Constraints that refer to constrained unknowns are followed through so many others at most.
const MAX_CHAIN: usize = 8;

/// An unknown with its weight in a sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term<I> {
    /// Index of the unknown.
    pub unknown: I,
    /// What it is multiplied by.
    pub weight: f64,
}

/// A constraint under construction: weights of raw unknowns, and a value.
#[derive(Debug, Clone, Default, PartialEq)]
struct Line {
    terms: Vec<Term<usize>>,
    value: f64,
}

/// Collects constraints, then resolves those that refer to constrained unknowns.
#[derive(Debug, Clone)]
pub struct ConstraintBuilder {
    lines: Vec<Option<Line>>,
}

impl ConstraintBuilder {
    /// No constraint on any of `n_raw` unknowns.
    #[must_use]
    pub fn new(n_raw: usize) -> Self {
        Self { lines: vec![None; n_raw] }
    }

    /// Whether a raw unknown is constrained already.
    #[must_use]
    pub fn is_constrained(&self, raw: usize) -> bool {
        self.lines[raw].is_some()
    }

    /// Sets x\[raw\] = sum of weight x\[other\] + value in place of an earlier constraint, if any.
    pub fn constrain(&mut self, raw: usize, terms: Vec<Term<usize>>, value: f64) {
        self.lines[raw] = Some(Line { terms, value });
    }

    /// Sets x\[raw\] = value.
    pub fn fix(&mut self, raw: usize, value: f64) {
        self.constrain(raw, Vec::new(), value);
    }

    /// Sets x\[raw\] = x\[other\].
    pub fn equate(&mut self, raw: usize, other: usize) {
        self.constrain(raw, vec![Term { unknown: other, weight: 1.0 }], 0.0);
    }

    /// Numbers the free unknowns in the order of the raw ones and expands all constraints.
    ///
    /// # Panics
    /// When constraints refer to each other in a cycle: a mistake in the program.
    #[must_use]
    pub fn build(self) -> AffineConstraints {
        let mut n_unknowns = 0;
        let number = |line: &Option<Line>| {
            let is_free = line.is_none();
            n_unknowns += usize::from(is_free);
            is_free.then(|| to_u32(n_unknowns - 1))
        };
        let unknown_of: Vec<Option<u32>> = self.lines.iter().map(number).collect();
        let mut constraints = AffineConstraints {
            offsets: vec![0],
            terms: Vec::with_capacity(self.lines.len()),
            values: Vec::with_capacity(self.lines.len()),
            unknown_of: unknown_of.clone(),
            n_unknowns,
        };
        for raw in 0..self.lines.len() {
            let first = constraints.terms.len();
            let value = self.expand(raw, 1.0, &unknown_of, &mut constraints.terms, 0);
            merge(&mut constraints.terms, first);
            constraints.values.push(value);
            constraints.offsets.push(to_u32(constraints.terms.len()));
        }
        constraints
    }

    /// Appends `weight` x\[raw\] in terms of free unknowns to `terms` and returns the value added.
    fn expand(
        &self,
        raw: usize,
        weight: f64,
        unknown_of: &[Option<u32>],
        terms: &mut Vec<Term<u32>>,
        depth: usize,
    ) -> f64 {
        assert!(depth < MAX_CHAIN, "constraints of unknown {raw} refer to each other in a cycle");
        match &self.lines[raw] {
            None => {
                let unknown = unknown_of[raw].expect("an unconstrained raw unknown is free");
                terms.push(Term { unknown, weight });
                0.0
            }
            Some(line) => {
                let referred: f64 = line
                    .terms
                    .iter()
                    .map(|other| {
                        let weight = weight * other.weight;
                        self.expand(other.unknown, weight, unknown_of, terms, depth + 1)
                    })
                    .sum();
                weight * line.value + referred
            }
        }
    }
}

/// Adds up the weights of unknowns that stand more than once among the terms from `first` on.
fn merge(terms: &mut Vec<Term<u32>>, first: usize) {
    let mut end = first;
    for next in first..terms.len() {
        let term = terms[next];
        match terms[first..end].iter_mut().find(|known| known.unknown == term.unknown) {
            Some(known) => known.weight += term.weight,
            None => {
                terms[end] = term;
                end += 1;
            }
        }
    }
    terms.truncate(end);
}

/// x = P y + g: raw unknowns x from free unknowns y.
#[derive(Debug, Clone, PartialEq)]
pub struct AffineConstraints {
    /// Start of each row of P in `terms`, and the end of the last.
    offsets: Vec<u32>,
    /// The entries of P, by the free unknown they multiply.
    terms: Vec<Term<u32>>,
    /// g.
    values: Vec<f64>,
    unknown_of: Vec<Option<u32>>,
    n_unknowns: usize,
}

impl AffineConstraints {
    /// Number of free unknowns.
    #[must_use]
    pub fn n_unknowns(&self) -> usize {
        self.n_unknowns
    }

    /// Number of raw unknowns.
    #[must_use]
    pub fn n_raw(&self) -> usize {
        self.values.len()
    }

    /// The row of P of a raw unknown, in terms of free unknowns.
    #[must_use]
    pub fn row(&self, raw: usize) -> &[Term<u32>] {
        &self.terms[self.offsets[raw] as usize..self.offsets[raw + 1] as usize]
    }

    /// The entry of g of a raw unknown.
    #[must_use]
    pub fn value(&self, raw: usize) -> f64 {
        self.values[raw]
    }

    /// The index of a raw unknown among the free ones, if it is one of them.
    #[must_use]
    pub fn unknown(&self, raw: usize) -> Option<usize> {
        self.unknown_of[raw].map(|unknown| unknown as usize)
    }

    /// P y + g.
    #[must_use]
    pub fn expand(&self, free: &[f64]) -> Vec<f64> {
        (0..self.n_raw())
            .map(|raw| {
                self.row(raw).iter().fold(self.values[raw], |sum, &Term { unknown, weight }| {
                    sum + weight * free[unknown as usize]
                })
            })
            .collect()
    }

    /// P^T r.
    #[must_use]
    pub fn restrict(&self, raw_values: &[f64]) -> Vec<f64> {
        let mut restricted = vec![0.0; self.n_unknowns];
        for (raw, value) in raw_values.iter().enumerate() {
            for &Term { unknown, weight } in self.row(raw) {
                restricted[unknown as usize] += weight * value;
            }
        }
        restricted
    }

    /// The values of the free unknowns among those of all raw ones.
    #[must_use]
    pub fn pick(&self, raw_values: &[f64]) -> Vec<f64> {
        raw_values
            .iter()
            .zip(&self.unknown_of)
            .filter_map(|(value, unknown)| unknown.map(|_| *value))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms<const N: usize>(all: [(usize, f64); N]) -> Vec<Term<usize>> {
        all.map(|(unknown, weight)| Term { unknown, weight }).to_vec()
    }

    #[test]
    fn weights_of_the_same_unknown_add_up() {
        let mut builder = ConstraintBuilder::new(3);
        builder.constrain(0, terms([(1, 2.0), (2, 1.0)]), 0.0);
        builder.constrain(1, terms([(2, 3.0)]), 0.0);
        let constraints = builder.build();
        assert_eq!(constraints.row(0), &[Term { unknown: 0, weight: 7.0 }]);
    }

    #[test]
    fn chains_of_constraints_are_resolved_with_their_values() {
        let mut builder = ConstraintBuilder::new(4);
        builder.constrain(0, terms([(1, 2.0)]), 1.0);
        builder.constrain(1, terms([(2, 3.0), (3, 1.0)]), 0.5);
        builder.fix(3, 4.0);
        let constraints = builder.build();
        assert_eq!(constraints.n_unknowns(), 1);
        assert_eq!(constraints.expand(&[1.0]), vec![16.0, 7.5, 1.0, 4.0]);
        assert_eq!(constraints.restrict(&[1.0, 1.0, 1.0, 1.0]), vec![10.0]);
        assert_eq!(constraints.pick(&[9.0, 8.0, 7.0, 6.0]), vec![7.0]);
    }

    #[test]
    #[should_panic(expected = "refer to each other in a cycle")]
    fn a_cycle_of_constraints_is_refused() {
        let mut builder = ConstraintBuilder::new(2);
        builder.equate(0, 1);
        builder.equate(1, 0);
        let _ = builder.build();
    }
}
