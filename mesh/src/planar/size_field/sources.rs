//! Wanted sizes on the boundary: own size, gap to what faces it, curvature, corners.
//!
//! The gap is Lipschitz with constant one, so samples closer than half of the size they find
//! cannot miss a narrow place between them.

use super::tree::SizeSource;
use crate::planar::boundary::{BoundaryLoops, Curve, Frame};
use crate::planar::outline::stokes_exponent;
use crate::surface::SurfaceTree;
use crate::{BoundaryKind, Domain, MeshError, PlacedShape, Point, Sizing};

/// Largest number of samples on the boundary.
const MOST_SAMPLES: usize = 1_000_000;

/// Two parts of one curve face each other when their normals enclose a cosine below this.
const FACING: f64 = -0.5;

/// Smallest part of the size of its sides that a corner has.
const SMALLEST_AT_CORNER: f64 = 1.0 / 64.0;

/// Places per outline, over four, of a spline or polygon that are compared with each other to find facing parts.
const FACING_SAMPLES: usize = 96;

/// Places on the boundary, close enough to each other, with the size wanted there (m).
///
/// # Errors
/// [`MeshError::TooManyCells`] when a gap is so small that a million places are needed.
pub fn surface_sizes(
    domain: &Domain,
    bodies: &[PlacedShape],
    sizing: &Sizing,
    border: &BoundaryLoops,
) -> Result<Vec<SizeSource>, MeshError> {
    let surfaces = Surfaces::new(domain, bodies, sizing, border);
    let images = &border.images;
    let mut sources = Vec::new();
    for (index, piece) in border.pieces.iter().enumerate() {
        if border.boundaries[piece.boundary].kind == BoundaryKind::Axis {
            continue;
        }
        let mut samples = Vec::new();
        let first = surfaces.sample(index, 0.0);
        samples.push(first);
        // Depth-first from the left; the right ends still to be reached wait on the stack
        let mut ends: Vec<(f64, u32)> = vec![(1.0, 0)];
        let mut from = (0.0, first);
        while let Some((to, depth)) = ends.pop() {
            let next = surfaces.sample(index, to);
            let length = (next.point - from.1.point).norm();
            if depth < surfaces.halvings(index) || length > 0.5 * next.size.min(from.1.size) {
                ends.push((to, depth + 1));
                ends.push((0.5 * (from.0 + to), depth + 1));
                if samples.len() + sources.len() > MOST_SAMPLES || depth > 60 {
                    return Err(MeshError::TooManyCells {
                        what: "places on the boundary",
                        limit: MOST_SAMPLES,
                        smallest: next.size.min(from.1.size),
                    });
                }
                continue;
            }
            samples.push(next);
            from = (to, next);
        }
        for shift in images {
            let moved = |s: &SizeSource| SizeSource { point: s.point + shift, ..*s };
            sources.extend(samples.iter().map(moved));
        }
    }
    sources.retain(|source| source.size < sizing.size);
    Ok(sources)
}

/// Gap over the size at its surfaces that gives a number of layers across it.
///
/// The size grows towards the middle, so the layers are ∫ ds / h = 2/g ln(1 + g gap / 2h), which is
/// solved for gap / h.
fn layers_at_surface(layers: f64, growth: f64) -> f64 {
    if growth > 0.0 { 2.0 / growth * (0.5 * growth * layers).exp_m1() } else { layers }
}

/// All surfaces, to ask for the distance from one to the others.
struct Surfaces<'a> {
    domain: &'a Domain,
    border: &'a BoundaryLoops,
    n_bodies: usize,
    /// Gap over the size at its surfaces.
    layers: f64,
    /// Own size of every boundary (m).
    own: Vec<f64>,
    /// Largest angle an edge turns by (rad).
    turn: f64,
    images: &'a [Point<2>],
    /// Where the bodies are.
    tree: SurfaceTree<2>,
    /// Places and normals of the bodies that may face themselves, empty for the convex ones.
    facing: Vec<Vec<(Point<2>, Point<2>)>>,
}

