//! `Tetrahedra`: a mesh that can be changed cell by cell, with what lies around each vertex.

pub mod boundary_edges;
pub mod measure;
pub mod surface_set;

use boundary_edges::{BoundaryEdges, INNER};
use measure::FACES;
use surface_set::SurfaceSet;

use crate::Point;
use crate::periods::Periods;

/// Stands for no vertex: the first vertex of a place in the list of cells that is free.
pub const NO_VERTEX: u32 = u32::MAX;

/// A face of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// The cell.
    pub cell: u32,
    /// The local vertex opposite the face.
    pub opposite: usize,
}

/// One step of a change, which can be taken back.
#[derive(Debug, Clone)]
enum Change {
    Added(u32),
    Deleted { vertices: [u32; 4], tags: [u16; 4] },
    Tagged { face: Face, tag: u16 },
    Moved { vertex: u32, point: Point<3>, size: f64 },
}

/// A mesh of tetrahedra that can be changed.
///
/// Vertices are never taken out of their lists: one without cells is not part of the mesh.
#[derive(Debug, Clone, Default)]
pub struct Tetrahedra {
    /// Lengths by which space repeats (m), zero along the other axes.
    periods: Periods<3>,
    /// Places of the vertices (m), each at one of its images.
    pub points: Vec<Point<3>>,
    /// Edge lengths wanted there (m).
    pub sizes: Vec<f64>,
    /// The surfaces each vertex is on.
    pub surfaces: Vec<SurfaceSet>,
    cells: Vec<[u32; 4]>,
    tags: Vec<[u16; 4]>,
    /// Cells around each vertex.
    around: Vec<Vec<u32>>,
    /// Free places in the list of cells, the last one to be taken first.
    free: Vec<u32>,
    edges: BoundaryEdges,
    /// Quality of each cell, not a number where it is to be computed.
    qualities: Vec<f64>,
    /// When the neighbourhood of each vertex changed last.
    changed: Vec<u32>,
    now: u32,
    marks: Vec<u32>,
    mark: u32,
    journal: Option<Vec<Change>>,
}

impl Tetrahedra {
    /// A mesh without vertices in space that may repeat.
    pub fn new(periods: Periods<3>) -> Self {
        Self { periods, ..Self::default() }
    }

    /// Adds a vertex, which has no cells yet.
    pub fn add_vertex(&mut self, point: Point<3>, size: f64, surfaces: SurfaceSet) -> u32 {
        let vertex = crate::number::index_u32(self.points.len());
        self.points.push(point);
        self.sizes.push(size);
        self.surfaces.push(surfaces);
        self.around.push(Vec::new());
        self.changed.push(self.now);
        self.marks.push(0);
        self.edges.add_vertex();
        vertex
    }

    /// Adds a positive cell with the tags of its faces.
    pub fn add_cell(&mut self, vertices: [u32; 4], tags: [u16; 4]) -> u32 {
        let cell = if let Some(cell) = self.free.pop() {
            self.cells[cell as usize] = vertices;
            self.tags[cell as usize] = tags;
            self.qualities[cell as usize] = f64::NAN;
            cell
        } else {
            self.cells.push(vertices);
            self.tags.push(tags);
            self.qualities.push(f64::NAN);
            crate::number::index_u32(self.cells.len() - 1)
        };
        for vertex in vertices {
            self.changed[vertex as usize] = self.now;
            self.around[vertex as usize].push(cell);
        }
        for (face, tag) in FACES.into_iter().zip(tags) {
            if tag != INNER {
                self.edges.add_face(face.map(|local| vertices[local]), tag);
            }
        }
        self.note(Change::Added(cell));
        cell
    }

    /// Takes a cell out of the mesh.
    pub fn delete_cell(&mut self, cell: u32) {
        let (vertices, tags) = (self.cells[cell as usize], self.tags[cell as usize]);
        for vertex in vertices {
            self.changed[vertex as usize] = self.now;
            let around = &mut self.around[vertex as usize];
            if let Some(at) = around.iter().position(|other| *other == cell) {
                around.swap_remove(at);
            }
        }
        for (face, tag) in FACES.into_iter().zip(tags) {
            if tag != INNER {
                self.edges.remove_face(face.map(|local| vertices[local]), tag);
            }
        }
        self.cells[cell as usize] = [NO_VERTEX; 4];
        self.free.push(cell);
        self.note(Change::Deleted { vertices, tags });
    }

