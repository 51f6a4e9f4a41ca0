//! What motors do to joints: springs, dampers, efforts on command, servos.

use crate::reduced::exchange::robot::{MotorLaw, Robot};

/// What acts on a joint besides its own spring and damper.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Drive {
    /// Springs and dampers of motors, and what these are told.
    pub stiffness: f64,
    pub damping: f64,
    pub effort: Option<Effort>,
    pub servo: Option<Servo>,
}

/// A motor of an effort.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    pub start: f64,
    pub limits: Option<[f64; 2]>,
}

/// A motor of a rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Servo {
    pub rate: f64,
    pub gain: f64,
    pub limit: Option<f64>,
}

/// What motors do to the joint of each body.
pub(super) fn drives(robot: &Robot) -> Vec<Drive> {
    let mut drives = vec![Drive::default(); robot.bodies.len()];
    let alone = |body: usize| robot.motors.iter().filter(|one| one.joint.body == body).count() == 1;
    for motor in &robot.motors {
        let drive = &mut drives[motor.joint.body];
        let factor = match motor.law {
            MotorLaw::Effort => 1.0,
            MotorLaw::Place { gain } => {
                drive.stiffness += gain;
                gain
            }
            MotorLaw::Rate { gain, limit } if alone(motor.joint.body) => {
                drive.servo = Some(Servo { rate: motor.control, gain, limit });
                continue;
            }
            MotorLaw::Rate { gain, .. } => {
                drive.damping += gain;
                gain
            }
        };
        let limits = motor.limits.map(|[a, b]| [a * factor, b * factor]);
        drive.effort = Some(match drive.effort {
            None => Effort { start: motor.control * factor, limits },
            Some(other) => Effort {
                start: other.start + motor.control * factor,
                limits: other.limits.zip(limits).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]),
            },
        });
    }
    drives
}
