//! The command line: commands, their output, and the exit codes.

mod check;
mod complete;
mod exchange;
mod exit;
mod facts;
mod gradient;
mod library;
mod manual;
mod mesh;
mod optimise;
mod panic;
mod parent;
mod plot;
mod read;
mod run;
mod searched;
mod soft;
mod status;
mod style;
mod surface;
mod sweep;
mod validate;
mod verify;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand, ValueHint};
use clap_complete::Shell;

use exit::{Exit, Failure};
use read::Settings;
use style::{complain, say};

use crate::runner::{end_aborted_with, ended_by_signal, outlive_file_size_limit};

pub use panic::guard;

const EXAMPLES: &str = "\
Examples:
  alewife list                                  the shipped cases
  alewife run squirmer-alone                    run one of them, into runs/squirmer-alone
  alewife show squirmer-alone --source > my.toml
  alewife check my.toml                         read it, mesh it, measure what a step takes
  alewife run my.toml --set mesh.scale=0.5      the same on a mesh twice as fine
  alewife sweep run my.toml --set fluid.viscosity=1:100:9:log
  alewife calibrate starfish-twin               find numbers of an elastic body from its motion
  alewife validate --quick                      do the shipped cases agree with their references?

A CASE is the path of a .toml file, the name of a shipped case, or either with /VARIANT behind it.

Exit codes: 0 done; 2 usage; 10 solver diverged; 11 mesh; 20 outside tolerance;
65 bad case; 66 no such case; 70 bug in alewife; 71 out of memory; 74 input or
output; 75 stopped, run it again to continue; 76 restarted without progress.";

/// Swimmers in viscous fluid: Taylor-Hood finite elements on body-fitted meshes.
#[derive(Debug, Parser)]
#[command(name = "alewife", version, after_help = EXAMPLES, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// List the shipped cases
    List {
        /// With their variants and references
        #[arg(long, short)]
        long: bool,
    },
    /// Show what a case is about: physics, derived numbers, references, variants
    Show {
        /// Which case
        #[arg(add = complete::case())]
        case: String,
        /// The text of the case file instead, to start a case of your own from
        #[arg(long)]
        source: bool,
    },
    /// Read cases, mesh them, and measure what a step takes; nothing is run
    Check {
        /// Which cases
        #[arg(required = true, add = complete::case())]
        cases: Vec<String>,
        #[command(flatten)]
        settings: Settings,
        /// Do not make the mesh: no sizes and no costs
        #[arg(long)]
        no_mesh: bool,
        /// Make the mesh, and no step on it: no costs
        #[arg(long)]
        no_step: bool,
        /// Threads of the step; by default those the batch system or the machine grants
        #[arg(long, short, value_name = "N")]
        threads: Option<usize>,
    },
    /// Make the mesh of a case, write it as VTU or for Gmsh, and report its quality
    Mesh {
        /// Which case
        #[arg(add = complete::case())]
        case: String,
        #[command(flatten)]
        settings: Settings,
        /// Where to write it; `<case>.vtu` here if absent. A name that ends in .msh makes it a file of
        /// Gmsh, MSH 4.1 in binary
        #[arg(long, short, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Write a file of Gmsh as text
        #[arg(long)]
        text: bool,
    },
    /// Run a case and compare it with its references
    Run(run::Options),
    /// Print how quantities of a steady flow, or of the end of a run without inertia, change with numbers of its case
    Gradient(gradient::Options),
    /// Find the numbers of a soft case that make it move as recorded, or coefficients of a reduced model
    Calibrate(soft::SearchOptions),
    /// Find the numbers of a case that make its objective large: of a soft case, of a steady flow, or of a run without inertia
    Optimise(soft::SearchOptions),
    /// Optimise, have a robot move so, and calibrate by what is seen, in turns
    Loop(soft::LoopOptions),
    /// Write the reduced model of a case for other programs, as MJCF of MuJoCo or as URDF
    Export(exchange::ExportOptions),
    /// Write a case of a model of MuJoCo (MJCF) or of ROS (URDF)
    Import(exchange::ImportOptions),
    /// Draw quantities of a run over time, as text
    Plot(plot::Options),
    /// Show how far a run, a sweep or a search is
    Status(status::Options),
    /// Report what a file of triangles encloses and whether it can be a body, and repair it
    Surface(surface::Options),
    /// Check that what runs, sweeps and searches have left is whole and agrees; nothing is run
    Verify(verify::Options),
    /// Run a case at many points: with several values of some of its keys
    Sweep(sweep::Options),
    /// Run shipped cases and compare them with their references
    Validate(validate::Options),
    /// Print the JSON Schema of case files
    ///
    /// Editors complete and check case files with it: write it to a file and put
    /// `#:schema ./alewife.schema.json` in the first line of the case.
    Schema {
        /// That of soft cases
        #[arg(long)]
        soft: bool,
    },
    /// Print what a shell needs to complete commands, options, cases, keys and quantities
    ///
    /// For bash, in ~/.bashrc: source <(alewife completions bash)
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Write the pages of the manual, for `man alewife` and `man alewife-run`
    ///
    /// For this user: alewife manual ~/.local/share/man/man1
    Manual {
        /// Where to write them
        #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
        directory: PathBuf,
    },
}

