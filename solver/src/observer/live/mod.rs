//! `LiveServer`: the messages of a run for viewers that connect while it is under way.
//!
//! It speaks the WebSocket protocol of Foxglove. The run only puts messages into queues of limited
//! length; each client has a thread of its own, and one that is slow misses messages.

mod client;
mod hub;

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use hub::Shared;

pub use hub::LiveChannel;

/// Clients at one time.
const MOST_CLIENTS: usize = 16;
/// Time between two looks for new clients.
const INTERVAL: Duration = Duration::from_millis(50);
/// Longest time for the last messages after the end of a run.
const FAREWELL: Duration = Duration::from_millis(500);

/// Serves the messages of one run.
#[derive(Debug)]
pub struct LiveServer {
    shared: Arc<Shared>,
    address: SocketAddr,
}

impl LiveServer {
    /// Listens at an address from now on; `name` is what viewers show.
    ///
    /// # Errors
    /// When the address is taken or is not one of this machine.
    pub fn start(address: &str, name: &str) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared::default());
        let (own, name) = (Arc::clone(&shared), name.to_owned());
        thread::Builder::new().name("live".to_owned()).spawn(move || {
            accept_clients(&listener, &own, &name);
        })?;
        Ok(Self { shared, address })
    }

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Adds a channel; its number.
    pub fn add_channel(&self, channel: LiveChannel) -> usize {
        self.shared.add_channel(channel)
    }

    /// Says something on a channel, without waiting for anybody.
    pub fn publish(&self, channel: usize, time: u64, data: &[u8]) {
        self.shared.publish(channel, time, data);
    }
}

impl Drop for LiveServer {
    /// Clients are given what they are still owed, if they take it at once.
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Release);
        let started = Instant::now();
        while self.shared.n_clients.load(Ordering::Acquire) > 0 && started.elapsed() < FAREWELL {
            thread::sleep(Duration::from_millis(5));
        }
    }
}

fn accept_clients(listener: &TcpListener, shared: &Arc<Shared>, name: &str) {
    while !shared.is_over() {
        let is_full = shared.n_clients.load(Ordering::Acquire) >= MOST_CLIENTS;
        let Ok((stream, _)) = listener.accept() else {
            thread::sleep(INTERVAL);
            continue;
        };
        if is_full {
            continue;
        }
        let (own, name) = (Arc::clone(shared), name.to_owned());
        shared.n_clients.fetch_add(1, Ordering::AcqRel);
        let started = thread::Builder::new().name("live client".to_owned()).spawn(move || {
            // What goes wrong between a viewer and its network is no matter of the run
            let _ = client::serve(stream, &own, &name);
            own.n_clients.fetch_sub(1, Ordering::AcqRel);
        });
        if started.is_err() {
            shared.n_clients.fetch_sub(1, Ordering::AcqRel);
        }
    }
}