impl<'a> Surfaces<'a> {
    fn new(
        domain: &'a Domain,
        bodies: &[PlacedShape],
        sizing: &Sizing,
        border: &'a BoundaryLoops,
    ) -> Self {
        let side_size = |name: &str| {
            let sizes = sizing.sides.iter().filter(|(side, _)| side == name);
            sizes.map(|(_, size)| *size).fold(f64::INFINITY, f64::min)
        };
        let own = border
            .boundaries
            .iter()
            .map(|boundary| match boundary.kind {
                BoundaryKind::Body(i) => bodies[i].size.unwrap_or(sizing.surface),
                BoundaryKind::Side | BoundaryKind::Axis => side_size(&boundary.name),
            })
            .map(|size| size.min(sizing.size))
            .collect();
        let mut facing = vec![Vec::new(); bodies.len()];
        for (index, piece) in border.pieces.iter().enumerate() {
            if let Curve::Quarter { outline, .. } = piece.curve
                && outline < bodies.len()
                && !border.outlines[outline].is_ellipse()
            {
                let n = (4 * FACING_SAMPLES / border.outlines[outline].n_pieces()).max(2);
                facing[outline].extend((0..n).map(|i| {
                    let parameter = i as f64 / n as f64;
                    (border.point(index, parameter), border.frame(index, parameter).normal)
                }));
            }
        }
        let n_bodies = bodies.len();
        let images = border.images.as_slice();
        let layers = layers_at_surface(sizing.gap_layers, sizing.growth);
        let tree = SurfaceTree::new(&border.outlines[..n_bodies]);
        Self { domain, border, n_bodies, layers, own, turn: sizing.turn, images, facing, tree }
    }

    /// Halvings of a piece before its samples are trusted to have seen its bends.
    fn halvings(&self, piece: usize) -> u32 {
        match self.border.pieces[piece].curve {
            Curve::Segment(..) => 2,
            Curve::Quarter { outline, .. } if self.border.outlines[outline].is_ellipse() => 4,
            Curve::Quarter { outline, .. } if self.border.outlines[outline].is_polygon() => 2,
            Curve::Quarter { .. } => 8,
        }
    }

    /// Place of a piece and the size wanted there.
    fn sample(&self, piece: usize, parameter: f64) -> SizeSource {
        let point = self.border.point(piece, parameter);
        let Frame { normal, radius } = self.border.frame(piece, parameter);
        let boundary = self.border.pieces[piece].boundary;
        let layers = self.layers;
        let size = match self.border.boundaries[boundary].kind {
            BoundaryKind::Body(body) => {
                let walls = (0..self.domain.sides().len()).map(|side| {
                    let gap = self.domain.side_gap(side, point);
                    // A periodic side is no surface: one layer up to it is enough. A torus has none
                    match (self.domain.is_periodic(side), self.border.torus.is_closed()) {
                        (true, false) => gap,
                        (true, true) => f64::INFINITY,
                        (false, _) => gap / layers,
                    }
                });
                let walls = walls.fold(f64::INFINITY, f64::min);
                let gap = self
                    .gap_to_bodies(point, Some(body))
                    .min(self.gap_to_self(body, point, normal));
                walls.min(gap / layers)
            }
            BoundaryKind::Side | BoundaryKind::Axis => {
                let gap = self.gap_to_bodies(point, None);
                if self.domain.is_periodic(boundary.index()) {
                    gap
                } else {
                    gap.min(self.domain.facing(boundary.index())) / layers
                }
            }
        };
        let size = size.min(self.own[boundary]).min(self.turn * radius);
        SizeSource { point, size: size * self.part_at_corner(piece, parameter, size) }
    }

    /// Part of the size (m) of its sides that a corner of a body has.
    ///
    /// Stokes flow near a corner goes like the power l of the distance, and stresses like l - 1. With cells
    /// of size h (h / L)^(1 / l - 1) there, L the shorter side, a force converges as without corners.
    fn part_at_corner(&self, piece: usize, parameter: f64, size: f64) -> f64 {
        let Some(corner) = self.border.corner(piece, parameter) else { return 1.0 };
        let exponent = 1.0 / stokes_exponent(corner.turn()) - 1.0;
        (size / corner.shorter).min(1.0).powf(exponent).max(SMALLEST_AT_CORNER)
    }

    /// Distance to the nearest body, the images of all and the body itself left out.
    fn gap_to_bodies(&self, point: Point<2>, but: Option<usize>) -> f64 {
        let bodies = &self.border.outlines[..self.n_bodies];
        self.tree
            .nearest(bodies, self.images, point, but, f64::INFINITY)
            .map_or(f64::INFINITY, |near| near.gap)
    }

    /// Diameter of the largest empty circle that touches the body here, seen from its own parts.
    fn gap_to_self(&self, body: usize, point: Point<2>, normal: Point<2>) -> f64 {
        let mut gap = f64::INFINITY;
        for (place, other) in &self.facing[body] {
            let across = place - point;
            let height = across.dot(&normal);
            if normal.dot(other) < FACING && height > 0.0 {
                gap = gap.min(across.norm_squared() / height);
            }
        }
        gap
    }
}
