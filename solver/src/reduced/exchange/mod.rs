//! The reduced model of a case as a model of other programs: MJCF and URDF.

mod describe;
mod error;
mod markup;
mod mjcf;
mod read;
mod robot;
#[cfg(test)]
mod tests;
mod urdf;

pub use error::ExchangeError;
pub use read::{Imported, Remark, import};

use crate::case::Model;

/// A format of models of robots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RobotFormat {
    /// That of `MuJoCo`.
    Mjcf,
    /// That of ROS.
    Urdf,
}

/// A model as text.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The file.
    pub text: String,
    /// What of the case is not in it, or otherwise.
    pub notes: Vec<String>,
}

/// The reduced model of a case by its name, in SI units where the case is: bodies, joints, springs, dampers, motors, and
/// in MJCF tendons and the ellipsoid model of the fluid.
///
/// # Errors
/// When the case has no reduced model, or no inertia.
pub fn export(model: &Model, name: &str, format: RobotFormat) -> Result<Exported, ExchangeError> {
    let described = describe::describe(model, name)?;
    let (robot, mut notes) = (described.robot, described.notes);
    notes.extend(match format {
        RobotFormat::Mjcf => mjcf::otherwise(&robot),
        RobotFormat::Urdf => urdf::missing(&robot),
    });
    let mut remarks = vec![format!("The reduced model of {name}, by alewife export")];
    remarks.extend(notes.iter().cloned());
    let text = match format {
        RobotFormat::Mjcf => mjcf::mjcf(&robot, &remarks),
        RobotFormat::Urdf => urdf::urdf(&robot, &remarks),
    };
    Ok(Exported { text, notes })
}
