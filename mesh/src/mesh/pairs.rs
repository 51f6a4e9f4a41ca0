//! Sides of a mesh that are the same but for a translation: their nodes in pairs.

use std::collections::{BTreeMap, BTreeSet};

use super::{BoundaryId, Mesh, NodeId, PeriodicPair, Point};
use crate::Bounds;

/// Largest distance of a node from where its partner has it, over the size of the mesh.
const APART: f64 = 1e-6;

/// Two sides, the second of which takes its values from the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SidePair {
    /// The side whose unknowns stay.
    pub original: BoundaryId,
    /// The other one.
    pub copy: BoundaryId,
}

/// Why two sides are no periodic pair.
#[derive(Debug, Clone, PartialEq)]
pub enum Unpaired {
    /// They lie apart across the axes.
    Oblique {
        /// From the middle of the first to that of the second (m).
        apart: Vec<f64>,
    },
    /// A node has no partner.
    Node {
        /// Where it is (m).
        at: Vec<f64>,
        /// Where its partner should be (m).
        wanted: Vec<f64>,
        /// The side it is on.
        side: BoundaryId,
        /// How far a partner may be from there (m).
        tolerance: f64,
    },
}

/// A mesh whose sides are periodic pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedMesh<const D: usize> {
    /// The mesh with pairs of nodes.
    pub mesh: Mesh<D>,
    /// From each original to its copy (m).
    pub translations: Vec<Point<D>>,
}

/// Coordinates in brackets (m).
#[must_use]
pub fn coordinates_of(place: &[f64]) -> String {
    let all: Vec<String> = place.iter().map(|x| format!("{x:.6}")).collect();
    format!("({})", all.join(", "))
}

impl Mesh<2> {
    /// The same mesh with nodes of sides in pairs, which are translated along an axis.
    ///
    /// # Errors
    /// When sides are not the same but for that, with the first node without a partner.
    pub fn paired(&self, sides: &[SidePair]) -> Result<PairedMesh<2>, Unpaired> {
        self.with_pairs(sides)
    }
}

impl Mesh<3> {
    /// The same in space.
    ///
    /// # Errors
    /// As in the plane.
    pub fn paired(&self, sides: &[SidePair]) -> Result<PairedMesh<3>, Unpaired> {
        self.with_pairs(sides)
    }
}

impl<const D: usize> Mesh<D> {
    /// Compiled in this crate, and not where cases are read, without optimisation.
    fn with_pairs(&self, sides: &[SidePair]) -> Result<PairedMesh<D>, Unpaired> {
        let Bounds { min, max } = Bounds::around(&self.nodes);
        let tolerance = APART * (max - min).norm();
        let mut translations = Vec::with_capacity(sides.len());
        let mut groups = Groups::default();
        for pair in sides {
            let [originals, copies] = [pair.original, pair.copy].map(|side| self.nodes_of(side));
            let [from, to] = [&originals, &copies].map(|nodes| {
                let bounds = Bounds::around(nodes.iter().map(|node| &self.nodes[*node]));
                (bounds.min + bounds.max) * 0.5
            });
            let apart = to - from;
            let across = apart.iter().filter(|x| x.abs() > tolerance).count();
            if across != 1 {
                return Err(Unpaired::Oblique { apart: apart.as_slice().to_vec() });
            }
            let axis = apart.iamax();
            let along = apart[axis];
            let translation = Point::<D>::from_fn(|row, _| if row == axis { along } else { 0.0 });
            let found = self.matched(&copies, &originals, -translation, tolerance);
            let partners =
                found.map_err(|node| self.lone(node, pair.copy, -translation, tolerance))?;
            let back = self.matched(&originals, &copies, translation, tolerance);
            back.map_err(|node| self.lone(node, pair.original, translation, tolerance))?;
            partners.iter().for_each(|[copy, original]| groups.join(*copy, *original));
            translations.push(translation);
        }
        let mut mesh = self.clone();
        mesh.topology_mut().periodic = groups.pairs();
        Ok(PairedMesh { mesh, translations })
    }

    fn nodes_of(&self, side: BoundaryId) -> BTreeSet<NodeId> {
        let own = self.facets.iter().filter(|facet| facet.boundary == side);
        own.flat_map(|facet| self.facet_nodes(facet)).collect()
    }

