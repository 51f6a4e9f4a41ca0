//! `Geometry`: all surfaces that bound the fluid, those of the domain first, and their boundaries.

use std::sync::Arc;

use nalgebra::{Isometry3, Matrix3, Translation3};

use super::domain::Domain;
use super::imported::Imported;
use super::shape::{Body, Part, Shape};
use super::surface::{Ellipsoid, Facets, Foot, Form, Revolved, SmoothSurface, Tube};
use crate::periods::Periods;
use crate::{Boundary, BoundaryId, BoundaryKind, Bounds, MeshError, Point, Sizing};

/// Steps of Newton's method onto several surfaces at once.
const MOST_STEPS: usize = 20;

/// Part of a period up to which a surface reaches from its middle whose nearest image is that of its middle.
const LARGE: f64 = 0.49;

/// Surfaces that belong together: the sides of the domain, or the parts of a body.
#[derive(Debug, Clone)]
pub struct Group {
    /// The first of its surfaces.
    pub first: usize,
    /// One past the last.
    pub last: usize,
    /// Centre of a ball around them (m).
    pub center: Point<3>,
    /// Its radius (m), infinite for the domain.
    pub reach: f64,
    /// Planes of symmetry that cut them, and sides that they go through.
    pub cut_by: Vec<usize>,
}

/// The surfaces that bound the fluid.
#[derive(Debug, Clone)]
pub struct Geometry {
    /// Sides of the domain, then parts of bodies.
    pub surfaces: Vec<SmoothSurface>,
    /// The domain, then the bodies.
    pub groups: Vec<Group>,
    /// Sides of the domain, then bodies.
    pub boundaries: Vec<Boundary>,
    /// Corners of a box around the fluid (m).
    pub corners: [Point<3>; 2],
    /// Lengths of the box along which it is periodic.
    pub periods: Periods<3>,
    /// The mesh that is to be cut by the bodies, where one is given.
    pub imported: Option<Imported>,
    /// The whole surface of a region whose sides are sheets of it.
    pub enclosure: Option<Arc<Facets>>,
}

impl Geometry {
    /// The surfaces of a domain with bodies, whose placement has been checked.
    ///
    /// # Errors
    /// Those of [`surfaces_of`].
    pub fn new(domain: &Domain, bodies: &[Body], sizing: &Sizing<3>) -> Result<Self, MeshError> {
        let mut surfaces = sides(domain);
        let mut boundaries = Vec::new();
        for (side, (name, surface)) in domain.sides().iter().zip(&mut surfaces).enumerate() {
            boundaries.push(Boundary { name: (*name).to_owned(), kind: BoundaryKind::Side });
            let is_own = |named: &str| named == *name || domain.twin(side) == Some(named);
            let own = sizing.sides.iter().filter(|(named, _)| is_own(named));
            let own = own.map(|(_, size)| *size).fold(f64::INFINITY, f64::min);
            surface.boundary = BoundaryId::new(side);
            surface.is_periodic = domain.is_periodic(side);
            // The fluid continues there, and nothing faces it
            let facing = if surface.is_periodic { f64::INFINITY } else { domain.facing(side) };
            surface.size = own.min(sizing.size).min(facing / sizing.gap_layers);
            surface.turn = sizing.turn;
            surface.is_symmetry = domain.is_symmetric(side);
        }
        let far = Point::<3>::zeros();
        let mut groups = vec![Group {
            first: 0,
            last: surfaces.len(),
            center: far,
            reach: f64::INFINITY,
            cut_by: Vec::new(),
        }];
        for (index, body) in bodies.iter().enumerate() {
            let first = surfaces.len();
            let boundary = BoundaryId::new(boundaries.len());
            let size = body.size.unwrap_or(sizing.surface).min(sizing.size);
            boundaries.push(Boundary { name: body.name.clone(), kind: BoundaryKind::Body(index) });
            surfaces.extend(surfaces_of(body)?.into_iter().map(|mut surface| {
                surface.boundary = boundary;
                surface.size = size;
                surface.turn = sizing.turn;
                surface.find_bends(sizing.growth);
                surface
            }));
            groups.push(around(&surfaces, first));
        }
        let corners = domain.corners();
        let imported = match domain {
            Domain::Imported(imported) => Some(imported.clone()),
            Domain::Box { .. } | Domain::Cylinder { .. } | Domain::Ball { .. } => None,
        };
        let periods = Periods::new(domain.periods());
        Ok(Self { surfaces, groups, boundaries, corners, periods, imported, enclosure: None })
    }

