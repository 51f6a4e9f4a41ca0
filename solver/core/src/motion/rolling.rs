//! `Rolling`: how the mesh on round bodies turns, so that it rolls along other bodies.
//!
//! How the nodes on a round body turn about its centre is free, as its surface stays the same. Between two bodies that
//! pass each other cells are sheared by the displacement of one surface along the other over the thickness of the film.
//! The rotation vectors phi of the round bodies, from the reference mesh on, are those of the least
//!
//! sum |P (s_a - s_b)|^2 / g^2 + 4 sum |phi|^2,   s = u + phi x l,   P = 1 - n n^T,
//!
//! over pairs of bodies with their gap g and normal n, levers l and displacements u of the centres; both terms are
//! squares of strains, in films and around bodies. Bodies whose mesh turns with them have their own phi. All but the
//! displacements is that of the reference mesh, so that phi is linear in them: paths of nodes are as smooth as those of
//! bodies.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Vector3};

use crate::algebra::Term;
use crate::body::{Mode, Pose, RigidVector};
use crate::contact::{ContactPair, Gaps, Partner};

/// Square of the strain around a body over that of its rotation, by trial: with 1, 4 and 12 five
/// squirmers in space took 15, 12 and 12 new meshes (19 where nothing rolls), 80 steps of twenty 7,
/// 5 and 5 (10). The runs are those of section 10 of docs/method.md.
const AROUND: f64 = 4.0;
/// Largest gap over the reach of the smaller body of a pair that counts.
const WIDEST: f64 = 1.0;
/// Least gap over that reach: thinner films count as this.
const THINNEST: f64 = 1e-3;

/// The slide of two surfaces along each other in one direction, over their gap.
#[derive(Debug)]
struct Slide {
    bodies: [usize; 2],
    /// Derivative by the displacements of both bodies.
    gradient: [RigidVector; 2],
}

/// The rotations of round bodies.
#[derive(Debug)]
pub(super) struct Rolling {
    slides: Vec<Slide>,
    /// First unknown of each body that rolls.
    first: Vec<Option<usize>>,
    rotations: Vec<Mode>,
    /// None where nothing rolls.
    normal_matrix: Option<Cholesky<f64, Dyn>>,
}

impl Rolling {
    /// With bodies at poses in the reference mesh. `rolls` says whose mesh may turn as it likes.
    pub fn new(gaps: &dyn Gaps, poses: &[Pose], rolls: &[bool]) -> Self {
        let rotations: Vec<Mode> = gaps.modes().rotations().collect();
        let can_turn = !rotations.is_empty();
        let may_roll = |body: usize| rolls[body] && can_turn;
        let mut slides = Vec::new();
        if (0..poses.len()).any(may_roll) {
            let reach = |body: usize| gaps.reach(body);
            let largest = (0..poses.len()).map(reach).fold(0.0, f64::max);
            for pair in gaps.pairs(poses, WIDEST * largest) {
                let Partner::Body(other) = pair.partner else { continue };
                let smaller = reach(pair.body).min(reach(other));
                if pair.gap < WIDEST * smaller && (may_roll(pair.body) || may_roll(other)) {
                    slides.extend(slides_of(&pair, other, THINNEST * smaller));
                }
            }
        }
        let mut rolling =
            Self { slides, first: vec![None; poses.len()], rotations, normal_matrix: None };
        rolling.number(may_roll);
        rolling.normal_matrix = rolling.normal_matrix();
        rolling
    }

    /// Numbers the unknowns of the bodies that may roll and have a partner.
    fn number(&mut self, may_roll: impl Fn(usize) -> bool) {
        let mut next = 0;
        for body in self.slides.iter().flat_map(|slide| slide.bodies) {
            if may_roll(body) && self.first[body].is_none() {
                self.first[body] = Some(next);
                next += self.rotations.len();
            }
        }
    }

    fn n_unknowns(&self) -> usize {
        self.rotations.len() * self.first.iter().flatten().count()
    }

