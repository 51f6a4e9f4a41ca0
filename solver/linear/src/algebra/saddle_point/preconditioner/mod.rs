//! `Preconditioner`: the upper block-triangular matrix [F G; 0 -S] with approximate inverses of F and S.

mod body_basis;
mod commutator;
mod scales;
mod schur;
mod transfer;
mod triangular;

pub(super) use self::body_basis::BodyBasis;
#[cfg(test)]
pub(super) use self::commutator::Commutator;
use self::scales::Scales;
use self::schur::SchurComplement;
pub(super) use self::transfer::transfer;
use super::data::{SaddlePoint, Weights};
use super::matrix::{B, Blocks, Gradient, Numbering, SaddleMatrix};
use crate::multigrid::{BlockMatrix, Chebyshev, Hierarchy, HierarchySettings, Spectrum, upwinded};
use crate::sparse::single::single;

/// Degree of the smoother of the first level of a multigrid cycle.
const SMOOTHING: usize = 2;
/// Degree of the polynomial that takes the place of a cycle where no level but the first is needed.
const DEGREE: usize = 4;
/// The part of the spectrum on which that polynomial is small.
const SPECTRUM: Spectrum = Spectrum::UpperEnd(1.0 / 10.0);
/// Part of the diagonal of F that is no derivative, in the median over the unknowns, from which the
/// coarser levels are left out.
const DOMINANT: f64 = 0.2;
/// Part of the diagonal of the upwinded F that is upwinding, from which convection decides how pressures are
/// found in steady flow.
const CONVECTIVE: f64 = 1e-3;

/// An approximate inverse of a saddle-point matrix, which stays with whoever has it.
#[derive(Debug)]
pub(super) struct Preconditioner {
    /// What stands for F and G where bodies have coordinates.
    changed: Option<Changed>,
    /// F with diffusion added, where there is convection.
    upwinded: Option<BlockMatrix<B>>,
    velocity: VelocitySolver,
    divergence: Gradient,
    schur: SchurComplement,
    scales: Scales,
    /// D of the lumped Schur complement.
    damping: Vec<[f32; B]>,
    scaled: Blocks,
}

/// A system with the velocities of bodies in a basis of their own.
#[derive(Debug)]
struct Changed {
    basis: BodyBasis,
    velocity: BlockMatrix<B>,
    gradient: Gradient,
    /// The transposed of the divergence, which has other signs than the gradient.
    divergence: Gradient,
}

impl Changed {
    /// None where no body has coordinates.
    fn new(matrix: &SaddleMatrix) -> Option<Self> {
        let basis = BodyBasis::new(matrix)?;
        let (velocity, divergence) = (basis.velocity(matrix), basis.divergence(matrix));
        let gradient = basis.gradient(&divergence);
        Some(Self { basis, velocity, gradient, divergence })
    }
}

/// F and G in the basis of the preconditioner.
struct Operators<'a> {
    block: &'a BlockMatrix<B>,
    gradient: &'a Gradient,
}

impl<'a> Operators<'a> {
    fn of(changed: Option<&'a Changed>, matrix: &'a SaddleMatrix) -> Self {
        match changed {
            Some(Changed { velocity, gradient, .. }) => Self { block: velocity, gradient },
            None => Self { block: matrix.velocity(), gradient: matrix.gradient() },
        }
    }
}

/// What takes the place of F^-1.
#[derive(Debug)]
enum VelocitySolver {
    /// Where derivatives dominate.
    Cycle(Box<Hierarchy<B>>),
    /// Where density over time step does: F is nearly a mass matrix.
    Polynomial(Box<Chebyshev<B>>),
}

impl Preconditioner {
    /// For a matrix of this system.
    pub fn new(system: &SaddlePoint, weights: &Weights, matrix: &SaddleMatrix) -> Self {
        let changed = Changed::new(matrix);
        let Operators { block, gradient } = Operators::of(changed.as_ref(), matrix);
        let numbering = matrix.numbering();
        let n_pairs = numbering.n_bodies;
        let is_dominated = damped_part(weights, numbering, block) > DOMINANT;
        let smooth = (weights.has_convection && !is_dominated).then(|| upwinded(block, n_pairs));
        let part = smooth.as_ref().map_or(0.0, |smooth| smooth.part);
        tracing::debug!(part, "upwinded");
        let upwinded = smooth.map(|smooth| smooth.matrix);
        let is_commutator = part > CONVECTIVE && weights.inertia == 0.0;
        let smooth = upwinded.as_ref().unwrap_or(block);
        let transfer = (!is_dominated).then(|| {
            let transfer = transfer(&weights.interpolation, numbering);
            match &changed {
                Some(Changed { basis, .. }) => basis.in_columns(&transfer),
                None => transfer,
            }
        });
        let velocity = || {
            if let Some(transfer) = transfer {
                let settings = HierarchySettings {
                    n_pairs,
                    degree: SMOOTHING,
                    is_singular: false,
                    is_convective: weights.has_convection,
                };
                VelocitySolver::Cycle(Box::new(Hierarchy::new(smooth, Some(transfer), settings)))
            } else {
                let chebyshev = Chebyshev::new(block, n_pairs, SPECTRUM, DEGREE);
                VelocitySolver::Polynomial(Box::new(chebyshev))
            }
        };
        let held = system.has_held_pressure;
        let damping = damping(weights, numbering);
        let schur = || {
            if is_commutator {
                SchurComplement::convective(block, gradient, numbering, held)
            } else {
                SchurComplement::new(weights, gradient, &damping, held)
            }
        };
        let divergence = changed.as_ref().map_or(gradient, |changed| &changed.divergence);
        let rest = || (schur(), divergence.transposed(), Scales::new(block, gradient));
        let (velocity, (schur, divergence, scales)) = rayon::join(velocity, rest);
        Self {
            changed,
            upwinded,
            velocity,
            divergence,
            schur,
            scales,
            damping,
            scaled: Blocks::zeros(numbering.blocks.len(), numbering.pressures.len()),
        }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        let velocity = match &self.velocity {
            VelocitySolver::Cycle(hierarchy) => hierarchy.n_bytes(),
            VelocitySolver::Polynomial(_) => 0,
        };
        let upwinded = self.upwinded.as_ref().map_or(0, BlockMatrix::n_bytes);
        let changed = self.changed.as_ref();
        let changed = changed.map_or(0, |own| own.velocity.n_bytes() + 2 * own.gradient.n_bytes());
        changed + velocity + upwinded + self.divergence.n_bytes() + self.schur.n_bytes()
    }

