//! Stresses and tangents against dual numbers and differences of the energies.

use nalgebra::Vector3;
use num_dual::{Dual64, DualNum, HyperDual64};

use super::*;

const LAWS: [Law; 4] =
    [Law::SaintVenantKirchhoff, Law::NeoHookean, Law::Corotated, Law::CorotatedVolume];

const LAME: Lame = Lame { shear: 1.3, volume: 4.1 };

const STRETCHES: [[f64; 3]; 4] =
    [[1.2, 0.9, 1.05], [0.7, 1.4, 0.8], [1.0, 1.0, 1.0], [1.3, 1.3, 1.1]];

fn deformation() -> Tensor {
    Tensor::new(1.1, 0.3, -0.1, -0.2, 0.9, 0.15, 0.05, 0.1, 1.2)
}

fn energy<T: DualNum<Primitive = f64> + Copy>(law: Law, stretches: [T; 3]) -> T {
    let [shear, volume] = law.energies(stretches);
    shear * LAME.shear + volume * LAME.volume
}

#[test]
fn stresses_are_derivatives_of_the_energy_by_the_stretches() {
    for law in LAWS {
        for stretches in STRETCHES {
            let [shear, volume] = law.first_order(stretches).stresses;
            for i in 0..3 {
                let dual = std::array::from_fn(|j| Dual64::new(stretches[j], f64::from(i == j)));
                let expected = energy(law, dual).eps;
                let found = LAME.shear * shear[i] + LAME.volume * volume[i];
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{law:?} {stretches:?} {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn moduli_are_second_derivatives_of_the_energy_by_the_stretches() {
    for law in LAWS {
        for stretches in STRETCHES {
            let moduli = law.moduli(stretches, LAME);
            let stress: Vec<f64> = (0..3)
                .map(|i| {
                    energy(
                        law,
                        std::array::from_fn(|j| Dual64::new(stretches[j], f64::from(i == j))),
                    )
                    .eps
                })
                .collect();
            for i in 0..3 {
                for j in 0..3 {
                    let dual = std::array::from_fn(|k| {
                        HyperDual64::new(stretches[k], f64::from(i == k), f64::from(j == k), 0.0)
                    });
                    let expected = energy(law, dual).eps1eps2;
                    let found = moduli.stretch[(i, j)];
                    assert!(
                        (found - expected).abs() < 1e-11,
                        "{law:?} {stretches:?} {i}{j}: {found} {expected}"
                    );
                }
            }
            for (pair, [i, j]) in pairs::PAIRS.into_iter().enumerate() {
                let flip = (stress[i] + stress[j]) / (stretches[i] + stretches[j]);
                assert!((moduli.flip[pair] - flip).abs() < 1e-12, "{law:?} flip");
                let apart = stretches[i] - stretches[j];
                // Where two stretches are equal, the limit is a difference of second derivatives
                let twist = if apart == 0.0 {
                    moduli.stretch[(i, i)] - moduli.stretch[(i, j)]
                } else {
                    (stress[i] - stress[j]) / apart
                };
                assert!((moduli.twist[pair] - twist).abs() < 1e-11, "{law:?} twist");
            }
        }
    }
}

/// Central differences of a tensor by each entry of a deformation.
fn differences(of: impl Fn(&Tensor) -> Tensor, at: &Tensor) -> Tangent {
    let h = 1e-5;
    Tangent::from_fn(|row, column| {
        let (mut above, mut below) = (*at, *at);
        above[(column / 3, column % 3)] += h;
        below[(column / 3, column % 3)] -= h;
        let entry = (row / 3, row % 3);
        (of(&above)[entry] - of(&below)[entry]) / (2.0 * h)
    })
}

/// Central differences of an energy.
fn slopes(of: impl Fn(&Tensor) -> f64, at: &Tensor) -> Tensor {
    let h = 1e-5;
    Tensor::from_fn(|i, j| {
        let (mut above, mut below) = (*at, *at);
        above[(i, j)] += h;
        below[(i, j)] -= h;
        (of(&above) - of(&below)) / (2.0 * h)
    })
}

#[test]
fn stress_and_tangent_are_derivatives_by_the_deformation() {
    for law in LAWS {
        let at = deformation();
        let principal = |f: &Tensor| Principal::of(f).expect("it is not turned over");
        let stress = principal(&at).stress(law, LAME).stress;
        let energy = principal(&at).stress(law, LAME).energy;
        assert!((energy - principal(&at).energy(law, LAME)).abs() < 1e-15, "{law:?}");
        let by_energy = slopes(|f| principal(f).energy(law, LAME), &at);
        assert!((stress - by_energy).norm() < 1e-8, "{law:?}");
        let tangent = principal(&at).tangent(law, LAME, Curvature::True);
        let by_stress = differences(|f| principal(f).stress(law, LAME).stress, &at);
        assert!((tangent - by_stress).norm() < 1e-7, "{law:?} {}", (tangent - by_stress).norm());
        let [shear, volume] = principal(&at).stress_by_moduli(law);
        let sum = shear * LAME.shear + volume * LAME.volume;
        assert!((sum - stress).norm() < 1e-13, "{law:?}");
    }
}

#[test]
fn a_pressure_has_the_stress_and_tangent_of_the_volume() {
    let at = deformation();
    let principal = |f: &Tensor| Principal::of(f).expect("it is not turned over");
    assert!((principal(&at).volume() - at.determinant()).abs() < 1e-14);
    let by_volume = slopes(Tensor::determinant, &at);
    assert!((principal(&at).cofactor() - by_volume).norm() < 1e-8);
    let pressure = 0.7;
    for law in LAWS {
        let under =
            |f: &Tensor| principal(f).stress(law, LAME).stress - principal(f).cofactor() * pressure;
        let tangent = principal(&at).tangent_under(law, LAME, pressure, Curvature::True);
        assert!((tangent - differences(under, &at)).norm() < 1e-7, "{law:?}");
    }
}

#[test]
fn laws_without_a_principal_frame_agree_with_it() {
    let over = Tensor::new(1.1, 0.3, 0.0, 0.2, 0.9, 0.1, 0.0, 0.2, -0.4);
    let cases = [
        (Law::NeoHookean, deformation()),
        (Law::NeoHookean, Tensor::new(0.5, 0.1, 0.0, -0.1, 0.6, 0.0, 0.0, 0.2, 0.7)),
        (Law::SaintVenantKirchhoff, deformation()),
        (Law::SaintVenantKirchhoff, over),
    ];
    for (law, at) in cases {
        let found = Kinematics::of(law, &at).expect("it has a volume");
        assert!(matches!(found, Kinematics::Direct(_)));
        let expected = Principal::of(&at).expect("it has a volume");
        let (one, other) = (found.stress(law, LAME), expected.stress(law, LAME));
        assert!(
            (one.energy - other.energy).abs() < 1e-13 && (one.stress - other.stress).norm() < 1e-12
        );
        let moduli = found.stress_by_moduli(law).into_iter().zip(expected.stress_by_moduli(law));
        assert!(moduli.map(|(one, other)| (one - other).norm()).sum::<f64>() < 1e-12);
        assert!((found.cofactor() - expected.cofactor()).norm() < 1e-13);
        assert!((found.volume() - expected.volume()).abs() < 1e-14);
        for curvature in [Curvature::True, Curvature::Positive] {
            let plain = expected.tangent(law, LAME, curvature);
            let apart = found.tangent(law, LAME, None, curvature) - plain;
            assert!(apart.norm() < 1e-12 * plain.norm(), "{law:?} {}", apart.norm());
            let under = expected.tangent_under(law, LAME, 0.7, curvature);
            let apart = found.tangent(law, LAME, Some(0.7), curvature) - under;
            assert!(apart.norm() < 1e-12 * under.norm(), "{law:?} {}", apart.norm());
        }
    }
    let turned_over = Kinematics::of(Law::NeoHookean, &over).expect("it has a volume");
    assert!(turned_over.stress(Law::NeoHookean, LAME).energy.is_nan());
    assert!(Kinematics::of(Law::NeoHookean, &Tensor::zeros()).is_none());
    assert!(Kinematics::of(Law::NeoHookean, &Tensor::from_element(f64::NAN)).is_none());
}

#[test]
fn fibres_and_damping_have_the_stress_and_tangent_of_their_energies() {
    let at = deformation();
    let fibre = Fibre { direction: Vector3::new(0.6, 0.0, 0.8), stiffness: 3.0, target: 0.8 };
    assert!((fibre.stress(&at) - slopes(|f| fibre.energy(f), &at)).norm() < 1e-8);
    let by_stress = differences(|f| fibre.stress(f), &at);
    assert!((fibre.tangent(&at, Curvature::True).whole() - by_stress).norm() < 1e-8);
    let h = 1e-5;
    let moved = |by: f64| Fibre { target: fibre.target + by, ..fibre }.stress(&at);
    let by_target = (moved(h) - moved(-h)) / (2.0 * h);
    assert!((fibre.stress_by_target(&at) - by_target).norm() < 1e-8);
    let before = Tensor::new(0.1, 0.02, 0.0, 0.02, -0.05, 0.03, 0.0, 0.03, 0.2);
    let viscous = Viscous { stiffness: 2.0, history: before };
    assert!((viscous.stress(&at) - slopes(|f| viscous.energy(f), &at)).norm() < 1e-8);
    let by_stress = differences(|f| viscous.stress(f), &at);
    assert!((viscous.tangent(&at, Curvature::True) - by_stress).norm() < 1e-8);
}

#[test]
fn positive_tangents_are_never_negative_and_leave_positive_ones_alone() {
    let pressed = Tensor::new(0.5, 0.1, 0.0, -0.1, 0.6, 0.0, 0.0, 0.2, 0.7);
    for law in LAWS {
        let at = Principal::of(&pressed).expect("it is not turned over");
        let smallest =
            |curvature| at.tangent(law, LAME, curvature).symmetric_eigen().eigenvalues.min();
        assert!(smallest(Curvature::True) < -1e-2, "{law:?}");
        assert!(smallest(Curvature::Positive) > -1e-12, "{law:?}");
        let rest = Principal::of(&Tensor::identity()).expect("it is at rest");
        let [all, kept] =
            [Curvature::True, Curvature::Positive].map(|c| rest.tangent(law, LAME, c));
        assert!((all - kept).norm() < 1e-12, "{law:?}");
    }
    let fibre = Fibre { direction: Vector3::x(), stiffness: 3.0, target: 1.2 };
    let eigenvalues =
        fibre.tangent(&pressed, Curvature::Positive).whole().symmetric_eigen().eigenvalues;
    assert!(eigenvalues.min() > -1e-12);
}

#[test]
fn small_strains_are_those_of_hooke_and_a_third_of_lambda_in_the_corotated_volume() {
    let strain = Tensor::new(1.0, 0.5, 0.0, 0.5, -0.4, 0.2, 0.0, 0.2, 0.7) * 1e-7;
    for law in LAWS {
        let at = Principal::of(&(Tensor::identity() + strain)).expect("it is hardly deformed");
        let part = if law == Law::CorotatedVolume { 1.0 / 3.0 } else { 1.0 };
        let hooke = strain * (2.0 * LAME.shear)
            + Tensor::identity() * (part * LAME.volume * strain.trace());
        assert!((at.stress(law, LAME).stress - hooke).norm() < 1e-12, "{law:?}");
    }
}

#[test]
fn a_cell_turned_over_has_a_negative_stretch() {
    let over = Tensor::new(1.1, 0.3, 0.0, 0.2, 0.9, 0.1, 0.0, 0.2, -0.4);
    let at = Principal::of(&over).expect("it has a volume");
    let product: f64 = at.stretches.iter().product();
    assert!((product - over.determinant()).abs() < 1e-14);
    let again = at.space * Tensor::from_diagonal(&at.stretches.into()) * at.body.transpose();
    assert!((again - over).norm() < 1e-14);
    // From there the laws that have an energy lead back
    for law in [Law::Corotated, Law::CorotatedVolume] {
        let slope = slopes(|f| Principal::of(f).expect("it has a volume").energy(law, LAME), &over);
        assert!((at.stress(law, LAME).stress - slope).norm() < 1e-7, "{law:?}");
    }
    assert!(at.energy(Law::NeoHookean, LAME).is_nan());
    assert!(Principal::of(&Tensor::zeros()).is_none());
    assert!(Principal::of(&Tensor::from_element(f64::NAN)).is_none());
}

#[test]
fn moduli_follow_young_and_poisson() {
    let material =
        Material { law: Law::NeoHookean, young: 1e5, poisson: 0.45, density: 1e3, viscosity: 0.0 };
    let h = 1e-6;
    let by_poisson = |by: f64| Material { poisson: 0.45 + by, ..material }.lame();
    let (above, below) = (by_poisson(h), by_poisson(-h));
    let slope = material.lame_by_poisson();
    assert!((slope.shear - (above.shear - below.shear) / (2.0 * h)).abs() < 1e-4);
    assert!(((above.volume - below.volume) / (2.0 * h) / slope.volume - 1.0).abs() < 1e-6);
    let unit = material.lame_by_young();
    assert!((unit.shear * 1e5 - material.lame().shear).abs() < 1e-9);
    assert!(material.check().is_ok());
    for (wrong, says) in [
        (Material { young: 0.0, ..material }, "Young's modulus is 0 Pa: it has to be positive"),
        (Material { poisson: 0.51, ..material }, "Poisson's ratio is 0.51: it has to be above -1"),
        (Material { density: f64::NAN, ..material }, "the density is NaN kg/m3"),
        (Material { viscosity: -1.0, ..material }, "the viscosity of the solid is -1 Pa s"),
    ] {
        let said = wrong.check().expect_err("it cannot be").to_string();
        assert!(said.starts_with(says), "{said}");
    }
}
