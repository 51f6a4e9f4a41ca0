//! Outlines have no linear momentum, and what is reported as subtracted for that is what is subtracted.

use alewife_mesh::{GaussRule, Point, Shape};

use super::*;

/// Momentum of whatever fills the outline and keeps its volume everywhere is given by the velocity of
/// the outline along its normal, int u dA = closed integral of x (u . n), here by another quadrature.
#[test]
fn no_linear_momentum_is_left() {
    for (name, profile, midline, times) in all() {
        let swimmer = SlenderBody::new(&profile, midline).unwrap();
        let rule = GaussRule::new(9);
        for time in times {
            let now = swimmer.at(time).unwrap();
            let Some(Shape::Curve { spline }) = now.shape() else { panic!("is a curve") };
            let mut momentum = Point::<2>::zeros();
            let (mut flux, mut size) = (0.0, 0.0);
            for ends in spline.knots().windows(2) {
                let span = ends[1] - ends[0];
                for (x, weight) in rule.points.iter().zip(&rule.weights) {
                    let parameter = ends[0] + span * x;
                    let [position, along, _] = spline.evaluate(parameter);
                    let rate = now.rate(parameter);
                    let through = weight * span * (rate.x * along.y - rate.y * along.x);
                    momentum += position * through;
                    flux += through;
                    size += position.norm() * through.abs();
                }
            }
            let left = momentum.norm() / size;
            println!("{name} at {time}: linear momentum {left:.1e} of its parts");
            assert!(left < 1e-12, "{name} at {time}: {left:.1e}");
            assert!(flux.abs() * profile.length() < 1e-10 * size, "{name} at {time}");
        }
    }
}

/// What is reported as subtracted is what is subtracted, and its rates are the derivatives of its positions.
#[test]
fn the_recoil_of_a_period_is_that_of_its_times() {
    for (name, profile, midline, _) in all() {
        let [transient, period] = midline.cycle();
        let swimmer = SlenderBody::new(&profile, midline).unwrap();
        let recoil = swimmer.recoil().unwrap();
        println!("{name}: {recoil:?}");
        let at = |t: f64| swimmer.at(t).unwrap().recoil;
        let (mut speed, mut turning) = (0.0, 0.0);
        let mut far: f64 = 0.0;
        for i in 0..32 {
            // Not at the end of the ramp, where second derivatives jump
            let time = transient + period * (f64::from(i) + 0.5) / 32.0;
            let now = at(time);
            if i % 8 == 3 {
                let step = 2e-3 * period;
                let velocity = difference(|t| at(t).center, time, step);
                let off = (velocity - now.velocity).norm() / recoil.largest_speed;
                assert!(off < 1e-6, "{name}: {off:.1e}");
                let turn = difference(|t| at(t).angle, time, step);
                let off = (turn - now.angular_velocity).abs() / recoil.largest_angular_velocity;
                assert!(off < 1e-6, "{name}: {off:.1e}");
            }
            speed = f64::max(speed, now.velocity.norm());
            turning = f64::max(turning, now.angular_velocity.abs());
            let opposite = at(time + 0.5 * period);
            far = far.max((now.center - opposite.center).norm());
        }
        assert!(
            speed <= recoil.largest_speed * (1.0 + 1e-4) && speed > 0.98 * recoil.largest_speed
        );
        let most = recoil.largest_angular_velocity;
        assert!(turning <= most * (1.0 + 1e-4) && turning > 0.98 * most, "{name}");
        assert!(far <= 2.0 * recoil.translation && far > recoil.translation, "{name}");
        let turn = at(transient + period).angle - at(transient).angle;
        assert!(
            recoil.rms_speed < recoil.largest_speed && (recoil.turn - turn).abs() < 1e-9,
            "{name}"
        );
    }
}
