//! Gaits with strokes in their midline, which are asked for while a run goes on.

use super::*;
use crate::case::{Command, Stroke};

fn with_strokes(beat: Stroke, bend: Stroke) -> SlenderBody {
    let Midline::Carangiform(Carangiform { length, gait }) = carangiform() else {
        panic!("is carangiform")
    };
    let gait = CarangiformGait { beat: Some(beat), bend: Some(bend), ..gait };
    SlenderBody::new(&fish(), Midline::Carangiform(Carangiform { length, gait })).unwrap()
}

/// The angle from intervals that grow is that of a ramp and a period.
#[test]
fn strokes_that_do_nothing_leave_the_gait_as_it_is() {
    let plain = SlenderBody::new(&fish(), carangiform()).unwrap();
    let same = with_strokes(Stroke::Constant(1.0), Stroke::Constant(0.0));
    for time in [0.3, 0.97, 2.1, 3.6] {
        let [plain, same] = [&plain, &same].map(|body| body.at(time).unwrap().recoil.angle);
        assert!((plain - same).abs() < 1e-11, "{time}: {plain} {same}");
    }
}

#[test]
fn what_is_asked_for_moves_the_body_without_momentum_and_leaves_the_past() {
    let bend = Command::new(0.0, Some([-0.8, 0.8]), Some(20.0), 0.05);
    let beat = Command::new(0.5, Some([0.0, 1.2]), None, 0.1);
    let strokes = || [&beat, &bend].map(|one| Stroke::Command(one.clone()));
    let [of_beat, of_bend] = strokes();
    let body = with_strokes(of_beat, of_bend);
    // Beyond what is known
    let _ = body.at(3.0).unwrap();
    let mut past: Vec<(f64, u64)> = Vec::new();
    for (nth, (asked, target)) in [(0.0, 0.6), (0.4, -0.8), (0.45, 0.3)].into_iter().enumerate() {
        bend.ask(asked, target);
        beat.ask(asked, 1.2 - target);
        let next = [0.4, 0.45, 1.2][nth];
        for part in [0.3, 0.6, 0.9] {
            let time = asked + part * (next - asked);
            let now = body.at(time).unwrap();
            let step = 1e-5;
            let [before, after] = [-step, step].map(|step| body.at(time + step).unwrap());
            for parameter in [0.1, 1.3, 2.7] {
                let slope = (after.position(parameter) - before.position(parameter)) / (2.0 * step);
                let off = (slope - now.rate(parameter)).norm();
                assert!(off < 1e-6, "{time} {parameter}: {off:.1e}");
            }
            let turn = (after.recoil.angle - before.recoil.angle) / (2.0 * step);
            assert!((turn - now.recoil.angular_velocity).abs() < 1e-6, "{time}: {turn}");
            past.push((time, now.recoil.angle.to_bits()));
        }
    }
    // The same from a body that is made with all of it, as where a run resumes
    let [of_beat, of_bend] = strokes();
    let again = with_strokes(of_beat, of_bend);
    for (time, angle) in past {
        for body in [&body, &again] {
            assert_eq!(body.at(time).unwrap().recoil.angle.to_bits(), angle, "{time}");
        }
    }
}
