//! `Factors`: the numbers of a factorisation.

mod delays;
mod elimination;
mod runs;
mod scaling;
mod traversal;

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use alewife_interrupt::{Listener, Stopped};
use rayon::prelude::*;
use thiserror::Error;

pub(super) use self::delays::Delay;
use self::delays::Delays;
use self::elimination::{DelayedContribution, DelayedPivotFactors, FactorisationContext};
use self::scaling::scale_pressures;
pub use self::traversal::Singular;
use self::traversal::{Incoming, SubtreeFactors, SubtreeResult, Workspace, factorise_subtree};
use super::analysis::Analysis;
use super::front::Subtree;
use super::substitution::Scratch;
use crate::sparse::SparseMatrix;

/// L and U of a matrix.
#[derive(Debug)]
pub struct Factors {
    /// Factors of the fronts without delayed pivots, one after the other.
    pub(super) values: Vec<f64>,
    /// Slot of each pivot's row.
    pub(super) pivot_rows: Vec<u32>,
    /// Factors of the fronts with delayed pivots, their rows and columns by slots.
    pub(super) delayed: BTreeMap<usize, DelayedPivotFactors>,
    /// What subtrees delayed to the fronts above.
    pub(super) delays: Delays,
    /// Contributions of the roots of the subtrees.
    outgoing: Vec<Vec<f64>>,
    /// Memory of the threads that factorise subtrees.
    workspaces: Mutex<Vec<Workspace>>,
    /// Memory of the fronts above.
    top_workspace: Workspace,
    pivot_floors: Vec<f64>,
    pub(super) pressure_scale: f64,
    pub(super) arch: pulp::Arch,
    pub(super) scratch: Scratch,
}

/// Why a matrix was not factorised.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoFactors {
    /// It has no inverse, or none that double precision can find.
    #[error("{} unknowns are not determined by the equations", .0.unknowns.len())]
    Singular(Singular),
    /// The work was to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// A subtree with the memory it is factorised in.
struct Task<'a> {
    subtree: &'a Subtree,
    factors: SubtreeFactors<'a>,
    outgoing: &'a mut Vec<f64>,
}

impl Factors {
    /// Memory for the factors of a matrix.
    #[must_use]
    pub fn new(analysis: &Analysis) -> Self {
        let outgoing = analysis.subtrees.iter().map(|subtree| {
            let root = &analysis.fronts[subtree.fronts.end - 1];
            vec![0.0; root.r * root.r]
        });
        let mut top_workspace = Workspace::default();
        top_workspace.fit(&analysis.top);
        Self {
            values: vec![0.0; analysis.n_values],
            pivot_rows: vec![0; analysis.n()],
            delayed: BTreeMap::new(),
            delays: Delays::default(),
            outgoing: outgoing.collect(),
            workspaces: Mutex::new(Vec::new()),
            top_workspace,
            pivot_floors: vec![0.0; analysis.n()],
            pressure_scale: 1.0,
            arch: pulp::Arch::new(),
            scratch: Scratch::default(),
        }
    }

    /// Number of fronts with pivots delayed into them or out of them.
    #[must_use]
    pub fn n_delayed_fronts(&self) -> usize {
        self.delayed.len()
    }

    /// Number of pivots that were delayed, once for each front they were delayed in.
    #[must_use]
    pub fn n_delayed_pivots(&self) -> usize {
        let delayed_in = |own: &DelayedPivotFactors| own.n_candidates - own.n_pivots;
        self.delayed.values().map(delayed_in).sum()
    }

    /// Number of entries of L and U, those of delayed pivots included.
    #[must_use]
    pub fn n_entries(&self, analysis: &Analysis) -> usize {
        let foreseen = |front: &usize| analysis.fronts[*front].n_values();
        let (planned, actual) =
            self.delayed.iter().fold((0, 0), |(planned, actual), (front, own)| {
                (planned + foreseen(front), actual + own.l.len() + own.u.len())
            });
        analysis.n_values - planned + actual
    }