    /// For each node the one that it meets when it is moved (m), or the first node that meets none; vertices meet
    /// vertices.
    fn matched(
        &self,
        nodes: &BTreeSet<NodeId>,
        others: &BTreeSet<NodeId>,
        by: Point<D>,
        tolerance: f64,
    ) -> Result<Vec<[NodeId; 2]>, NodeId> {
        // Cells of a grid twice as large as what is searched: neighbours are in the next one at most
        let cell = |point: &Point<D>, step: [i64; D]| -> [i64; D] {
            #[expect(clippy::cast_possible_truncation, reason = "a million cells across a mesh")]
            std::array::from_fn(|axis| {
                (point[axis] / (2.0 * tolerance)).floor() as i64 + step[axis]
            })
        };
        let mut grid: BTreeMap<[i64; D], Vec<NodeId>> = BTreeMap::new();
        for &other in others {
            grid.entry(cell(&self.nodes[other], [0; D])).or_default().push(other);
        }
        let steps = (0..3_usize.pow(u32::try_from(D).unwrap_or(0))).map(|nth| {
            let mut rest = nth;
            std::array::from_fn::<i64, D, _>(|_| {
                let step = [0, 1, -1][rest % 3];
                rest /= 3;
                step
            })
        });
        let steps: Vec<[i64; D]> = steps.collect();
        let partner = |node: NodeId| {
            let place = self.nodes[node] + by;
            let near = steps.iter().filter_map(|step| grid.get(&cell(&place, *step))).flatten();
            near.copied().find(|other| {
                let is_vertex = |node: NodeId| node.index() < self.n_vertices;
                is_vertex(node) == is_vertex(*other)
                    && (self.nodes[*other] - place).norm() <= tolerance
            })
        };
        nodes.iter().map(|&node| Ok([node, partner(node).ok_or(node)?])).collect()
    }

    fn lone(&self, node: NodeId, side: BoundaryId, by: Point<D>, tolerance: f64) -> Unpaired {
        let at = self.nodes[node];
        Unpaired::Node {
            at: at.as_slice().to_vec(),
            wanted: (at + by).as_slice().to_vec(),
            side,
            tolerance,
        }
    }
}

/// Nodes that are the same, by the smallest of them.
#[derive(Debug, Default)]
struct Groups(BTreeMap<NodeId, NodeId>);

impl Groups {
    fn first(&self, node: NodeId) -> NodeId {
        let mut at = node;
        while let Some(&next) = self.0.get(&at) {
            at = next;
        }
        at
    }

    fn join(&mut self, one: NodeId, other: NodeId) {
        let [one, other] = [one, other].map(|node| self.first(node));
        if one != other {
            self.0.insert(one.max(other), one.min(other));
        }
    }

    fn pairs(&self) -> Vec<PeriodicPair> {
        let pair = |&copy: &NodeId| PeriodicPair { copy, original: self.first(copy) };
        self.0.keys().map(pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Sizing, generate};

    fn square(periodic: bool) -> Mesh<2> {
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(2.0, 1.0));
        let domain = Domain::Box { min, max, periodic_x: periodic, periodic_y: periodic };
        generate(&domain, &[], &Sizing::graded(0.3, 0.4, 0.3)).expect("it is meshed")
    }

    /// As many nodes are the same as in a mesh that is made periodic, corners included.
    #[test]
    fn sides_of_a_periodic_mesh_are_found_again() {
        let made = square(true);
        let mut plain = made.clone();
        plain.topology_mut().periodic.clear();
        let side = |name: &str| {
            let place = plain.boundaries.iter().position(|side| side.name == name);
            BoundaryId::new(place.expect("there is one"))
        };
        let pairs = [
            SidePair { original: side("left"), copy: side("right") },
            SidePair { original: side("bottom"), copy: side("top") },
        ];
        let found = plain.paired(&pairs).expect("they fit");
        let along = [Point::<2>::new(2.0, 0.0), Point::<2>::new(0.0, 1.0)];
        assert_eq!(found.translations, along);
        let groups = |mesh: &Mesh<2>| {
            let mut all: BTreeMap<NodeId, BTreeSet<NodeId>> = BTreeMap::new();
            for pair in &mesh.periodic {
                all.entry(pair.original).or_default().extend([pair.copy, pair.original]);
            }
            all.into_values().collect::<BTreeSet<_>>()
        };
        assert_eq!(groups(&found.mesh), groups(&made));
        let originals: BTreeSet<NodeId> =
            found.mesh.periodic.iter().map(|pair| pair.original).collect();
        assert!(found.mesh.periodic.iter().all(|pair| !originals.contains(&pair.copy)));
    }

    #[test]
    fn a_node_without_partner_is_told_with_its_place() {
        let mut mesh = square(true);
        let side = |name: &str| {
            BoundaryId::new(mesh.boundaries.iter().position(|side| side.name == name).expect("one"))
        };
        let [left, right, top] = ["left", "right", "top"].map(side);
        let moved = mesh.nodes_of(right).into_iter().find(|node| {
            let at = mesh.nodes[*node];
            at.y > 0.2 && at.y < 0.8
        });
        let moved = moved.expect("there are some between");
        mesh.nodes[moved].y += 1e-3;
        let error = mesh.paired(&[SidePair { original: left, copy: right }]).unwrap_err();
        let Unpaired::Node { at, side, .. } = error else { panic!("{error:?}") };
        assert_eq!((at.as_slice(), side), (mesh.nodes[moved].as_slice(), right));
        let error = mesh.paired(&[SidePair { original: left, copy: top }]).unwrap_err();
        assert!(matches!(error, Unpaired::Oblique { .. }), "{error:?}");
    }
}
