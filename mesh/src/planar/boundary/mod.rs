//! The boundary as closed loops of curve pieces, the fluid on their left.
//!
//! The outer loop runs counter-clockwise, bodies are clockwise holes. In an axisymmetric domain the
//! outer loop follows the axis and climbs over every body on it by the upper half of its outline.

use std::f64::consts::FRAC_PI_2;

use crate::number::whole;
use crate::planar::lattice::lattice;
use crate::planar::outline::Corner;
use crate::planar::torus::Torus;
use crate::planar::vector::cross;
use crate::quadrature::integrate;
use crate::{Boundary, BoundaryId, BoundaryKind, Domain, Outline, PlacedShape, Point};

/// A smooth piece of the boundary with a parameter in [0, 1] in the direction of travel.
#[derive(Debug, Clone)]
pub struct BoundaryPiece {
    /// Its curve.
    pub curve: Curve,
    /// Index of its boundary.
    pub boundary: BoundaryId,
    /// The piece whose discretisation it copies backwards.
    pub copy_of: Option<CopyOf>,
}

/// The curve of a piece.
#[derive(Debug, Clone)]
pub enum Curve {
    /// Straight from a to b.
    Segment(Point<2>, Point<2>),
    /// A quarter of outline `outline` of [`BoundaryLoops::outlines`], or a side of a polygon.
    Quarter {
        /// Index of the outline.
        outline: usize,
        /// Which quarter.
        quarter: usize,
        /// Whether it is travelled clockwise.
        reversed: bool,
    },
}

/// What a periodic side copies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CopyOf {
    /// Index of the original.
    pub original: usize,
    /// Whole periods from it to the copy (m).
    pub shift: Point<2>,
}

/// How the boundary runs at one of its points.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Unit normal into the fluid.
    pub normal: Point<2>,
    /// Radius of curvature (m), infinite when straight.
    pub radius: f64,
}

/// All loops of the boundary.
#[derive(Debug, Clone)]
pub struct BoundaryLoops {
    /// The pieces, loop after loop; within a loop each starts where the one before ends.
    pub pieces: Vec<BoundaryPiece>,
    /// First piece of each loop.
    pub loops: Vec<usize>,
    /// Outlines of the bodies, then of a round domain.
    pub outlines: Vec<Outline>,
    /// Sides of the domain, then bodies.
    pub boundaries: Vec<Boundary>,
    /// The vectors by which what it bounds repeats next to itself, zero first (m).
    pub images: Vec<Point<2>>,
    /// The box where it closes on itself and has no periodic sides.
    pub torus: Torus,
}

impl BoundaryLoops {
    /// Loops around a domain and its bodies, whose outlines are given.
    pub fn new(domain: &Domain, bodies: &[PlacedShape], mut outlines: Vec<Outline>) -> Self {
        let boundaries = boundaries(domain, bodies);
        let sides = domain.sides();
        let first_body = sides.len();
        let mut pieces = Vec::new();
        let mut loops = vec![0];
        match domain {
            Domain::Box { min, max, periodic_x, periodic_y } => {
                let (right_min, left_max) =
                    (Point::<2>::new(max.x, min.y), Point::<2>::new(min.x, max.y));
                let width = Point::<2>::new(max.x - min.x, 0.0);
                let height = Point::<2>::new(0.0, max.y - min.y);
                let copy = |original, shift| CopyOf { original, shift };
                // Left comes before right here, so that a copy always refers to an earlier piece
                pieces.push(segment(left_max, *min, 0, None));
                pieces.push(segment(*min, right_min, 2, None));
                pieces.push(segment(right_min, *max, 1, periodic_x.then_some(copy(0, width))));
                pieces.push(segment(*max, left_max, 3, periodic_y.then_some(copy(1, height))));
            }
            Domain::Disc { center, radius } => {
                outlines.push(Outline::circle(*center, *radius));
                for quarter in 0..4 {
                    pieces.push(quarter_of(outlines.len() - 1, quarter, false, 0));
                }
            }
            Domain::HalfDisc { center, radius } => {
                outlines.push(Outline::circle(Point::<2>::new(*center, 0.0), *radius));
                for quarter in 0..2 {
                    pieces.push(quarter_of(outlines.len() - 1, quarter, false, 0));
                }
                let x = [center - radius, center + radius];
                along_axis(&mut pieces, x, 1, first_body, &outlines[..bodies.len()], false);
            }
            Domain::Cylinder { x, radius, periodic_x } => {
                let corner = |x: f64, y: f64| Point::<2>::new(x, y);
                let length = corner(x[1] - x[0], 0.0);
                pieces.push(segment(corner(x[0], *radius), corner(x[0], 0.0), 0, None));
                along_axis(&mut pieces, *x, 3, first_body, &outlines[..bodies.len()], false);
                let copy = periodic_x.then_some(CopyOf { original: 0, shift: length });
                pieces.push(segment(corner(x[1], 0.0), corner(x[1], *radius), 1, copy));
                pieces.push(segment(corner(x[1], *radius), corner(x[0], *radius), 2, None));
            }
        }
        if !domain.is_axisymmetric() {
            around_bodies(&mut pieces, &mut loops, &outlines[..bodies.len()], first_body);
        }
        Self {
            pieces,
            loops,
            outlines,
            boundaries,
            images: domain.images(),
            torus: Torus::default(),
        }
    }

