//! `SurfaceFault`: why a file or its triangles are no closed surface, and where.

use thiserror::Error;

/// Why triangles do not enclose a body.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SurfaceFault {
    /// A file of no kind that is read.
    #[error(
        "it is no STL, OBJ or PLY file: it starts with neither \"solid\" nor \"ply\", has no line \"v x y z\", \
         and its length is that of no binary STL"
    )]
    Kind,
    /// A file that breaks off, or says what cannot be.
    #[error("{place}: {found}")]
    File {
        /// Line or byte.
        place: String,
        /// What is there.
        found: String,
    },
    /// No triangles, or more than can be meant.
    #[error("it has {n} triangles; a body has 4 or more, and at most {}", MOST_TRIANGLES)]
    Count {
        /// How many.
        n: usize,
    },
    /// A coordinate is no finite number.
    #[error("vertex {vertex} is not at finite coordinates")]
    NotFinite {
        /// Its number, from 0.
        vertex: usize,
    },
    /// A triangle without area.
    #[error("{n} triangles have no area, the first at {}", place(.at))]
    Flat {
        /// How many.
        n: usize,
        /// Where one of them is.
        at: [f64; 3],
    },
    /// Edges with a triangle on one side only.
    #[error("{n} edges are open, with a triangle on one side only, the first at {}", place(.at))]
    Open {
        /// How many.
        n: usize,
        /// The middle of one of them.
        at: [f64; 3],
    },
    /// Edges at which two triangles are seen from different sides.
    #[error("at {n} edges a triangle is turned inside out against its neighbour, the first at {}", place(.at))]
    Flipped {
        /// How many.
        n: usize,
        /// The middle of one of them.
        at: [f64; 3],
    },
    /// Edges or vertices at which more than one sheet meets.
    #[error("at {n} edges or vertices several sheets of the surface meet, the first at {}", place(.at))]
    Branched {
        /// How many.
        n: usize,
        /// Where one of them is.
        at: [f64; 3],
    },
    /// Several shells.
    #[error("it has {n} shells, which do not hang together; the second has a vertex at {}", place(.at))]
    Shells {
        /// How many.
        n: usize,
        /// A vertex of the second.
        at: [f64; 3],
    },
    /// All triangles are seen from inside.
    #[error(
        "it is inside out: its triangles run clockwise as seen from outside, and enclose {volume:.4e}"
    )]
    InsideOut {
        /// Volume with its sign (m3).
        volume: f64,
    },
    /// Triangles go through each other.
    #[error("triangles {first} and {second} go through each other at {}", place(.at))]
    Crossing {
        /// Number of the one, from 0.
        first: usize,
        /// Number of the other.
        second: usize,
        /// Where.
        at: [f64; 3],
    },
    /// An edge that is too sharp.
    #[error(
        "at {n} edges the surface turns by more than {limit} degrees, most at {}, by {angle:.0} degrees",
        place(.at)
    )]
    Crease {
        /// How many.
        n: usize,
        /// Largest angle (degrees).
        angle: f64,
        /// Limit (degrees).
        limit: f64,
        /// The middle of the sharpest.
        at: [f64; 3],
    },
}

/// Most triangles of a surface.
const MOST_TRIANGLES: usize = 2_000_000;

impl SurfaceFault {
    /// What can be done about it.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Kind => "give a file of triangles: STL as text or binary, OBJ or PLY",
            Self::File { .. } | Self::NotFinite { .. } => "export it again",
            Self::Count { .. } => "export the surface of a solid, as fine as the cells are to be",
            Self::Flat { .. } | Self::Open { .. } => {
                "`alewife surface FILE --repair OUT.stl` welds vertices that are close to each other and \
                 drops triangles without area; holes are to be closed where the surface was made"
            }
            Self::Flipped { .. } | Self::InsideOut { .. } => {
                "`alewife surface FILE --repair OUT.stl` turns all triangles outwards"
            }
            Self::Branched { .. } | Self::Crossing { .. } => {
                "unite the solids where the surface was made, so that one surface is left"
            }
            Self::Shells { .. } => {
                "write each shell to a file of its own, for a body each; a hollow is no part of a body"
            }
            Self::Crease { .. } => {
                "round sharp edges where the surface was made, with two or more triangles across the \
                 rounding, or let them be rounded over the triangles beside them by smooth = 180"
            }
        }
    }
}

/// Whether there are no more triangles than can be meant.
pub fn at_most(n: usize) -> Result<(), SurfaceFault> {
    if n > MOST_TRIANGLES { Err(SurfaceFault::Count { n }) } else { Ok(()) }
}

/// Coordinates in brackets.
fn place(at: &[f64; 3]) -> String {
    let [x, y, z] = at;
    format!("({x:.6}, {y:.6}, {z:.6})")
}
