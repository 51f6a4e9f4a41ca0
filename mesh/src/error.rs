//! `MeshError`: every way a mesh can be refused, with the numbers and a remedy.

use alewife_interrupt::Stopped;
use thiserror::Error;

use crate::CellId;

/// Why a domain with its bodies cannot be meshed, or why a mesh is not one.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// It was asked to end ([`alewife_interrupt`]).
    #[error("meshing was asked to end")]
    Stopped,
    /// A size of the domain is zero, negative or not finite.
    #[error("domain: {what} = {value:e} must be positive and finite")]
    Domain {
        /// Which size.
        what: &'static str,
        /// Its value (m).
        value: f64,
    },
    /// An entry of the sizing is out of range.
    #[error("sizing: {what} = {value:e} is out of range: it must be {wanted}")]
    Sizing {
        /// Which entry.
        what: String,
        /// Its value.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A size is asked on a side the domain does not have.
    #[error("sizing.sides: there is no side \"{name}\"; this domain has {sides:?}")]
    UnknownSide {
        /// The name asked for.
        name: String,
        /// The names of the domain.
        sides: Vec<String>,
    },
    /// Two boundaries would carry the same name.
    #[error(
        "two boundaries are named \"{name}\": give every body its own name, not that of a side"
    )]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A length of a body is zero, negative or not finite.
    #[error("body \"{body}\": {what} = {value:e} must be {wanted}")]
    Body {
        /// Name of the body.
        body: String,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A planar shape in an axisymmetric domain, or the other way round.
    #[error("body \"{body}\": {shape} does not fit {domain} domain: use {remedy}")]
    ShapeKind {
        /// Name of the body.
        body: String,
        /// What it is.
        shape: &'static str,
        /// What the domain is, with its article.
        domain: &'static str,
        /// What may stand there.
        remedy: &'static str,
    },
    /// A body of an axisymmetric domain is not centred on the axis, or turned away from it.
    #[error(
        "body \"{body}\": centre y = {y:e}, angle = {angle:e}; in an axisymmetric domain both must \
         be 0"
    )]
    OffAxis {
        /// Name of the body.
        body: String,
        /// Distance of its centre from the axis (m).
        y: f64,
        /// Its angle (rad).
        angle: f64,
    },
    /// A body touches or crosses the boundary of the domain.
    #[error(
        "body \"{body}\" touches or leaves the domain at ({x:.6e}, {y:.6e}): gap {gap:.3e}; move it \
         inward or enlarge the domain"
    )]
    Outside {
        /// Name of the body.
        body: String,
        /// Smallest signed gap to the boundary of the domain (m).
        gap: f64,
        /// Where, x (m).
        x: f64,
        /// Where, y (m).
        y: f64,
    },
    /// Two bodies touch or overlap.
    #[error(
        "bodies \"{first}\" and \"{second}\" touch or overlap at ({x:.6e}, {y:.6e}): gap {gap:.3e}; \
         move them apart"
    )]
    Overlap {
        /// Name of the first body.
        first: String,
        /// Name of the second body.
        second: String,
        /// Smallest signed gap (m).
        gap: f64,
        /// Where, x (m).
        x: f64,
        /// Where, y (m).
        y: f64,
    },
    /// An outline crosses itself.
    #[error(
        "body \"{body}\": the outline crosses itself near ({x:.6e}, {y:.6e}); reorder its points or \
         add some there"
    )]
    SelfIntersection {
        /// Name of the body.
        body: String,
        /// Where, x (m).
        x: f64,
        /// Where, y (m).
        y: f64,
    },
    /// The size field asks for more cells than can be meant.
    #[error(
        "the cell sizes ask for more than {limit} {what} (the smallest size is {smallest:.3e}): raise \
         mesh.surface, mesh.size or mesh.growth, lower mesh.gap_layers, or widen the smallest gap"
    )]
    TooManyCells {
        /// Of what.
        what: &'static str,
        /// How many are allowed.
        limit: usize,
        /// Smallest size on the boundary (m).
        smallest: f64,
    },
    /// The triangulation does not contain the boundary.
    #[error(
        "the boundary could not be triangulated near ({x:.6e}, {y:.6e}): {reason}; lower \
         mesh.surface there"
    )]
    Boundary {
        /// Where, x (m).
        x: f64,
        /// Where, y (m).
        y: f64,
        /// What went wrong.
        reason: &'static str,
    },
    /// A cell at a curved boundary is folded and could not be repaired.
    #[error(
        "cell {cell} at ({x:.6e}, {y:.6e}) is folded by its curved side: smallest det J coefficient \
         {det_jacobian:.2e}; lower mesh.surface or set mesh.curved = false"
    )]
    FoldedCell {
        /// The cell.
        cell: CellId,
        /// Smallest Bezier coefficient of det J (m^2).
        det_jacobian: f64,
        /// Centre of the cell, x (m).
        x: f64,
        /// Centre of the cell, y (m).
        y: f64,
    },
    /// A body in space touches or crosses a side of the domain.
    #[error(
        "body \"{body}\" touches or crosses side \"{side}\" at {}: gap {gap:.3e}; move it inward, \
         enlarge the domain, or make the side a plane of symmetry", place(.at)
    )]
    BodyMeetsSide {
        /// Name of the body.
        body: String,
        /// Name of the side.
        side: Box<str>,
        /// Smallest signed gap (m).
        gap: f64,
        /// Where (m).
        at: [f64; 3],
    },
    /// Two bodies in space touch or overlap.
    #[error(
        "bodies \"{first}\" and \"{second}\" touch or overlap at {}: gap {gap:.3e}; move them apart",
        place(.at)
    )]
    BodiesMeet {
        /// Name of the first body.
        first: String,
        /// Name of the second body.
        second: String,
        /// Smallest signed gap (m).
        gap: f64,
        /// Where (m).
        at: [f64; 3],
    },
    /// A body meets its own image in a periodic box.
    #[error(
        "body \"{body}\" touches or overlaps its own image one period away, at {}: gap {gap:.3e}",
        place(.at)
    )]
    BodyMeetsImage {
        /// Name of the body.
        body: String,
        /// Smallest signed gap (m).
        gap: f64,
        /// Where (m).
        at: [f64; 3],
    },
    /// A cylinder without ends touches a periodic side or crosses it.
    #[error(
        "the cylinder \"{body}\" touches or crosses the periodic side \"{side}\" at {}: gap \
         {gap:.3e}; cylinders without ends stay inside of periodic sides", place(.at)
    )]
    BodyMeetsPeriodicSide {
        /// Name of the body.
        body: String,
        /// Name of the side.
        side: Box<str>,
        /// Smallest signed gap (m).
        gap: f64,
        /// Where (m).
        at: [f64; 3],
    },
    /// No mesh of tetrahedra with good cells was found.
    #[error(
        "no good tetrahedra near {}: {reason} ({value:.3e}); lower mesh.surface or raise \
         mesh.gap_layers there", place(.at)
    )]
    PoorTetrahedra {
        /// What is poor.
        reason: &'static str,
        /// Its value.
        value: f64,
        /// Where (m).
        at: [f64; 3],
    },
    /// A mesh breaks one of its invariants.
    #[error("mesh: {what} (cell or node {index})")]
    Invariant {
        /// Which one.
        what: &'static str,
        /// Where.
        index: usize,
    },
}

impl From<Stopped> for MeshError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

/// Coordinates in brackets.
fn place(at: &[f64; 3]) -> String {
    let [x, y, z] = at;
    format!("({x:.6e}, {y:.6e}, {z:.6e})")
}