    /// Derivative of a slide by the unknowns.
    fn row(&self, slide: &Slide) -> Vec<Term<usize>> {
        let mut row = Vec::new();
        for (body, gradient) in slide.bodies.iter().zip(&slide.gradient) {
            let Some(first) = self.first[*body] else { continue };
            let rotations = self.rotations.iter().enumerate();
            row.extend(rotations.map(|(position, mode)| Term {
                unknown: first + position,
                weight: gradient[*mode],
            }));
        }
        row
    }

    fn normal_matrix(&self) -> Option<Cholesky<f64, Dyn>> {
        let n = self.n_unknowns();
        let mut matrix = DMatrix::from_diagonal_element(n, n, AROUND);
        for row in self.slides.iter().map(|slide| self.row(slide)) {
            for one in &row {
                for other in &row {
                    matrix[(one.unknown, other.unknown)] += one.weight * other.weight;
                }
            }
        }
        if n > 0 { matrix.cholesky() } else { None }
    }

    /// How the mesh on each body turns when bodies have been displaced from the reference mesh; none where it does not.
    pub fn turns(&self, displacements: &[RigidVector]) -> Vec<Option<RigidVector>> {
        let Some(normal_matrix) = &self.normal_matrix else { return vec![None; self.first.len()] };
        let mut rhs = DVector::zeros(self.n_unknowns());
        for slide in &self.slides {
            let known: f64 = self.known_parts(slide, displacements).sum();
            for term in self.row(slide) {
                rhs[term.unknown] -= term.weight * known;
            }
        }
        let found = normal_matrix.solve(&rhs);
        let of_body = |first: &Option<usize>| {
            let first = (*first)?;
            let mut turn = RigidVector::zeros();
            for (position, mode) in self.rotations.iter().enumerate() {
                turn[*mode] = found[first + position];
            }
            // A body at rest keeps the last bit of its mesh
            (turn != RigidVector::zeros()).then_some(turn)
        };
        self.first.iter().map(of_body).collect()
    }

    /// What the displacements of each body make of a slide, but for turns of those that roll.
    fn known_parts<'a>(
        &'a self,
        slide: &'a Slide,
        displacements: &'a [RigidVector],
    ) -> impl Iterator<Item = f64> {
        slide.bodies.iter().zip(&slide.gradient).map(|(&body, gradient)| {
            let n_known = if self.first[body].is_some() { 3 } else { 6 };
            displacements[body].rows(0, n_known).dot(&gradient.rows(0, n_known))
        })
    }
}

/// The slides of a pair along its tangents.
fn slides_of(pair: &ContactPair, other: usize, thinnest: f64) -> Vec<Slide> {
    let gap = pair.gap.max(thinnest);
    let tangents = tangents(&pair.normal);
    let of_tangent = |tangent: Vector3<f64>| {
        let along = |lever: &Vector3<f64>, sign: f64| {
            let turn = lever.cross(&tangent);
            let part = RigidVector::from_fn(|i, _| if i < 3 { tangent[i] } else { turn[i - 3] });
            pair.modes.project(&(part * (sign / gap)))
        };
        let [on_body, on_partner] = &pair.levers;
        let gradient = [along(on_body, 1.0), along(on_partner, -1.0)];
        Slide { bodies: [pair.body, other], gradient }
    };
    tangents.map(of_tangent).into()
}

/// Two unit vectors normal to another one and to each other.
fn tangents(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    // In the plane one of them is along z, along which nothing moves
    let first = Vector3::ith(normal.iamin(), 1.0);
    let second = normal.cross(&first).normalize();
    [second, normal.cross(&second)]
}

#[cfg(test)]
mod tests {
    use alewife_mesh::{Domain, PlacedShape, Point, Shape};

    use super::*;
    use crate::contact::PlanarGaps;

    const GAP: f64 = 0.05;

    fn rolling(shapes: &[Shape], poses: &[Pose]) -> Rolling {
        let body = |shape: &Shape| PlacedShape {
            name: "body".to_owned(),
            shape: shape.clone(),
            center: Point::<2>::zeros(),
            angle: 0.0,
            size: None,
        };
        let bodies: Vec<PlacedShape> = shapes.iter().map(body).collect();
        let (min, max) = (Point::<2>::repeat(-20.0), Point::<2>::repeat(20.0));
        let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let gaps = PlanarGaps::new(&domain, &[0, 1, 2, 3], &bodies).expect("they have surfaces");
        let is_disc = |shape: &Shape| matches!(shape, Shape::Disc { .. });
        Rolling::new(&gaps, poses, &shapes.iter().map(is_disc).collect::<Vec<_>>())
    }

