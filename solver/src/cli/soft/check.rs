//! `check` and `show` of soft cases.

use std::fmt::Write as _;

use alewife_reduced::tier::{Bodies, Model, SolidOf};

use crate::case::printable;
use crate::case::soft::{SoftFile, check_starts};
use crate::cli::exit::{Exit, Failure};
use crate::cli::facts::one_line;
use crate::cli::read::{as_warnings, print_warnings};
use crate::cli::style::{Ink, on_stdout, say};

/// Reads a soft case, makes its body, and says what it is; nothing is run.
pub fn check(file: &SoftFile) -> Result<Exit, Failure> {
    let text = match file.case.geometry.dimensions() {
        2 => made::<2>(file)?,
        _ => made::<3>(file)?,
    };
    say(&format!("{}\n{text}\nnothing was run", head(file)));
    print_warnings(&as_warnings(check_starts(file)));
    Ok(Exit::Done)
}

/// Shows what a soft case is about.
pub fn show(file: &SoftFile) -> Result<Exit, Failure> {
    let case = &file.case;
    let mut text = head(file);
    if !case.description.trim().is_empty() {
        let _ = writeln!(text, "\n{}", printable(case.description.trim()));
    }
    if let Some(data) = &case.data {
        let (files, source) = (data.files.join(", "), printable(&data.source));
        let _ = writeln!(text, "needs {}, from {source}", printable(&files));
    }
    for (title, is_there) in [
        ("calibration", case.calibration.is_some()),
        ("optimisation", case.optimisation.is_some()),
        ("robot", case.robot.is_some()),
    ] {
        if is_there {
            let _ = writeln!(text, "has [{title}]");
        }
    }
    for variant in &case.variant {
        let set: Vec<String> =
            variant.set.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        let _ = writeln!(
            text,
            "variant {}/{}: {}",
            printable(&file.name),
            printable(&variant.name),
            printable(&set.join(", "))
        );
    }
    for reference in &case.reference {
        let _ = writeln!(
            text,
            "  {} = {} +- {:.2e}  {}: {}",
            printable(&reference.quantity),
            reference.value,
            reference.allowed(),
            reference.kind.name(),
            printable(&reference.source)
        );
    }
    say(text.trim_end());
    Ok(Exit::Done)
}

fn head(file: &SoftFile) -> String {
    format!("{}  {}\n", on_stdout(Ink::Bold, &file.name), one_line(&file.case.title))
}

fn made<const D: usize>(file: &SoftFile) -> Result<String, Failure>
where
    Bodies: SolidOf<D>,
{
    let model = Model::<D>::new(file)?;
    let solid = &model.body.solid;
    let spec = solid.spec();
    let mut text = format!(
        "{}, without a flow\n{} cells, {} nodes, {} unknowns, volume {:.4e}\n{} frames of {} s, {} steps\n",
        file.case.geometry.name(),
        spec.mesh.n_cells(),
        spec.mesh.nodes.len(),
        solid.n_unknowns(),
        solid.volume(),
        model.plan.targets.len(),
        model.plan.frame,
        model.plan.n_steps()
    );
    for (fibre, made) in file.case.solid.iter().flat_map(|solid| &solid.fibre).zip(&spec.fibres) {
        let name = printable(&fibre.name);
        let _ = writeln!(text, "fibres \"{name}\" in {} cells", made.cells.len());
    }
    for (marker, node) in file.case.marker.iter().zip(&model.nodes) {
        let at: Vec<String> = spec.mesh.nodes[*node].iter().map(|x| format!("{x:.4e}")).collect();
        let _ = writeln!(text, "marker \"{}\" at ({})", marker.name, at.join(", "));
    }
    Ok(text)
}
