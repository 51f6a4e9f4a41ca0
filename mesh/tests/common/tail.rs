//! A head with a tail along which a wave runs, as flagellated swimmers of cases are.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use alewife_mesh::spatial::{Body, SectionHeight, Sections, Shape, Slender};
use alewife_mesh::{FlagellateForm, Point, Profile, Spline};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Amplitude at the end of the tail (m).
const AMPLITUDE: f64 = 2.0;

/// Wavelength along the axis (m).
const WAVELENGTH: f64 = 20.0;

/// Steps along the midline between two stations.
const STEPS: u32 = 8;

/// A place of the midline and its slope dy/dx, by the distance from the head along x (m).
fn midline(tail: f64, x: f64, phase: f64) -> [f64; 2] {
    let wave = |x: f64| {
        let joint = 1.0 - (-(x / (0.05 * tail)).powi(3)).exp();
        AMPLITUDE * x / tail * joint * (TAU * (x / WAVELENGTH - phase)).sin()
    };
    let step = 1e-5 * tail;
    if x <= 0.0 {
        return [0.0; 2];
    }
    [wave(x), (wave(x + step) - wave(x - step)) / (2.0 * step)]
}

/// The swimmer of the case `sperm-3d`, of which the tail is 50 long and 0.2 thick, with a tail of some length and
/// thickness (m) at a phase of its beat, the head at 18 and ahead along -x.
pub fn flagellate([length, thickness]: [f64; 2], phase: f64) -> Body {
    let form =
        FlagellateForm { head: [2.0, 1.0], tail_length: length, thickness, fillet: thickness };
    let profile = Profile::flagellate(&form).expect("it is a profile");
    let stations = profile.stations();
    let (mut x, mut along) = (0.0, 0.0);
    let mut upper = Vec::new();
    let mut lower = Vec::new();
    for station in &stations {
        let step = (station.along - along) / f64::from(STEPS);
        for _ in 0..STEPS {
            let [_, slope] = midline(form.tail_length, x - 2.0 * form.head[0], phase);
            x += step / slope.hypot(1.0);
        }
        along = station.along;
        let [y, slope] = midline(form.tail_length, x - 2.0 * form.head[0], phase);
        let side = Point::<2>::new(-slope, 1.0) * (station.half_width / slope.hypot(1.0));
        upper.push([x + side.x, y + side.y]);
        lower.push([x - side.x, y - side.y]);
    }
    let last = stations.len() - 1;
    let back = lower[1..last].iter().rev();
    let points: Vec<[f64; 2]> = upper.iter().chain(back).map(|[x, y]| [-x, *y]).collect();
    let rest = profile.spline().expect("it is an outline");
    let outline = Spline::with_knots(&points, rest.knots()).expect("it is bent");
    let heights = SectionHeight::Round.along(&profile);
    let sections = Sections::new(&outline, &heights).expect("they are sections");
    let shape = Shape::Slender(Arc::new(Slender::new(sections)));
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI);
    Body::new("sperm", shape, Isometry3::from_parts([16.0, 0.0, 0.0].into(), turn))
}