    fn displacement(x: f64, y: f64, turn: f64) -> RigidVector {
        RigidVector::from([x, y, 0.0, 0.0, 0.0, turn])
    }

    fn angles(turns: &[Option<RigidVector>]) -> Vec<f64> {
        turns.iter().map(|turn| turn.map_or(0.0, |turn| turn[5])).collect()
    }

    fn discs(n: usize) -> Vec<Shape> {
        vec![Shape::Disc { radius: 1.0 }; n]
    }

    /// In a row upwards.
    fn row(n: usize) -> Vec<Pose> {
        (0..n).map(|nth| Pose::planar(0.0, (2.0 + GAP) * nth as f64, 0.3)).collect()
    }

    /// They share the slide s but for what the rotations cost: (s - 2 phi)^2 / g^2 + 2 AROUND phi^2 is least.
    #[test]
    fn two_discs_that_pass_each_other_roll_along_each_other() {
        let moved = [displacement(-0.1, 0.02, 0.0), displacement(0.1, 0.0, 0.0)];
        let [lower, upper] = angles(&rolling(&discs(2), &row(2)).turns(&moved))[..] else {
            panic!("there are two")
        };
        assert!((lower - upper).abs() < 1e-12, "{lower} {upper}");
        // The lower one goes left, its top comes back to the right: clockwise
        let exact = -0.2 / (2.0 + AROUND * GAP * GAP);
        assert!((lower - exact).abs() < 1e-12, "{lower} {exact}");
    }

    #[test]
    fn a_disc_between_two_that_it_passes_does_not_roll_but_they_do() {
        let mut moved = [displacement(0.0, 0.0, 0.0); 3];
        moved[1] = displacement(0.2, 0.0, 0.0);
        let angles = angles(&rolling(&discs(3), &row(3)).turns(&moved));
        assert!(angles[1].abs() < 1e-12, "{angles:?}");
        // The inner sides of both follow the whole way of the one between them
        let exact = 0.2 / (1.0 + AROUND * GAP * GAP);
        assert!((angles[0] + exact).abs() < 1e-12, "{angles:?}");
        assert!((angles[2] - exact).abs() < 1e-12, "{angles:?}");
    }

    #[test]
    fn bodies_that_move_together_or_are_far_apart_do_not_roll() {
        let rolling_pair = rolling(&discs(2), &row(2));
        let together = [displacement(0.3, 0.2, 0.0); 2];
        assert_eq!(angles(&rolling_pair.turns(&together)), [0.0, 0.0]);
        let far = [Pose::planar(0.0, 0.0, 0.0), Pose::planar(0.0, 3.5, 0.0)];
        let moved = [displacement(-0.1, 0.0, 0.0), displacement(0.1, 0.0, 0.0)];
        assert_eq!(rolling(&discs(2), &far).turns(&moved), [None, None]);
    }

    /// An ellipse that turns has a surface that goes with it.
    #[test]
    fn a_disc_rolls_along_a_body_that_turns() {
        let shapes = [Shape::Disc { radius: 1.0 }, Shape::Ellipse { semi_axes: [2.0, 1.0] }];
        let poses = [Pose::planar(0.0, 0.0, 0.0), Pose::planar(0.0, 2.0 + GAP, 0.0)];
        let moved = [displacement(0.0, 0.0, 0.7), displacement(0.0, 0.0, 0.1)];
        let turns = rolling(&shapes, &poses).turns(&moved);
        assert_eq!(turns[1], None);
        // Its lowest point goes to the right by 0.1, as the highest one of the disc does that turns by -0.1
        let exact = -0.1 / (1.0 + AROUND * GAP * GAP);
        assert!((angles(&turns)[0] - exact).abs() < 1e-12, "{turns:?}");
    }
}
