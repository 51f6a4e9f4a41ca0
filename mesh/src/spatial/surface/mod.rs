//! `SmoothSurface`: a side of the domain or a part of a body, with exact distance and curvature.

mod curvature;
mod ellipsoid;
mod facets;
mod hole;
mod patch;
mod revolved;
mod ring;
mod sheet;
mod sizes;
mod slender;
mod triangulated;
mod tube;

pub use ellipsoid::Ellipsoid;
pub use facets::Facets;
pub use hole::SolidHole;
pub use patch::{Patch, is_bent};
pub use revolved::Revolved;
pub use sheet::{Sheet, SheetTriangle};
pub use sizes::{Bend, SizedGap};
pub use slender::Slender;
pub use triangulated::{Triangulated, enclosed};
pub use tube::Tube;

use std::sync::Arc;

use nalgebra::{Isometry3, Matrix3};

use crate::{BoundaryId, Point};

/// The form of a smooth surface in its own frame; the solid is on the side its normal leaves.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// The plane x = 0, the solid below it.
    Plane,
    /// A sphere about the origin with this radius (m).
    Sphere(f64),
    /// A cylinder about the x axis with this radius (m), without ends.
    Cylinder(f64),
    /// A cylinder about the x axis with half spheres at its ends.
    Capsule {
        /// Radius (m).
        radius: f64,
        /// Half the distance between the centres of the half spheres (m).
        half_length: f64,
    },
    /// An ellipsoid about the origin.
    Ellipsoid(Ellipsoid),
    /// A tube along a curve.
    Tube(Arc<Tube>),
    /// A surface of revolution about the x axis.
    Revolved(Arc<Revolved>),
    /// Elliptic sections about a midline in the plane z = 0.
    Slender(Arc<Slender>),
    /// Triangles, smooth through their vertices.
    Triangulated(Arc<Triangulated>),
    /// A side of a given mesh, in the frame of the mesh.
    Facets(Arc<Facets>),
    /// A smooth part of a surface of triangles, continued beyond its rim.
    Sheet(Arc<Sheet>),
}

/// The point of a smooth surface nearest to another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Where on the surface (m).
    pub point: Point<3>,
    /// Unit normal there, into the fluid: the gradient of the gap.
    pub normal: Point<3>,
    /// Signed distance (m), positive in the fluid.
    pub gap: f64,
}

/// A smooth surface in its place.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothSurface {
    form: Form,
    origin: Point<3>,
    rotation: Matrix3<f64>,
    /// Whether the fluid is on the inside, as that of a container.
    is_hollow: bool,
    /// The boundary its facets belong to.
    pub boundary: BoundaryId,
    /// Edge length wanted on it (m), where its curvature asks for none that is smaller.
    pub size: f64,
    /// Largest angle by which it turns along one edge (rad).
    pub turn: f64,
    /// Whether it is a plane of symmetry, which is no wall.
    pub is_symmetry: bool,
    /// Whether it is one of a pair of periodic sides, where the fluid continues.
    pub is_periodic: bool,
    /// Places on it where it bends more than around them, with the edge lengths wanted there.
    pub bends: Vec<Bend>,
}

/// Places on a surface with varying curvature that are looked at.
const SAMPLES: usize = 600;

impl SmoothSurface {
    /// A form in its place with the fluid outside of it, or inside.
    #[must_use]
    pub fn new(form: Form, pose: &Isometry3<f64>, is_hollow: bool) -> Self {
        Self {
            form,
            origin: pose.translation.vector,
            rotation: pose.rotation.to_rotation_matrix().into_inner(),
            is_hollow,
            boundary: BoundaryId::default(),
            size: f64::INFINITY,
            turn: f64::INFINITY,
            is_symmetry: false,
            is_periodic: false,
            bends: Vec::new(),
        }
    }

    /// The surface carried along by a motion of space.
    #[must_use]
    pub fn moved(&self, by: &Isometry3<f64>) -> Self {
        let rotation = by.rotation.to_rotation_matrix().into_inner() * self.rotation;
        let origin = by.transform_point(&self.origin.into()).coords;
        let bends = self.bends.iter();
        let bends =
            bends.map(|bend| Bend { at: by.transform_point(&bend.at.into()).coords, ..*bend });
        Self { origin, rotation, bends: bends.collect(), ..self.clone() }
    }

    /// A plane through a point with a unit normal into the fluid.
    #[must_use]
    pub fn plane(through: Point<3>, axis: usize, direction: f64) -> Self {
        let mut surface = Self::new(Form::Plane, &Isometry3::identity(), false);
        surface.origin = through;
        let mut normal = Point::<3>::zeros();
        normal[axis] = direction;
        // Only the first column of the rotation of a plane is used
        surface.rotation.set_column(0, &normal);
        surface
    }

