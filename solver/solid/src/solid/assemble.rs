//! Energy, forces and stiffness of a solid, summed over the quadrature points of its cells.

use alewife_mesh::Point;

use super::build::Solid;
use super::geometry::{At, CellMatrix, MAX_NODES, MAX_PLACES, MAX_UNKNOWNS};
use super::rigid::pose::Pose;
use crate::material::{
    Curvature, Fibre, Kinematics, Lame, Law, Stress, Tangent, Tensor, Viscous, green,
};

/// Green's strain as the backward difference of a step has it from levels before.
#[derive(Debug, Clone, PartialEq)]
pub struct StrainHistory {
    /// The factor a (1/s) of the rate a (E - E_h).
    pub rate: f64,
    /// E_h at all quadrature points.
    pub strains: Vec<Tensor>,
}

/// A level before, with the factor of its strain in the history.
#[derive(Debug, Clone, Copy)]
pub struct StrainLevel<'a> {
    /// The factor, -a_i/a_0.
    pub factor: f64,
    /// Places of all nodes (m).
    pub places: &'a [f64],
}

/// What a state depends on besides the places of the nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Controls<'a> {
    /// The stretch each set of fibres is told.
    pub targets: &'a [f64],
    /// Strains of the levels before, where there is damping.
    pub damping: Option<&'a StrainHistory>,
}

/// Which stiffness is added, and how much of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stiffness {
    pub curvature: Curvature,
    pub factor: f64,
}

/// A deformation gradient with what the law asks of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deformed<'a> {
    deformation: Tensor,
    kinematics: &'a Kinematics,
    pressure: Option<f64>,
}

/// What acts at a quadrature point.
pub(super) struct Response<'a, const D: usize> {
    solid: &'a Solid<D>,
    cell: usize,
    deformation: Tensor,
    kinematics: &'a Kinematics,
    viscous: Option<Viscous>,
    pressure: Option<f64>,
    controls: Controls<'a>,
}

impl<'a, const D: usize> Response<'a, D> {
    fn new(
        solid: &'a Solid<D>,
        cell: usize,
        number: usize,
        controls: Controls<'a>,
        at: Deformed<'a>,
    ) -> Self {
        let viscosity = solid.spec.materials[solid.material_of(cell)].viscosity;
        let viscous = controls.damping.filter(|_| viscosity > 0.0).map(|history| Viscous {
            stiffness: 2.0 * viscosity * history.rate,
            history: history.strains[number],
        });
        let Deformed { deformation, kinematics, pressure } = at;
        Self { solid, cell, deformation, kinematics, viscous, pressure, controls }
    }

    /// Fibres of the cell.
    pub(super) fn fibres(&self) -> impl Iterator<Item = (usize, Fibre)> {
        self.solid.fibres_in[self.cell].iter().map(|fibre| {
            let stiffness = self.solid.spec.fibres[fibre.set].stiffness;
            let target = self.controls.targets[fibre.set];
            (fibre.set, Fibre { direction: fibre.direction, stiffness, target })
        })
    }

    /// The deformation gradient.
    pub(super) fn deformation(&self) -> &Tensor {
        &self.deformation
    }

    /// Stresses by the shear modulus and by lambda.
    pub(super) fn stress_by_moduli(&self) -> [Tensor; 2] {
        let material = self.solid.material_of(self.cell);
        self.kinematics.stress_by_moduli(self.solid.spec.materials[material].law)
    }

    /// The damping of the point, if it has any.
    pub(super) fn viscous(&self) -> Option<&Viscous> {
        self.viscous.as_ref()
    }

    /// The pressure, where the volume is kept.
    pub(super) fn pressure(&self) -> Option<f64> {
        self.pressure
    }

    /// What the law asks of the deformation.
    pub(super) fn kinematics(&self) -> &Kinematics {
        self.kinematics
    }

    /// Energy and first Piola-Kirchhoff stress of all together.
    pub(super) fn stress(&self) -> Stress {
        let material = self.solid.material_of(self.cell);
        let law = self.solid.spec.materials[material].law;
        let mut stress = self.kinematics.stress(law, self.solid.lame[material]);
        if let Some(pressure) = self.pressure {
            stress.energy -= pressure * (self.kinematics.volume() - 1.0);
            stress.stress -= self.kinematics.cofactor() * pressure;
        }
        for (_, fibre) in self.fibres() {
            stress.energy += fibre.energy(&self.deformation);
            stress.stress += fibre.stress(&self.deformation);
        }
        if let Some(viscous) = &self.viscous {
            stress.energy += viscous.energy(&self.deformation);
            stress.stress += viscous.stress(&self.deformation);
        }
        stress
    }

