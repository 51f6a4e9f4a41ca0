//! `LiveServer`: the messages of a run for viewers that connect while it is under way.
//!
//! It speaks the WebSocket protocol of Foxglove. The run only puts messages into queues of limited
//! length; each client has a thread of its own, and one that is slow misses messages.

mod client;
mod host;
mod hub;
mod visitors;

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use host::Host;
use hub::Shared;

pub use hub::LiveChannel;

/// Clients at one time.
const MOST_CLIENTS: usize = 8;
/// Time between two looks for new clients.
const INTERVAL: Duration = Duration::from_millis(50);
/// Shortest time between two clients that are let in.
const PAUSE: Duration = Duration::from_millis(10);
/// The same after one that was refused, or closed since it asked for too much: it may come again at once.
const PENALTY: Duration = Duration::from_millis(250);
/// Longest time for the last messages after the end of a run.
const FAREWELL: Duration = Duration::from_millis(500);

/// Serves the messages of one run.
#[derive(Debug)]
pub struct LiveServer {
    shared: Arc<Shared>,
    address: SocketAddr,
}

impl LiveServer {
    /// Listens at an address from now on; `name` is what viewers show, `origins` are those of web pages that may
    /// look on besides those of this machine.
    ///
    /// # Errors
    /// When the address is taken or is not one of this machine.
    pub fn start(address: &str, name: &str, origins: &[String]) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared::default());
        let host = Arc::new(Host::new(address, name, origins));
        let own = Arc::clone(&shared);
        thread::Builder::new().name("live".to_owned()).spawn(move || {
            accept_clients(&listener, &own, &host);
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

fn accept_clients(listener: &TcpListener, shared: &Arc<Shared>, host: &Arc<Host>) {
    while !shared.is_over() {
        let is_full = shared.n_clients.load(Ordering::Acquire) >= MOST_CLIENTS;
        let Ok((stream, _)) = listener.accept() else {
            thread::sleep(INTERVAL);
            continue;
        };
        // However many come, the run has its time
        let was_wrong = shared.was_wrong.swap(false, Ordering::AcqRel);
        thread::sleep(if was_wrong { PENALTY } else { PAUSE });
        if is_full {
            continue;
        }
        let (own, host) = (Arc::clone(shared), Arc::clone(host));
        shared.n_clients.fetch_add(1, Ordering::AcqRel);
        let started = thread::Builder::new().name("live client".to_owned()).spawn(move || {
            // What goes wrong between a viewer and its network is no matter of the run
            if client::serve(stream, &own, &host).is_err() {
                own.was_wrong.store(true, Ordering::Release);
            }
            own.n_clients.fetch_sub(1, Ordering::AcqRel);
        });
        if started.is_err() {
            shared.n_clients.fetch_sub(1, Ordering::AcqRel);
        }
    }
}
