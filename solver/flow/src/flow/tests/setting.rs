//! `Setting`: sample meshes with fields on them, whose residuals and matrices are tested.

use alewife_mesh::{Domain, Mesh, Point, Sizing, generate};

use crate::algebra::{AffineConstraints, CellMaps, ConstraintBuilder};
use crate::flow::*;
use crate::space::sample_mesh::{bent, two_simplices};
use crate::space::{DofLayout, Metric};

pub const METRICS: [Metric; 2] = [Metric::Cartesian, Metric::Revolved];

/// How far nodes of curved cells are from the middle of their edge (m).
pub const BEND: f64 = 0.08;

pub fn mesh_of_disc(curved: bool, metric: Metric) -> Mesh<2> {
    let domain = match metric {
        Metric::Cartesian => Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 },
        Metric::Revolved => Domain::HalfDisc { center: 0.0, radius: 1.0 },
    };
    let sizing = Sizing { curved, ..Sizing::graded(0.4, 0.3, 0.4) };
    let mesh = generate(&domain, &[], &sizing).expect("a disc has a mesh");
    assert_eq!(mesh.curved.contains(&true), curved);
    assert!(mesh.curved.contains(&false));
    mesh
}

/// Meshes of discs and their metrics, straight and curved.
pub fn discs() -> impl Iterator<Item = (Mesh<2>, Metric)> {
    [false, true]
        .into_iter()
        .flat_map(|curved| METRICS.map(|metric| (mesh_of_disc(curved, metric), metric)))
}

/// Two tetrahedra, straight and curved.
pub fn tetrahedra() -> [Mesh<3>; 2] {
    [0.0, BEND].map(|bend| bent(two_simplices::<3>(), bend))
}

/// A smooth field with all derivatives.
pub fn field<const D: usize>(mesh: &Mesh<D>, shift: f64) -> Vec<Point<D>> {
    let value = |position: &Point<D>| {
        Point::<D>::from_fn(|i, _| {
            let [x, y] = [0, 1].map(|k| position[(i + k) % D] + shift * (0.4 - 0.3 * i as f64));
            (2.0 * x + y).sin() + (x - 3.0 * position[D - 1 - i]).cos() + 0.3 * y + x * y
        })
    };
    mesh.nodes.iter().map(value).collect()
}

/// A system without constraints, with one more body for its velocities.
pub struct Setting<const D: usize> {
    pub mesh: Mesh<D>,
    pub metric: Metric,
    pub layout: DofLayout<D>,
    pub constraints: AffineConstraints,
    pub maps: CellMaps,
    pub assembly: Assembly<D>,
    pub velocity: Vec<Point<D>>,
    pub pressure: Vec<f64>,
    pub history: Vec<Point<D>>,
    pub frame: Point<D>,
    pub rate: f64,
    pub density: f64,
    pub viscosity: Viscosity,
    /// The velocity whose strain a viscosity is taken at; that of the setting if absent.
    pub sheared: Option<Vec<Point<D>>>,
    pub has_tangent: bool,
}

impl<const D: usize> Setting<D> {
    /// Every side is open, curved ones too.
    pub fn new(mesh: Mesh<D>, metric: Metric, with_frame: bool) -> Self {
        Self::with_backflow(mesh, metric, with_frame, 0.0)
    }

    /// Every side is open, and takes this part of the momentum of fluid that enters.
    pub fn with_backflow(mesh: Mesh<D>, metric: Metric, with_frame: bool, backflow: f64) -> Self {
        let open = |boundary| OpenSide { boundary, is_developed: true, backflow };
        let sides: Vec<_> = (0..mesh.boundaries.len()).map(open).collect();
        Self::with_open_sides(mesh, metric, with_frame, &sides)
    }

    pub fn closed(mesh: Mesh<D>, metric: Metric) -> Self {
        Self::with_open_sides(mesh, metric, false, &[])
    }

