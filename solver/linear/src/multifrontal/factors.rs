//! `Factors`: the numbers of a factorisation, and the work through all fronts.

use std::collections::BTreeMap;
use std::sync::Mutex;

use rayon::prelude::*;

use super::analysis::{Analysis, Part};
use super::front::{self, Child, Contribution, Input, Irregular};
use super::solve::Scratch;
use crate::sparse::SparseMatrix;

/// Pivots below this part of the scale of their unknown count as zero.
const SINGULAR: f64 = 1e-13;

/// No pivot is left for some unknowns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Singular {
    /// Unknowns that the equations do not determine.
    pub unknowns: Vec<usize>,
    /// Equations that are left without a pivot.
    pub equations: Vec<usize>,
}

/// L and U of a matrix.
#[derive(Debug)]
pub struct Factors {
    pub(super) values: Vec<f64>,
    /// Place of each pivot's row.
    pub(super) pivot_rows: Vec<u32>,
    pub(super) irregular: BTreeMap<usize, Irregular>,
    /// Contributions of the roots of the subtrees.
    outgoing: Vec<Vec<f64>>,
    top_stack: Vec<f64>,
    stacks: Mutex<Vec<Workspace>>,
    tiny: Vec<f64>,
    pub(super) pressure_scale: f64,
    pub(super) arch: pulp::Arch,
    pub(super) scratch: Scratch,
}

#[derive(Debug, Default)]
struct Workspace {
    stack: Vec<f64>,
    swaps: Vec<u32>,
}

/// What a part leaves besides its factors.
#[derive(Debug, Default)]
struct Outcome {
    irregular: Vec<(usize, Irregular)>,
    contributions: BTreeMap<usize, Contribution>,
    singular: Option<Singular>,
}

impl Factors {
    /// Room for the factors of a matrix.
    #[must_use]
    pub fn new(analysis: &Analysis) -> Self {
        let outgoing = analysis.subtrees.iter().map(|part| {
            let root = &analysis.fronts[part.fronts.end - 1];
            vec![0.0; root.r * root.r]
        });
        Self {
            values: vec![0.0; analysis.n_values],
            pivot_rows: vec![0; analysis.n],
            irregular: BTreeMap::new(),
            outgoing: outgoing.collect(),
            top_stack: vec![0.0; analysis.top.stack],
            stacks: Mutex::new(Vec::new()),
            tiny: vec![0.0; analysis.n],
            pressure_scale: 1.0,
            arch: pulp::Arch::new(),
            scratch: Scratch::default(),
        }
    }

    /// Number of fronts with pivots delayed into them or out of them.
    #[must_use]
    pub fn n_delayed_fronts(&self) -> usize {
        self.irregular.len()
    }

    /// Factor of each equation that makes those of pressures as large as those of velocities.
    #[must_use]
    pub fn row_scales(&self, analysis: &Analysis) -> Vec<f64> {
        let mut scales = vec![1.0; analysis.n];
        for (&unknown, &is_pressure) in analysis.unknown_at.iter().zip(&analysis.is_pressure_at) {
            if is_pressure {
                scales[unknown as usize] = self.pressure_scale;
            }
        }
        scales
    }

    /// Factorises a matrix with the analysed pattern.
    ///
    /// Memory is taken for delayed pivots only.
    ///
    /// # Panics
    /// When the number of values is not that of the pattern's entries.
    ///
    /// # Errors
    /// When pivots are missing: the matrix is singular, or as good as.
    pub fn factorise(
        &mut self,
        analysis: &Analysis,
        matrix: &SparseMatrix,
    ) -> Result<(), Singular> {
        let values = matrix.values();
        assert_eq!(values.len(), analysis.n_entries, "the values of the analysed pattern");
        self.irregular.clear();
        self.pressure_scale = scales(analysis, matrix, &mut self.tiny);
        let input = Input {
            analysis,
            values,
            pressure_scale: self.pressure_scale,
            tiny: &self.tiny,
            arch: self.arch,
            shared: false,
        };
        let mut panels = self.values.as_mut_slice();
        let mut rows = self.pivot_rows.as_mut_slice();
        let mut tasks = Vec::with_capacity(analysis.subtrees.len());
        for (part, outgoing) in analysis.subtrees.iter().zip(&mut self.outgoing) {
            let last = &analysis.fronts[part.fronts.end - 1];
            let first = &analysis.fronts[part.fronts.start];
            let (panel, others) = panels.split_at_mut(last.values + last.n_values() - first.values);
            let (row, other_rows) = rows.split_at_mut(last.start + last.k - first.start);
            (panels, rows) = (others, other_rows);
            tasks.push((part, panel, row, outgoing));
        }
        let outcomes: Vec<Outcome> = tasks
            .into_par_iter()
            .with_max_len(1)
            .map(|(part, panels, rows, outgoing)| {
                let mut workspace =
                    self.stacks.lock().ok().and_then(|mut all| all.pop()).unwrap_or_default();
                if workspace.stack.len() < part.stack {
                    workspace.stack.resize(part.stack, 0.0);
                }
                let outcome = work_through(
                    input,
                    part,
                    (panels, rows),
                    (&mut workspace.stack, &mut workspace.swaps),
                    &[],
                    &BTreeMap::new(),
                    Some(outgoing),
                );
                if let Ok(mut all) = self.stacks.lock() {
                    all.push(workspace);
                }
                outcome
            })
            .collect();
        let mut contributions = BTreeMap::new();
        for outcome in outcomes {
            if let Some(singular) = outcome.singular {
                return Err(singular);
            }
            self.irregular.extend(outcome.irregular);
            contributions.extend(outcome.contributions);
        }
        let outcome = work_through(
            Input { shared: true, ..input },
            &analysis.top,
            (panels, rows),
            (&mut self.top_stack, &mut Vec::new()),
            &self.outgoing,
            &contributions,
            None,
        );
        self.irregular.extend(outcome.irregular);
        outcome.singular.map_or(Ok(()), Err)
    }
}

