//! `loop`: optimisation, a robot's motion and calibration in turns.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use alewife_reduced::search::write_whole;
use alewife_reduced::tier::{Bodies, Perturbed, Round, Rounds, SolidOf, Which, write_case};
use clap::{Args, ValueHint};

use super::directory::{not_written, prepare};
use super::search::progress_line;
use crate::case::soft::SoftFile;
use crate::cli::complete;
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::Settings;
use crate::cli::style::{complain, say};

/// The file that is written last.
const LAST: &str = "rounds.csv";

/// What `loop` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Each round makes the objective of the model large, has the robot move so, and calibrates the model by what
was seen of it. The robot is the case with the numbers of [robot].")]
pub struct LoopOptions {
    /// Which case
    #[arg(add = complete::case())]
    case: String,
    #[command(flatten)]
    settings: Settings,
    /// How many rounds
    #[arg(long, value_name = "N", default_value_t = 3)]
    rounds: usize,
    /// Directory of the loop; `runs/<case>-loop` if absent
    #[arg(long, short, value_name = "DIR", value_hint = ValueHint::DirPath)]
    out: Option<PathBuf>,
    /// Replace a finished loop
    #[arg(long)]
    overwrite: bool,
    /// No progress on the terminal
    #[arg(long, short)]
    quiet: bool,
}

/// Goes round.
pub fn rounds(options: &LoopOptions) -> Result<Exit, Failure> {
    let file = SoftFile::read(&options.case, &options.settings.set)?;
    match file.case.geometry.dimensions() {
        2 => turns::<2>(&file, options),
        _ => turns::<3>(&file, options),
    }
}

fn turns<const D: usize>(file: &SoftFile, options: &LoopOptions) -> Result<Exit, Failure>
where
    Bodies: SolidOf<D>,
{
    let default = || Path::new("runs").join(format!("{}-loop", file.directory_name()));
    let out = options.out.clone().unwrap_or_else(default);
    let mut rounds = Rounds::<D>::new(file)?;
    let mut robot = Perturbed::<D>::new(file)?;
    let _held = prepare(&out, [LAST, "journal"], options.overwrite)?;
    let names = rounds.names().join(",");
    let mut table = format!("round,robot,model,gap,loss,{names}\n");
    say(&table.trim_end().replace(',', "  "));
    for number in 1..=options.rounds {
        let mut told = |what: &str, progress: &_| {
            if !options.quiet {
                let which = match what {
                    "calibration" => Which::Calibration,
                    _ => Which::Optimisation,
                };
                complain(&format!("round {number} {}", progress_line(progress, which)));
            }
        };
        let made = rounds
            .round(number, &out, &mut robot, &mut told)
            .map_err(|why| Failure::new(Exit::Diverged, format!("round {number}: {why}")))?;
        let Round { model, robot: real, calibrated, loss } = made;
        let numbers = [real, model, (real - model).abs(), loss];
        let cells: Vec<String> =
            numbers.iter().chain(&calibrated).map(|value| format!("{value:?}")).collect();
        let _ = writeln!(table, "{number},{}", cells.join(","));
        let shown: Vec<String> =
            numbers.iter().chain(&calibrated).map(|value| format!("{value:.5e}")).collect();
        say(&format!("{number}  {}", shown.join("  ")));
    }
    let failed = |error: std::io::Error| not_written(&out, &error);
    write_case(&out, file, &rounds.model.case).map_err(failed)?;
    write_whole(&out.join(LAST), table).map_err(failed)?;
    say(&format!("written to {}", out.display()));
    Ok(Exit::Done)
}
