//! `Mirror`: whether a planar problem is its own mirror image; half of its boundary; reflection.
//!
//! A front that meets itself decides by rounding, so the mesh of a symmetric problem would not be
//! symmetric. Half of it is meshed instead, with the line of symmetry as a boundary, and reflected.

use std::collections::HashMap;

use crate::planar::boundary::{BoundaryLoops, BoundaryPiece, CopyOf, Curve, quarter_of, segment};
use crate::{
    Boundary, BoundaryId, BoundaryKind, CellId, Domain, Facet, Mesh, NodeId, Outline, PeriodicPair,
    PlacedShape, Point, Sizing, Topology,
};

/// Mirror images agree within this part of the size of the domain: bodies that have moved through a
/// mirror-symmetric mesh are images of each other to rounding, which adds up on the way.
const AGREEMENT: f64 = 1e-10;

/// Places per quarter that are compared with their mirror image.
const SAMPLES: usize = 48;

/// Where a body is with respect to the line.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    /// Its own mirror image; the line enters it at the start of one of its pieces, and leaves it at that of
    /// another one.
    OnLine { entry: usize, exit: usize },
    /// In the half that is meshed.
    Kept,
    /// The mirror image of a body that is.
    Image,
}

/// A line of symmetry x = const or y = const; the half beyond it, of larger coordinates, is meshed.
#[derive(Debug, Clone)]
pub struct Mirror {
    /// The coordinate that is reflected.
    axis: usize,
    /// The line (m).
    at: f64,
    roles: Vec<Role>,
    /// The boundary that is the image of each.
    image_of: Vec<BoundaryId>,
    /// Whether the far side and its image are a periodic pair.
    is_periodic: bool,
}

impl Mirror {
    /// The line of symmetry of a planar domain with its bodies and sizing, if there is one; along x
    /// rather than along y.
    pub fn find(domain: &Domain, outlines: &[Outline], sizing: &Sizing) -> Option<Self> {
        [1, 0].into_iter().find_map(|axis| Self::about(axis, domain, outlines, sizing))
    }

    fn about(axis: usize, domain: &Domain, outlines: &[Outline], sizing: &Sizing) -> Option<Self> {
        let (at, size, is_periodic) = match domain {
            Domain::Box { min, max, periodic_x, periodic_y } => {
                let periodic = [*periodic_x, *periodic_y][axis];
                (0.5 * (min[axis] + max[axis]), (max - min).max(), periodic)
            }
            Domain::Disc { center, radius } => (center[axis], *radius, false),
            Domain::HalfDisc { .. } | Domain::Cylinder { .. } => return None,
        };
        let mut image_of: Vec<_> = (0..domain.sides().len()).map(BoundaryId::new).collect();
        if image_of.len() == 4 {
            image_of.swap(2 * axis, 2 * axis + 1);
        }
        let mut mirror = Self { axis, at, roles: Vec::new(), image_of, is_periodic };
        let near = AGREEMENT * size;
        if !mirror.keeps_sizing(domain, sizing, near) {
            return None;
        }
        let n_sides = domain.sides().len();
        // The half ends at the side that faces its own image
        let [low, high] = domain.corners().map(|corner| corner[axis]);
        let is_across = |outline: &Outline| {
            samples(outline).any(|place| place[axis] <= low || place[axis] >= high)
        };
        if is_periodic && outlines.iter().any(is_across) {
            return None;
        }
        for outline in outlines {
            let image = outlines.iter().position(|other| mirror.takes(outline, other, near))?;
            let is_own = std::ptr::eq(outline, &outlines[image]);
            mirror.roles.push(mirror.role(outline, is_own, near)?);
            mirror.image_of.push(BoundaryId::new(n_sides + image));
        }
        Some(mirror)
    }

    /// Whether bodies that are images of each other ask for the same cells.
    pub fn keeps_sizes_of(&self, bodies: &[PlacedShape]) -> bool {
        let n_sides = self.image_of.len() - bodies.len();
        let images = self.image_of[n_sides..].iter().map(|image| image.index() - n_sides);
        bodies.iter().zip(images).all(|(body, image)| body.size == bodies[image].size)
    }

    fn reflect(&self, mut place: Point<2>) -> Point<2> {
        place[self.axis] = 2.0 * self.at - place[self.axis];
        place
    }

