//! The shipped vehicle: speeds at full power, ballast, thrusters.

use super::{last, run};

#[test]
fn it_reaches_its_terminal_speeds() {
    let expected = [
        ("", "velocity.x", 0.7294),
        ("/sway", "velocity.y", 0.6259),
        ("/heave", "velocity.z", 0.7126),
        ("/roll", "angular_velocity.x", 4.674),
        ("/pitch", "angular_velocity.y", 4.673),
        ("/yaw", "angular_velocity.z", 3.830),
    ];
    for (variant, quantity, expected) in expected {
        let series = run(&format!("underwater-vehicle{variant}"), &[]);
        let found = last(&series, &format!("vehicle.{quantity}"));
        assert!((found / expected - 1.0).abs() < 1e-3, "{variant}: {found} {expected}");
    }
}

/// 33 w + 190 w^2 is the weight of 0.1 and 0.7 kg more than is displaced.
#[test]
fn ballast_weighs_and_displaces_nothing() {
    for (variant, surplus) in [("afloat", 0.1), ("ballast", 0.7)] {
        let series = run(&format!("underwater-vehicle/{variant}"), &[]);
        let speed = ((33.0_f64.powi(2) + 760.0 * surplus * 9.82).sqrt() - 33.0) / 380.0;
        let found = last(&series, "vehicle.velocity.z");
        assert!((found / -speed - 1.0).abs() < 1e-4, "{variant}: {found} {speed}");
    }
    // The centre of buoyancy is above that of mass: tilted, it comes upright
    let tilted = "body.0.orientation.turned={ axis = [1, 0, 0], angle = 1.0 }";
    let series = run("underwater-vehicle/afloat", &[tilted, "time.unsteady.end=60"]);
    assert!(last(&series, "vehicle.orientation.w").abs() > 0.99, "it stays tilted");
}

/// 13.7 u + 141 u^2 is what four thrusters give at 45 degrees; after a few times 0.01 s the lag is over.
#[test]
fn thrusters_drive_it_by_their_curve_after_their_lag() {
    let curve = [8.9, 176.0, -404.1, 389.9, -140.3];
    let force: f64 = (0..5).map(|k| curve[k] * 0.5_f64.powi(2 * k as i32 + 1)).sum();
    let thrust = 4.0 * force * std::f64::consts::FRAC_1_SQRT_2;
    let speed = ((13.7_f64.powi(2) + 564.0 * thrust).sqrt() - 13.7) / 282.0;
    let series = run("underwater-vehicle/thrusters", &[]);
    let found = last(&series, "vehicle.velocity.x");
    assert!((found / speed - 1.0).abs() < 1e-6, "{found} {speed}");
    // Momentum that the lag has cost: the thrust times the mean delay a_1/a_0 - b_1/b_0
    let fine = ["time.unsteady.step=1e-4", "time.unsteady.end=1.0"];
    let no_drag = "reduced.coefficients={ added_mass_surge = 6.36 }";
    let series = run("underwater-vehicle/thrusters", &[fine[0], fine[1], no_drag]);
    let delay = (9258.0 - 6136.0) / 108_700.0;
    let expected = thrust * (1.0 - delay) / (13.5 + 6.36);
    let found = last(&series, "vehicle.velocity.x");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn a_thruster_follows_a_recording() {
    let thruster = "reduced.thruster=[{ name = 'aft', body = 'vehicle', direction = [2.0, 0.0, 0.0], \
                    curve = [10.0], drive.command = { filter = 0.05, limits = [-1, 1] } }]";
    let rest = "body.0.force=[0.0, 0.0, 0.0]";
    let file = super::read("underwater-vehicle", &[thruster, rest]);
    assert_eq!(file.model.commands.names(), ["thruster.aft"]);
    let asked = alewife::case::Asked { time: 0.0, command: "thruster.aft".to_owned(), target: 2.0 };
    file.model.commands.ask(&asked).unwrap();
    let series = alewife::reduced::simulate(&file.model).unwrap();
    // 13.7 u + 141 u^2 = 10 N: what is asked for beyond a limit is cut
    let speed = ((13.7_f64.powi(2) + 5640.0).sqrt() - 13.7) / 282.0;
    let found = last(&series, "vehicle.velocity.x");
    assert!((found / speed - 1.0).abs() < 1e-3, "{found} {speed}");
}
