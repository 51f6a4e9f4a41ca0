//! `Host`: what is the same for all viewers: what they show, and who of them is let in.

use std::net::SocketAddr;
use std::sync::atomic::AtomicBool;

use super::visitors::Visitors;

/// What is the same for all clients.
#[derive(Debug)]
pub struct Host {
    /// What viewers show.
    pub name: String,
    /// Who may look on.
    pub visitors: Visitors,
    /// Whether somebody was refused, which is reported once.
    pub has_refused: AtomicBool,
}

impl Host {
    /// That of a server at an address, which nobody was refused by so far.
    #[must_use]
    pub fn new(address: SocketAddr, name: &str, origins: &[String]) -> Self {
        let visitors = Visitors::new(address, origins);
        Self { name: name.to_owned(), visitors, has_refused: AtomicBool::new(false) }
    }
}
