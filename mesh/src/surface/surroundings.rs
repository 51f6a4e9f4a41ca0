//! `Surroundings`: sides of a domain and surfaces of bodies, and which of them faces a point.

use std::sync::OnceLock;

use super::SurfaceTree;
use crate::{BoundaryKind, Facing, FacingSurfaces, Point, Surface};

/// The sides of a domain, as bodies face them.
pub trait Sides<const D: usize> {
    /// Number of sides.
    fn n_sides(&self) -> usize;

    /// Whether a side is one that bodies face, as a wall.
    fn is_faced(&self, side: usize) -> bool;

    /// Signed distance from a point (m) to a side (m), positive in the fluid, where it is below a bound.
    fn gap_to_side(&self, side: usize, point: Point<D>, bound: f64) -> Option<f64>;
}

/// Sides and bodies that face each other across the fluid.
#[derive(Debug)]
pub struct Surroundings<const D: usize, R, S> {
    domain: R,
    bodies: Vec<S>,
    /// Vectors by which the domain repeats (m), zero first.
    images: Vec<Point<D>>,
    /// Where the bodies are, found out when first asked for.
    tree: OnceLock<SurfaceTree<D>>,
}

impl<const D: usize, R: Sides<D>, S: Surface<D>> Surroundings<D, R, S> {
    /// The sides of a domain and surfaces of bodies, which may overlap; `images` are the vectors by which
    /// the domain repeats (m), zero first.
    #[must_use]
    pub fn of(domain: R, bodies: Vec<S>, images: Vec<Point<D>>) -> Self {
        Self { domain, bodies, images, tree: OnceLock::new() }
    }

    /// The surface of a body.
    #[must_use]
    pub fn body(&self, body: usize) -> Option<&S> {
        self.bodies.get(body)
    }

    /// Gives a body, by its index, another surface.
    pub fn set_body(&mut self, body: usize, surface: S) {
        if let Some(known) = self.bodies.get_mut(body) {
            *known = surface;
        }
        self.tree.take();
    }
}

impl<const D: usize, R: Sides<D>, S: Surface<D>> FacingSurfaces<D> for Surroundings<D, R, S> {
    /// Bodies face sides of the domain, each other and all their periodic images; sides face bodies.
    fn facing(
        &self,
        boundary: usize,
        kind: BoundaryKind,
        point: Point<D>,
        reach: f64,
    ) -> Option<Facing> {
        let n_sides = self.domain.n_sides();
        let but = match kind {
            BoundaryKind::Body(body) => Some(body),
            BoundaryKind::Side if self.domain.is_faced(boundary) => None,
            BoundaryKind::Side | BoundaryKind::Axis => return None,
        };
        let tree = self.tree.get_or_init(|| SurfaceTree::new(&self.bodies));
        let body = tree
            .nearest(&self.bodies, &self.images, point, but, reach)
            .map(|near| Facing { boundary: n_sides + near.surface, gap: near.gap });
        let sides = (0..n_sides)
            .filter(|&side| but.is_some() && self.domain.is_faced(side))
            .filter_map(|side| {
                let gap = self.domain.gap_to_side(side, point, reach)?;
                Some(Facing { boundary: side, gap })
            });
        body.into_iter().chain(sides).min_by(|a, b| a.gap.total_cmp(&b.gap))
    }
}