    /// Loops around bodies in a periodic domain that closes on itself, whose outlines are given, and its
    /// walls and axis, of which each is a loop by itself.
    pub fn on_torus(domain: &Domain, bodies: &[PlacedShape], outlines: Vec<Outline>) -> Self {
        let first_body = domain.sides().len();
        // Two bodies of half a period may face each other two periods away
        let reach = outlines.iter().map(Outline::reach).fold(0.0, f64::max);
        let shortest = domain.periods().into_iter().flatten().fold(f64::INFINITY, f64::min);
        let images = lattice(domain.periods(), 1 + whole(2.0 * reach / shortest));
        let torus = Torus::new(domain);
        let mut pieces = Vec::new();
        let mut loops = Vec::new();
        if let Domain::Cylinder { x, radius, .. } = domain {
            let [left, right] = x.map(|x| Point::<2>::new(x, *radius));
            pieces.push(segment(right, left, 2, None));
            along_axis(&mut pieces, *x, 3, first_body, &outlines, true);
            loops.extend([0, 1]);
        } else {
            pieces = Self::new(domain, &[], Vec::new()).pieces;
            pieces.retain(|wall| !domain.is_periodic(wall.boundary.index()));
            loops.extend(0..pieces.len());
            around_bodies(&mut pieces, &mut loops, &outlines[..bodies.len()], first_body);
        }
        let boundaries = boundaries(domain, bodies);
        Self { pieces, loops, outlines, boundaries, images, torus }
    }

    /// Point (m), first and second derivative of a piece.
    pub fn evaluate(&self, piece: usize, parameter: f64) -> [Point<2>; 3] {
        match &self.pieces[piece].curve {
            Curve::Segment(a, b) => {
                let point = if parameter >= 1.0 { *b } else { a + (b - a) * parameter };
                [point, b - a, Point::<2>::zeros()]
            }
            Curve::Quarter { outline, quarter, reversed: false } => {
                self.outlines[*outline].evaluate(*quarter, parameter)
            }
            Curve::Quarter { outline, quarter, reversed: true } => {
                let [point, first, second] =
                    self.outlines[*outline].evaluate(*quarter, 1.0 - parameter);
                [point, -first, second]
            }
        }
    }

    /// Point of a piece (m).
    pub fn point(&self, piece: usize, parameter: f64) -> Point<2> {
        self.evaluate(piece, parameter)[0]
    }

    /// Length of the curve between two parameters of a piece (m).
    pub fn arc(&self, piece: usize, from: f64, to: f64) -> f64 {
        match self.speed(piece) {
            Some(speed) => speed * (to - from),
            None => integrate(from, to, |t| self.evaluate(piece, t)[1].norm()),
        }
    }

    /// Parameter between two others that cuts the arc length at a fraction, by Newton.
    pub fn cut(&self, piece: usize, from: f64, to: f64, fraction: f64) -> f64 {
        let mut t = from + fraction * (to - from);
        if self.speed(piece).is_some() {
            return t;
        }
        let wanted = fraction * self.arc(piece, from, to);
        for _ in 0..20 {
            let step = (self.arc(piece, from, t) - wanted) / self.evaluate(piece, t)[1].norm();
            t -= step;
            if step.abs() <= 1e-15 {
                break;
            }
        }
        t.clamp(from, to)
    }

    /// Normal and radius of curvature at a point of a piece.
    pub fn frame(&self, piece: usize, parameter: f64) -> Frame {
        let [_, first, second] = self.evaluate(piece, parameter);
        let speed = first.norm();
        let bend = cross(first, second).abs();
        let normal = Point::<2>::new(-first.y, first.x) / speed;
        Frame { normal, radius: speed.powi(3) / bend }
    }

    /// Whether the edges of a piece are straight.
    pub fn is_straight(&self, piece: usize) -> bool {
        match self.pieces[piece].curve {
            Curve::Segment(..) => true,
            Curve::Quarter { outline, .. } => self.outlines[outline].is_polygon(),
        }
    }

