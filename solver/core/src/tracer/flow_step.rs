//! `FlowStep`: the flow between two levels on a mesh that moves, where velocities are taken.

use alewife_mesh::{
    CellId, Facet, Locator, Mesh, Neighbours, Point, Simplex, map_quadratic, shape_functions,
};

/// Barycentric coordinates below this are zero by rounding.
const ON_FACET: f64 = 1e-9;

/// Part of the way beyond a side that the fluid which crosses it must have made in the step, for a particle to leave.
const CROSSED: f64 = 0.1;

/// What happens to particles at a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// They are kept in the fluid.
    Closed,
    /// They leave.
    Open,
    /// They leave where the fluid does, and are kept in it elsewhere.
    WithFluid,
}

/// The flow between two levels: velocities and places of nodes go from one to the other at a constant rate.
#[derive(Debug, Clone, Copy)]
pub struct FlowStep<'a, const D: usize> {
    /// The mesh at the end, in the laboratory.
    pub mesh: &'a Mesh<D>,
    /// Positions of its nodes at the beginning (m), in the laboratory.
    pub nodes_before: &'a [Point<D>],
    /// Velocities of its nodes at the beginning and at the end (m/s).
    pub velocities: [&'a [Point<D>]; 2],
    /// Time at the beginning and at the end (s).
    pub times: [f64; 2],
    /// Vectors by which the mesh repeats (m), zero first.
    pub images: &'a [Point<D>],
    /// What happens at each boundary of the mesh.
    pub passages: &'a [Passage],
}

impl<const D: usize> FlowStep<'_, D> {
    /// Its length (s).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// Whether nodes move in it.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.nodes_before != self.mesh.nodes.as_slice()
    }

    /// The mesh at a part of the step.
    pub(super) fn mesh_at(&self, part: f64) -> Mesh<D> {
        if part == 1.0 {
            return self.mesh.clone();
        }
        let nodes = self.nodes_before.iter().zip(&self.mesh.nodes);
        self.mesh.with_nodes(nodes.map(|(from, to)| from + (to - from) * part).collect())
    }
}

/// The mesh at one time of a step, in which particles are sought.
pub(super) struct Instant<'a, const D: usize> {
    /// The step it is in.
    step: &'a FlowStep<'a, D>,
    mesh: Mesh<D>,
    locator: Locator<D>,
    neighbours: &'a Neighbours<D>,
}

/// Where a particle is in the mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found<const D: usize> {
    /// The cell.
    pub cell: CellId,
    /// Reference coordinates in it; those of the nearest place of a particle outside.
    pub at: [f64; D],
    /// Velocity of the fluid there (m/s).
    pub velocity: Point<D>,
    /// The whole periods that lead there (m), beside those known before.
    pub shift: Point<D>,
    /// Distance out of the mesh (m).
    pub distance: f64,
}

impl<'a, const D: usize> Instant<'a, D> {
    /// At a part of a step.
    pub fn new(step: &'a FlowStep<'a, D>, part: f64, neighbours: &'a Neighbours<D>) -> Self {
        let mesh = step.mesh_at(part);
        Self { step, locator: Locator::new(&mesh), mesh, neighbours }
    }

    /// Where a point (m) is, sooner near the cell of a number, with the velocity at a part of the step; `None` of one
    /// that is not finite.
    pub fn find(&self, part: f64, point: &Point<D>, near: usize) -> Option<Found<D>> {
        let guess = (near < self.mesh.n_cells()).then(|| CellId::new(near));
        let walked = guess.and_then(|cell| self.locator.walk(self.neighbours, cell, *point));
        let (located, shift) = match walked {
            Some(located) => (located, Point::<D>::zeros()),
            None => {
                let image = self.locator.nearest_image(*point, self.step.images)?;
                (image.located, self.step.images[image.shift])
            }
        };
        let at =
            if located.distance > 0.0 { clamped(located.reference) } else { located.reference };
        let velocity = self.velocity(part, located.cell, at);
        Some(Found { cell: located.cell, at, velocity, shift, distance: located.distance })
    }

    fn velocity(&self, part: f64, cell: CellId, at: [f64; D]) -> Point<D> {
        let [before, now] = self.step.velocities;
        let nodes = self.mesh.cell(cell).iter();
        nodes.zip(shape_functions(at).iter()).fold(Point::<D>::zeros(), |sum, (&node, phi)| {
            let [before, now] = [before[node.index()], now[node.index()]];
            let velocity = if part == 1.0 { now } else { before + (now - before) * part };
            sum + velocity * *phi
        })
    }

    /// The place of the mesh (m).
    pub fn place(&self, found: &Found<D>) -> Point<D> {
        map_quadratic(&self.mesh.cell_nodes(found.cell), found.at).position
    }

    /// Shortest distance between vertices of a cell (m).
    pub fn cell_size(&self, cell: CellId) -> f64 {
        let nodes = self.mesh.cell_nodes(cell);
        let vertices = &nodes[..=D];
        let pairs = (0..=D).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs.map(|(i, j)| (vertices[i] - vertices[j]).norm()).fold(f64::INFINITY, f64::min)
    }

    /// Whether a particle at a point (m) outside has left, rather than that it is to be put back.
    pub fn has_left(&self, point: &Point<D>, found: &Found<D>) -> bool {
        let beyond = point + found.shift - self.place(found);
        let passes = |facet: &Facet| match self.step.passages[facet.boundary.index()] {
            Passage::Closed => false,
            Passage::Open => true,
            Passage::WithFluid => {
                let cell = self.mesh.cell(found.cell).iter();
                let weights = shape_functions(found.at);
                let way =
                    cell.zip(weights.iter()).fold(Point::<D>::zeros(), |sum, (&node, phi)| {
                        let node = node.index();
                        sum + (self.step.mesh.nodes[node] - self.step.nodes_before[node]) * *phi
                    });
                let crossing = found.velocity * self.step.length() - way;
                crossing.dot(&beyond) > CROSSED * beyond.norm_squared()
            }
        };
        let vertices = self.mesh.cell(found.cell)[..=D].iter();
        let touched: Vec<_> = barycentric(found.at)
            .zip(vertices)
            .filter_map(|(share, vertex)| (share > ON_FACET).then_some(*vertex))
            .collect();
        let holds = |facet: &&Facet| {
            let own = self.mesh.facet_vertices(facet);
            touched.iter().all(|vertex| own.contains(vertex))
        };
        touched.len() <= Simplex::<D>::FACETS[0].len()
            && self.mesh.facets.iter().filter(holds).any(passes)
    }
}

fn barycentric<const D: usize>(at: [f64; D]) -> impl Iterator<Item = f64> {
    std::iter::once(1.0 - at.iter().sum::<f64>()).chain(at)
}

/// The place in the reference simplex for coordinates outside.
fn clamped<const D: usize>(at: [f64; D]) -> [f64; D] {
    let sum: f64 = barycentric(at).map(|share| share.max(0.0)).sum();
    at.map(|share| share.max(0.0) / sum)
}
