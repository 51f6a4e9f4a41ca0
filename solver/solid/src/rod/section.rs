//! `Section`: area and moments of a section of a rod, for its mass and its stiffness.

use std::f64::consts::PI;

/// A section of a rod, with d1 along its width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Section {
    /// Of a planar rod, per length out of the plane.
    Strip {
        /// Half of its thickness (m).
        half_width: f64,
    },
    /// Of a rod in space.
    Ellipse {
        /// Half of its axis along d1 (m).
        half_width: f64,
        /// Half of its axis along d2 (m).
        half_height: f64,
    },
}

impl Section {
    /// Area (m², of strips m), which times a density is the mass per length.
    #[must_use]
    pub fn area(self) -> f64 {
        match self {
            Self::Strip { half_width } => 2.0 * half_width,
            Self::Ellipse { half_width, half_height } => PI * half_width * half_height,
        }
    }

    /// Second moment (m⁴, of strips m³) for bending in the plane of t and d1, which is about d2: times Young's modulus
    /// the stiffness. Young's modulus of a strip is that of plane strain, E / (1 - nu²).
    #[must_use]
    pub fn second_moment(self) -> f64 {
        match self {
            Self::Strip { half_width } => 2.0 * half_width.powi(3) / 3.0,
            Self::Ellipse { half_width, half_height } => {
                PI * half_height * half_width.powi(3) / 4.0
            }
        }
    }

    /// The same for bending in the plane of t and d2, about d1; zero of strips, which do not.
    #[must_use]
    pub fn second_moment_across(self) -> f64 {
        match self {
            Self::Strip { .. } => 0.0,
            Self::Ellipse { half_width, half_height } => {
                Self::Ellipse { half_width: half_height, half_height: half_width }.second_moment()
            }
        }
    }

    /// Second moment (m⁴, of strips m³) that times a density is the moment of inertia per length: about d2 of strips,
    /// about the centreline of ellipses.
    #[must_use]
    pub fn turning(self) -> f64 {
        self.second_moment() + self.second_moment_across()
    }

    /// Torsion constant (m⁴), which times the shear modulus is the stiffness in twist (Saint-Venant's ellipse); zero of
    /// strips.
    #[must_use]
    pub fn torsion(self) -> f64 {
        match self {
            Self::Strip { .. } => 0.0,
            Self::Ellipse { half_width: a, half_height: b } => {
                PI * (a * b).powi(3) / (a * a + b * b)
            }
        }
    }
}
