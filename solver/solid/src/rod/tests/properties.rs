//! What makes no rod, and numbers along one.

use super::common::{assert_near, unit};
use crate::rod::{Along, Flexure, PlanarProperties, PlanarRod, RodError, RodProperties, Section};

fn refused(rod: RodProperties, stiffness: Along) -> RodError {
    let bending = Flexure::passive(stiffness);
    PlanarRod::new(PlanarProperties { rod, bending }).expect_err("there is no such rod")
}

#[test]
fn rods_without_size_stiffness_or_sense_are_refused() {
    let stiff = Along::Constant(1.0);
    let size = refused(RodProperties { elements: 0, ..unit(2) }, stiff.clone());
    assert_eq!(size, RodError::Size { length: 1.0, elements: 0 });
    refused(RodProperties { length: f64::NAN, ..unit(2) }, stiff.clone());
    refused(RodProperties { stretching: -1.0, ..unit(2) }, stiff.clone());
    refused(RodProperties { damping: f64::INFINITY, ..unit(2) }, stiff.clone());
    refused(RodProperties { mass: Along::Constant(-1.0), ..unit(2) }, stiff);
    let soft = refused(unit(2), Along::Table(vec![[0.0, 1.0], [1.0, -1.0]]));
    let message = soft.to_string();
    assert!(message.contains("bending") && message.contains("along"), "{message}");
}

#[test]
fn tables_are_linear_between_rows_and_constant_outside() {
    let table = Along::Table(vec![[0.2, 1.0], [0.6, 3.0]]);
    for (along, value) in [(0.0, 1.0), (0.2, 1.0), (0.3, 1.5), (0.6, 3.0), (1.0, 3.0)] {
        assert!((table.at(along) - value).abs() < 1e-14, "{along}: {}", table.at(along));
    }
}

#[test]
fn moments_of_sections_are_their_integrals() {
    const N: u32 = 400;
    let (a, b) = (0.3, 0.2);
    let ellipse = Section::Ellipse { half_width: a, half_height: b };
    let (mut area, mut about_second, mut about_first) = (0.0, 0.0, 0.0);
    let middle = |i: u32| (f64::from(i) + 0.5) * 2.0 / f64::from(N) - 1.0;
    for i in 0..N {
        let x = a * middle(i);
        let height = 2.0 * b * (1.0 - middle(i).powi(2)).sqrt();
        let width = 2.0 * a / f64::from(N);
        area += width * height;
        about_second += width * height * x * x;
        about_first += width * height.powi(3) / 12.0;
    }
    assert_near(ellipse.area(), area, 1e-3);
    assert_near(ellipse.second_moment(), about_second, 1e-3);
    assert_near(ellipse.second_moment_across(), about_first, 1e-3);
    assert_near(ellipse.turning(), about_first + about_second, 1e-3);
    let round = Section::Ellipse { half_width: a, half_height: a };
    assert_near(round.torsion(), 2.0 * round.second_moment(), 1e-12);
    let strip = Section::Strip { half_width: a };
    assert_near(strip.second_moment(), strip.area().powi(3) / 12.0, 1e-12);
}
