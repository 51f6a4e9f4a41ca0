//! One viewer: the WebSocket protocol of Foxglove, from the handshake to the end.

use std::io;
use std::net::TcpStream;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use serde::Deserialize;
use serde_json::{Value, json};
use tungstenite::handshake::HandshakeError;
use tungstenite::handshake::server::{Callback, ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Bytes, Error, Message, WebSocket};

use super::host::Host;
use super::hub::{LiveMessage, Shared};

/// Protocols that are spoken; what is used of them is the same in both.
const PROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// Header of the protocols.
const PROTOCOL_HEADER: &str = "sec-websocket-protocol";
/// First byte of a message of a channel.
const MESSAGE_DATA: u8 = 1;
/// First byte of a simulated time.
const TIME: u8 = 2;
/// Longest wait for a word of the client, and so between two looks for news.
const TICK: Duration = Duration::from_millis(20);
/// Longest handshake, and longest wait for a client that takes nothing.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest message of a client (bytes): subscriptions to ten thousand channels.
const LONGEST_REQUEST: usize = 1 << 18;
/// Messages of a client in [`SPAN`]: viewers send a few when a panel is opened.
const MOST_REQUESTS: usize = 200;
/// Time over which messages of a client are counted.
const SPAN: Duration = Duration::from_secs(10);
/// Time between two questions whether a client is there.
const ASK_EVERY: Duration = Duration::from_secs(10);
/// A client is closed that says nothing for so long, not even that it is there, or that wants nothing.
const IDLE: Duration = Duration::from_secs(30);

/// Serves a client until it goes, wants nothing, asks too much, or the run is over.
///
/// # Errors
/// What went wrong with the connection.
pub fn serve(stream: TcpStream, shared: &Shared, host: &Host) -> Result<(), Error> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(TICK))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let socket = shake_hands(stream, host)?;
    let client = shared.enter();
    let heard = Heard::now();
    let connection = Connection { socket, shared, client, n_known: 0, time: None, heard };
    let served = connection.run(&host.name);
    shared.leave(client);
    served
}

/// The handshake, within its time.
fn shake_hands(stream: TcpStream, host: &Host) -> Result<WebSocket<TcpStream>, Error> {
    let started = Instant::now();
    let config = WebSocketConfig::default()
        .max_message_size(Some(LONGEST_REQUEST))
        .max_frame_size(Some(LONGEST_REQUEST));
    let mut shaken = tungstenite::accept_hdr_with_config(stream, Answer { host }, Some(config));
    loop {
        match shaken {
            Ok(socket) => return Ok(socket),
            Err(HandshakeError::Interrupted(half)) if started.elapsed() < PATIENCE => {
                shaken = half.handshake();
            }
            Err(refused) => return Err(Error::Io(io::Error::other(refused.to_string()))),
        }
    }
}

/// What the handshake answers to a request: whether its viewer is let in, and by which protocol.
struct Answer<'a> {
    host: &'a Host,
}

impl Callback for Answer<'_> {
    fn on_request(
        self,
        request: &Request,
        mut response: Response,
    ) -> Result<Response, ErrorResponse> {
        let refuse = |status: StatusCode, reason: String| {
            let mut refusal = ErrorResponse::new(Some(reason));
            *refusal.status_mut() = status;
            refusal
        };
        if let Err(reason) = self.host.visitors.check(request) {
            if !self.host.has_refused.swap(true, Ordering::Relaxed) {
                tracing::warn!(
                    "--live: a viewer was refused: {reason}; --live-origin lets others in"
                );
            }
            return Err(refuse(StatusCode::FORBIDDEN, format!("{reason}; see --live-origin")));
        }
        let offered = request.headers().get_all(PROTOCOL_HEADER);
        let offered: Vec<&str> = offered
            .iter()
            .filter_map(|value| value.to_str().ok())
            .flat_map(|value| value.split(',').map(str::trim))
            .collect();
        match PROTOCOLS.into_iter().find(|known| offered.contains(known)) {
            Some(known) => {
                response.headers_mut().insert(PROTOCOL_HEADER, HeaderValue::from_static(known));
                Ok(response)
            }
            None => {
                Err(refuse(StatusCode::BAD_REQUEST, format!("protocols: {}", PROTOCOLS.join(", "))))
            }
        }
    }
}

/// When a client was last heard, and how often of late.
#[derive(Debug)]
struct Heard {
    last: Instant,
    /// When it was last asked whether it is there.
    asked: Instant,
    /// When it last wanted something.
    wanted: Instant,
    span: Instant,
    n_in_span: usize,
}

impl Heard {
    fn now() -> Self {
        let now = Instant::now();
        Self { last: now, asked: now, wanted: now, span: now, n_in_span: 0 }
    }

