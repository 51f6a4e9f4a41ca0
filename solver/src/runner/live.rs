//! `--live`: where viewers connect to a run.

use super::failure::{Exit, Failure};
use crate::observer::{LiveServer, print_line};

/// Where viewers look first; of this machine alone.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:8765";

/// Listens from now on, before anything of a run is made.
pub fn start(address: &str, name: &str) -> Result<LiveServer, Failure> {
    let is_whole = address
        .rsplit_once(':')
        .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok());
    if !is_whole {
        let reason = format!(
            "--live: `{address}` is no ADDRESS:PORT, such as {DEFAULT_ADDRESS}; 0.0.0.0:8765 lets other \
             machines connect, too"
        );
        return Err(Failure::new(Exit::Usage, reason));
    }
    let server = LiveServer::start(address, name).map_err(|error| {
        let reason = format!("--live: cannot listen at {address}: {error}; give another port");
        Failure::new(Exit::Usage, reason)
    })?;
    print_line(&format!("live at ws://{}", server.address()));
    Ok(server)
}
