//! Angles of a planar body in a record, and pulses of its fibres.

use alewife_reduced::search::Sought as _;
use alewife_reduced::tier::{Kind, Model, Seeker, TierError, series};

use crate::bar::{BAR, Folder, agrees, record, sought};

/// The bar with pulses, and how it is bent in its middle in the record.
fn pulsed() -> String {
    let wave = "stretch.wave = { mean = 0.95, amplitude = 0.04, frequency = 3.0, phase = 0.1 }";
    let pulses = "stretch.trapezoid = { amplitude = 0.08, frequency = 3.1, phase = 0.11, rise = 0.23, on = 0.47 }";
    let more = r#"
[[marker]]
name = "foot"
at = [0.0, -0.06]

[[marker]]
name = "middle"
at = [0.0, 0.0]

[[angle]]
name = "bend"
markers = ["foot", "middle", "tip"]
column = "bend"
weight = 1e-3

[record]
angle_unit = "deg"
"#;
    let text = BAR.replace(wave, pulses).replace("[record]", more.trim_start());
    text.replace("stretch.wave.amplitude", "stretch.trapezoid.amplitude")
}

/// That of the bar with a column of angles.
fn bends() -> String {
    let bend = |(k, row): (usize, &str)| match k {
        0 => format!("{row},bend\n"),
        _ => format!("{row},{}\n", 5.0 - 0.7 * k as f64),
    };
    record().lines().enumerate().map(bend).collect()
}

#[test]
fn angles_and_pulses_have_their_derivatives_too() {
    let folder = Folder::new(&pulsed(), &bends());
    let keys = [
        ("amplitude", "solid.0.fibre.0.stretch.trapezoid.amplitude", 0.1),
        ("rise", "solid.0.fibre.0.stretch.trapezoid.rise", 0.1),
        ("on", "solid.0.fibre.0.stretch.trapezoid.on", 0.1),
        ("young", "solid.0.material.young", 1e4),
    ];
    // The loss is that of the angle nearly alone
    let file = folder.read(&["marker.0.weight=1e-3"]);
    let model = Model::<2>::new(&file).expect("it is a body");
    let recorded = model.recorded.as_ref().expect("it has a record");
    assert!((recorded.angles[2][0] + 1.4f64.to_radians()).abs() < 1e-12);
    let (kind, sought) = (Kind::Calibration(model.tracks(recorded)), sought(&file, &keys));
    let start: Vec<f64> = sought.bounded.iter().map(|one| one.start).collect();
    let mut seeker = Seeker { model, sought, kind };
    let found = seeker.evaluate(&start).expect("it moves");
    agrees(&mut seeker, &start, &keys, &found.slopes);
    let table = series(&seeker.model, &seeker.model.body.simulate(&seeker.model.plan).unwrap());
    let table = table.expect("it has a series");
    let change = table.last("bend.angle").expect("it is a column") - table.rows[0][13];
    assert_eq!(table.names[13], "bend.angle");
    assert!(change.abs() > 1e-3, "{change}");
}

#[test]
fn degrees_that_are_read_as_radians_are_refused() {
    let said = |text: &str, record: &str| {
        let folder = Folder::new(text, record);
        match Model::<2>::new(&folder.read(&[])) {
            Err(TierError::Case(found)) => found[0].to_string(),
            _ => String::new(),
        }
    };
    let (case, record) = (pulsed(), bends());
    assert_eq!(said(&case, &record), "");
    let radians = case.replace("angle_unit = \"deg\"\n", "");
    let found = said(&radians, &record);
    assert!(found.contains("changes by -6.300 rad until row 11, more than a turn"), "{found}");
    assert!(found.contains("angle_unit = \"deg\""), "{found}");
    let (case, record) = (
        radians.replace("column = \"bend\"", "column = \"bend (deg)\""),
        record.replace("tip y,bend", "tip y,bend (deg)"),
    );
    assert!(said(&case, &record).contains("degrees by its name"), "{}", said(&case, &record));
}