    /// Whether it is a sphere.
    #[must_use]
    pub fn is_sphere(&self) -> bool {
        matches!(self.form, Form::Sphere(_))
    }

    /// A side of a given mesh.
    #[must_use]
    pub fn of_facets(facets: Arc<Facets>) -> Self {
        Self::new(Form::Facets(facets), &Isometry3::identity(), false)
    }

    /// A smooth part of a surface of triangles.
    #[must_use]
    pub fn of_sheet(sheet: Arc<Sheet>) -> Self {
        Self::new(Form::Sheet(sheet), &Isometry3::identity(), false)
    }

    /// The smooth part of a surface of triangles that it is.
    #[must_use]
    pub fn sheet(&self) -> Option<&Sheet> {
        if let Form::Sheet(sheet) = &self.form { Some(sheet) } else { None }
    }

    /// Whether edges on it are straight.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        match &self.form {
            Form::Plane => true,
            Form::Facets(facets) => !facets.is_curved(),
            Form::Sheet(sheet) => sheet.is_flat(),
            _ => false,
        }
    }

    /// Whether it is a side of a given mesh, on which everything stays as it is.
    #[must_use]
    pub fn is_given(&self) -> bool {
        matches!(self.form, Form::Facets(_))
    }

    /// Position of the origin of its own frame (m).
    #[must_use]
    pub fn origin(&self) -> Point<3> {
        self.origin
    }

    /// Whether it is a wall or a body, which other surfaces may leave a gap to.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        !self.is_symmetry && !self.is_periodic
    }

    /// Radius of a ball about the origin that holds the surface (m); infinite without one.
    #[must_use]
    pub fn reach(&self) -> f64 {
        match &self.form {
            Form::Plane | Form::Cylinder(_) | Form::Facets(_) | Form::Sheet(_) => f64::INFINITY,
            Form::Sphere(radius) => *radius,
            Form::Capsule { radius, half_length } => radius + half_length,
            Form::Ellipsoid(ellipsoid) => ellipsoid.reach(),
            Form::Tube(tube) => tube.reach(),
            Form::Revolved(revolved) => revolved.reach(),
            Form::Slender(slender) => slender.reach(),
            Form::Triangulated(triangles) => triangles.reach(),
        }
    }

    /// Its radius of a cylinder without ends, else that of [`Self::reach`] (m).
    #[must_use]
    pub fn scale(&self) -> f64 {
        if let Form::Cylinder(radius) = &self.form { *radius } else { self.reach() }
    }

    /// The direction of a cylinder without ends.
    #[must_use]
    pub fn endless_axis(&self) -> Option<Point<3>> {
        matches!(self.form, Form::Cylinder(_)).then(|| self.axis())
    }

    /// Whether it is a cylinder that goes through a plane.
    #[must_use]
    pub fn goes_through(&self, plane: &Self) -> bool {
        let along = self.endless_axis().map(|axis| axis.dot(&plane.axis()));
        along.is_some_and(|along| along.abs() > 0.5)
    }

    /// Radius (m) of a solid sphere; `None` of other surfaces.
    #[must_use]
    pub fn radius_of_sphere(&self) -> Option<f64> {
        let Form::Sphere(radius) = self.form else { return None };
        (!self.is_hollow).then_some(radius)
    }

    /// A lower bound of the gap to a point (m), at little cost.
    #[must_use]
    pub fn least_gap(&self, point: Point<3>) -> f64 {
        if self.is_hollow { f64::NEG_INFINITY } else { (point - self.origin).norm() - self.reach() }
    }

    fn axis(&self) -> Point<3> {
        self.rotation.column(0).into_owned()
    }

    /// Vector from the nearest point of what the surface runs around, a point or a line.
    fn off_skeleton(&self, point: Point<3>) -> Point<3> {
        let off = point - self.origin;
        let along = |most: f64| {
            let axis = self.axis();
            off - axis * off.dot(&axis).clamp(-most, most)
        };
        match &self.form {
            Form::Cylinder(_) => along(f64::INFINITY),
            Form::Capsule { half_length, .. } => along(*half_length),
            Form::Tube(tube) => {
                let local = self.rotation.tr_mul(&off);
                self.rotation * (local - tube.on_centreline(local))
            }
            Form::Plane
            | Form::Sphere(_)
            | Form::Ellipsoid(_)
            | Form::Revolved(_)
            | Form::Slender(_)
            | Form::Triangulated(_)
            | Form::Facets(_)
            | Form::Sheet(_) => off,
        }
    }

    /// Signed distance of a point (m), positive in the fluid.
    #[must_use]
    pub fn gap(&self, point: Point<3>) -> f64 {
        let gap = match &self.form {
            Form::Plane => self.axis().dot(&(point - self.origin)),
            Form::Sphere(radius) | Form::Cylinder(radius) | Form::Capsule { radius, .. } => {
                self.off_skeleton(point).norm() - radius
            }
            Form::Tube(tube) => self.off_skeleton(point).norm() - tube.radius(),
            Form::Ellipsoid(_)
            | Form::Revolved(_)
            | Form::Slender(_)
            | Form::Triangulated(_)
            | Form::Facets(_)
            | Form::Sheet(_) => return self.foot(point).gap,
        };
        if self.is_hollow { -gap } else { gap }
    }

    /// The nearest point of the surface to a point (m).
    #[must_use]
    pub fn foot(&self, point: Point<3>) -> Foot {
        let mut foot = match &self.form {
            Form::Plane => {
                let normal = self.axis();
                let gap = normal.dot(&(point - self.origin));
                Foot { point: point - normal * gap, normal, gap }
            }
            Form::Sphere(radius) | Form::Cylinder(radius) | Form::Capsule { radius, .. } => {
                self.foot_around(point, *radius)
            }
            Form::Tube(tube) => self.foot_around(point, tube.radius()),
            Form::Ellipsoid(ellipsoid) => self.to_world(&ellipsoid.foot(self.to_local(point))),
            Form::Revolved(revolved) => self.to_world(&revolved.foot(self.to_local(point))),
            Form::Slender(slender) => self.to_world(&slender.foot(self.to_local(point))),
            Form::Triangulated(triangles) => self.to_world(&triangles.foot(self.to_local(point))),
            Form::Facets(facets) => facets.foot(point),
            Form::Sheet(sheet) => sheet.foot(point),
        };
        if self.is_hollow {
            foot.normal = -foot.normal;
            foot.gap = -foot.gap;
        }
        foot
    }

    fn to_local(&self, point: Point<3>) -> Point<3> {
        self.rotation.tr_mul(&(point - self.origin))
    }

    fn to_world(&self, local: &Foot) -> Foot {
        Foot {
            point: self.origin + self.rotation * local.point,
            normal: self.rotation * local.normal,
            gap: local.gap,
        }
    }

    /// The nearest point at a distance (m) from what the surface runs around.
    fn foot_around(&self, point: Point<3>, radius: f64) -> Foot {
        let off = self.off_skeleton(point);
        let distance = off.norm();
        // Any normal will do in the middle
        let normal = if distance > 0.0 { off / distance } else { self.rotation.column(1).into() };
        let gap = distance - radius;
        Foot { point: point - normal * gap, normal, gap }
    }

    /// Whether a plane cuts it, or touches it.
    #[must_use]
    pub fn crosses(&self, plane: &Self) -> bool {
        if self.endless_axis().is_some() {
            return self.goes_through(plane) || plane.gap(self.origin) <= self.scale();
        }
        self.places(SAMPLES).iter().any(|point| plane.gap(*point) <= 0.0)
    }

    /// Places on a slender body about which it is nearest to a plane; `None` of other surfaces.
    #[must_use]
    pub fn nearest_to_plane(&self, plane: &Self) -> Option<Vec<Point<3>>> {
        let (Form::Slender(slender), Form::Plane) = (&self.form, &plane.form) else { return None };
        let own = slender.farthest_against(self.rotation.tr_mul(&plane.axis()));
        Some(own.into_iter().map(|place| self.origin + self.rotation * place).collect())
    }

    /// About so many places on it, as seen from far away; of a slender body and of triangles all over it.
    #[must_use]
    pub fn places(&self, n: usize) -> Vec<Point<3>> {
        if let Form::Slender(slender) = &self.form {
            let all: Vec<Point<3>> = slender.places().collect();
            let every = (all.len() / n).max(1);
            let own = all.iter().step_by(every);
            return own.map(|place| self.origin + self.rotation * place).collect();
        }
        if let Form::Triangulated(triangles) = &self.form {
            let all = triangles.places();
            let own = all.iter().step_by((all.len() / n).max(1));
            return own.map(|place| self.origin + self.rotation * place).collect();
        }
        let far = 2.0 * self.reach();
        directions(n).map(|to| self.foot(self.origin + to * far).point).collect()
    }
}

/// Unit vectors in all directions, evenly.
pub fn directions(n: usize) -> impl Iterator<Item = Point<3>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..n).map(move |i| {
        let height = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let ring = (1.0 - height * height).sqrt();
        Point::<3>::new(ring * cos, ring * sin, height)
    })
}

#[cfg(test)]
mod tests;
