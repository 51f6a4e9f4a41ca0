//! A bug ends the program with a message and what is needed to report it.

use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

use super::exit::Exit;
use super::style::complain;

/// Runs the program; a panic becomes a message and exit code 70.
#[must_use]
pub fn guard(program: impl FnOnce() -> ExitCode) -> ExitCode {
    // With RUST_BACKTRACE set, somebody is looking for the bug: let Rust print all it knows.
    if std::env::var_os("RUST_BACKTRACE").is_none() {
        panic::set_hook(Box::new(|information| {
            let place = information
                .location()
                .map_or("an unknown place".to_owned(), |at| format!("{}:{}", at.file(), at.line()));
            let payload = information.payload();
            let what = payload
                .downcast_ref::<&str>()
                .map(ToString::to_string)
                .or_else(|| payload.downcast_ref::<String>().cloned())
                .unwrap_or_else(|| "no message".to_owned());
            complain(&format!(
                "Sorry: this is a bug in alewife {}, not in your case.\n\
                 Please report it with the case file and this line:\n  {what} ({place})",
                env!("CARGO_PKG_VERSION")
            ));
        }));
    }
    panic::catch_unwind(AssertUnwindSafe(program)).unwrap_or_else(|_| Exit::Bug.into())
}