    /// Derivatives of the stress by the deformation gradient (Pa).
    pub(super) fn tangent(&self, curvature: Curvature) -> Tangent {
        let (law, lame) = (self.solid.law_of(self.cell), self.lame());
        let mut tangent = self.kinematics.tangent(law, lame, self.pressure, curvature);
        for (_, fibre) in self.fibres() {
            tangent += fibre.tangent(&self.deformation, curvature).whole();
        }
        if let Some(viscous) = &self.viscous {
            tangent += viscous.tangent(&self.deformation, curvature);
        }
        tangent
    }

    /// Adds a multiple of the stiffness to the lower triangle of the matrix of the cell.
    fn add_stiffness(&self, at: &At<'_, D>, wanted: Stiffness, matrix: &mut CellMatrix) {
        let Stiffness { curvature, factor } = wanted;
        let (law, lame) = (self.solid.law_of(self.cell), self.lame());
        let parts = self.kinematics.parts(law, lame, self.pressure, curvature);
        let Some(parts) = parts.filter(|_| self.viscous.is_none() && at.curvature == 0.0) else {
            return at.add_tangent(&self.tangent(curvature), factor, matrix);
        };
        at.add_parts(&parts, factor, matrix);
        for (_, fibre) in self.fibres() {
            at.add_parts(&fibre.tangent(&self.deformation, curvature), factor, matrix);
        }
    }

    /// The moduli of the point.
    fn lame(&self) -> Lame {
        self.solid.lame[self.solid.material_of(self.cell)]
    }
}

impl<const D: usize> Solid<D> {
    /// Calls `visit` for all quadrature points of a state; false where a cell is turned over, with the points
    /// before it visited.
    pub(super) fn each_point(
        &self,
        places: &[f64],
        controls: Controls<'_>,
        visit: impl FnMut(usize, At<'_, D>, Response<'_, D>),
    ) -> bool {
        self.each_known_point(places, controls, &[], visit)
    }

    /// The same with what laws ask of deformations known, of all points or of none.
    pub(super) fn each_known_point(
        &self,
        places: &[f64],
        controls: Controls<'_>,
        known: &[Kinematics],
        mut visit: impl FnMut(usize, At<'_, D>, Response<'_, D>),
    ) -> bool {
        let mut local = [Point::<D>::zeros(); MAX_NODES];
        for cell in 0..self.spec.mesh.n_cells() {
            let local = self.gather(cell, places, &mut local);
            let law = self.law_of(cell);
            for k in 0..self.points.n_points {
                let at = self.points.at(cell, k);
                let deformation = at.deformation(local);
                let number = cell * self.points.n_points + k;
                let new;
                let kinematics = if let Some(known) = known.get(number) {
                    known
                } else {
                    let Some(found) = Kinematics::of(law, &deformation) else { return false };
                    new = found;
                    &new
                };
                let pressure = self.pressures.at(cell, at.shares, places);
                let deformed = Deformed { deformation, kinematics, pressure };
                visit(cell, at, Response::new(self, cell, number, controls, deformed));
            }
        }
        true
    }

    /// What laws ask of the deformations at all points of a state; none at all where a cell has no volume.
    #[must_use]
    pub fn kinematics(&self, places: &[f64]) -> Vec<Kinematics> {
        let deformations = self.deformations(places);
        let all = deformations.iter().enumerate().map(|(number, deformation)| {
            Kinematics::of(self.law_of(number / self.points.n_points), deformation)
        });
        all.collect::<Option<Vec<_>>>().unwrap_or_default()
    }

    /// The law of a cell.
    fn law_of(&self, cell: usize) -> Law {
        self.spec.materials[self.material_of(cell)].law
    }

    /// The cells turned over in a state, if any: the first of them.
    pub(super) fn turned_over(&self, places: &[f64]) -> Option<usize> {
        let deformations = self.deformations(places);
        let first =
            deformations.iter().position(|f| f.determinant().is_nan() || f.determinant() <= 0.0);
        first.map(|number| number / self.points.n_points)
    }

