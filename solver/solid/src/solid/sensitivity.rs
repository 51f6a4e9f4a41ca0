//! How the forces of a step depend on moduli, fibres, the shape at rest and the levels before.

use alewife_mesh::Point;

use super::SolidError;
use super::assemble::{Controls, Response, StrainLevel};
use super::build::Solid;
use super::cholesky::Factor;
use super::geometry::{At, MAX_NODES, MAX_PLACES};
use super::mesh::Order;
use super::potential::Potential;
use crate::material::{Curvature, Fibre, Kinematics, Lame, Tensor};

/// Derivatives of z . r, where r is the slope of a potential and z a list of all components.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// By the Young's modulus of each material.
    pub young: Vec<f64>,
    /// By the Poisson's ratio of each material.
    pub poisson: Vec<f64>,
    /// By the stiffness of each set of fibres.
    pub fibre_stiffness: Vec<f64>,
    /// By the stretch each set of fibres is told.
    pub targets: Vec<f64>,
    /// By the places of all nodes at rest; empty where it was not asked for.
    pub shape: Vec<f64>,
    /// By the places of all nodes, inertia aside; empty where the shape was not asked for.
    pub places: Vec<f64>,
}

/// Energy of fibres with its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct FibreEnergy {
    /// Energy (J).
    pub value: f64,
    /// Its derivatives (N) by all components of places.
    pub by_places: Vec<f64>,
    /// Its derivatives (J) by the stretch each set is told.
    pub by_targets: Vec<f64>,
    /// Its derivatives (m3) by the stiffness of each set.
    pub by_stiffness: Vec<f64>,
}

impl Sensitivity {
    fn new<const D: usize>(solid: &Solid<D>, with_shape: bool) -> Self {
        let (n_materials, n_sets) = (solid.spec.materials.len(), solid.spec.fibres.len());
        Self {
            young: vec![0.0; n_materials],
            poisson: vec![0.0; n_materials],
            fibre_stiffness: vec![0.0; n_sets],
            targets: vec![0.0; n_sets],
            shape: vec![0.0; if with_shape { solid.n_components() } else { 0 }],
            places: vec![0.0; if with_shape { solid.n_components() } else { 0 }],
        }
    }
}

impl<const D: usize> Solid<D> {
    /// Solves the linear system of a potential at its minimum for a list of all components, as the adjoint
    /// of a step asks for: by iterations where factors at hand are near, else by new ones, which are kept. Zero where
    /// held. What laws ask of deformations may be known, of all points or of none.
    ///
    /// # Errors
    /// [`SolidError::TurnedOver`], and [`SolidError::Singular`] where the state is no minimum.
    pub fn solve_at(
        &self,
        potential: &Potential<'_, D>,
        places: &[f64],
        known: &[Kinematics],
        right: &[f64],
        factor: &mut Option<Factor>,
    ) -> Result<Vec<f64>, SolidError> {
        let turned_over = || SolidError::TurnedOver(self.turned_over(places).unwrap_or_default());
        let values = potential.curvature(places, Curvature::True, known).ok_or_else(turned_over)?;
        let right = self.free(places, right);
        let near = factor
            .as_ref()
            .and_then(|factor| self.cholesky.solve_near(&self.pattern, &values, factor, &right));
        if let Some(solution) = near {
            return Ok(self.all(places, &solution));
        }
        let new = self.cholesky.factorise(&self.pattern, &values).ok_or(SolidError::Singular)?;
        let mut solution = right.clone();
        if !self.cholesky.solve(&self.pattern, &new, &mut solution) {
            return Err(SolidError::Singular);
        }
        *factor = Some(new);
        Ok(self.all(places, &solution))
    }

