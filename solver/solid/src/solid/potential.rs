//! `Potential`: what a solid minimises at rest, or in one implicit time step.

use alewife_mesh::Point;

use super::assemble::{Controls, Stiffness, StrainHistory};
use super::build::Solid;
use super::geometry::MAX_NODES;
use crate::material::{Curvature, Kinematics};

/// Inertia of a step: the energy c/2 (x - y)^2 in the norm of the mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Inertia {
    /// c (1/s2).
    pub factor: f64,
    /// The places y that the nodes would reach without forces (m).
    pub coasted: Vec<f64>,
}

/// Inner forces as their mean along the straight way from one state to the sought one: with the trapezoidal
/// rule for the places, energy is kept for ever.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Where it begins (m).
    pub from: Vec<f64>,
    /// Places on it, from 0 to 1, and their weights: Gauss-Legendre.
    pub points: Vec<[f64; 2]>,
}

/// Elastic energy, less the work of loads, and with inertia; less pressures times changes of the volume where it is
/// kept, so that the sought state is a saddle.
#[derive(Debug, Clone)]
pub struct Potential<'a, const D: usize> {
    /// The body.
    pub solid: &'a Solid<D>,
    /// The stretch that each set of fibres is told.
    pub targets: &'a [f64],
    /// Loads (N) on all components that do not depend on the state.
    pub loads: &'a [f64],
    /// Inertia, in a step.
    pub inertia: Option<Inertia>,
    /// Strains of levels before, where there is damping.
    pub damping: Option<StrainHistory>,
    /// The way along which the inner forces are averaged, in a conservative step.
    pub way: Option<Way>,
}

/// A potential and its slope.
#[derive(Debug, Clone)]
pub(super) struct Slope {
    /// The potential (J).
    pub value: f64,
    /// Its derivatives (N), by all components; where held, less the force that holds.
    pub slope: Vec<f64>,
    /// Norm (N) of the largest of the forces of free components that balance.
    pub scale: f64,
    /// What laws ask of the deformations at all points; empty where there are several states.
    pub known: Vec<Kinematics>,
}

impl<'a, const D: usize> Potential<'a, D> {
    /// The potential of a solid at rest under loads.
    #[must_use]
    pub fn at_rest(solid: &'a Solid<D>, targets: &'a [f64], loads: &'a [f64]) -> Self {
        Self { solid, targets, loads, inertia: None, damping: None, way: None }
    }

