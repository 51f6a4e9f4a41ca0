//! What a run and the threads of its viewers share: channels, and messages on their way.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Messages that wait for a client; older ones are then left out.
const LONGEST_QUEUE: usize = 4096;
/// Bytes that wait for a client; older messages are then left out, and the latest never.
const LARGEST_QUEUE: usize = 1 << 20;

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
    /// Subscription of each channel that is wanted: one of each, however often a client asks.
    subscriptions: BTreeMap<usize, u32>,
    waiting: VecDeque<LiveMessage>,
    n_bytes: usize,
}

impl Client {
    fn push(&mut self, message: LiveMessage) {
        self.n_bytes += message.data.len();
        self.waiting.push_back(message);
        let is_full =
            |queue: &Self| queue.waiting.len() > LONGEST_QUEUE || queue.n_bytes > LARGEST_QUEUE;
        while self.waiting.len() > 1 && is_full(self) {
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
    /// Whether a client was refused of late, or asked for too much.
    pub was_wrong: AtomicBool,
    /// Connections there are.
    pub n_clients: AtomicUsize,
}

/// What a client is to be sent next.
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
            if client.subscriptions.contains_key(&channel) {
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

    /// A client wants a channel, if there is such a one; it is given what was said there first, and last, unless it
    /// had the channel before.
    pub fn subscribe(&self, client: usize, subscription: u32, channel: usize) {
        let mut state = self.state();
        let Some(kept) = state.kept.get(channel).cloned() else { return };
        if let Some(client) = state.clients.get_mut(&client) {
            let before = client.subscriptions.insert(channel, subscription);
            if before.is_none() {
                kept.into_iter().flatten().for_each(|message| client.push(message));
            }
        }
    }

    /// A client wants no more of what some subscriptions are of.
    pub fn unsubscribe(&self, client: usize, subscriptions: &[u32]) {
        if let Some(client) = self.state().clients.get_mut(&client) {
            let mut subscriptions = subscriptions.to_vec();
            subscriptions.sort_unstable();
            client.subscriptions.retain(|_, own| subscriptions.binary_search(own).is_err());
        }
    }

    /// Whether a client has asked for a channel, or there is none to ask for.
    pub fn wants_something(&self, client: usize) -> bool {
        let state = self.state();
        let wants = |client: &Client| !client.subscriptions.is_empty();
        state.channels.is_empty() || state.clients.get(&client).is_some_and(wants)
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
            let wanted = client.subscriptions.get(&message.channel);
            messages.extend(wanted.map(|&subscription| (subscription, message)));
        }
        News { channels, messages }
    }
}