    /// Whether the sizes asked for are their own mirror image.
    fn keeps_sizing(&self, domain: &Domain, sizing: &Sizing, near: f64) -> bool {
        let sides = domain.sides();
        let size_of = |side: usize| {
            let sizes = sizing.sides.iter().filter(|(name, _)| name == sides[side]);
            sizes.map(|(_, size)| *size).fold(f64::INFINITY, f64::min)
        };
        let sides_agree =
            (0..sides.len()).all(|side| size_of(side) == size_of(self.image_of[side].index()));
        sides_agree
            && sizing.boxes.iter().all(|one| {
                let (mut min, mut max) = (self.reflect(one.min), self.reflect(one.max));
                std::mem::swap(&mut min[self.axis], &mut max[self.axis]);
                sizing.boxes.iter().any(|other| {
                    other.size == one.size
                        && (other.min - min).amax() <= near
                        && (other.max - max).amax() <= near
                })
            })
    }

    /// Whether the mirror image of one outline is the other.
    fn takes(&self, one: &Outline, other: &Outline, near: f64) -> bool {
        samples(one).all(|place| other.nearest(self.reflect(place)).gap.abs() <= near)
            && samples(other).all(|place| one.nearest(self.reflect(place)).gap.abs() <= near)
    }

    /// The role of a body; `None` when it meets the line elsewhere than at ends of its quarters.
    fn role(&self, outline: &Outline, is_own: bool, near: f64) -> Option<Role> {
        let beyond = |place: Point<2>| place[self.axis] - self.at;
        if is_own {
            let pole = |quarter: usize| outline.evaluate(quarter, 0.0)[0];
            let on_line = |quarter: &usize| beyond(pole(*quarter)).abs() <= near;
            // Along y = const the line is travelled to larger x, along x = const to smaller y
            let along = |quarter: usize| {
                if self.axis == 1 { pole(quarter).x } else { -pole(quarter).y }
            };
            let n = outline.n_pieces();
            let poles: Vec<usize> = (0..n).filter(on_line).collect();
            let &[one, other] = poles.as_slice() else { return None };
            let [entry, exit] = if along(other) < along(one) { [other, one] } else { [one, other] };
            // Between its poles the travelled half lies beyond the line
            let stays = travelled(entry, exit, n).into_iter().all(|piece| {
                let first = usize::from(on_line(&piece));
                (first..SAMPLES)
                    .all(|i| beyond(outline.evaluate(piece, i as f64 / SAMPLES as f64)[0]) > near)
            });
            return stays.then_some(Role::OnLine { entry, exit });
        }
        if samples(outline).all(|place| beyond(place) > near) {
            Some(Role::Kept)
        } else if samples(outline).all(|place| beyond(place) < -near) {
            Some(Role::Image)
        } else {
            None
        }
    }

    /// Loops around the half that is meshed, the line of symmetry as the last boundary.
    pub fn half(&self, domain: &Domain, border: &BoundaryLoops) -> BoundaryLoops {
        let n_sides = domain.sides().len();
        let mut pieces: Vec<BoundaryPiece> = Vec::new();
        let [start, end] = match domain {
            Domain::Box { min, max, .. } => self.half_box(&mut pieces, domain, *min, *max),
            _ => {
                let outline = border.outlines.len() - 1;
                let first = if self.axis == 1 { 0 } else { 3 };
                for quarter in [first, (first + 1) % 4] {
                    pieces.push(quarter_of(outline, quarter, false, 0));
                }
                let pole = |quarter: usize| border.outlines[outline].evaluate(quarter, 0.0)[0];
                [pole((first + 2) % 4), pole(first)]
            }
        };
        let torus = border.torus.along(1 - self.axis);
        let mut loops = vec![0];
        if torus.is_closed() {
            // The side beyond and the line are left, each a loop by itself
            pieces.retain(|piece| piece.boundary.index() == 2 * self.axis + 1);
            loops.push(pieces.len());
        }
        let ends = [start, end];
        self.along_line(&mut pieces, &border.outlines, n_sides, ends, torus.is_closed());
        for (body, role) in self.roles.iter().enumerate() {
            if *role == Role::Kept {
                loops.push(pieces.len());
                for quarter in (0..border.outlines[body].n_pieces()).rev() {
                    pieces.push(quarter_of(body, quarter, true, n_sides + body));
                }
            }
        }
        let mut boundaries = border.boundaries.clone();
        boundaries.push(Boundary { name: String::new(), kind: BoundaryKind::Side });
        BoundaryLoops { pieces, loops, boundaries, torus, ..border.clone() }
    }