    pub(super) fn controls(&self) -> Controls<'_> {
        Controls { targets: self.targets, damping: self.damping.as_ref() }
    }

    /// States whose inner forces are summed, with their weights and how far they follow the sought one.
    fn stages(&self, places: &[f64]) -> Vec<Stage> {
        let Some(way) = &self.way else {
            return vec![Stage { places: places.to_vec(), weight: 1.0, share: 1.0 }];
        };
        let between = |share: f64| {
            let pairs = way.from.iter().zip(places);
            pairs.map(|(from, to)| from + share * (to - from)).collect()
        };
        let stages = way.points.iter();
        stages
            .map(|[share, weight]| Stage {
                places: between(*share),
                weight: *weight,
                share: *share,
            })
            .collect()
    }

    /// The potential and its slope; none where a cell is turned over.
    pub(super) fn slope(&self, places: &[f64]) -> Option<Slope> {
        let mut slope = vec![0.0; places.len()];
        let (mut value, mut known) = (0.0, Vec::new());
        for stage in self.stages(places) {
            let energy = self.solid.add_forces(
                &stage.places,
                self.controls(),
                stage.weight,
                &mut slope,
                &mut known,
            )?;
            value += stage.weight / stage.share * energy;
        }
        let n_free = self.solid.pattern.n_places;
        let free = |all: &[f64]| norm(&self.solid.free(places, all)[..n_free]);
        let mut scale = free(&slope).max(free(self.loads));
        for (entry, (load, place)) in slope.iter_mut().zip(self.loads.iter().zip(places)) {
            *entry -= load;
            value -= load * place;
        }
        if let Some(inertia) = &self.inertia {
            let apart: Vec<f64> = places.iter().zip(&inertia.coasted).map(|(x, y)| x - y).collect();
            let forces = self.solid.mass.times(&apart);
            for ((entry, force), apart) in slope.iter_mut().zip(&forces).zip(&apart) {
                *entry += inertia.factor * force;
                value += 0.5 * inertia.factor * force * apart;
            }
            scale = scale.max(inertia.factor * free(&forces));
        }
        if self.way.is_some() {
            // There are others along the way
            known.clear();
        }
        Some(Slope { value, slope, scale, known })
    }

    /// Its second derivatives by the unknowns, with what laws ask of deformations where that is known; none where a
    /// cell is turned over.
    pub(super) fn curvature(
        &self,
        places: &[f64],
        curvature: Curvature,
        known: &[Kinematics],
    ) -> Option<Vec<f64>> {
        let pattern = &self.solid.pattern;
        let mut values = vec![0.0; pattern.n_entries()];
        for stage in self.stages(places) {
            let factor = stage.weight * stage.share;
            let is_whole = self.solid.add_stiffness(
                &stage.places,
                self.controls(),
                known,
                Stiffness { curvature, factor },
                &mut values,
            );
            if !is_whole {
                return None;
            }
        }
        let pose = self.solid.pose(places);
        if let Some(inertia) = &self.inertia {
            self.solid.mass.add(inertia.factor, pattern, &mut values);
            if let Some(pose) = &pose {
                self.solid.mass.add_tied(inertia.factor, pose, pattern, &mut values);
            }
        }
        if let Some(pose) = pose.filter(|_| curvature == Curvature::True) {
            pose.add_turning(pattern, &self.slope(places)?.slope, &mut values);
        }
        Some(values)
    }

    /// What rounding may leave at a state: places have as many digits as they have, and strains are differences
    /// of them over the size of a cell.
    pub(super) fn rounding(&self, places: &[f64]) -> Rounding {
        let solid = self.solid;
        let mut forces = vec![0.0; places.len()];
        let mut energy = 0.0;
        let mut volumes = vec![0.0; solid.pressures.count()];
        let mut local = [Point::<D>::zeros(); MAX_NODES];
        for cell in 0..solid.spec.mesh.n_cells() {
            let lame = solid.lame[solid.material_of(cell)];
            let fibres = &solid.fibres_in[cell];
            let stiffness: f64 = fibres.iter().map(|f| solid.spec.fibres[f.set].stiffness).sum();
            let pressures = solid.pressures.of(cell).iter().map(|one| places[*one].abs());
            let pressure = pressures.fold(0.0, f64::max);
            let modulus = 2.0 * lame.shear + lame.volume.abs() + stiffness + pressure;
            let local = solid.gather(cell, places, &mut local);
            for k in 0..solid.points.n_points {
                let at = solid.points.at(cell, k);
                let pairs = local.iter().zip(at.gradients);
                let lost: f64 = pairs.map(|(place, slope)| place.norm() * slope.norm()).sum();
                energy += modulus * at.weight;
                for (pressure, share) in solid.pressures.of(cell).iter().zip(at.shares) {
                    volumes[*pressure - solid.pressures.first] +=
                        (1.0 + lost) * at.weight * share.abs();
                }
                for (node, slope) in solid.nodes_of(cell).iter().zip(at.gradients) {
                    forces[D * node] += modulus * (1.0 + lost) * at.weight * slope.norm();
                }
            }
        }
        let mut slope = norm(&forces);
        if let Some(inertia) = &self.inertia {
            let sizes: Vec<f64> = places.iter().map(|place| place.abs()).collect();
            let momentum = solid.mass.times(&sizes);
            slope = slope.hypot(inertia.factor * norm(&momentum));
            let apart = places.iter().zip(&inertia.coasted).map(|(x, y)| (x - y).abs());
            energy += inertia.factor * momentum.iter().zip(apart).map(|(p, x)| p * x).sum::<f64>();
        }
        energy += self.loads.iter().zip(places).map(|(load, x)| (load * x).abs()).sum::<f64>();
        // Forces on all nodes of a rigid part are summed
        let most = solid.ties.parts.iter().map(Vec::len).max().unwrap_or(1);
        let slope = slope * (most as f64).sqrt();
        Rounding {
            value: f64::EPSILON * energy,
            slope: f64::EPSILON * slope,
            volume: f64::EPSILON * norm(&volumes),
        }
    }
}

/// What rounding may leave of a potential (J), of the norm of its slope (N), and of that of the volumes that are
/// kept (m3).
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounding {
    pub value: f64,
    pub slope: f64,
    pub volume: f64,
}

/// A state whose inner forces count.
struct Stage {
    places: Vec<f64>,
    weight: f64,
    share: f64,
}

/// Euclidean norm.
pub(super) fn norm(all: &[f64]) -> f64 {
    all.iter().map(|value| value * value).sum::<f64>().sqrt()
}
