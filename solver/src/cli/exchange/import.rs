//! `import`: a case of a model of another program.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use crate::case::{Case, Diagnostic, Severity, check, check_reduced};
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::print_warnings;
use crate::cli::style::say;
use crate::observer::write_atomic;
use crate::reduced::{self, Imported, Remark};

/// Largest file that is read (bytes).
const LARGEST_FILE: u64 = 100_000_000;

/// What `import` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife import fish.xml fish.toml
  alewife run fish.toml

What of the model is not in the case is named with its line, here and at the head of the case.")]
pub struct ImportOptions {
    /// The model: MJCF, or URDF
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    model: PathBuf,
    /// The case that is written, a name that ends in .toml
    #[arg(value_name = "OUT.toml", value_hint = ValueHint::FilePath)]
    out: PathBuf,
    /// Write the case even if there is a file of this name
    #[arg(long)]
    overwrite: bool,
}

/// Writes a case of a model.
///
/// # Errors
/// When the model has what no case has, and when a file cannot be read or written.
pub fn import(options: &ImportOptions) -> Result<Exit, Failure> {
    let ImportOptions { model, out, overwrite } = options;
    let is_case = out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    if !is_case {
        let message = format!("{}: let the name of the case end in .toml", out.display());
        return Err(Failure::new(Exit::Usage, message));
    }
    if out.exists() && !overwrite {
        let message = format!("{} is there; --overwrite it, or choose another name", out.display());
        return Err(Failure::new(Exit::Usage, message));
    }
    let text = read(model)?;
    let place = |remark: &Remark| format!("{}:{remark}", model.display());
    let name = model.file_name().map(|name| name.to_string_lossy().into_owned());
    let Imported { text, notes } = reduced::import(&text, &name.unwrap_or_default())
        .map_err(|remark| Failure::new(Exit::BadCase, place(&remark)))?;
    let file = Case::parse(&out.display().to_string(), &text, &[])?;
    let mut found = check(&file);
    let is_new = |one: &Diagnostic| one.severity == Severity::Error && !found.contains(one);
    let more: Vec<Diagnostic> = check_reduced(&file).into_iter().filter(is_new).collect();
    found.extend(more);
    if found.iter().any(|one| one.severity == Severity::Error) {
        return Err(Failure::wrong(&found));
    }
    print_warnings(&found);
    write_atomic(out, text.as_bytes())?;
    for note in &notes {
        say(&format!("note: {}", place(note)));
    }
    say(&format!("written to {}", out.display()));
    Ok(Exit::Done)
}

fn read(path: &Path) -> Result<String, Failure> {
    let named =
        |error: std::io::Error| Failure::new(Exit::NoInput, format!("{}: {error}", path.display()));
    // Asked before it is opened: opening a pipe waits for somebody to write into it
    let found = fs::metadata(path).map_err(named)?;
    if !found.is_file() || found.len() > LARGEST_FILE {
        let reason = format!("{} is no file of up to 100 MB", path.display());
        return Err(Failure::new(Exit::NoInput, reason));
    }
    fs::read_to_string(path).map_err(named)
}
