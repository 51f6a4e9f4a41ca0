//! The fronts of a subtree, factorised one after the other: children before parents.

use std::collections::BTreeMap;

use super::super::analysis::Analysis;
use super::super::front::{Front, Subtree};
use super::elimination::{
    Child, DelayedContribution, DelayedElimination, DelayedPivotFactors, FactorisationContext,
    FrontTarget, factorise_delayed, factorise_static,
};

/// Equations and unknowns without a pivot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Singular {
    /// Unknowns that the equations do not determine.
    pub unknowns: Vec<usize>,
    /// Equations that are left without a pivot.
    pub equations: Vec<usize>,
}

/// Where the factors of the fronts of a subtree go.
pub(super) struct SubtreeFactors<'a> {
    /// Factors without delayed pivots, one front after the other.
    pub panels: &'a mut [f64],
    /// Slots of the pivot rows.
    pub pivot_rows: &'a mut [u32],
}

impl<'a> SubtreeFactors<'a> {
    /// The memory of a subtree whose fronts come first, and that of all others.
    pub fn split(self, analysis: &Analysis, subtree: &Subtree) -> [Self; 2] {
        let fronts = &analysis.fronts[subtree.fronts.clone()];
        let n_values = fronts.iter().map(Front::n_values).sum();
        let n_pivots = fronts.iter().map(|front| front.k).sum();
        let (panels, other_panels) = self.panels.split_at_mut(n_values);
        let (pivot_rows, other_rows) = self.pivot_rows.split_at_mut(n_pivots);
        [Self { panels, pivot_rows }, Self { panels: other_panels, pivot_rows: other_rows }]
    }
}

/// Memory of a thread.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    /// Contributions of fronts.
    pub stack: Vec<f64>,
    /// Row exchanges of a front.
    pub swaps: Vec<u32>,
}

impl Workspace {
    /// Makes the stack large enough for a subtree.
    pub fn fit(&mut self, subtree: &Subtree) {
        if self.stack.len() < subtree.stack_size {
            self.stack.resize(subtree.stack_size, 0.0);
        }
    }
}

/// Contributions of the subtrees below.
#[derive(Debug, Clone, Copy)]
pub(super) struct Incoming<'a> {
    /// Of the roots of all subtrees.
    pub roots: &'a [Vec<f64>],
    /// Of the fronts among them with delayed pivots.
    pub delayed: &'a BTreeMap<usize, DelayedContribution>,
}

/// What elimination of a subtree gives besides the factors of fronts without delayed pivots.
#[derive(Debug, Default)]
pub(super) struct SubtreeResult {
    /// Factors of fronts with delayed pivots.
    pub delayed_factors: Vec<(usize, DelayedPivotFactors)>,
    /// Their contributions.
    pub delayed_contributions: BTreeMap<usize, DelayedContribution>,
    pub singular: Option<Singular>,
}

/// Assembles and eliminates the fronts of a subtree, or some of them where the work is to end.
///
/// The contribution of its last front goes to `outgoing`, where there is one.
pub(super) fn factorise_subtree(
    context: FactorisationContext<'_>,
    subtree: &Subtree,
    factors: SubtreeFactors<'_>,
    workspace: &mut Workspace,
    incoming: Incoming<'_>,
    mut outgoing: Option<&mut Vec<f64>>,
) -> SubtreeResult {
    let analysis = context.analysis;
    let mut result = SubtreeResult::default();
    let SubtreeFactors { mut panels, mut pivot_rows } = factors;
    let Workspace { stack, swaps } = workspace;
    for index in subtree.fronts.clone() {
        let front = &analysis.fronts[index];
        if context.is_to_end(front) {
            return result;
        }
        let panel = panels.split_off_mut(..front.n_values()).expect("factors of all fronts");
        let pivot_rows = pivot_rows.split_off_mut(..front.k).expect("pivots of all fronts");
        if swaps.len() < front.k {
            swaps.resize(front.k, 0);
        }
        let is_root = index + 1 == subtree.fronts.end;
        let outgoing = outgoing.as_deref_mut().filter(|_| is_root);
        let StackSlot { contribution, others, offset } = StackSlot::new(front, stack, outgoing);
        let below = Contributions {
            analysis,
            subtree,
            stack: others,
            offset,
            delayed: &result.delayed_contributions,
            incoming,
        };
        let children = analysis.children_of(front).iter().map(|&child| below.of(child as usize));
        let has_delayed = children.clone().any(|child| !child.delayed_rows.is_empty());
        let target = FrontTarget { panel, contribution, pivot_rows, swaps };
        if !has_delayed && factorise_static(context, front, children.clone(), target).is_ok() {
            continue;
        }
        if context.listener.was_ended() {
            return result;
        }
        let DelayedElimination { factors, contribution } =
            factorise_delayed(context, front, children);
        if front.parent.is_none() && !contribution.delayed_rows.is_empty() {
            result.singular = Some(Singular::new(analysis, &contribution));
            return result;
        }
        result.delayed_factors.push((index, factors));
        result.delayed_contributions.insert(index, contribution);
    }
    result
}

impl Singular {
    /// What a root delays has no pivot.
    fn new(analysis: &Analysis, contribution: &DelayedContribution) -> Self {
        let unknowns_at = |positions: &[u32]| -> Vec<usize> {
            positions.iter().map(|&at| analysis.unknown_at[at as usize] as usize).collect()
        };
        Self {
            unknowns: unknowns_at(&contribution.delayed_columns),
            equations: unknowns_at(&contribution.delayed_rows),
        }
    }
}

/// The stack as a front sees it.
struct StackSlot<'a> {
    /// Memory of its own contribution.
    contribution: &'a mut [f64],
    /// The part of the stack with those of its children, and where in the stack that begins.
    others: &'a [f64],
    offset: usize,
}

impl<'a> StackSlot<'a> {
    fn new(front: &Front, stack: &'a mut [f64], outgoing: Option<&'a mut Vec<f64>>) -> Self {
        let size = front.r * front.r;
        if let Some(outgoing) = outgoing {
            Self { contribution: outgoing, others: stack, offset: 0 }
        } else if front.grows_down {
            let (low, high) = stack.split_at_mut(front.contribution);
            Self { contribution: &mut high[..size], others: low, offset: 0 }
        } else {
            let end = front.contribution + size;
            let (low, high) = stack.split_at_mut(end);
            Self { contribution: &mut low[front.contribution..], others: high, offset: end }
        }
    }
}

/// The contributions a front may take.
struct Contributions<'a> {
    analysis: &'a Analysis,
    subtree: &'a Subtree,
    /// A part of the stack, and where in the stack it begins.
    stack: &'a [f64],
    offset: usize,
    /// Those of fronts of this subtree with delayed pivots.
    delayed: &'a BTreeMap<usize, DelayedContribution>,
    incoming: Incoming<'a>,
}

impl<'a> Contributions<'a> {
    fn of(&self, index: usize) -> Child<'a> {
        let front = &self.analysis.fronts[index];
        let relative = self.analysis.relative_of(front);
        let delayed = self.delayed.get(&index).or_else(|| self.incoming.delayed.get(&index));
        if let Some(DelayedContribution { values, delayed_rows, delayed_columns }) = delayed {
            return Child { values, relative, delayed_rows, delayed_columns };
        }
        let values = if self.subtree.fronts.contains(&index) {
            &self.stack[front.contribution - self.offset..][..front.r * front.r]
        } else {
            self.incoming.roots[self.analysis.subtree_of(index)].as_slice()
        };
        Child { values, relative, delayed_rows: &[], delayed_columns: &[] }
    }
}
