//! `SolidError`: what is wrong with a solid, or why a state of it could not be found.

use thiserror::Error;

use crate::material::MaterialError;

/// Why a solid cannot be made or moved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SolidError {
    /// A material is none.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A cell has no volume, or names nodes that do not exist.
    #[error("cell {0} has no volume, or nodes that the mesh does not have")]
    Cell(usize),
    /// Something refers to a cell, node or material that does not exist.
    #[error("{what} {number} does not exist: there are {count}")]
    Missing {
        /// What it is.
        what: &'static str,
        /// Its number.
        number: usize,
        /// How many there are.
        count: usize,
    },
    /// The frame does not suit the dimension of the mesh.
    #[error("a mesh in {0} dimensions is used in the plane or around an axis (2), or in space (3)")]
    Frame(usize),
    /// A fibre has no direction.
    #[error("the fibres of cell {0} have no direction")]
    Direction(usize),
    /// No node can move.
    #[error("all nodes are held: nothing can move")]
    AllHeld,
    /// A list has not one number for each unknown, or each set of fibres.
    #[error("{what}: {found} numbers where {expected} are needed")]
    Length {
        /// What the list is.
        what: &'static str,
        /// Numbers it has.
        found: usize,
        /// Numbers it should have.
        expected: usize,
    },
    /// A cell is turned over in the state a search starts from.
    #[error("cell {0} is turned over: a shorter step or a softer start may help")]
    TurnedOver(usize),
    /// Newton's method ended without an equilibrium.
    #[error(
        "no equilibrium after {iterations} iterations: a residual of {residual:.2e} of {scale:.2e} is left; \
         shorter steps may help"
    )]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// Norm of the residual (N).
        residual: f64,
        /// Norm of the forces it is small against (N).
        scale: f64,
    },
    /// A step that keeps the energy is asked for a body that loses it.
    #[error("a conservative step has no damping: use a backward difference, or a viscosity of 0")]
    Damped,
    /// Cells with one strain each cannot keep their volume.
    #[error(
        "linear cells cannot bend where each keeps its volume: use quadratic ones, or a Poisson's ratio below 0.5"
    )]
    LinearVolume,
    /// A step that keeps the energy is asked for a body that keeps its volume.
    #[error(
        "a conservative step has no pressures: use a backward difference, or a Poisson's ratio below 0.5"
    )]
    KeptVolume,
    /// Two rigid parts have nodes in common.
    #[error("rigid parts {} and {} touch each other: make them one, or leave cells between them", .0[0], .0[1])]
    RigidTouch([usize; 2]),
    /// A rigid part has no cells.
    #[error("rigid part {0} has no cells")]
    RigidEmpty(usize),
    /// A node of a rigid part is held.
    #[error(
        "rigid part {0} has a node that is held: it would not move freely; hold cells beside it, or let it be elastic"
    )]
    RigidHeld(usize),
    /// What cannot be had where parts are rigid.
    #[error("{0} is not known where parts are rigid")]
    Rigid(&'static str),
    /// The matrix of a linear solution is singular.
    #[error("the stiffness is singular: is the body held so that it cannot move as a rigid one?")]
    Singular,
}
