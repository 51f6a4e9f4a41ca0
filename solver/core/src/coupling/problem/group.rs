//! `Group`: bodies that are reported as one, such as those of a swimmer.

/// Bodies that are reported as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name.
    pub name: String,
    /// Its bodies; the angle of the first is reported as that of all.
    pub bodies: Vec<usize>,
    /// Time of one cycle (s).
    pub period: Option<f64>,
    /// Force per velocity that drags it when towed (N s/m).
    pub resistance: Option<f64>,
}