    /// Elastic energy of a state (J), that of fibres and of damping's increment included; none where a cell is
    /// turned over.
    pub(super) fn energy_of(&self, places: &[f64], controls: Controls<'_>) -> Option<f64> {
        let mut energy = 0.0;
        let visit = |_, at: At<'_, D>, response: Response<'_, D>| {
            energy += at.weight * response.stress().energy;
        };
        self.each_point(places, controls, visit).then_some(energy)
    }

    /// Adds a multiple of the inner forces of a state, and returns its energy; none where a cell is turned over.
    /// What laws ask of deformations, found on the way, goes to `known`.
    pub(super) fn add_forces(
        &self,
        places: &[f64],
        controls: Controls<'_>,
        factor: f64,
        forces: &mut [f64],
        known: &mut Vec<Kinematics>,
    ) -> Option<f64> {
        let mut energy = 0.0;
        known.clear();
        known.reserve(self.points.weights.len());
        let visit = |cell, at: At<'_, D>, response: Response<'_, D>| {
            let Stress { energy: part, stress } = response.stress();
            energy += at.weight * part;
            known.push(*response.kinematics());
            let mut local = [0.0; MAX_PLACES];
            at.add_forces(&stress, &mut local);
            let excess = at.weight * (response.kinematics().volume() - 1.0);
            for (pressure, share) in self.pressures.of(cell).iter().zip(at.shares) {
                forces[*pressure] -= factor * share * excess;
            }
            for (a, node) in self.nodes_of(cell).iter().enumerate() {
                for i in 0..D {
                    forces[node * D + i] += factor * local[a * D + i];
                }
            }
        };
        self.each_point(places, controls, visit).then_some(energy)
    }

    /// Adds a multiple of the stiffness of a state to the values of a matrix; false where a cell is turned over.
    pub(super) fn add_stiffness(
        &self,
        places: &[f64],
        controls: Controls<'_>,
        known: &[Kinematics],
        wanted: Stiffness,
        values: &mut [f64],
    ) -> bool {
        let pose = self.pose(places);
        let last = self.points.n_points - 1;
        let mut matrix = [[0.0; MAX_UNKNOWNS]; MAX_UNKNOWNS];
        let n = D * self.points.n_local + if self.pattern.is_mixed() { D + 1 } else { 0 };
        let mut point = 0;
        self.each_known_point(places, controls, known, |cell, at, response| {
            response.add_stiffness(&at, wanted, &mut matrix);
            if response.pressure().is_some() {
                at.add_volume(&response.kinematics().cofactor(), wanted.factor, &mut matrix);
            }
            if point == last {
                self.pattern.add_cell(cell, values, |p, q| matrix[p][q]);
                if let Some(pose) = pose.as_ref().filter(|_| self.ties.is_beside(cell)) {
                    self.add_tied(cell, pose, &matrix, values);
                }
                for row in &mut matrix[..n] {
                    row[..n].fill(0.0);
                }
                point = 0;
            } else {
                point += 1;
            }
        })
    }

    /// Adds what the matrix of a cell beside rigid parts has of their nodes.
    fn add_tied(&self, cell: usize, pose: &Pose<'_, D>, matrix: &CellMatrix, values: &mut [f64]) {
        let places = self.nodes_of(cell).iter().flat_map(|node| node * D..(node + 1) * D);
        let all: Vec<usize> = places.chain(self.pressures.of(cell).iter().copied()).collect();
        for p in 0..all.len() {
            for q in 0..=p {
                pose.add_entry(&self.pattern, [all[p], all[q]], matrix[p][q], values);
            }
        }
    }

    /// Strains that the backward difference with these factors has of levels before.
    pub(super) fn strain_history(&self, rate: f64, levels: &[StrainLevel<'_>]) -> StrainHistory {
        let mut strains = vec![Tensor::zeros(); self.points.weights.len()];
        for StrainLevel { factor, places } in levels {
            for (strain, deformation) in strains.iter_mut().zip(self.deformations(places)) {
                *strain += green(&deformation) * *factor;
            }
        }
        StrainHistory { rate, strains }
    }
}
