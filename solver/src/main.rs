//! Command line: `list`, `show`, `check`, `mesh`, `run`, `plot`, `status`, `sweep`, `validate`.

use std::process::ExitCode;

use alewife::cli;

fn main() -> ExitCode {
    cli::guard(cli::run)
}
