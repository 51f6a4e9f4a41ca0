//! The domain of a case: its extent, its named sides, the planar domain to be meshed, and sizes.

use alewife_mesh::{Domain, Point, SizeBox, Sizing};

use crate::MeshFile;
use crate::spec::extent::Extent;
use crate::{Body, BoundaryCondition, Case, DomainSpec, Geometry, ShapeSpec};

/// The axis that a straight side is normal to.
#[must_use]
pub fn normal_axis(side: &str) -> Option<usize> {
    match side {
        "left" | "right" => Some(0),
        "bottom" | "top" => Some(1),
        "back" | "front" => Some(2),
        _ => None,
    }
}

/// The side a periodic side can be paired with.
#[must_use]
pub fn opposite(side: &str) -> Option<&'static str> {
    match side {
        "left" => Some("right"),
        "right" => Some("left"),
        "bottom" => Some("top"),
        "top" => Some("bottom"),
        "back" => Some("front"),
        "front" => Some("back"),
        _ => None,
    }
}

impl Case {
    /// The mesh the domain is given by, or that was made inside a surface; `None` of other domains.
    #[must_use]
    pub fn given_mesh(&self) -> Option<&MeshFile> {
        match &self.domain {
            DomainSpec::Mesh(file) => Some(file),
            DomainSpec::Surface(region) => region.mesh(),
            _ => None,
        }
    }

    /// The body whose surface is this side of a given mesh; `None` of other sides.
    #[must_use]
    pub fn body_around(&self, side: &str) -> Option<&Body> {
        let is_surface =
            |body: &&Body| matches!(&body.shape, ShapeSpec::Side(hole) if hole.side == side);
        self.body.iter().find(is_surface)
    }

    /// Whether bodies are what a given mesh leaves out.
    #[must_use]
    pub fn bodies_are_holes(&self) -> bool {
        self.body.iter().any(|body| matches!(body.shape, ShapeSpec::Side(_)))
    }

    /// The same case with the file of its mesh, where one is given, under another name.
    #[must_use]
    pub fn naming_mesh(&self, file: &str) -> Self {
        let mut case = self.clone();
        if let DomainSpec::Mesh(mesh) = &mut case.domain {
            file.clone_into(&mut mesh.file);
        }
        case
    }

    /// Along which coordinates the domain is periodic.
    #[must_use]
    pub fn periodic_axes(&self) -> [bool; 3] {
        let is_periodic =
            |side: &str| matches!(self.boundary.get(side), Some(BoundaryCondition::Periodic(_)));
        match self.given_mesh() {
            Some(mesh) => mesh.periodic(),
            None => ["left", "bottom", "back"].map(is_periodic),
        }
    }

    /// The period of the domain along a line at an angle to x (rad) (m); none where it has none along that.
    #[must_use]
    pub fn period_along(&self, angle: f64) -> Option<f64> {
        /// Sine of the angle below which a line is along an axis.
        const ALONG: f64 = 1e-9;
        let [along_x, along_y] = self.mesh_domain().periods();
        let (sin, cos) = angle.sin_cos();
        let is_along = |off: f64| off.abs() < ALONG;
        along_x.filter(|_| is_along(sin)).or(along_y.filter(|_| is_along(cos)))
    }

    /// The walls of a channel, with its images behind axis and planes of symmetry (m), along each
    /// coordinate; `None` without walls.
    #[must_use]
    pub fn walls_across(&self) -> [Option<[f64; 2]>; 3] {
        let extent = self.extent();
        let is_mirror = |side: &str| {
            let condition = self.boundary.get(side);
            matches!(condition, Some(BoundaryCondition::Symmetry | BoundaryCondition::Axis))
        };
        let is_periodic = self.periodic_axes();
        let is_axisymmetric = self.geometry == Geometry::Axisymmetric;
        let pairs = [["left", "right"], ["bottom", "top"], ["back", "front"]];
        std::array::from_fn(|axis| {
            let [low, high] = [extent.min[axis], extent.max[axis]];
            if is_axisymmetric && axis == 1 {
                return Some([-high, high]);
            }
            match pairs[axis].map(is_mirror) {
                [false, false] => (!is_periodic[axis]).then_some([low, high]),
                [true, false] => Some([2.0 * low - high, high]),
                [false, true] => Some([low, 2.0 * high - low]),
                [true, true] => None,
            }
        })
    }

    /// Names of the sides of the domain.
    #[must_use]
    pub fn sides(&self) -> Vec<&str> {
        match (&self.domain, self.geometry) {
            (DomainSpec::Box { .. }, Geometry::Spatial) => {
                vec!["left", "right", "bottom", "top", "back", "front"]
            }
            (DomainSpec::Box { .. } | DomainSpec::Channel { .. }, _) => {
                vec!["left", "right", "bottom", "top"]
            }
            (DomainSpec::Disc { .. } | DomainSpec::Sphere { .. }, _) => vec!["wall"],
            (DomainSpec::HalfDisc { .. }, _) => vec!["wall", "axis"],
            (DomainSpec::Cylinder { .. }, Geometry::Spatial) => vec!["left", "right", "wall"],
            (DomainSpec::Cylinder { .. }, _) => vec!["left", "right", "wall", "axis"],
            (DomainSpec::Mesh(file), _) => {
                let names = file.side_names().into_iter();
                names.filter(|side| self.body_around(side).is_none()).collect()
            }
            (DomainSpec::Surface(region), _) => {
                region.mesh().map_or_else(Vec::new, MeshFile::side_names)
            }
        }
    }