impl Command {
    /// What there is to say where a signal ends it; nothing of a command that sees to signals itself.
    fn left_by_a_signal(&self) -> Option<&'static str> {
        match self {
            Self::Run(options) if options.is_of_flow() => None,
            Self::Sweep(options) if options.runs() => None,
            Self::Validate(_) => None,
            Self::Calibrate(_) | Self::Optimise(_) | Self::Loop(_) => Some(
                "called again, it comes to the same bits, and makes no evaluation again that is in the journal of its directory",
            ),
            Self::Run(_) => {
                Some("it keeps nothing on its way, and begins again when it is run again")
            }
            _ => Some("it begins again when it is called again"),
        }
    }
}

/// Does what the command line says.
#[must_use]
pub fn run() -> ExitCode {
    complete::answer::<CommandLine>();
    let command_line = CommandLine::parse();
    match dispatch(command_line.command) {
        Ok(exit) => match style::stdout_error() {
            // What was asked for was done, but nobody can read it
            Some(error) => {
                complain(&format!("error: cannot write standard output: {error}"));
                Exit::InputOutput.into()
            }
            None => exit.into(),
        },
        Err(failure) => {
            complain(&failure.message);
            failure.exit.into()
        }
    }
}

fn dispatch(command: Command) -> Result<Exit, Failure> {
    outlive_file_size_limit()?;
    end_aborted_with(Exit::OutOfMemory)?;
    parent::follow_named()?;
    match command.left_by_a_signal() {
        Some(left) => ended_by_signal(left, || perform(command)),
        None => perform(command),
    }
}

fn perform(command: Command) -> Result<Exit, Failure> {
    match command {
        Command::List { long } => library::list(long),
        Command::Show { case, source } => library::show(&case, source),
        Command::Check { cases, settings, no_mesh, no_step, threads } => {
            crate::runner::threads::start(threads)?;
            let depth = match (no_mesh, no_step) {
                (true, _) => check::Depth::Text,
                (false, true) => check::Depth::Mesh,
                (false, false) => check::Depth::Step,
            };
            check::check(&cases, &settings.set, depth)
        }
        Command::Mesh { case, settings, out, text } => {
            mesh::mesh(&case, &settings.set, mesh::Target { out, as_text: text })
        }
        Command::Run(options) => run::run(&options),
        Command::Gradient(options) => gradient::gradient(&options),
        Command::Calibrate(options) => soft::calibrate(&options),
        Command::Optimise(options) => optimise::optimise(&options),
        Command::Loop(options) => soft::rounds(&options),
        Command::Export(options) => exchange::export(&options),
        Command::Import(options) => exchange::import(&options),
        Command::Plot(options) => plot::plot(&options),
        Command::Status(options) => status::status(&options),
        Command::Surface(options) => surface::surface(&options),
        Command::Verify(options) => verify::verify(&options),
        Command::Sweep(options) => sweep::sweep(&options),
        Command::Validate(options) => validate::validate(&options),
        Command::Schema { soft } => {
            let schema = if soft { crate::case::soft::schema() } else { crate::case::schema() };
            say(schema.trim_end());
            Ok(Exit::Done)
        }
        Command::Completions { shell } => complete::completions(shell, &CommandLine::command()),
        Command::Manual { directory } => manual::manual(&directory, CommandLine::command()),
    }
}
