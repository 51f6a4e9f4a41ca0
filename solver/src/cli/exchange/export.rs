//! `export`: the reduced model of a case as MJCF or URDF.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::case::{Case, Severity, check, check_reduced};
use crate::cli::complete;
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::{Settings, print_warnings, refuse_soft};
use crate::cli::style::say;
use crate::observer::write_atomic;
use crate::reduced::{self, Exported, RobotFormat};

/// What `export` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife export tendon-fish fish.xml
  alewife export my.toml my.urdf --set time.unsteady.step=0.001

A file that is there already is written anew.")]
pub struct ExportOptions {
    /// Which case
    #[arg(add = complete::case())]
    case: String,
    /// What to write: MJCF if its name ends in .xml, URDF if in .urdf
    #[arg(value_name = "OUT", value_hint = ValueHint::FilePath)]
    out: PathBuf,
    #[command(flatten)]
    settings: Settings,
}

/// Writes the reduced model of a case for another program.
///
/// # Errors
/// When the case is wrong or has no reduced model, and when the file cannot be written.
pub fn export(options: &ExportOptions) -> Result<Exit, Failure> {
    let ending = options.out.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let format = match ending.as_deref() {
        Some("xml") => RobotFormat::Mjcf,
        Some("urdf") => RobotFormat::Urdf,
        _ => {
            let message = format!(
                "OUT: no model is written as \"{}\"; let the name end in .xml (MJCF) or .urdf",
                options.out.display()
            );
            return Err(Failure::new(Exit::Usage, message));
        }
    };
    let (case, settings) = (&options.case, &options.settings.set);
    refuse_soft(case, settings)?;
    let file = Case::read(case, settings)?;
    let found = check(&file);
    for found in [&found, &check_reduced(&file)] {
        if found.iter().any(|one| one.severity == Severity::Error) {
            return Err(Failure::wrong(found));
        }
    }
    print_warnings(&found);
    let Exported { text, notes } = reduced::export(&file.model, &file.full_name(), format)
        .map_err(|error| Failure::new(Exit::BadCase, error.to_string()))?;
    write_atomic(&options.out, text.as_bytes())?;
    for note in notes {
        say(&format!("note: {note}"));
    }
    say(&format!("written to {}", options.out.display()));
    Ok(Exit::Done)
}
