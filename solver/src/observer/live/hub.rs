//! What a run and the threads of its viewers share: channels, and messages on their way.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Messages that wait for a client; older ones are then left out.
const LONGEST_QUEUE: usize = 4096;
/// Bytes that wait for a client; older messages are then left out.
const LARGEST_QUEUE: usize = 1 << 26;

/// A topic of the run.
#[derive(Debug, Clone)]
pub struct LiveChannel {
    /// Its name.
    pub topic: String,
    /// Name of its schema.
    pub schema_name: String,
    /// Its schema, by the rules of JSON Schema.
    pub schema: String,
}

/// A message on its way to a client.
#[derive(Debug, Clone)]
pub struct LiveMessage {
    /// Number of its channel.
    pub channel: usize,
    /// Simulated time (ns).
    pub time: u64,
    /// Its content.
    pub data: Arc<[u8]>,
}

/// What is kept for one client.
#[derive(Debug, Default)]
struct Client {
    /// Channel of each subscription.
    subscriptions: BTreeMap<u32, usize>,
    waiting: VecDeque<LiveMessage>,
    n_bytes: usize,
}

impl Client {
    fn push(&mut self, message: LiveMessage) {
        self.n_bytes += message.data.len();
        self.waiting.push_back(message);
        while self.waiting.len() > LONGEST_QUEUE || self.n_bytes > LARGEST_QUEUE {
            let Some(oldest) = self.waiting.pop_front() else { break };
            self.n_bytes -= oldest.data.len();
        }
    }
}

#[derive(Debug, Default)]
struct State {
    channels: Vec<LiveChannel>,
    /// The first and the latest message of each channel: what a late client is given.
    kept: Vec<[Option<LiveMessage>; 2]>,
    clients: BTreeMap<usize, Client>,
    n_came: usize,
}

/// What the run and the threads of clients share.
#[derive(Debug, Default)]
pub struct Shared {
    state: Mutex<State>,
    /// Whether the run is over.
    pub is_over: AtomicBool,
    /// Connections there are.
    pub n_clients: AtomicUsize,
}

/// What a client is to be told next.
#[derive(Debug, Default)]
pub struct News {
    /// Channels that it does not know yet, with their numbers.
    pub channels: Vec<(usize, LiveChannel)>,
    /// Messages with the subscriptions they are for.
    pub messages: Vec<(u32, LiveMessage)>,
}

impl Shared {
    /// Adds a channel; its number.
    pub fn add_channel(&self, channel: LiveChannel) -> usize {
        let mut state = self.state();
        state.channels.push(channel);
        state.kept.push([None, None]);
        state.channels.len() - 1
    }

    /// Says something on a channel, without waiting for anybody.
    pub fn publish(&self, channel: usize, time: u64, data: &[u8]) {
        let message = LiveMessage { channel, time, data: Arc::from(data) };
        let mut state = self.state();
        if let Some([first, latest]) = state.kept.get_mut(channel) {
            match first {
                None => *first = Some(message.clone()),
                Some(_) => *latest = Some(message.clone()),
            }
        }
        for client in state.clients.values_mut() {
            if client.subscriptions.values().any(|own| *own == channel) {
                client.push(message.clone());
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the run is over.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }

    /// A new client, by its number.
    pub fn enter(&self) -> usize {
        let mut state = self.state();
        state.n_came += 1;
        let id = state.n_came;
        state.clients.insert(id, Client::default());
        id
    }

    /// A client has gone.
    pub fn leave(&self, client: usize) {
        self.state().clients.remove(&client);
    }

    /// A client wants a channel; it is given what was last said there, and what was said first.
    pub fn subscribe(&self, client: usize, subscription: u32, channel: usize) {
        let mut state = self.state();
        let kept = state.kept.get(channel).cloned().unwrap_or_default();
        if let Some(client) = state.clients.get_mut(&client) {
            client.subscriptions.insert(subscription, channel);
            kept.into_iter().flatten().for_each(|message| client.push(message));
        }
    }

    /// A client wants no more of a channel.
    pub fn unsubscribe(&self, client: usize, subscription: u32) {
        if let Some(client) = self.state().clients.get_mut(&client) {
            client.subscriptions.remove(&subscription);
        }
    }

    /// What has come up for a client that knows the first `n_known` channels.
    pub fn news(&self, client: usize, n_known: usize) -> News {
        let mut state = self.state();
        let channels = state.channels.iter().cloned().enumerate().skip(n_known).collect();
        let Some(client) = state.clients.get_mut(&client) else { return News::default() };
        client.n_bytes = 0;
        let waiting = std::mem::take(&mut client.waiting);
        let mut messages = Vec::with_capacity(waiting.len());
        for message in waiting {
            let wanted = client.subscriptions.iter().find(|(_, own)| **own == message.channel);
            messages.extend(wanted.map(|(&subscription, _)| (subscription, message)));
        }
        News { channels, messages }
    }
}