    /// One more message; whether there are too many.
    fn message(&mut self) -> bool {
        self.last = Instant::now();
        if self.span.elapsed() > SPAN {
            (self.span, self.n_in_span) = (self.last, 0);
        }
        self.n_in_span += 1;
        self.n_in_span > MOST_REQUESTS
    }
}

/// What a client says; what else it may want is not offered.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Words {
    op: String,
    #[serde(default)]
    subscriptions: Vec<Subscription>,
    #[serde(default)]
    subscription_ids: Vec<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Subscription {
    id: u32,
    channel_id: u32,
}

struct Connection<'a> {
    socket: WebSocket<TcpStream>,
    shared: &'a Shared,
    client: usize,
    /// Number of channels that the client knows.
    n_known: usize,
    /// Latest simulated time that was sent to it (ns).
    time: Option<u64>,
    heard: Heard,
}

impl Connection<'_> {
    fn run(mut self, name: &str) -> Result<(), Error> {
        self.send_text(&json!({
            "op": "serverInfo",
            "name": name,
            "capabilities": ["time"],
            "supportedEncodings": ["json"],
            "metadata": {"program": concat!("alewife ", env!("CARGO_PKG_VERSION"))},
            "sessionId": std::process::id().to_string(),
        }))?;
        loop {
            // What was said before the end was said before this look
            let is_over = self.shared.is_over();
            self.send_news()?;
            if is_over {
                return self.close();
            }
            match self.socket.read() {
                Ok(message) => {
                    let is_too_much = self.heard.message();
                    if is_too_much || !self.hear(&message) {
                        self.close()?;
                        return Err(Error::Io(io::Error::other("it asks for too much")));
                    }
                }
                Err(Error::Io(error)) if is_timeout(&error) => {}
                Err(Error::ConnectionClosed) => return Ok(()),
                Err(error) => return Err(error),
            }
            if self.is_idle()? {
                return self.close();
            }
        }
    }

    fn close(mut self) -> Result<(), Error> {
        self.socket.close(None)?;
        self.socket.flush()
    }

    /// Whether the client is gone or wants nothing; it is asked from time to time.
    fn is_idle(&mut self) -> Result<bool, Error> {
        if self.shared.wants_something(self.client) {
            self.heard.wanted = Instant::now();
        }
        if self.heard.asked.elapsed() > ASK_EVERY {
            self.heard.asked = Instant::now();
            self.socket.send(Message::Ping(Bytes::new()))?;
        }
        Ok(self.heard.last.elapsed() > IDLE || self.heard.wanted.elapsed() > IDLE)
    }

    fn send_news(&mut self) -> Result<(), Error> {
        let news = self.shared.news(self.client, self.n_known);
        if !news.channels.is_empty() {
            let channels = news.channels.iter().map(|(id, channel)| {
                json!({
                    "id": id,
                    "topic": channel.topic,
                    "encoding": "json",
                    "schemaName": channel.schema_name,
                    "schema": channel.schema,
                    "schemaEncoding": "jsonschema",
                })
            });
            let channels: Vec<Value> = channels.collect();
            self.n_known += channels.len();
            self.send_text(&json!({"op": "advertise", "channels": channels}))?;
        }
        for (subscription, LiveMessage { time, data, .. }) in news.messages {
            // What is reported first of an earlier time does not set the clock back
            if self.time.is_none_or(|reported| reported < time) {
                self.time = Some(time);
                let mut frame = vec![TIME];
                frame.extend(time.to_le_bytes());
                self.socket.write(Message::binary(frame))?;
            }
            let mut frame = Vec::with_capacity(13 + data.len());
            frame.push(MESSAGE_DATA);
            frame.extend(subscription.to_le_bytes());
            frame.extend(time.to_le_bytes());
            frame.extend_from_slice(&data);
            self.socket.write(Message::binary(frame))?;
        }
        self.socket.flush()
    }

    fn send_text(&mut self, what: &Value) -> Result<(), Error> {
        self.socket.send(Message::text(what.to_string()))
    }

    /// Subscriptions; whether they are such as a viewer sends: no more than there are channels.
    fn hear(&self, message: &Message) -> bool {
        let Message::Text(text) = message else { return true };
        let Ok(words) = serde_json::from_str::<Words>(text) else { return true };
        let most = self.n_known;
        if words.subscriptions.len() > most || words.subscription_ids.len() > most {
            return false;
        }
        match words.op.as_str() {
            "subscribe" => {
                for Subscription { id, channel_id } in words.subscriptions {
                    self.shared.subscribe(self.client, id, channel_id as usize);
                }
            }
            "unsubscribe" => self.shared.unsubscribe(self.client, &words.subscription_ids),
            _ => {}
        }
        true
    }
}

fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}