    /// The smallest box around the domain.
    #[must_use]
    pub fn extent(&self) -> Extent {
        match &self.domain {
            DomainSpec::Box { min, max } => Extent::between(min, max),
            DomainSpec::Channel { length, height } => Extent::between(&[], &[*length, *height]),
            DomainSpec::Disc { center: [x, y], radius } => {
                Extent::around([*x, *y, 0.0], [*radius, *radius, 0.0])
            }
            DomainSpec::HalfDisc { center, radius } => {
                Extent::between(&[center - radius], &[center + radius, *radius])
            }
            DomainSpec::Cylinder { x, radius } if self.geometry == Geometry::Spatial => {
                Extent::between(&[x[0], -radius, -radius], &[x[1], *radius, *radius])
            }
            DomainSpec::Cylinder { x, radius } => Extent::between(&x[..1], &[x[1], *radius]),
            DomainSpec::Sphere { center, radius } => Extent::around(*center, [*radius; 3]),
            DomainSpec::Mesh(file) => file.extent(),
            DomainSpec::Surface(region) => {
                region.mesh().map_or_else(|| Extent::between(&[], &[]), MeshFile::extent)
            }
        }
    }

    /// Whether a side of the domain waves.
    #[must_use]
    pub fn has_waving_sheet(&self) -> bool {
        self.boundary.values().any(|side| matches!(side, BoundaryCondition::WavingSheet { .. }))
    }

    /// Whether force and moment coefficients are defined: 2 F / (density velocity^2 area).
    #[must_use]
    pub fn has_coefficients(&self) -> bool {
        self.scales.is_some() && self.fluid.density > 0.0
    }

    /// The planar domain to be meshed, with its periodic pairs; of a domain in space its section, of a
    /// given mesh the box around it.
    #[must_use]
    pub fn mesh_domain(&self) -> Domain {
        let is_periodic =
            |side: &str| matches!(self.boundary.get(side), Some(BoundaryCondition::Periodic(_)));
        let (periodic_x, periodic_y) = (
            is_periodic("left") || is_periodic("right"),
            is_periodic("bottom") || is_periodic("top"),
        );
        match self.domain {
            DomainSpec::Mesh(_) | DomainSpec::Surface(_) => {
                let [min, max] = self.extent().in_plane().map(Into::into);
                let [periodic_x, periodic_y, _] = self.periodic_axes();
                Domain::Box { min, max, periodic_x, periodic_y }
            }
            DomainSpec::Box { .. } | DomainSpec::Channel { .. } => {
                let [min, max] = self.extent().in_plane();
                Domain::Box { min: min.into(), max: max.into(), periodic_x, periodic_y }
            }
            DomainSpec::Sphere { center: [x, y, _], radius } => {
                Domain::Disc { center: [x, y].into(), radius }
            }
            DomainSpec::Disc { center, radius } => Domain::Disc { center: center.into(), radius },
            DomainSpec::HalfDisc { center, radius } => Domain::HalfDisc { center, radius },
            DomainSpec::Cylinder { x, radius } => Domain::Cylinder { x, radius, periodic_x },
        }
    }
}

/// Angle by which an outline turns along one edge at most (rad), however large its size.
const LARGEST_TURN: f64 = 0.5;

impl Case {
    /// The wanted cell sizes.
    #[must_use]
    pub fn sizing<const D: usize>(&self) -> Sizing<D> {
        let mesh = &self.mesh;
        // `check` makes sure that there is a number for each dimension
        let corner = |given: &[f64]| {
            Point::<D>::from_fn(|axis, _| given.get(axis).copied().unwrap_or(f64::NAN))
        };
        let boxes = mesh.boxes.iter().map(|refined| SizeBox {
            min: corner(&refined.min),
            max: corner(&refined.max),
            size: refined.size * mesh.scale,
        });
        Sizing {
            size: mesh.size * mesh.scale,
            surface: mesh.surface.unwrap_or(mesh.size) * mesh.scale,
            sides: mesh
                .sides
                .iter()
                .map(|(name, size)| (name.clone(), size * mesh.scale))
                .collect(),
            // A finer mesh has the same shape: more layers in gaps, slower growth
            growth: mesh.growth * mesh.scale,
            gap_layers: mesh.layers_when_new(),
            turn: LARGEST_TURN * mesh.scale,
            boxes: boxes.collect(),
            curved: mesh.curved,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Case;

    /// A parabola has its largest value at a plane of symmetry, and none where there are no walls.
    #[test]
    fn the_walls_of_a_channel_are_behind_its_planes_of_symmetry() {
        let text = "title = 't'
geometry = 'spatial'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [0.0, 0.0, 1.0], max = [4.0, 2.0, 2.0] }
boundary = { left = { parabolic = { peak = 1.0 } }, right = 'do-nothing', bottom = 'no-slip', \
             top = 'no-slip', back = 'no-slip', front = 'symmetry' }
mesh = { size = 0.3 }
time = { steady = {} }
";
        let across = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|&one| one.to_owned()).collect();
            Case::parse("t.toml", text, &settings).unwrap().model.case.walls_across()
        };
        assert_eq!(across(&[])[1..], [Some([0.0, 2.0]), Some([1.0, 3.0])]);
        let back = "boundary.back='symmetry'";
        assert_eq!(across(&[back])[2], None);
        assert_eq!(across(&[back, "boundary.front='no-slip'"])[2], Some([0.0, 2.0]));
        let pair = ["boundary.back={ periodic = 'front' }", "boundary.front={ periodic = 'back' }"];
        assert_eq!(across(&pair)[2], None);
    }
}