    /// Tags a face as one of the boundary, or as an inner one.
    pub fn set_tag(&mut self, face: Face, tag: u16) {
        let vertices = self.face_vertices(face);
        let entry = &mut self.tags[face.cell as usize][face.opposite];
        let before = std::mem::replace(entry, tag);
        if before != INNER {
            self.edges.remove_face(vertices, before);
        }
        if tag != INNER {
            self.edges.add_face(vertices, tag);
        }
        self.note(Change::Tagged { face, tag: before });
    }

    /// Moves a vertex.
    pub fn move_vertex(&mut self, vertex: u32, point: Point<3>, size: f64) {
        let v = vertex as usize;
        self.note(Change::Moved { vertex, point: self.points[v], size: self.sizes[v] });
        self.points[v] = point;
        self.sizes[v] = size;
        for at in 0..self.around[v].len() {
            let cell = self.around[v][at] as usize;
            self.qualities[cell] = f64::NAN;
            for other in self.cells[cell] {
                self.changed[other as usize] = self.now;
            }
        }
    }

    fn note(&mut self, change: Change) {
        if let Some(journal) = &mut self.journal {
            journal.push(change);
        }
    }

    /// From now on all changes can be taken back.
    pub fn start_journal(&mut self) {
        self.journal = Some(Vec::new());
    }

    /// The changes since the start of the journal stay.
    pub fn keep_changes(&mut self) {
        self.journal = None;
    }

    /// Takes all changes since the start of the journal back; vertices that were added lose their
    /// cells.
    pub fn undo_changes(&mut self) {
        for change in self.journal.take().unwrap_or_default().into_iter().rev() {
            match change {
                Change::Added(cell) => self.delete_cell(cell),
                // The place it had is free again and the last in the list
                Change::Deleted { vertices, tags } => {
                    self.add_cell(vertices, tags);
                }
                Change::Tagged { face, tag } => self.set_tag(face, tag),
                Change::Moved { vertex, point, size } => self.move_vertex(vertex, point, size),
            }
        }
    }

    /// Number of cells.
    pub fn n_cells(&self) -> usize {
        self.cells.len() - self.free.len()
    }