    /// The factors of rows and columns.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// What bodies with coordinates are solved for in place of their velocities.
    pub fn basis(&self) -> Option<&BodyBasis> {
        self.changed.as_ref().map(|changed| &changed.basis)
    }

    /// Overwrites y with S A S x, with S the diagonal matrix of the scales.
    pub fn multiply(&mut self, matrix: &SaddleMatrix, x: &Blocks, y: &mut Blocks) {
        let Self { changed, divergence, scales, scaled, .. } = self;
        let Operators { block, gradient } = Operators::of(changed.as_ref(), matrix);
        scaled.clone_from(x);
        scales.multiply(scaled);
        block.multiply(&scaled.velocity, &mut y.velocity);
        gradient.multiply_add(&scaled.pressure, &mut y.velocity);
        divergence.multiply_transposed(&scaled.velocity, &mut y.pressure);
        scales.multiply(y);
    }

    /// Overwrites z with S^-1 M^-1 S^-1 r for the approximation M of the matrix.
    pub fn apply(&mut self, matrix: &SaddleMatrix, r: &Blocks, z: &mut Blocks) {
        let Self { changed, upwinded, velocity, schur, scales, scaled, .. } = self;
        let Operators { block, gradient } = Operators::of(changed.as_ref(), matrix);
        scaled.clone_from(r);
        scales.divide(scaled);
        z.pressure.copy_from_slice(&scaled.pressure);
        schur.solve(block, &mut z.pressure);
        gradient.multiply_add(&z.pressure, &mut scaled.velocity);
        z.pressure.iter_mut().for_each(|value| *value = -*value);
        match velocity {
            VelocitySolver::Cycle(hierarchy) => {
                let smooth = upwinded.as_ref().unwrap_or(block);
                hierarchy.cycle(smooth, &scaled.velocity, &mut z.velocity);
            }
            VelocitySolver::Polynomial(chebyshev) => {
                chebyshev.solve(block, &scaled.velocity, &mut z.velocity);
            }
        }
        scales.divide(z);
    }
}

impl Preconditioner {
    /// Overwrites z with a correction S^-1 (D^-1 G q, -q) that leaves the part `reduction` of the rows of pressures in
    /// a scaled residual r: the equations of a fluid in which D stands for F (@chorin1968). Whether there is such a D.
    pub fn divergence_correction(
        &mut self,
        matrix: &SaddleMatrix,
        r: &Blocks,
        reduction: f64,
        z: &mut Blocks,
    ) -> bool {
        let Self { schur, scales, damping, scaled, .. } = self;
        scaled.clone_from(r);
        scales.divide(scaled);
        z.pressure.copy_from_slice(&scaled.pressure);
        if !schur.solve_lumped(&mut z.pressure, reduction) {
            return false;
        }
        z.velocity.fill([0.0; B]);
        matrix.gradient().multiply_add(&z.pressure, &mut z.velocity);
        z.pressure.iter_mut().for_each(|value| *value = -*value);
        // Bodies have no D
        z.velocity[damping.len()..].fill([0.0; B]);
        for (velocity, damping) in z.velocity.iter_mut().zip(damping.iter()) {
            for (value, damping) in velocity.iter_mut().zip(damping) {
                *value = if *damping > 0.0 { *value / damping } else { 0.0 };
            }
        }
        scales.divide(z);
        true
    }
}

/// What damps the velocities at nodes beside their differences: walls and inertia. Pressures that vary over
/// more than the distance to walls have the Schur complement G^T D^-1 G with it, and not a mass over the
/// viscosity.
fn damping(weights: &Weights, numbering: &Numbering) -> Vec<[f32; B]> {
    let Weights { lumped_mass, wall_drag, inertia, .. } = weights;
    let sums = lumped_mass.iter().zip(wall_drag).map(|(mass, drag)| inertia * mass + drag);
    let sums: Vec<f64> = sums.collect();
    let mut damping = numbering.split(&sums, |_, sum| single(sum)).velocity;
    damping.truncate(numbering.n_nodes);
    damping
}

/// Median over the velocities at nodes of what is no derivative in the diagonal of F.
fn damped_part(weights: &Weights, numbering: &Numbering, block: &BlockMatrix<B>) -> f64 {
    if weights.inertia == 0.0 {
        return 0.0;
    }
    let mut parts: Vec<f64> = Vec::with_capacity(B * numbering.n_nodes);
    for (row, unknowns) in numbering.blocks[..numbering.n_nodes].iter().enumerate() {
        for (unknown, value) in unknowns.iter().zip(block.diagonal(row)) {
            let Some(unknown) = unknown else { continue };
            let mass = weights.lumped_mass[*unknown as usize];
            parts.push(weights.inertia * mass / f64::from(value));
        }
    }
    let middle = parts.len() / 2;
    if parts.is_empty() {
        return 0.0;
    }
    *parts.select_nth_unstable_by(middle, f64::total_cmp).1
}