    /// The inside of a surface whose smooth parts are given.
    pub fn inside(
        sheets: Vec<SmoothSurface>,
        boundaries: Vec<Boundary>,
        enclosure: Arc<Facets>,
    ) -> Self {
        let bounds = Bounds::around(&enclosure.points().collect::<Vec<_>>());
        let center = Point::<3>::zeros();
        let (last, reach) = (sheets.len(), f64::INFINITY);
        let all = Group { first: 0, last, center, reach, cut_by: Vec::new() };
        Self {
            surfaces: sheets,
            groups: vec![all],
            boundaries,
            corners: [bounds.min, bounds.max],
            periods: Periods::new(Point::<3>::zeros()),
            imported: None,
            enclosure: Some(enclosure),
        }
    }

    /// Whether a body has several parts, whose surfaces may meet, or the region sharp edges.
    pub fn has_creases(&self) -> bool {
        self.enclosure.is_some() || self.groups[1..].iter().any(|body| body.last > body.first + 1)
    }

    /// About the distance to the nearest surface (m), negative outside the fluid; where it is certain to
    /// exceed a bound, a value above the bound.
    pub fn clearance(&self, point: Point<3>, bound: f64) -> f64 {
        if let Some(enclosure) = &self.enclosure {
            return enclosure.foot(point).gap;
        }
        let mut least = f64::INFINITY;
        for group in &self.groups {
            let apart = self.periods.beside(point, group.center) - group.center;
            let apart = apart.norm() - group.reach;
            if apart > bound {
                least = least.min(apart);
                continue;
            }
            for surface in group.first..group.last {
                if !self.surfaces[surface].is_periodic {
                    let image = self.nearest_image(surface, point);
                    let surface = &self.surfaces[surface];
                    if surface.may_be_within(image, bound) {
                        least = least.min(surface.rough_gap(image));
                    }
                }
            }
        }
        least
    }

    /// The image of a point (m) that is nearest to a surface.
    #[inline]
    pub fn nearest_image(&self, surface: usize, point: Point<3>) -> Point<3> {
        if !self.periods.is_any() || surface < self.groups[0].last {
            return point;
        }
        let surface = &self.surfaces[surface];
        let beside = self.periods.beside(point, surface.origin());
        if surface.reach() < LARGE * self.periods.shortest() {
            return beside;
        }
        let (mut nearest, mut least) = (beside, surface.gap(beside));
        for image in self.periods.shifts().into_iter().skip(1).map(|shift| beside + shift) {
            if surface.least_gap(image) < least {
                let gap = surface.gap(image);
                if gap < least {
                    (nearest, least) = (image, gap);
                }
            }
        }
        nearest
    }

    /// Signed distance of a point to the nearest image of a surface (m), positive in the fluid.
    #[inline]
    pub fn gap(&self, surface: usize, point: Point<3>) -> f64 {
        self.surfaces[surface].gap(self.nearest_image(surface, point))
    }

    /// The nearest point of the nearest image of a surface to a point (m).
    #[inline]
    pub fn foot(&self, surface: usize, point: Point<3>) -> Foot {
        let image = self.nearest_image(surface, point);
        let foot = self.surfaces[surface].foot(image);
        Foot { point: foot.point + (point - image), ..foot }
    }

    /// Whole periods from a point on a surface (m) to where the surface is.
    pub fn steps_home(&self, surface: usize, point: Point<3>) -> [i32; 3] {
        self.periods.steps(point, self.nearest_image(surface, point))
    }

    /// The point on all of these surfaces near a point (m); on several by Newton's method, each step
    /// the shortest way to where their tangent planes meet.
    pub fn project(&self, surfaces: &[u16], point: Point<3>) -> Point<3> {
        match surfaces {
            [] => point,
            [one] => self.foot(usize::from(*one), point).point,
            several => self.project_onto_several(several, point),
        }
    }

