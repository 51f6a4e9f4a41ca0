//! `--live`: viewers connect to a run under way, and change nothing of it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

use super::{alewife, done};

/// Some seconds of steps, as long as a test lasts.
const LONG: [&str; 11] = [
    "run",
    "squirmer-pair",
    "--threads",
    "1",
    "--quiet",
    "--set",
    "mesh.scale=2",
    "--set",
    "time.unsteady.end=60",
    "--set",
    "time.unsteady.step=0.001",
];

/// A run under way, ended with the test.
struct Live {
    run: Child,
    address: String,
    /// Kept open, as the run writes to it.
    _stderr: BufReader<ChildStderr>,
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = self.run.kill();
        let _ = self.run.wait();
    }
}

fn start(directory: &Path, arguments: &[&str]) -> Live {
    let mut run = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(arguments)
        .args(["--out", "run", "--live", "127.0.0.1:0"])
        .current_dir(directory)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stderr = BufReader::new(run.stderr.take().unwrap());
    let mut line = String::new();
    stderr.read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("live at ws://").unwrap().to_owned();
    Live { run, address, _stderr: stderr }
}

struct Viewer {
    socket: WebSocket<TcpStream>,
}

impl Viewer {
    fn connect(address: &str, protocol: &str) -> Self {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let mut request = format!("ws://{address}").into_client_request().unwrap();
        request.headers_mut().insert("Sec-WebSocket-Protocol", protocol.parse().unwrap());
        let (socket, response) = tungstenite::client(request, stream).unwrap();
        let chosen = response.headers()["Sec-WebSocket-Protocol"].to_str().unwrap();
        assert!(protocol.split(", ").any(|offered| offered == chosen), "{chosen}");
        Self { socket }
    }

    fn text(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().unwrap() {
                return serde_json::from_str(&text).unwrap();
            }
        }
    }

    /// Channels by their topics, until there is this one.
    fn channels(&mut self, until: &str) -> Vec<Value> {
        let mut all: Vec<Value> = Vec::new();
        while !all.iter().any(|channel| channel["topic"] == until) {
            let told = self.text();
            assert_eq!(told["op"], "advertise");
            all.extend(told["channels"].as_array().unwrap().iter().cloned());
        }
        all
    }

    fn subscribe(&mut self, id: u32, channel: &Value) {
        let subscription = json!({"id": id, "channelId": channel["id"]});
        let request = json!({"op": "subscribe", "subscriptions": [subscription]});
        self.socket.send(Message::text(request.to_string())).unwrap();
    }

    /// The next message of a channel: its subscription, time and content.
    fn message(&mut self) -> Received {
        loop {
            let Message::Binary(data) = self.socket.read().unwrap() else { continue };
            if data[0] == 1 {
                return Received {
                    subscription: u32::from_le_bytes(data[1..5].try_into().unwrap()),
                    time: u64::from_le_bytes(data[5..13].try_into().unwrap()),
                    content: serde_json::from_slice(&data[13..]).unwrap(),
                };
            }
            assert_eq!((data[0], data.len()), (2, 9), "a time");
        }
    }
}

struct Received {
    subscription: u32,
    time: u64,
    content: Value,
}

fn channel<'a>(all: &'a [Value], topic: &str) -> &'a Value {
    all.iter().find(|channel| channel["topic"] == topic).unwrap()
}

#[test]
fn a_late_viewer_is_shown_the_scene_and_the_steps() {
    let directory = tempfile::tempdir().unwrap();
    let live = start(directory.path(), &LONG);
    for protocol in ["foxglove.websocket.v1", "foxglove.sdk.v1, foxglove.websocket.v1"] {
        let mut viewer = Viewer::connect(&live.address, protocol);
        let info = viewer.text();
        assert_eq!(info["op"], "serverInfo");
        assert!(info["name"].as_str().unwrap().contains("squirmer-pair"), "{info}");
        assert_eq!(info["capabilities"], json!(["time"]));
        let channels = viewer.channels("/forces");
        for known in &channels {
            let schema: Value = serde_json::from_str(known["schema"].as_str().unwrap()).unwrap();
            assert_eq!(
                (&schema["type"], &schema["title"]),
                (&json!("object"), &known["schemaName"])
            );
            assert_eq!(
                (&known["encoding"], &known["schemaEncoding"]),
                (&json!("json"), &json!("jsonschema"))
            );
        }
        // It was told once, at the start
        viewer.subscribe(7, channel(&channels, "/scene"));
        let Received { subscription, time, content } = viewer.message();
        assert_eq!((subscription, time), (7, 0));
        let names: Vec<&Value> =
            content["entities"].as_array().unwrap().iter().map(|entity| &entity["id"]).collect();
        assert_eq!(names, ["a", "b"]);
        viewer.subscribe(8, channel(&channels, "/step"));
        let steps: Vec<u64> =
            (0..5).map(|_| viewer.message().content["step"].as_u64().unwrap()).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
        // The first one, the latest one, and all that come
        assert!(steps[0] == 0 && steps[3] == steps[2] + 1, "{steps:?}");
    }
}