    /// The sides of a box beyond the line; where the line starts and ends.
    fn half_box(
        &self,
        pieces: &mut Vec<BoundaryPiece>,
        domain: &Domain,
        min: Point<2>,
        max: Point<2>,
    ) -> [Point<2>; 2] {
        let at = |x: f64, y: f64| Point::<2>::new(x, y);
        let copy_of_first = |shift| CopyOf { original: 0, shift };
        if self.axis == 1 {
            // Left comes first, for right to copy it
            let copy = domain.is_periodic(0).then_some(at(max.x - min.x, 0.0));
            let [start, end] = [at(min.x, self.at), at(max.x, self.at)];
            pieces.push(segment(at(min.x, max.y), start, 0, None));
            // The line and what it enters are put between the two sides, the top comes last
            pieces.push(segment(end, max, 1, copy.map(copy_of_first)));
            pieces.push(segment(max, at(min.x, max.y), 3, None));
            [start, end]
        } else {
            let copy = domain.is_periodic(2).then_some(at(0.0, max.y - min.y));
            let [start, end] = [at(self.at, max.y), at(self.at, min.y)];
            pieces.push(segment(end, at(max.x, min.y), 2, None));
            pieces.push(segment(at(max.x, min.y), max, 1, None));
            pieces.push(segment(max, start, 3, copy.map(copy_of_first)));
            [start, end]
        }
    }

    /// The line of symmetry, interrupted by the halves of the bodies on it; one that closes on itself begins
    /// where the first of them does.
    fn along_line(
        &self,
        pieces: &mut Vec<BoundaryPiece>,
        outlines: &[Outline],
        n_sides: usize,
        [start, end]: [Point<2>; 2],
        closes: bool,
    ) {
        let line = self.image_of.len();
        let on_line = |mut place: Point<2>| {
            place[self.axis] = self.at;
            place
        };
        let pole = |body: usize, quarter: usize| on_line(outlines[body].evaluate(quarter, 0.0)[0]);
        let mut bodies: Vec<(f64, usize, [usize; 2])> = Vec::new();
        for (body, role) in self.roles.iter().enumerate() {
            if let Role::OnLine { entry, exit } = role {
                let along = (pole(body, *entry) - start).dot(&(end - start));
                bodies.push((along, body, [*entry, *exit]));
            }
        }
        bodies.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut made = Vec::new();
        let (mut from, mut to) = (on_line(start), on_line(end));
        if let (true, Some(&(_, body, [entry, _]))) = (closes, bodies.first()) {
            to += pole(body, entry) - from;
            from = pole(body, entry);
        }
        for (_, body, [entry, exit]) in bodies {
            if from != pole(body, entry) {
                made.push(segment(from, pole(body, entry), line, None));
            }
            let boundary = n_sides + body;
            for piece in travelled(entry, exit, outlines[body].n_pieces()) {
                made.push(quarter_of(body, piece, true, boundary));
            }
            from = pole(body, exit);
        }
        made.push(segment(from, to, line, None));
        // Behind the side at whose end the line starts: the first of a box cut along y = const,
        // else the last
        let first_end = match &pieces[0].curve {
            Curve::Segment(_, end) => Some(*end),
            Curve::Quarter { .. } => None,
        };
        let place = if first_end == Some(start) { 1 } else { pieces.len() };
        pieces.splice(place..place, made);
    }