    fn project_onto_several(&self, surfaces: &[u16], mut point: Point<3>) -> Point<3> {
        for _ in 0..MOST_STEPS {
            let mut normals = Matrix3::<f64>::zeros();
            let mut gaps = Point::<3>::zeros();
            for (row, surface) in surfaces.iter().take(3).enumerate() {
                let foot = self.foot(usize::from(*surface), point);
                normals.set_row(row, &foot.normal.transpose());
                gaps[row] = foot.gap;
            }
            // With the multipliers l of the normals N: N Nᵀ l = gaps; a row that is not there is 1
            let mut products = normals * normals.transpose();
            if surfaces.len() == 2 {
                products[(2, 2)] = 1.0;
            }
            let Some(inverse) = products.try_inverse().filter(|inverse| inverse.amax() < 1e8)
            else {
                return point;
            };
            point -= normals.tr_mul(&(inverse * gaps));
            if gaps.amax() < 1e-15 * (1.0 + point.amax()) {
                break;
            }
        }
        point
    }
}

/// The sides of a domain, in their order.
pub fn sides(domain: &Domain) -> Vec<SmoothSurface> {
    match domain {
        Domain::Box { min, max, .. } => (0..6)
            .map(|side| {
                let (corner, direction) = if side % 2 == 0 { (min, 1.0) } else { (max, -1.0) };
                SmoothSurface::plane(*corner, side / 2, direction)
            })
            .collect(),
        Domain::Cylinder { x: [left, right], radius } => vec![
            SmoothSurface::plane(Point::<3>::new(*left, 0.0, 0.0), 0, 1.0),
            SmoothSurface::plane(Point::<3>::new(*right, 0.0, 0.0), 0, -1.0),
            SmoothSurface::new(Form::Cylinder(*radius), &Isometry3::identity(), true),
        ],
        Domain::Ball { center, radius } => {
            let pose = Isometry3::from_parts(Translation3::from(*center), nalgebra::one());
            vec![SmoothSurface::new(Form::Sphere(*radius), &pose, true)]
        }
        Domain::Imported(imported) => imported.surfaces(),
    }
}

/// The surfaces of the parts of a body.
///
/// # Errors
/// [`MeshError::Body`] where a profile is not one.
pub fn surfaces_of(body: &Body) -> Result<Vec<SmoothSurface>, MeshError> {
    let surface = |part: &Part| {
        let form = match &part.shape {
            Shape::Sphere { radius } => Form::Sphere(*radius),
            Shape::Ellipsoid { semi_axes } => Form::Ellipsoid(Ellipsoid::new(*semi_axes)),
            Shape::Capsule { radius, length } => {
                Form::Capsule { radius: *radius, half_length: 0.5 * length }
            }
            Shape::Cylinder { radius } => Form::Cylinder(*radius),
            Shape::Revolved { profile } => {
                Form::Revolved(Arc::new(Revolved::new(&body.name, profile)?))
            }
            Shape::Slender(slender) => Form::Slender(Arc::clone(slender)),
            Shape::Triangulated(triangles) => Form::Triangulated(Arc::clone(triangles)),
            Shape::Tube { centreline, radius } => {
                Form::Tube(Arc::new(Tube::new(centreline.clone(), *radius)))
            }
        };
        Ok(SmoothSurface::new(form, &(body.pose * part.pose), false))
    };
    body.parts.iter().map(surface).collect()
}

/// The group of the surfaces from one on, with a ball around their balls.
fn around(surfaces: &[SmoothSurface], first: usize) -> Group {
    let own = &surfaces[first..];
    let middle: Point<3> = own.iter().map(SmoothSurface::origin).sum();
    let center = middle / own.len().max(1) as f64;
    let reach = own.iter().map(|surface| (surface.origin() - center).norm() + surface.reach());
    let reach = reach.fold(0.0, f64::max);
    let is_cut = |plane: &SmoothSurface| {
        own.iter().any(|surface| {
            surface.goes_through(plane) || (plane.is_symmetry && surface.crosses(plane))
        })
    };
    let planes = surfaces[..first].iter().enumerate().filter(|(_, plane)| plane.is_flat());
    let cut_by = planes.filter(|(_, plane)| is_cut(plane)).map(|(side, _)| side).collect();
    Group { first, last: surfaces.len(), center, reach, cut_by }
}