    /// Derivatives of z . r at a state, the slope r of a potential with inertia or without; `levels` are those
    /// of its damping, which matter for the shape. What laws ask of deformations may be known, of all points or of
    /// none.
    ///
    /// # Errors
    /// [`SolidError::TurnedOver`], and [`SolidError::Rigid`] for the shape where parts are rigid.
    pub fn sensitivity(
        &self,
        potential: &Potential<'_, D>,
        places: &[f64],
        known: &[Kinematics],
        z: &[f64],
        levels: Option<&[StrainLevel<'_>]>,
    ) -> Result<Sensitivity, SolidError> {
        if levels.is_some() && !self.ties.is_empty() {
            return Err(SolidError::Rigid("the derivative by the shape"));
        }
        let mut found = Sensitivity::new(self, levels.is_some());
        let mut by_lame = vec![[0.0; 2]; self.spec.materials.len()];
        let before: Vec<(f64, Vec<Tensor>)> = levels
            .unwrap_or_default()
            .iter()
            .filter(|_| self.is_damped())
            .map(|level| (level.factor, self.deformations(level.places)))
            .collect();
        let mut local = [Point::<D>::zeros(); MAX_NODES];
        let mut number = 0;
        let controls = potential.controls();
        let is_whole = self.each_known_point(places, controls, known, |cell, at, response| {
            let rate = at.gradient(self.gather(cell, z, &mut local));
            let stresses = response.stress_by_moduli();
            for (sum, stress) in by_lame[self.material_of(cell)].iter_mut().zip(stresses) {
                *sum += at.weight * stress.dot(&rate);
            }
            for (set, fibre) in response.fibres() {
                let unit = Fibre { stiffness: 1.0, ..fibre };
                let deformation = response.deformation();
                found.fibre_stiffness[set] += at.weight * unit.stress(deformation).dot(&rate);
                found.targets[set] += at.weight * fibre.stress_by_target(deformation).dot(&rate);
            }
            if levels.is_some() {
                let mut moved = moved_stress(&response, &rate);
                let mut kept = 0.0;
                if let Some(pressure) = self.pressures.at(cell, at.shares, z) {
                    moved -= response.kinematics().cofactor() * pressure;
                    kept = pressure * (1.0 - response.kinematics().volume());
                }
                self.add(cell, &at, &moved, &mut found.places);
                let mut stress = shape_stress(&response, &rate, &moved);
                stress += Tensor::identity() * kept;
                if let Some(viscous) = response.viscous() {
                    let strain = symmetric(&(response.deformation().transpose() * rate));
                    for (factor, deformations) in &before {
                        let f = &deformations[number];
                        stress += f.transpose() * f * strain * (viscous.stiffness * factor);
                    }
                }
                self.add(cell, &at, &stress, &mut found.shape);
            }
            number += 1;
        });
        if !is_whole {
            return Err(SolidError::TurnedOver(self.turned_over(places).unwrap_or_default()));
        }
        for (k, [shear, volume]) in by_lame.into_iter().enumerate() {
            let along = |lame: Lame| shear * lame.shear + volume * lame.volume;
            found.young[k] = along(self.spec.materials[k].lame_by_young());
            found.poisson[k] = along(self.spec.materials[k].lame_by_poisson());
        }
        if levels.is_some() {
            self.add_inertia_of_shape(potential, places, z, &mut found.shape);
        }
        Ok(found)
    }

    /// The energy of all fibres in a state, told these stretches.
    #[must_use]
    pub fn fibre_energy(&self, places: &[f64], targets: &[f64]) -> FibreEnergy {
        let mut found = FibreEnergy {
            value: 0.0,
            by_places: vec![0.0; places.len()],
            by_targets: vec![0.0; targets.len()],
            by_stiffness: vec![0.0; targets.len()],
        };
        let mut local = [Point::<D>::zeros(); MAX_NODES];
        for (cell, fibres) in self.fibres_in.iter().enumerate().filter(|(_, all)| !all.is_empty()) {
            let local = self.gather(cell, places, &mut local);
            for k in 0..self.points.n_points {
                let at = self.points.at(cell, k);
                let deformation = at.deformation(local);
                for fibre in fibres {
                    let stiffness = self.spec.fibres[fibre.set].stiffness;
                    let target = targets[fibre.set];
                    let one = Fibre { direction: fibre.direction, stiffness, target };
                    let longer = one.stretch(&deformation) - target;
                    found.value += at.weight * one.energy(&deformation);
                    found.by_targets[fibre.set] -= at.weight * stiffness * longer;
                    found.by_stiffness[fibre.set] += 0.5 * at.weight * longer * longer;
                    let mut forces = [0.0; MAX_PLACES];
                    at.add_forces(&one.stress(&deformation), &mut forces);
                    for (a, node) in self.nodes_of(cell).iter().enumerate() {
                        for i in 0..D {
                            found.by_places[node * D + i] += forces[a * D + i];
                        }
                    }
                }
            }
        }
        found
    }

    /// Adds what the masses contribute to the derivatives by the shape at rest.
    fn add_inertia_of_shape(
        &self,
        potential: &Potential<'_, D>,
        places: &[f64],
        z: &[f64],
        shape: &mut [f64],
    ) {
        let Some(inertia) = &potential.inertia else { return };
        let apart: Vec<f64> = places.iter().zip(&inertia.coasted).map(|(x, y)| x - y).collect();
        let (mut one, mut other) =
            ([Point::<D>::zeros(); MAX_NODES], [Point::<D>::zeros(); MAX_NODES]);
        for cell in 0..self.spec.mesh.n_cells() {
            let density = self.spec.materials[self.material_of(cell)].density * inertia.factor;
            let z = self.gather(cell, z, &mut one);
            let apart = self.gather(cell, &apart, &mut other);
            for k in 0..self.points.n_points {
                let at = self.points.at(cell, k);
                let mean = |values: &[Point<D>]| -> Point<D> {
                    values.iter().zip(at.shapes).map(|(value, shape)| value * *shape).sum()
                };
                let product = match self.spec.mesh.order {
                    Order::Linear => (0..z.len()).map(|a| at.shapes[a] * z[a].dot(&apart[a])).sum(),
                    Order::Quadratic => mean(z).dot(&mean(apart)),
                };
                self.add(cell, &at, &(Tensor::identity() * (density * product)), shape);
            }
        }
    }

    /// Derivatives of z . r by the places of the levels before, which the damping has strains of; a list for
    /// each level.
    ///
    /// # Errors
    /// [`SolidError::TurnedOver`].
    pub fn damping_by_levels(
        &self,
        potential: &Potential<'_, D>,
        places: &[f64],
        z: &[f64],
        levels: &[StrainLevel<'_>],
    ) -> Result<Vec<Vec<f64>>, SolidError> {
        let mut all = vec![vec![0.0; places.len()]; levels.len()];
        if !self.is_damped() {
            return Ok(all);
        }
        let before: Vec<Vec<Tensor>> =
            levels.iter().map(|level| self.deformations(level.places)).collect();
        let mut local = [Point::<D>::zeros(); MAX_NODES];
        let mut number = 0;
        let controls: Controls<'_> = potential.controls();
        let is_whole = self.each_point(places, controls, |cell, at, response| {
            if let Some(viscous) = response.viscous() {
                let rate = at.gradient(self.gather(cell, z, &mut local));
                let strain = symmetric(&(response.deformation().transpose() * rate));
                for ((forces, level), before) in all.iter_mut().zip(levels).zip(&before) {
                    let stress = before[number] * strain * (-viscous.stiffness * level.factor);
                    self.add(cell, &at, &stress, forces);
                }
            }
            number += 1;
        });
        if is_whole {
            Ok(all)
        } else {
            Err(SolidError::TurnedOver(self.turned_over(places).unwrap_or_default()))
        }
    }

    /// Adds the forces of a stress at a point to those of all nodes.
    fn add(&self, cell: usize, at: &At<'_, D>, stress: &Tensor, forces: &mut [f64]) {
        let mut local = [0.0; MAX_PLACES];
        at.add_forces(stress, &mut local);
        for (a, node) in self.nodes_of(cell).iter().enumerate() {
            for i in 0..D {
                forces[node * D + i] += local[a * D + i];
            }
        }
    }
}

fn symmetric(tensor: &Tensor) -> Tensor {
    (tensor + tensor.transpose()) * 0.5
}

/// What the stress changes by where the places change by a field of this gradient.
fn moved_stress<const D: usize>(response: &Response<'_, D>, rate: &Tensor) -> Tensor {
    let row = nalgebra::SVector::<f64, 9>::from_fn(|k, _| rate[(k / 3, k % 3)]);
    let moved = response.tangent(Curvature::True) * row;
    Tensor::from_fn(|i, j| moved[3 * i + j])
}

/// What w P : Grad z, a volume w at rest, changes by where the places at rest change by Y, over Grad Y:
/// volumes grow by its trace, gradients shrink by it.
fn shape_stress<const D: usize>(
    response: &Response<'_, D>,
    rate: &Tensor,
    moved: &Tensor,
) -> Tensor {
    let stress = response.stress().stress;
    Tensor::identity() * stress.dot(rate)
        - response.deformation().transpose() * moved
        - rate.transpose() * stress
}
