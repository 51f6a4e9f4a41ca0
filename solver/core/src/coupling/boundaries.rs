//! `Boundaries`: nodes and facets of each boundary of a mesh, and the boundaries each node lies on.

use alewife_mesh::{BoundaryId, BoundaryKind, FacetId, Mesh, NodeId, PeriodicPair};

/// Nodes and facets of the boundaries of a mesh.
#[derive(Debug, Clone)]
pub struct Boundaries {
    /// Nodes on boundaries with a boundary each lies on, sorted, each pair once.
    pairs: Vec<(NodeId, BoundaryId)>,
    /// Nodes of each boundary, ascending.
    nodes: Vec<Vec<NodeId>>,
    /// Facets of each boundary, ascending.
    facets: Vec<Vec<FacetId>>,
    /// The body each boundary is the surface of.
    bodies: Vec<Option<usize>>,
    /// Periodic copies of nodes on bodies, which are on none themselves.
    body_copies: Vec<PeriodicPair>,
}

/// A node on a boundary.
#[derive(Debug, Clone)]
pub struct BoundaryNode {
    /// The node.
    pub node: NodeId,
    /// The boundaries it lies on, ascending.
    pub boundaries: Vec<BoundaryId>,
    /// The body it lies on, the first one where there are several.
    pub body: Option<usize>,
}

impl Boundaries {
    /// Collects the boundary facets of a mesh with their nodes.
    #[must_use]
    pub fn new<const D: usize>(mesh: &Mesh<D>) -> Self {
        let mut pairs: Vec<(NodeId, BoundaryId)> = mesh
            .facets
            .iter()
            .flat_map(|facet| mesh.facet_nodes(facet).map(|node| (node, facet.boundary)))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut nodes = vec![Vec::new(); mesh.boundaries.len()];
        for &(node, boundary) in &pairs {
            nodes[boundary].push(node);
        }
        let mut facets = vec![Vec::new(); mesh.boundaries.len()];
        for facet in mesh.facet_ids() {
            facets[mesh.facets[facet].boundary].push(facet);
        }
        let bodies = mesh.boundaries.iter().map(|boundary| match boundary.kind {
            BoundaryKind::Body(body) => Some(body),
            BoundaryKind::Side | BoundaryKind::Axis => None,
        });
        let bodies: Vec<Option<usize>> = bodies.collect();
        let mut is_on_body = vec![false; mesh.n_nodes()];
        for (node, _) in pairs.iter().filter(|(_, boundary)| bodies[*boundary].is_some()) {
            is_on_body[*node] = true;
        }
        let is_copy = |pair: &PeriodicPair| is_on_body[pair.original] && !is_on_body[pair.copy];
        let body_copies = mesh.periodic.iter().copied().filter(is_copy).collect();
        Self { pairs, nodes, facets, bodies, body_copies }
    }

    /// Nodes with the boundaries they lie on, ascending.
    pub fn nodes(&self) -> impl Iterator<Item = BoundaryNode> + '_ {
        self.pairs.chunk_by(|one, other| one.0 == other.0).map(|pairs| {
            let boundaries: Vec<BoundaryId> = pairs.iter().map(|(_, boundary)| *boundary).collect();
            let body = boundaries.iter().find_map(|&boundary| self.bodies[boundary]);
            BoundaryNode { node: pairs[0].0, boundaries, body }
        })
    }

    /// Periodic copies of nodes on bodies, which are on none themselves: cells that a body meets with an edge or
    /// a corner only may be shown periods away from it.
    #[must_use]
    pub fn body_copies(&self) -> &[PeriodicPair] {
        &self.body_copies
    }

    /// Nodes on one boundary, ascending.
    #[must_use]
    pub fn nodes_on(&self, boundary: BoundaryId) -> &[NodeId] {
        &self.nodes[boundary]
    }

    /// Facets of one boundary, ascending.
    #[must_use]
    pub fn facets_on(&self, boundary: BoundaryId) -> &[FacetId] {
        &self.facets[boundary]
    }
}