    /// Whether a piece is one of a periodic pair.
    pub fn is_periodic(&self, piece: usize) -> bool {
        let copies = self.pieces.iter().filter_map(|p| p.copy_of);
        self.pieces[piece].copy_of.is_some()
            || copies.into_iter().any(|copy| copy.original == piece)
    }

    /// Length per parameter where it is constant: straight pieces and circles.
    fn speed(&self, piece: usize) -> Option<f64> {
        match &self.pieces[piece].curve {
            Curve::Segment(a, b) => Some((b - a).norm()),
            Curve::Quarter { outline, quarter, .. } => {
                let outline = &self.outlines[*outline];
                if outline.is_polygon() {
                    return Some(outline.evaluate(*quarter, 0.0)[1].norm());
                }
                outline.circle_radius().map(|radius| radius * FRAC_PI_2)
            }
        }
    }

    /// The corner of a polygon at the start of a piece, 0, or at its end, 1.
    pub fn corner(&self, piece: usize, parameter: f64) -> Option<Corner> {
        let Curve::Quarter { outline, quarter, reversed } = self.pieces[piece].curve else {
            return None;
        };
        let at_start = parameter == if reversed { 1.0 } else { 0.0 };
        let at_end = parameter == if reversed { 0.0 } else { 1.0 };
        let outline = &self.outlines[outline];
        let (corners, n) = (outline.corners(), outline.n_pieces());
        let index = if at_end { (quarter + 1) % n } else { quarter };
        corners.get(index).filter(|_| at_start || at_end).copied()
    }
}

/// The sides of a domain, then its bodies.
fn boundaries(domain: &Domain, bodies: &[PlacedShape]) -> Vec<Boundary> {
    let kind = |name: &str| match name {
        "axis" => BoundaryKind::Axis,
        _ => BoundaryKind::Side,
    };
    let sides = domain.sides().iter();
    let sides = sides.map(|name| Boundary { name: (*name).to_string(), kind: kind(name) });
    let bodies = bodies.iter().enumerate();
    let bodies =
        bodies.map(|(i, body)| Boundary { name: body.name.clone(), kind: BoundaryKind::Body(i) });
    sides.chain(bodies).collect()
}

/// A clockwise loop around each body of a planar domain.
fn around_bodies(
    pieces: &mut Vec<BoundaryPiece>,
    loops: &mut Vec<usize>,
    outlines: &[Outline],
    first_body: usize,
) {
    for (body, outline) in outlines.iter().enumerate() {
        loops.push(pieces.len());
        for quarter in (0..outline.n_pieces()).rev() {
            pieces.push(quarter_of(body, quarter, true, first_body + body));
        }
    }
}

/// Straight piece from a to b.
pub fn segment(
    a: Point<2>,
    b: Point<2>,
    boundary: usize,
    copy_of: Option<CopyOf>,
) -> BoundaryPiece {
    BoundaryPiece { curve: Curve::Segment(a, b), boundary: BoundaryId::new(boundary), copy_of }
}

/// A quarter of an outline.
pub fn quarter_of(
    outline: usize,
    quarter: usize,
    reversed: bool,
    boundary: usize,
) -> BoundaryPiece {
    let curve = Curve::Quarter { outline, quarter, reversed };
    BoundaryPiece { curve, boundary: BoundaryId::new(boundary), copy_of: None }
}

/// The axis from left to right, interrupted by the upper halves of the bodies in order of x; one that
/// closes on itself begins where the first body does.
fn along_axis(
    pieces: &mut Vec<BoundaryPiece>,
    x: [f64; 2],
    axis: usize,
    first_body: usize,
    bodies: &[Outline],
    closes: bool,
) {
    let pole =
        |body: usize, quarter| Point::<2>::new(bodies[body].evaluate(quarter, 0.0)[0].x, 0.0);
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by(|a, b| pole(*a, 2).x.total_cmp(&pole(*b, 2).x));
    let [mut from, mut end] = x.map(|x| Point::<2>::new(x, 0.0));
    if let (true, Some(first)) = (closes, order.first()) {
        end += pole(*first, 2) - from;
        from = pole(*first, 2);
    }
    for body in order {
        if from != pole(body, 2) {
            pieces.push(segment(from, pole(body, 2), axis, None));
        }
        pieces.push(quarter_of(body, 1, true, first_body + body));
        pieces.push(quarter_of(body, 0, true, first_body + body));
        from = pole(body, 0);
    }
    pieces.push(segment(from, end, axis, None));
}