    /// All cells.
    pub fn cells(&self) -> impl Iterator<Item = u32> + '_ {
        let all = (0..).zip(&self.cells);
        all.filter(|(_, vertices)| vertices[0] != NO_VERTEX).map(|(cell, _)| cell)
    }

    /// All vertices that have cells.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.around).filter(|(_, around)| !around.is_empty()).map(|(vertex, _)| vertex)
    }

    /// One past the last vertex there has been.
    pub fn end_of_vertices(&self) -> u32 {
        crate::number::index_u32(self.points.len())
    }

    /// Whether these are the vertices of this cell still.
    pub fn is_still(&self, cell: u32, vertices: [u32; 4]) -> bool {
        self.cells[cell as usize] == vertices
    }

    /// Vertices of a cell.
    #[inline]
    pub fn cell(&self, cell: u32) -> [u32; 4] {
        self.cells[cell as usize]
    }

    /// Tags of the faces of a cell, each opposite a vertex.
    #[inline]
    pub fn tags(&self, cell: u32) -> [u16; 4] {
        self.tags[cell as usize]
    }

    /// Places of vertices of a cell (m), next to that of the first of them.
    #[inline]
    pub fn corners<const N: usize>(&self, vertices: [u32; N]) -> [Point<3>; N] {
        self.corners_beside(vertices, self.point(vertices[0]))
    }

    /// Places of vertices (m), next to a point.
    #[inline]
    pub fn corners_beside<const N: usize>(
        &self,
        vertices: [u32; N],
        beside: Point<3>,
    ) -> [Point<3>; N] {
        let points = vertices.map(|vertex| self.points[vertex as usize]);
        if self.periods.is_any() {
            points.map(|point| self.periods.beside(point, beside))
        } else {
            points
        }
    }

    /// Place of a vertex (m).
    #[inline]
    pub fn point(&self, vertex: u32) -> Point<3> {
        self.points[vertex as usize]
    }

    /// Surfaces a vertex is on.
    #[inline]
    pub fn surfaces(&self, vertex: u32) -> SurfaceSet {
        self.surfaces[vertex as usize]
    }

    /// Cells around a vertex.
    #[inline]
    pub fn around(&self, vertex: u32) -> &[u32] {
        &self.around[vertex as usize]
    }

    /// Vertices of a face, counter-clockwise from outside the cell.
    pub fn face_vertices(&self, face: Face) -> [u32; 3] {
        FACES[face.opposite].map(|local| self.cells[face.cell as usize][local])
    }

    /// The surfaces whose boundary faces meet at an edge; none for an edge inside the fluid.
    #[inline]
    pub fn edge_surfaces(&self, a: u32, b: u32) -> SurfaceSet {
        if self.surfaces(a).meets(self.surfaces(b)) {
            self.edges.surfaces(a, b)
        } else {
            SurfaceSet::EMPTY
        }
    }

    /// Cells around an edge; none where there is no such edge.
    pub fn shell(&self, a: u32, b: u32, cells: &mut Vec<u32>) {
        cells.clear();
        let is_shorter = self.around(a).len() <= self.around(b).len();
        let (from, other) = if is_shorter { (a, b) } else { (b, a) };
        let with = self.around(from).iter().filter(|cell| self.cell(**cell).contains(&other));
        cells.extend(with);
    }

    /// The face of another cell with these vertices.
    pub fn across(&self, vertices: [u32; 3], but: u32) -> Option<Face> {
        let fewest = vertices.iter().min_by_key(|vertex| self.around(**vertex).len())?;
        self.around(*fewest).iter().filter(|cell| **cell != but).find_map(|&cell| {
            let own = self.cell(cell);
            let [a, b, c] = vertices;
            // Without branches: three of the four are those of the face
            let is_other =
                own.map(|vertex| u8::from((vertex != a) & (vertex != b) & (vertex != c)));
            let has_all = is_other.iter().sum::<u8>() == 1;
            let opposite = is_other.iter().position(|other| *other == 1)?;
            has_all.then_some(Face { cell, opposite })
        })
    }

    /// Vertices that share an edge with a vertex, in the order of its cells.
    pub fn neighbours(&mut self, vertex: u32, neighbours: &mut Vec<u32>) {
        neighbours.clear();
        let mark = self.new_mark();
        self.marks[vertex as usize] = mark;
        for cell in &self.around[vertex as usize] {
            for other in self.cells[*cell as usize] {
                if self.marks[other as usize] != mark {
                    self.marks[other as usize] = mark;
                    neighbours.push(other);
                }
            }
        }
    }

    /// Number of vertices in both of two lists, none of them twice in one.
    pub fn n_common(&mut self, one: &[u32], other: &[u32]) -> usize {
        let mark = self.new_mark();
        for vertex in one {
            self.marks[*vertex as usize] = mark;
        }
        other.iter().filter(|vertex| self.marks[**vertex as usize] == mark).count()
    }

    /// A mark that no vertex has.
    fn new_mark(&mut self) -> u32 {
        self.mark += 1;
        self.mark
    }

    /// Middle of an edge (m), next to its first end.
    #[inline]
    pub fn middle(&self, ends: [u32; 2]) -> Point<3> {
        let [a, b] = self.corners(ends);
        (a + b) * 0.5
    }

    /// Length of an edge (m).
    #[inline]
    pub fn length(&self, a: u32, b: u32) -> f64 {
        let [a, b] = self.corners([a, b]);
        (a - b).norm()
    }

    /// Length of an edge over the mean of the sizes wanted at its ends.
    #[inline]
    pub fn relative_length(&self, a: u32, b: u32) -> f64 {
        let mean = 0.5 * (self.sizes[a as usize] + self.sizes[b as usize]);
        self.length(a, b) / mean
    }

    /// The quality of a cell that was kept, not a number where there is none.
    #[inline]
    pub fn kept_quality(&self, cell: u32) -> f64 {
        self.qualities[cell as usize]
    }

    /// Keeps the quality of a cell until it changes.
    pub fn keep_quality(&mut self, cell: u32, quality: f64) {
        self.qualities[cell as usize] = quality;
    }

    /// The qualities of all cells are to be computed again.
    pub fn forget_qualities(&mut self) {
        self.qualities.fill(f64::NAN);
    }

    /// The qualities of these cells are to be computed again.
    pub fn forget_around(&mut self, vertex: u32) {
        for cell in &self.around[vertex as usize] {
            self.qualities[*cell as usize] = f64::NAN;
        }
    }

    /// Starts a new interval of time, and gives its number.
    pub fn tick(&mut self) -> u32 {
        self.now += 1;
        self.now
    }

    /// Whether something around a vertex has changed in this interval or later.
    #[inline]
    pub fn has_changed_since(&self, vertex: u32, interval: u32) -> bool {
        self.changed[vertex as usize] >= interval
    }
}
