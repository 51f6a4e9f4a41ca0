//! Command line: `list`, `show`, `check`, `mesh`, `run`, `gradient`, `plot`, `status`, `sweep`, `verify`, `validate`.

use std::process::ExitCode;

use alewife::cli;

fn main() -> ExitCode {
    cli::guard(cli::run)
}
