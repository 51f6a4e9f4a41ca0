//! `Opened`: which image of each cell the mesh of a periodic box shows, cut open along faces of cells.
//!
//! Cells at bodies are where their body is, so that bodies stay whole; all others where their middle is in
//! the box. Each vertex has as many copies as places in which the cells around it show it.

use super::improve::Improver;
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::{INNER, surface_of};
use super::tetrahedra::measure::FACES;
use crate::Point;

/// Numbers of whole periods along the axes.
pub type Steps = [i32; 3];

/// A vertex or an edge in one of its places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Copy {
    steps: Steps,
    /// Whether it is on a boundary facet there.
    is_on_boundary: bool,
}

/// A vertex of a cell that is on a body.
struct OnBody {
    /// Its number in the cell.
    local: usize,
    /// The surface it is on.
    surface: usize,
}

/// Where cells and vertices are shown.
#[derive(Debug)]
pub struct Opened {
    /// Whole periods from where each vertex of each cell is to where the cell shows it, by cell.
    cells: Vec<[Steps; 4]>,
    /// Places of each vertex, its original first.
    copies: Vec<Vec<Copy>>,
}

fn add(one: Steps, other: Steps) -> Steps {
    std::array::from_fn(|axis| one[axis] + other[axis])
}

fn subtract(one: Steps, other: Steps) -> Steps {
    std::array::from_fn(|axis| one[axis] - other[axis])
}

impl Opened {
    /// That of a mesh.
    pub fn new(improver: &Improver<'_>) -> Self {
        let mesh = &improver.mesh;
        let mut cells = vec![[[0; 3]; 4]; mesh.cells().last().map_or(0, |last| last as usize + 1)];
        let mut copies: Vec<Vec<Copy>> = vec![Vec::new(); mesh.points.len()];
        for cell in mesh.cells() {
            let steps = improver.steps_of(cell);
            cells[cell as usize] = steps;
            let tags = mesh.tags(cell);
            for (local, vertex) in mesh.cell(cell).into_iter().enumerate() {
                let is_on_boundary = (0..4).any(|face| face != local && tags[face] != INNER);
                let known = &mut copies[vertex as usize];
                match known.iter_mut().find(|copy| copy.steps == steps[local]) {
                    Some(copy) => copy.is_on_boundary |= is_on_boundary,
                    None => known.push(Copy { steps: steps[local], is_on_boundary }),
                }
            }
        }
        for of_vertex in &mut copies {
            // The originals first: on the boundary, whose values are given, and near
            of_vertex.sort_by_key(|copy| {
                let n_steps: i32 = copy.steps.iter().map(|step| step.abs()).sum();
                (!copy.is_on_boundary, n_steps, copy.steps)
            });
        }
        Self { cells, copies }
    }

    /// The places of a vertex, its original first.
    pub fn places(&self, vertex: u32) -> impl Iterator<Item = Steps> + '_ {
        self.copies[vertex as usize].iter().map(|copy| copy.steps)
    }

    /// Which of its places a vertex of a cell has there.
    pub fn place_in(&self, cell: u32, local: usize, vertex: u32) -> usize {
        let steps = self.steps(cell, local);
        let at = self.copies[vertex as usize].iter().position(|copy| copy.steps == steps);
        at.unwrap_or(0)
    }

    /// Whole periods from where a vertex of a cell is to where the cell shows it.
    pub fn steps(&self, cell: u32, local: usize) -> Steps {
        self.cells[cell as usize][local]
    }

    /// The side of the box that stands for an inner face of a cell along which the mesh is cut open; `None`
    /// for other faces.
    pub fn side(&self, improver: &Improver<'_>, face: Face) -> Option<usize> {
        let vertices = improver.mesh.face_vertices(face);
        let across = improver.mesh.across(vertices, face.cell)?;
        let local = |cell| improver.mesh.cell(cell).iter().position(|v| *v == vertices[0]);
        let own = self.steps(face.cell, local(face.cell)?);
        let step = subtract(own, self.steps(across.cell, local(across.cell)?));
        let axis = step.iter().position(|step| *step != 0)?;
        Some(2 * axis + usize::from(step[axis] > 0))
    }
}

impl Improver<'_> {
    /// Whole periods from where the vertices of a cell are to where the cell shows them.
    fn steps_of(&self, cell: u32) -> [Steps; 4] {
        let periods = &self.geometry.periods;
        if !periods.is_any() {
            return [[0; 3]; 4];
        }
        let vertices = self.mesh.cell(cell);
        let first = self.mesh.point(vertices[0]);
        // To where the cell is whole beside its first vertex, and from there
        let together = vertices.map(|vertex| periods.steps(self.mesh.point(vertex), first));
        let on = match self.body_vertex(cell) {
            Some(OnBody { local, surface }) => {
                let home = self.geometry.steps_home(surface, self.mesh.point(vertices[local]));
                subtract(home, together[local])
            }
            None => {
                let middle = self.mesh.corners(vertices).iter().sum::<Point<3>>() * 0.25;
                let [min, max] = self.geometry.corners;
                periods.steps(middle, (min + max) * 0.5)
            }
        };
        together.map(|steps| add(steps, on))
    }

    /// A vertex of a cell on a body: that of a face where there is one, else the first.
    fn body_vertex(&self, cell: u32) -> Option<OnBody> {
        let first_of_bodies = self.geometry.groups[0].last;
        let tags = self.mesh.tags(cell).into_iter().enumerate();
        let faces = tags.filter(|(_, tag)| *tag != INNER);
        let mut faces = faces
            .map(|(at, tag)| OnBody { local: FACES[at][0], surface: usize::from(surface_of(tag)) });
        faces.find(|on| on.surface >= first_of_bodies).or_else(|| {
            self.mesh.cell(cell).into_iter().enumerate().find_map(|(local, vertex)| {
                let surfaces = self.mesh.surfaces(vertex);
                let mut own = surfaces.as_slice().iter().map(|surface| usize::from(*surface));
                own.find(|surface| *surface >= first_of_bodies)
                    .map(|surface| OnBody { local, surface })
            })
        })
    }
}