    /// The whole mesh from that of the half.
    pub fn whole(&self, mut half: Mesh<2>) -> Mesh<2> {
        let line = half.boundaries.len() - 1;
        let mut is_on_line = vec![false; half.n_nodes()];
        let mut is_far = vec![false; half.n_nodes()];
        for facet in &half.facets {
            let boundary = facet.boundary.index();
            for node in half.facet_nodes(facet) {
                is_on_line[node] |= boundary == line;
                // The side that faces its own image
                is_far[node] |= boundary == 2 * self.axis + 1;
            }
        }
        for (node, _) in half.nodes.iter_mut().zip(&is_on_line).filter(|(_, on_line)| **on_line) {
            node[self.axis] = self.at;
        }
        let Numbering { kept, image, n_nodes } = number(&half, &is_on_line);
        let on_line = is_on_line[..half.n_vertices].iter().filter(|on_line| **on_line).count();
        let mut whole = Topology {
            n_vertices: 2 * half.n_vertices - on_line,
            cells: Vec::with_capacity(2 * half.cells.len()),
            curved: [half.curved.as_slice(), &half.curved].concat(),
            facets: Vec::new(),
            boundaries: half.boundaries[..line].to_vec(),
            periodic: Vec::new(),
        };
        let mut nodes = vec![Point::<2>::zeros(); n_nodes];
        for (node, place) in half.nodes.iter().enumerate() {
            nodes[image[node]] = self.reflect(*place);
            nodes[kept[node]] = *place;
        }
        whole.cells.extend(half.cells.iter().map(|node| kept[*node]));
        for cell in half.cells() {
            // Turned round: the sides are those from 0 to 2, 2 to 1, 1 to 0
            whole.cells.extend([0, 2, 1, 5, 4, 3].map(|i| image[cell[i]]));
        }
        for facet in half.facets.iter().filter(|facet| facet.boundary.index() != line) {
            whole.facets.push(*facet);
            whole.facets.push(Facet {
                cell: CellId::new(facet.cell.index() + half.n_cells()),
                side: 2 - facet.side,
                boundary: self.image_of[facet.boundary],
            });
        }
        let pair = |copy: NodeId, original: NodeId| PeriodicPair { copy, original };
        let pairs = half.periodic.iter();
        let mut periodic: Vec<PeriodicPair> = pairs
            .flat_map(|&PeriodicPair { copy, original: of }| {
                [pair(kept[copy], kept[of]), pair(image[copy], image[of])]
            })
            .collect();
        if self.is_periodic {
            let far = half.node_ids().filter(|node| is_far[*node]);
            periodic.extend(far.map(|node| pair(kept[node], image[node])));
        }
        whole.periodic = resolve(periodic);
        Mesh::new(nodes, whole)
    }
}

/// Numbers of nodes in the whole mesh.
struct Numbering {
    /// Of the nodes of the half.
    kept: Vec<NodeId>,
    /// Of their images.
    image: Vec<NodeId>,
    /// How many there are.
    n_nodes: usize,
}

/// Numbers the nodes of the whole mesh, vertices first.
fn number(half: &Mesh<2>, is_on_line: &[bool]) -> Numbering {
    let (mut kept, mut image) =
        (vec![NodeId::default(); half.n_nodes()], vec![NodeId::default(); half.n_nodes()]);
    let mut next = 0;
    for range in [0..half.n_vertices, half.n_vertices..half.n_nodes()] {
        for node in range.clone() {
            (kept[node], image[node]) = (NodeId::new(next), NodeId::new(next));
            next += 1;
        }
        for node in range.filter(|node| !is_on_line[*node]) {
            image[node] = NodeId::new(next);
            next += 1;
        }
    }
    Numbering { kept, image, n_nodes: next }
}

/// The pieces of an outline, of so many, from the start of one of them back to that of another one.
fn travelled(entry: usize, exit: usize, n: usize) -> Vec<usize> {
    let count = (entry + n - exit) % n;
    (1..=count).map(|back| (entry + n - back) % n).collect()
}

/// Places around an outline, the ends of its pieces among them.
fn samples(outline: &Outline) -> impl Iterator<Item = Point<2>> + '_ {
    let n = (4 * SAMPLES / outline.n_pieces()).max(2);
    (0..outline.n_pieces() * n).map(move |i| outline.evaluate(i / n, (i % n) as f64 / n as f64)[0])
}

/// Pairs with chains followed to their ends, each copy once, sorted.
fn resolve(pairs: Vec<PeriodicPair>) -> Vec<PeriodicPair> {
    let mut original: HashMap<NodeId, NodeId> = HashMap::new();
    for PeriodicPair { copy, original: of } in pairs {
        if copy != of {
            original.entry(copy).or_insert(of);
        }
    }
    let root = |mut node: NodeId| {
        while let Some(next) = original.get(&node) {
            node = *next;
        }
        node
    };
    let pairs = original.keys().map(|&copy| PeriodicPair { copy, original: root(copy) });
    let mut resolved: Vec<_> = pairs.collect();
    resolved.sort_unstable();
    resolved
}