/// Assembles and eliminates the fronts of a part, children before parents.
fn work_through(
    input: Input<'_>,
    part: &Part,
    (panels, rows): (&mut [f64], &mut [u32]),
    (stack, swaps): (&mut Vec<f64>, &mut Vec<u32>),
    from_subtrees: &[Vec<f64>],
    irregular_from_subtrees: &BTreeMap<usize, Contribution>,
    mut outgoing: Option<&mut Vec<f64>>,
) -> Outcome {
    let analysis = input.analysis;
    let mut outcome = Outcome::default();
    if part.fronts.is_empty() {
        return outcome;
    }
    let (first_value, first_place) =
        (analysis.fronts[part.fronts.start].values, analysis.fronts[part.fronts.start].start);
    for index in part.fronts.clone() {
        let front = &analysis.fronts[index];
        let panel = &mut panels[front.values - first_value..][..front.n_values()];
        let pivot_rows = &mut rows[front.start - first_place..][..front.k];
        let size = front.r * front.r;
        let is_last = index + 1 == part.fronts.end;
        // Its own contribution, those of its children, and where in the stack the latter begin.
        let (c, others, offset): (&mut [f64], &[f64], usize) =
            if let Some(outgoing) = outgoing.as_deref_mut().filter(|_| is_last) {
                (outgoing, stack, 0)
            } else if front.grows_down {
                let (low, high) = stack.split_at_mut(front.contribution);
                (&mut high[..size], low, 0)
            } else {
                let end = front.contribution + size;
                let (low, high) = stack.split_at_mut(end);
                (&mut low[front.contribution..], high, end)
            };
        let own = &outcome.contributions;
        let children = analysis.children_of(front).iter().map(|&child| {
            let child_index = child as usize;
            let child = &analysis.fronts[child_index];
            let relative = analysis.relative_of(child);
            let irregular =
                own.get(&child_index).or_else(|| irregular_from_subtrees.get(&child_index));
            if let Some(irregular) = irregular {
                return Child {
                    values: &irregular.values,
                    relative,
                    delayed_rows: &irregular.delayed_rows,
                    delayed_columns: &irregular.delayed_columns,
                };
            }
            let values = if part.fronts.contains(&child_index) {
                &others[child.contribution - offset..][..child.r * child.r]
            } else {
                from_subtrees[analysis.subtree_of(child_index)].as_slice()
            };
            Child { values, relative, delayed_rows: &[], delayed_columns: &[] }
        });
        if swaps.len() < front.k {
            swaps.resize(front.k, 0);
        }
        let is_delayed = children.clone().any(|child| !child.delayed_rows.is_empty());
        let is_done = !is_delayed
            && front::regular(input, front, children.clone(), panel, c, pivot_rows, swaps).is_ok();
        if !is_done {
            let (factors, contribution) = front::irregular(input, front, children);
            if front.parent.is_none() && !contribution.delayed_rows.is_empty() {
                let named = |places: &[u32]| -> Vec<usize> {
                    places.iter().map(|&at| analysis.unknown_at[at as usize] as usize).collect()
                };
                outcome.singular = Some(Singular {
                    unknowns: named(&contribution.delayed_columns),
                    equations: named(&contribution.delayed_rows),
                });
                return outcome;
            }
            outcome.irregular.push((index, factors));
            outcome.contributions.insert(index, contribution);
        }
    }
    outcome
}

/// Sets the size below which a pivot of each place counts as zero, and returns the factor of the
/// rows and columns of pressures that makes their entries as large as those of velocities.
fn scales(analysis: &Analysis, matrix: &SparseMatrix, tiny: &mut [f64]) -> f64 {
    let values = matrix.values();
    let diagonal = |place: usize| {
        values.get(analysis.diagonal[place] as usize).map_or(0.0, |value| value.abs())
    };
    let mut velocity = (0.0, 0usize);
    let mut pressure = (0.0, 0usize);
    for (place, &unknown) in analysis.unknown_at.iter().enumerate() {
        let own = diagonal(place);
        tiny[place] = own;
        if own > 0.0 {
            // Those of bodies are of another size altogether, and only a few.
            if analysis.dense.binary_search(&unknown).is_ok() {
                continue;
            }
            velocity = (velocity.0 + own, velocity.1 + 1);
        } else {
            let entries = &values[matrix.pattern().entries(unknown as usize)];
            let most = entries.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            tiny[place] = most;
            if analysis.is_pressure_at[place] {
                pressure = (pressure.0 + most, pressure.1 + 1);
            }
        }
    }
    let mean = |(sum, count): (f64, usize)| sum / count.max(1) as f64;
    let ratio = mean(velocity) / mean(pressure);
    // A power of two changes no digit.
    let scale = if ratio.is_normal() { ratio.log2().round().exp2() } else { 1.0 };
    for (place, tiny) in tiny.iter_mut().enumerate() {
        if analysis.is_pressure_at[place] {
            // What elimination of the velocities makes of a pressure, b^2 / a, has the size of a.
            *tiny *= scale;
        }
        *tiny *= SINGULAR;
    }
    scale
}
