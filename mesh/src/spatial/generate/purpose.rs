//! `Purpose`: what a mesh is for, and what is asked of cells at the boundary for it.

/// What a mesh is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A flow: velocities are given on the boundary, and no equation has the pressure of a cell all of whose
    /// nodes are there.
    Flow,
    /// An elastic solid: cells are as good at the boundary as elsewhere.
    Solid,
}

/// What is asked of the cells at the boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Asked {
    /// Whether each cell has a node that is on no boundary.
    pub free_nodes: bool,
    /// Whether edges on curved surfaces are bent.
    pub bent_edges: bool,
    /// Whether cells are shaped with their bent edges, all of which stay; else by straight ones, and those
    /// that would fold a cell stay straight.
    pub bent_shapes: bool,
}

impl Purpose {
    /// What this asks of cells whose edges on curved surfaces are bent, or stay straight.
    pub(super) fn asks(self, bent_edges: bool) -> Asked {
        match self {
            Self::Flow => Asked { free_nodes: true, bent_edges: true, bent_shapes: true },
            // Surfaces of triangles turn within the length of a cell: bent shapes took ten times as long there,
            // and left flat cells
            Self::Solid => Asked { free_nodes: false, bent_edges, bent_shapes: false },
        }
    }
}