    /// Factor of each equation that makes those of pressures as large as those of velocities.
    #[must_use]
    pub fn row_scales(&self, analysis: &Analysis) -> Vec<f64> {
        let mut scales = vec![1.0; analysis.n()];
        for (&unknown, &is_pressure) in analysis.unknown_at.iter().zip(&analysis.is_pressure_at) {
            if is_pressure {
                scales[unknown as usize] = self.pressure_scale;
            }
        }
        scales
    }

    /// Factorises a matrix with the analysed pattern.
    ///
    /// Memory is allocated for delayed pivots only.
    ///
    /// # Panics
    /// When the number of entries is not that of the analysed pattern.
    ///
    /// # Errors
    /// When pivots are missing: the matrix is singular to working precision; or when the work of this thread is to
    /// end. There are no factors then.
    pub fn factorise(
        &mut self,
        analysis: &Analysis,
        matrix: &SparseMatrix,
    ) -> Result<(), NoFactors> {
        assert_eq!(matrix.pattern().n_entries(), analysis.n_entries, "the analysed pattern");
        let listener = Listener::here();
        listener.check()?;
        self.delayed.clear();
        self.pressure_scale = scale_pressures(analysis, matrix, &mut self.pivot_floors);
        let context = FactorisationContext {
            analysis,
            values: matrix.values(),
            pressure_scale: self.pressure_scale,
            pivot_floors: &self.pivot_floors,
            arch: self.arch,
            shared: false,
            listener: &listener,
        };
        let mut factors =
            SubtreeFactors { panels: &mut self.values, pivot_rows: &mut self.pivot_rows };
        let mut tasks = Vec::with_capacity(analysis.subtrees.len());
        for (subtree, outgoing) in analysis.subtrees.iter().zip(&mut self.outgoing) {
            let [own, others] = factors.split(analysis, subtree);
            tasks.push(Task { subtree, factors: own, outgoing });
            factors = others;
        }
        let mut delayed_contributions = BTreeMap::new();
        let results = factorise_subtrees(context, tasks, &self.workspaces);
        // Fronts are left out since then
        if listener.was_ended() {
            return Err(Stopped.into());
        }
        for result in results {
            if let Some(singular) = result.singular {
                return Err(NoFactors::Singular(singular));
            }
            self.delayed.extend(result.delayed_factors);
            delayed_contributions.extend(result.delayed_contributions);
        }
        let incoming = Incoming { roots: &self.outgoing, delayed: &delayed_contributions };
        let context = FactorisationContext { shared: true, ..context };
        let workspace = &mut self.top_workspace;
        let result = factorise_subtree(context, &analysis.top, factors, workspace, incoming, None);
        if listener.was_ended() {
            return Err(Stopped.into());
        }
        self.delayed.extend(result.delayed_factors);
        self.place_delayed(analysis, &delayed_contributions);
        result.singular.map_or(Ok(()), |singular| Err(NoFactors::Singular(singular)))
    }

    /// Replaces positions by slots in the fronts with delayed pivots.
    fn place_delayed(
        &mut self,
        analysis: &Analysis,
        contributions: &BTreeMap<usize, DelayedContribution>,
    ) {
        self.delays = Delays::new(&analysis.segments, contributions);
        for (&front, own) in &mut self.delayed {
            let segment = &analysis.segments[analysis.subtree_of(front)];
            own.rows = self.delays.slots_of_rows(segment, &own.rows);
            own.columns = self.delays.slots_of_columns(segment, &own.columns);
        }
    }
}

/// Factorises subtrees in parallel.
fn factorise_subtrees(
    context: FactorisationContext<'_>,
    tasks: Vec<Task<'_>>,
    workspaces: &Mutex<Vec<Workspace>>,
) -> Vec<SubtreeResult> {
    let nothing = BTreeMap::new();
    let incoming = Incoming { roots: &[], delayed: &nothing };
    // The lock is never held while a workspace is written, so a panic leaves none half written.
    let free = || workspaces.lock().unwrap_or_else(PoisonError::into_inner);
    let factorise = |Task { subtree, factors, outgoing }: Task<'_>| {
        let mut workspace = free().pop().unwrap_or_default();
        workspace.fit(subtree);
        let result =
            factorise_subtree(context, subtree, factors, &mut workspace, incoming, Some(outgoing));
        free().push(workspace);
        result
    };
    tasks.into_par_iter().with_max_len(1).map(factorise).collect()
}
