//! Elastic rods on bodies that are free, held or moved: of any stiffness from rest, and behind a magnet in a field.

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// A head with these keys, and a slender body behind it with these.
fn head_and_tail(time: &str, head: &str, tail: &str) -> Model {
    case(&format!(
        r#"
        title = "a head with a tail in a box"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-1.3, -0.9], max = [1.3, 0.9] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ growth = 0.5, gap_layers = 1, moving.layers = 1, size = 0.45, surface = 0.08 }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "tail"
        shape.fish = {{ length = 1.0, head_width = 0.08, head_end = 0.08, tail_width = 0.06, tip_radius = 0.02, corner_radius = 0.05 }}
        center = [-0.05, 0.0]
        motion = "free"
        {tail}
        [[body]]
        name = "head"
        shape.disc.radius = 0.12
        center = [0.65, 0.0]
        {head}
        "#
    ))
}

const PULLED: &str = "motion = \"free\"\nforce = [1.0, -10.0]";

fn rod(bending: f64, hold: &str) -> String {
    format!(
        "rod = {{ bending = {bending:e}, elements = 8 }}\n\
         attached = {{ to = \"head\", hold = \"{hold}\" }}"
    )
}

/// Way and turn of the head in long steps from rest.
fn moved(model: &Model) -> [f64; 3] {
    let summary = run(model);
    let from = |name: &str| last(&summary, name) - column(&summary, name)[0];
    ["head.x", "head.y", "head.angle"].map(from)
}

/// Hinged, where the head turns by itself, and on bodies that are held or moved.
#[test]
fn rods_of_any_stiffness_take_whole_steps() {
    const TIME: &str = "step = 0.1, end = 0.2";
    let moved = "motion.y.imposed.sine = { amplitude = 0.1, period = 1.0 }";
    for bending in [1.0, 1e6] {
        for (hold, head) in [
            ("hinged", PULLED),
            ("clamped", moved),
            ("hinged", moved),
            ("clamped", "motion = \"held\""),
        ] {
            let tail = format!("{}\nforce = [0.0, -1.0]", rod(bending, hold));
            let summary = run(&head_and_tail(TIME, head, &tail));
            let rows = column(&summary, "tail.tip.y");
            assert!(
                rows.len() == 3 && rows[2] < rows[0] + 0.2,
                "{bending} {hold} {head}: {rows:?}"
            );
        }
    }
}

/// Pulled by its tail, on a head that is held or pulled as much the other way: until the fluid is at rest, by how much of its length F / A
/// says.
#[test]
fn a_rod_that_is_clamped_to_a_body_is_stretched_by_a_force_along_it() {
    for head in ["motion = \"held\"", "motion = \"free\"\nforce = [0.5, 0.0]"] {
        let tail = "rod = { bending = 5.0, elements = 3, stretching = 10.0, load.tip.force = [{ constant = -0.5 }, { constant = 0.0 }] }\n\
             attached = { to = \"head\", hold = \"clamped\" }";
        let model = head_and_tail("step = 20.0, end = 160.0", head, tail);
        let length = model.bodies[0].shape.profile().expect("it is slender").length();
        let summary = run(&model);
        let apart =
            |row: usize| column(&summary, "head.x")[row] - column(&summary, "tail.tip.x")[row];
        let end = column(&summary, "head.x").len() - 1;
        let off = (apart(end) - apart(0)) / (length * 0.05) - 1.0;
        figure!(off, "{head}");
        assert!(off.abs() < 1e-6, "{head}: {off}");
    }
}