    pub fn with_open_sides(
        mesh: Mesh<D>,
        metric: Metric,
        with_frame: bool,
        sides: &[OpenSide],
    ) -> Self {
        let layout = DofLayout::new(&mesh, 1, D * (D + 1) / 2);
        let constraints = ConstraintBuilder::new(layout.n_raw()).build();
        let frame = with_frame.then_some(0);
        let assembly = Assembly::new(&mesh, layout, &constraints, metric, sides, frame);
        let vertices = &mesh.nodes[..mesh.n_vertices];
        Self {
            velocity: field(&mesh, 0.0),
            pressure: vertices.iter().map(|x| x[0] - x[1] * x[D - 1]).collect(),
            history: field(&mesh, 0.4),
            frame: Point::from_fn(|axis, _| 0.3 - 0.5 * axis as f64),
            rate: 1.7,
            density: 1.3,
            viscosity: Viscosity::Newtonian(0.7),
            sheared: None,
            has_tangent: true,
            mesh,
            metric,
            layout,
            maps: assembly.maps(&constraints, &[]),
            constraints,
            assembly,
        }
    }

    /// What convects: given, or the velocity itself as seen from the frame.
    pub fn convecting_velocity(&self, convection: Convection) -> Vec<Point<D>> {
        match convection {
            Convection::None => Vec::new(),
            Convection::Oseen => field(&self.mesh, -0.6),
            Convection::Newton | Convection::NewtonInFrame => {
                self.velocity.iter().map(|velocity| velocity - self.frame).collect()
            }
        }
    }

    pub fn with_terms<T>(
        &self,
        convection: Convection,
        work: impl FnOnce(&FlowTerms<'_, D>, &Fields<'_, D>) -> T,
    ) -> T {
        let viscosity = match self.viscosity {
            Viscosity::Newtonian(value) => ViscosityTerm::Constant(value),
            law => ViscosityTerm::Local(LocalViscosity {
                law,
                velocity: self.sheared.as_ref().unwrap_or(&self.velocity),
                has_tangent: self.has_tangent,
            }),
        };
        let terms = FlowTerms {
            viscosity,
            density: self.density,
            rate: self.rate,
            history: &self.history,
            convecting_velocity: &self.convecting_velocity(convection),
            convection,
        };
        work(&terms, &Fields { velocity: &self.velocity, pressure: &self.pressure })
    }

    pub fn residual(&self, convection: Convection) -> Vec<f64> {
        self.with_terms(convection, |terms, fields| {
            residual(&self.assembly, &self.mesh, terms, fields)
        })
    }

    pub fn matrix(&self, convection: Convection) -> Vec<f64> {
        let mut values = vec![0.0; self.maps.pattern().n_entries()];
        self.with_terms(convection, |terms, fields| {
            let Self { assembly, mesh, constraints, maps, .. } = self;
            let scatter = |cell, matrix: &[f64]| maps.scatter(cell, matrix, &mut values);
            assemble(assembly, mesh, constraints, terms, fields, scatter);
        });
        values
    }

    /// Moves all unknowns by `step` along a direction, which is returned.
    pub fn moved(&mut self, step: f64, in_frame: bool) -> Vec<f64> {
        let mut direction = vec![0.0; self.layout.n_raw()];
        let velocity = field(&self.mesh, 0.9);
        for (node, change) in self.layout.nodes().zip(&velocity) {
            self.velocity[node] += change * step;
            for axis in 0..D {
                direction[self.layout.velocity(node, axis)] = change[axis];
            }
        }
        for (vertex, pressure) in self.layout.vertices().zip(&mut self.pressure) {
            let change = (5.0 * vertex.index() as f64).sin();
            *pressure += step * change;
            direction[self.layout.pressure(vertex)] = change;
        }
        for axis in (0..D).filter(|&axis| in_frame && self.metric.has_translation(axis)) {
            let change = 0.8 - 0.3 * axis as f64;
            self.frame[axis] += change * step;
            direction[self.layout.rigid(0, axis)] = change;
        }
        direction
    }

    /// Sum of a raw residual's momentum rows times a velocity at the nodes.
    pub fn power(&self, residual: &[f64], velocity: &[Point<D>]) -> f64 {
        let rows = |node| (0..D).map(move |axis| (axis, self.layout.velocity(node, axis)));
        let nodes = self.layout.nodes().zip(velocity);
        nodes
            .flat_map(|(node, velocity)| {
                rows(node).map(|(axis, row)| residual[row] * velocity[axis])
            })
            .sum()
    }
}