#[test]
fn viewers_change_no_bit_and_one_that_takes_nothing_delays_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let mut arguments = LONG;
    arguments[8] = "time.unsteady.end=0.3";
    let apart = [&arguments[..], &["--out", "apart"]].concat();
    done(directory.path(), &apart);
    let mut live = start(directory.path(), &arguments);
    // One subscribes to everything and then reads nothing, one speaks no protocol, one goes at once
    let mut idle = Viewer::connect(&live.address, "foxglove.sdk.v1");
    // Once it is told of channels: who subscribes to more than that is sent away
    idle.text();
    idle.channels("/forces");
    for id in 0..10 {
        idle.subscribe(id, &json!({"id": id}));
    }
    let _silent = TcpStream::connect(&live.address).unwrap();
    drop(Viewer::connect(&live.address, "foxglove.sdk.v1"));
    let started = Instant::now();
    assert_eq!(live.run.wait().unwrap().code(), Some(0));
    assert!(started.elapsed() < Duration::from_secs(120));
    let read = |name: &str| std::fs::read(directory.path().join(name)).unwrap();
    assert_eq!(read("run/series.csv"), read("apart/series.csv"));
    drop(idle);
}

#[test]
fn an_address_that_is_taken_or_none_is_refused_before_anything_is_made() {
    let directory = tempfile::tempdir().unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().map(|address| (taken, address.to_string())).unwrap();
    for (address, said) in [(taken.1.as_str(), "cannot listen at"), ("here", "is no ADDRESS:PORT")]
    {
        let output = alewife(directory.path(), &["run", "squirmer-pair", "--live", address]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(said) && stderr.contains(address), "{stderr}");
        assert!(!directory.path().join("runs").exists());
    }
}

#[test]
fn a_request_of_a_web_page_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let live = start(directory.path(), &LONG);
    let mut stream = TcpStream::connect(&live.address).unwrap();
    std::io::Write::write_all(&mut stream, b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    // It may be closed without a word
    let _ = stream.read_to_end(&mut answer);
    assert!(!answer.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&answer));
}

/// The status with which a server answers an upgrade as a browser sends it, and whether it was made.
fn upgrade(address: &str, host: &str, origin: Option<&str>) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let origin = origin.map_or_else(String::new, |origin| format!("Origin: {origin}\r\n"));
    let request = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\n{origin}Upgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut line = String::new();
    BufReader::new(stream).read_line(&mut line).unwrap();
    line.split_whitespace().nth(1).unwrap_or_default().to_owned()
}

#[test]
fn a_page_of_another_origin_or_under_another_name_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let live = start(
        directory.path(),
        &[&LONG[..], &["--live-origin", "https://viewer.example"]].concat(),
    );
    let here = live.address.as_str();
    let port = here.rsplit_once(':').unwrap().1;
    let named = format!("localhost:{port}");
    for (host, origin, status) in [
        (here, None, "101"),
        (&named, None, "101"),
        (here, Some("http://localhost:3000"), "101"),
        (here, Some("https://viewer.example"), "101"),
        (here, Some("http://evil.example"), "403"),
        (here, Some("http://localhost.evil.example"), "403"),
        (here, Some("null"), "403"),
        // Its name stands for this machine's address: DNS rebinding
        ("evil.example", Some("http://evil.example"), "403"),
        ("evil.example", None, "403"),
        (&format!("evil.example:{port}"), Some(&format!("http://evil.example:{port}")), "403"),
    ] {
        assert_eq!(upgrade(here, host, origin), status, "{host} {origin:?}");
    }
    let alone = alewife(directory.path(), &["run", "squirmer-pair", "--live-origin", "a.example"]);
    assert_eq!(alone.status.code(), Some(2));
}

#[test]
fn a_viewer_that_asks_for_too_much_is_closed_and_the_run_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let live = start(directory.path(), &LONG);
    let flood = |of: &dyn Fn(usize) -> Value, n: usize| {
        let mut viewer = Viewer::connect(&live.address, "foxglove.sdk.v1");
        assert_eq!(viewer.text()["op"], "serverInfo");
        viewer.channels("/forces");
        let subscriptions: Vec<Value> = (0..n).map(of).collect();
        let request = json!({"op": "subscribe", "subscriptions": subscriptions}).to_string();
        // Sooner or later nothing is taken any more
        for _ in 0..400 {
            if viewer.socket.send(Message::text(request.clone())).is_err() {
                return;
            }
        }
        let started = Instant::now();
        while viewer.socket.read().is_ok() {
            assert!(started.elapsed() < Duration::from_secs(20), "it was not closed");
        }
    };
    flood(&|nth| json!({"id": nth, "channelId": 99_999}), 30_000);
    flood(&|nth| json!({"id": nth, "channelId": 0}), 3000);
    flood(&|nth| json!({"id": nth, "channelId": 0}), 1);
    // One channel is sent once, however often it is asked for
    let mut viewer = Viewer::connect(&live.address, "foxglove.sdk.v1");
    assert_eq!(viewer.text()["op"], "serverInfo");
    let channels = viewer.channels("/forces");
    for id in [1, 2, 3] {
        viewer.subscribe(id, channel(&channels, "/step"));
    }
    let mut steps: Vec<u64> = Vec::new();
    let mut last = 0;
    while steps.len() < 20 || last != 3 {
        let message = viewer.message();
        steps.push(message.content["step"].as_u64().unwrap());
        last = message.subscription;
    }
    assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
}
