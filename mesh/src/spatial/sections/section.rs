//! `Section`: one cross-section of a body, and the points of its ellipse.

use nalgebra::SVector;

use crate::Point;

/// Midline, half width and half height of a section, each by x, y and z (m).
pub type Section = SVector<f64, 9>;

/// The point of a section at an angle (rad).
#[must_use]
pub fn on_section(section: &Section, around: f64) -> Point<3> {
    let (sin, cos) = around.sin_cos();
    let [middle, width, height] = parts_of(section);
    middle + width * cos + height * sin
}

/// Its derivative by the angle.
#[must_use]
pub fn along_section(section: &Section, around: f64) -> Point<3> {
    let (sin, cos) = around.sin_cos();
    let [_, width, height] = parts_of(section);
    height * cos - width * sin
}

/// Midline, half width and half height of a section (m).
#[must_use]
pub fn parts_of(section: &Section) -> [Point<3>; 3] {
    [0, 3, 6].map(|first| section.fixed_rows::<3>(first).into_owned())
}

/// Midline (x, y), half width (x, y) and half height (m) of a section whose midline is in the plane z = 0.
#[must_use]
pub fn in_plane(section: &Section) -> [f64; 5] {
    [0, 1, 3, 4, 8].map(|i| section[i])
}

/// A section of its parts.
pub fn section(middle: Point<3>, width: Point<3>, height: Point<3>) -> Section {
    let parts = [middle, width, height];
    Section::from_fn(|i, _| parts[i / 3][i % 3])
}
