//! `Vehicle`: an underwater vehicle with added masses, linear and quadratic damping on its axes.

use nalgebra::Vector3;

use super::Resistance;
use crate::tree::spatial::{Number, Symmetric, Twist, Wrench};

/// A vehicle in the model of Fossen (Handbook of Marine Craft Hydrodynamics and Motion Control, chapter 6): six
/// added masses A, linear and quadratic damping d and D on the axes of its frame, so that the load of the
/// velocities v, three along and three about, is
///
/// ```text
/// -A v' - C_A(v) v - (d + D |v|) v
/// ```
///
/// axis by axis but for the forces `C_A`(v) v of the momentum that turns with it. Restoring loads are `Weight`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle<T: Number> {
    /// Added masses along (kg) and about (kg m2) the axes.
    pub added: [T; 6],
    /// Force per velocity along (N s/m) and torque per rate about (N m s) the axes.
    pub linear: [T; 6],
    /// Force per velocity squared along (N s2/m2) and torque per rate squared about (N m s2) the axes.
    pub quadratic: [T; 6],
}

/// Three numbers of six: those along the axes, or about them.
fn half<T: Number>(six: &[T; 6], from: usize) -> Vector3<T> {
    Vector3::new(six[from], six[from + 1], six[from + 2])
}

impl<T: Number> Vehicle<T> {
    pub(super) fn added_mass(&self) -> Symmetric<T> {
        Symmetric::diagonal(half(&self.added, 0), half(&self.added, 3))
    }

    pub(super) fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        let load = |v: &Vector3<T>, from: usize| {
            Vector3::from_fn(|k, _| {
                -(self.linear[from + k] + self.quadratic[from + k] * v[k].abs()) * v[k]
            })
        };
        let slope = |v: &Vector3<T>, from: usize| {
            Vector3::from_fn(|k, _| {
                self.linear[from + k] + self.quadratic[from + k] * v[k].abs() * 2.0
            })
        };
        let (v, w) = (&twist.linear, &twist.angular);
        Resistance {
            wrench: Wrench { force: load(v, 0), torque: load(w, 3) },
            slope: Symmetric::diagonal(slope(v, 0), slope(w, 3)),
        }
    }
}
