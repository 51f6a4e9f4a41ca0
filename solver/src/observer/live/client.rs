//! One viewer: the WebSocket protocol of Foxglove, from the handshake to the end.

use std::io;
use std::net::TcpStream;
use std::time::Duration;

use serde_json::{Value, json};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::HeaderValue;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};

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
/// Longest message of a client (bytes): subscriptions to all channels are far less.
const LONGEST_REQUEST: usize = 1 << 20;

/// Serves a client until it goes or the run is over.
///
/// # Errors
/// What went wrong with the connection.
pub fn serve(stream: TcpStream, shared: &Shared, name: &str) -> Result<(), Error> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let config = WebSocketConfig::default().max_message_size(Some(LONGEST_REQUEST));
    let socket = tungstenite::accept_hdr_with_config(stream, choose_protocol, Some(config))
        .map_err(|refused| Error::Io(io::Error::other(refused.to_string())))?;
    socket.get_ref().set_read_timeout(Some(TICK))?;
    let client = shared.enter();
    let served = Connection { socket, shared, client, n_known: 0, time: None }.run(name);
    shared.leave(client);
    served
}

#[expect(clippy::result_large_err, reason = "the signature is that of the handshake")]
fn choose_protocol(request: &Request, mut response: Response) -> Result<Response, ErrorResponse> {
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
            let mut refusal =
                ErrorResponse::new(Some(format!("protocols: {}", PROTOCOLS.join(", "))));
            *refusal.status_mut() = tungstenite::http::StatusCode::BAD_REQUEST;
            Err(refusal)
        }
    }
}

struct Connection<'a> {
    socket: WebSocket<TcpStream>,
    shared: &'a Shared,
    client: usize,
    /// Number of channels that the client knows.
    n_known: usize,
    /// Latest simulated time that was sent to it (ns).
    time: Option<u64>,
}

impl Connection<'_> {
    fn run(mut self, name: &str) -> Result<(), Error> {
        self.tell(&json!({
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
            self.tell_news()?;
            if is_over {
                self.socket.close(None)?;
                return self.socket.flush();
            }
            match self.socket.read() {
                Ok(Message::Text(text)) => self.hear(&text),
                Ok(_) => {}
                Err(Error::Io(error)) if is_timeout(&error) => {}
                Err(Error::ConnectionClosed) => return Ok(()),
                Err(error) => return Err(error),
            }
        }
    }

    fn tell_news(&mut self) -> Result<(), Error> {
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
            self.tell(&json!({"op": "advertise", "channels": channels}))?;
        }
        for (subscription, LiveMessage { time, data, .. }) in news.messages {
            // What is told first of an earlier time does not set the clock back
            if self.time.is_none_or(|told| told < time) {
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

    fn tell(&mut self, what: &Value) -> Result<(), Error> {
        self.socket.send(Message::text(what.to_string()))
    }

    /// Subscriptions; what else a client may want is not offered.
    fn hear(&self, text: &str) {
        let Ok(request) = serde_json::from_str::<Value>(text) else { return };
        let list = |key: &str| request[key].as_array().cloned().unwrap_or_default();
        let number = |value: &Value| value.as_u64().and_then(|number| u32::try_from(number).ok());
        match request["op"].as_str() {
            Some("subscribe") => {
                for one in list("subscriptions") {
                    let [id, channel] = ["id", "channelId"].map(|key| number(&one[key]));
                    if let (Some(id), Some(channel)) = (id, channel) {
                        self.shared.subscribe(self.client, id, channel as usize);
                    }
                }
            }
            Some("unsubscribe") => {
                for id in list("subscriptionIds").iter().filter_map(number) {
                    self.shared.unsubscribe(self.client, id);
                }
            }
            _ => {}
        }
    }
}

fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}