/// Its head turns by a fifth of a radian in three steps: as the same outline made rigid, the more so the stiffer it is.
#[test]
fn a_rod_of_any_stiffness_goes_with_the_body_it_is_clamped_to() {
    const TIME: &str = "step = 0.1, end = 0.3";
    let joint = "[[joint]]\nparent = \"head\"\nchild = \"tail\"\non_parent = [-0.7, 0.0]\nkind.bent.angle = 0.0";
    let rigid = moved(&head_and_tail(TIME, &format!("{PULLED}\n{joint}"), ""));
    assert!(rigid[2].abs() > 0.15, "{rigid:?}");
    let offs = [1.0, 1e2, 1e4, 1e6].map(|bending| {
        let found = moved(&head_and_tail(TIME, PULLED, &rod(bending, "clamped")));
        let off = (found[2] / rigid[2] - 1.0).abs().max((found[1] / rigid[1] - 1.0).abs());
        figure!(off, "{bending}");
        off
    });
    assert!(
        offs[0] > 5.0 * offs[1] && offs[1] < 2e-2 && offs[2..].iter().all(|off| *off < 3e-3),
        "{offs:?}"
    );
}

/// A head with a magnetic moment along x, in a field with a part along it and one that oscillates across.
fn magnetic(bending: f64, amplitude: f64, time: &str) -> Model {
    let head = format!(
        r#"
        motion = "free"
        magnetic_moment = [10.0, 0.0]
        [field.magnetic]
        components = [{{ constant = 1.0 }}, {{ sine = {{ amplitude = {amplitude}, period = 1.0, ramp = 0.5 }} }}]
        "#
    );
    head_and_tail(time, &head, &rod(bending, "clamped"))
}

/// The way of the head along the field in the last period, and the work of the field then less what is dissipated and stored,
/// over that work.
struct Cycle {
    way: f64,
    defect: f64,
}

fn cycle(bending: f64, steps: u32) -> Cycle {
    let step = 1.0 / f64::from(steps);
    let summary = run(&magnetic(bending, 0.5, &format!("step = {step}, end = 2.0")));
    let start = steps as usize;
    let values = |name: &str| column(&summary, name)[start..].to_vec();
    let integral = |name: &str| -> f64 {
        values(name).windows(2).map(|pair| 0.5 * step * (pair[0] + pair[1])).sum()
    };
    let change = |name: &str| last(&summary, name) - values(name)[0];
    let work = integral("head.magnetic_power");
    let taken = integral("flow.dissipation") + change("tail.elastic_energy");
    Cycle { way: change("head.x"), defect: (work - taken) / work }
}

/// In a field that oscillates a soft tail pushes its head ahead and a stiff one, which comes back the way it went, does not; the
/// field does the work that is dissipated.
#[test]
fn a_magnetic_head_swims_by_a_soft_tail_only() {
    let [soft, stiff] = [3.0, 1e4].map(|bending| cycle(bending, 50));
    figure!(soft.way, "soft");
    figure!(stiff.way, "stiff");
    figure!(soft.defect, "defect");
    assert!(soft.way > 2e-3 && stiff.way.abs() < 0.1 * soft.way, "{} {}", soft.way, stiff.way);
    assert!(soft.defect.abs() < 1e-3 && stiff.defect.abs() < 1e-3, "{}", soft.defect);
}

/// All numbers of all rows as bits.
fn bits(outcome: &RunSummary) -> Vec<Vec<u64>> {
    outcome.series.rows.iter().map(|row| row.iter().map(|x| x.to_bits()).collect()).collect()
}

/// On a mesh that is replaced, stopped before and after.
#[test]
fn a_flexible_magnetic_swimmer_ends_with_the_same_bits() {
    let model = magnetic(0.5, 3.0, "step = 0.05, end = 0.8");
    let whole = simulate::<2>(&model, &mut []).expect("the case runs");
    assert!(last(&whole, "flow.remeshes") >= 1.0, "{}", last(&whole, "flow.remeshes"));
    for steps in [3, 13] {
        let saved: SavedState<2> = stopped(&model, steps);
        let rest = resumed(&model, &saved).expect("it continues");
        assert!(bits(&rest) == bits(&whole), "stopped after {steps} steps");
    }
}
