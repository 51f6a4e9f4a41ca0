//! `Ties`: which nodes move with which rigid part, and the unknowns of the parts.

use std::collections::BTreeSet;

use alewife_mesh::Point;

use crate::solid::SolidError;
use crate::solid::mesh::{Frame, SolidMesh};

/// Nodes of no part.
const FREE: usize = usize::MAX;

/// Rigid parts. Unknowns of a part are the way of its middle and, but around an axis, the angles by which it turns
/// there times its size: they come first of all unknowns, part after part.
#[derive(Debug, Clone, Default)]
pub(in crate::solid) struct Ties {
    /// Nodes of each part, ascending.
    pub parts: Vec<Vec<usize>>,
    /// The part of each node; empty where there are none.
    part_of: Vec<usize>,
    /// Root mean square of the distances (m) from the middle of each part.
    pub sizes: Vec<f64>,
    /// Whether each cell has nodes of a part and is in none itself; empty where there are no parts.
    is_beside: Vec<bool>,
    /// Unknowns of a part.
    pub n_each: usize,
}

impl Ties {
    /// Those of cells that make up parts.
    pub(in crate::solid) fn new<const D: usize>(
        parts: &[Vec<usize>],
        mesh: &SolidMesh<D>,
        frame: Frame,
    ) -> Result<Self, SolidError> {
        if parts.is_empty() {
            return Ok(Self::default());
        }
        let n_local = mesh.n_local();
        let nodes_of = |cell: usize| &mesh.cells[cell * n_local..(cell + 1) * n_local];
        let n_each = if frame == Frame::Axis { 1 } else { D * (D + 1) / 2 };
        let mut ties = Self { part_of: vec![FREE; mesh.nodes.len()], n_each, ..Self::default() };
        let mut is_rigid = vec![false; mesh.n_cells()];
        for (part, cells) in parts.iter().enumerate() {
            let wrong = cells.iter().find(|cell| **cell >= is_rigid.len());
            if let Some(number) = wrong {
                return Err(SolidError::Missing {
                    what: "cell",
                    number: *number,
                    count: is_rigid.len(),
                });
            }
            cells.iter().for_each(|cell| is_rigid[*cell] = true);
            let nodes: BTreeSet<usize> =
                cells.iter().flat_map(|cell| nodes_of(*cell).iter().copied()).collect();
            for node in &nodes {
                if ties.part_of[*node] != FREE {
                    return Err(SolidError::RigidTouch([ties.part_of[*node], part]));
                }
                ties.part_of[*node] = part;
            }
            let nodes: Vec<usize> = nodes.into_iter().collect();
            let middle = nodes.iter().map(|node| mesh.nodes[*node]).sum::<Point<D>>();
            let middle = middle / nodes.len() as f64;
            let squares = nodes.iter().map(|node| (mesh.nodes[*node] - middle).norm_squared());
            let size = (squares.sum::<f64>() / nodes.len() as f64).sqrt();
            if !(size > 0.0 && size.is_finite()) {
                return Err(SolidError::RigidEmpty(part));
            }
            ties.sizes.push(size);
            ties.parts.push(nodes);
        }
        ties.is_beside = (0..mesh.n_cells())
            .map(|cell| !is_rigid[cell] && nodes_of(cell).iter().any(|node| ties.has(*node)))
            .collect();
        Ok(ties)
    }

    /// Whether there are none.
    pub(in crate::solid) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The part of a node.
    pub(in crate::solid) fn part_of(&self, node: usize) -> Option<usize> {
        self.part_of.get(node).copied().filter(|part| *part != FREE)
    }

    /// Whether a node moves with a part.
    pub(in crate::solid) fn has(&self, node: usize) -> bool {
        self.part_of(node).is_some()
    }

    /// Whether a cell has nodes of a part and is in none itself.
    pub(in crate::solid) fn is_beside(&self, cell: usize) -> bool {
        self.is_beside.get(cell) == Some(&true)
    }

    /// Number of unknowns of all parts.
    pub(in crate::solid) fn n_unknowns(&self) -> usize {
        self.parts.len() * self.n_each
    }

    /// The unknowns of a part.
    pub(in crate::solid) fn unknowns(&self, part: usize) -> std::ops::Range<usize> {
        part * self.n_each..(part + 1) * self.n_each
    }
}
