//! Vectors of a mesh of any dimension as vectors of space, and back.

use nalgebra::{SVector, Vector3};

/// A vector of the mesh in space: components it lacks are zero.
#[must_use]
pub fn in_space<const D: usize>(vector: &SVector<f64, D>) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 })
}

/// The components of a vector of space that a mesh has.
#[must_use]
pub fn on_mesh<const D: usize>(vector: &Vector3<f64>) -> SVector<f64, D> {
    SVector::from_fn(|axis, _| vector[axis])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_mesh_has_goes_there_and_back() {
        let plane = SVector::<f64, 2>::new(1.0, -2.0);
        assert_eq!(in_space(&plane), Vector3::new(1.0, -2.0, 0.0));
        assert_eq!(on_mesh::<2>(&in_space(&plane)), plane);
        let space = Vector3::new(1.0, 2.0, 3.0);
        assert_eq!(on_mesh::<3>(&in_space(&space)), space);
    }
}
