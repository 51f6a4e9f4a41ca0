//! `run.mcap`: bodies and quantities as messages, for viewers and for post-processing.
//!
//! Messages are stamped with the simulated time, so that two runs of one case write the same
//! bytes after the provenance. The file is read from its start: what was flushed before a run was
//! killed can be read, though the index at its end is missing.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, McapError, Schema, WriteOptions, Writer};
use serde::Serialize;

use super::drawing::{Arm, WallBox, arms, forces, walls};
use super::foxglove::{self, Kind, Severity};
use super::messages::Messages;
use super::points::{point_cloud, scalar_cloud};
use super::primitives::nanoseconds;
use super::quantities::Group;
use super::scene::{Shown, scene};
use crate::case::{Body, Model};
use crate::observer::live::{LiveChannel, LiveServer};
use crate::observer::run_directory::{History, RunDirectory};
use crate::observer::schedule::Schedule;
use crate::observer::system::{AtPath, unfinished_file};
use crate::run::{LastState, Observer, RunError, SavedState, Snapshot};

/// Size of a chunk, the unit of compression (bytes).
const CHUNK: u64 = 256 * 1024;

/// Steps between two flushes, except for the first few. Steps and not seconds, because a flush
/// ends a chunk, and the bytes of a file shall not depend on the speed of a machine.
const FLUSH_STEPS: usize = 16;

/// Topic of the outlines of bodies, which come once but for those that change.
const SCENE: &str = "/scene";
/// Topic of the sides of the domain, which come again where they have moved.
const WALLS: &str = "/walls";
/// Topic of arms between bodies.
const ARMS: &str = "/arms";
/// Topic of forces on bodies.
const FORCES: &str = "/forces";
/// Topic of the log.
const LOG: &str = "/log";
/// Topics whose messages come with each row: `/body/NAME` besides.
const EACH_ROW: [&str; 2] = ["/step", "/tf"];
/// Length of the longest arrow over the radius of the largest body.
const ARROW: f64 = 2.0;

/// The open file.
pub struct MessageFile {
    /// Nothing once the file is finished.
    writer: Option<Writer<BufWriter<File>>>,
    /// The same file.
    file: File,
    path: PathBuf,
    /// Of rows.
    schedule: Schedule,
    /// Of scalars all over the fluid, which come as often as fields do.
    field_schedule: Schedule,
    channels: BTreeMap<String, Channel>,
    /// Who looks on while the run is under way.
    live: Option<LiveServer>,
    /// Made with the first step.
    groups: Vec<Group>,
    arms: Vec<Arm>,
    /// Whether the outline of a body changes in time.
    deforms: bool,
    /// Where the walls were drawn.
    walls: Option<WallBox>,
    /// Length of the longest arrow (m).
    longest_arrow: f64,
    sequence: u32,
    title: String,
    bodies: Vec<Body>,
    time: f64,
}

/// Numbers of a topic, in the file and for those who look on.
#[derive(Debug, Clone, Copy)]
struct Channel {
    file: u16,
    live: Option<usize>,
}

impl MessageFile {
    /// `run.mcap` in `directory`, with the case as attachment, the provenance as metadata, and the
    /// messages of a run that resumes. A live server is sent the same.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn create(
        directory: &RunDirectory,
        model: &Model,
        history: Option<&History>,
        live: Option<LiveServer>,
    ) -> io::Result<Self> {
        let schedule = |cadence| Schedule::new(cadence, history.map(|history| history.time));
        // The file that is there, if any, is replaced once all its messages are in the new one
        let unfinished = unfinished_file(directory.path())?;
        let file = BufWriter::new(unfinished.reopen()?);
        let mut writer = WriteOptions::new()
            .library(concat!("alewife ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            .chunk_size(Some(CHUNK))
            // A chunk's length is then written with the chunk, never patched in later: a killed
            // run ends in a plain end of file.
            .disable_seeking(true)
            .create(file)
            .map_err(to_io)?;
        let provenance = directory.provenance().flattened()?;
        writer
            .write_metadata(&Metadata { name: "provenance".to_owned(), metadata: provenance })
            .map_err(to_io)?;
        writer
            .attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: "case.toml".to_owned(),
                media_type: "application/toml".to_owned(),
                data: Cow::Borrowed(directory.case_text().as_bytes()),
            })
            .map_err(to_io)?;
        let mut made = Self {
            writer: Some(writer),
            file: unfinished.reopen()?,
            schedule: schedule(model.case.output.series),
            field_schedule: schedule(model.case.output.fields),
            path: directory.path().join("run.mcap"),
            channels: BTreeMap::new(),
            live,
            groups: Vec::new(),
            arms: Arm::all(model),
            deforms: model.bodies.iter().any(Body::deforms),
            walls: None,
            longest_arrow: 0.0,
            sequence: 0,
            title: model.case.title.clone(),
            bodies: model.bodies.clone(),
            time: 0.0,
        };
        if let Some(history) = history {
            made.take_over(history)?;
        }
        if let Some(writer) = &mut made.writer {
            writer.flush().map_err(to_io)?;
        }
        unfinished.as_file().sync_all().at(&made.path)?;
        unfinished.persist(&made.path).map_err(|refused| refused.error).at(&made.path)?;
        Ok(made)
    }

    /// Copies the messages of another file up to the time of a state; what a killed run left half written
    /// is not there. Where more is missing, that is reported.
    fn take_over(&mut self, history: &History) -> io::Result<()> {
        let path = history.directory.join("run.mcap");
        let found = match std::fs::read(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Messages::default(),
            read => Messages::read(&read.at(&path)?),
        };
        let last = nanoseconds(history.time);
        let mut n_kept = 0;
        for message in found.all.iter().filter(|message| message.time <= last) {
            let Some(schema) = found.schemas.get(&message.schema) else { continue };
            let channel = self.channel(&message.topic, || Ok(schema.to_mcap()))?;
            self.write(channel, message.time, &message.data)?;
            let topic = message.topic.as_str();
            n_kept += usize::from(EACH_ROW.contains(&topic) || topic.starts_with("/body/"));
            if topic == WALLS {
                self.walls = serde_json::from_slice(&message.data)
                    .ok()
                    .and_then(|of| WallBox::of_scene(&of));
            }
            self.time = Duration::from_nanos(message.time).as_secs_f64();
        }
        // Rows and messages are of the same steps, and both are on the disk before a state is
        let n_written = history.series.times.len() * (2 + self.bodies.len());
        if n_kept < n_written {
            let reason = found.damage.unwrap_or_else(|| "it is too short".to_owned());
            let (path, from, to) = (path.display(), self.time, history.time);
            tracing::warn!(
                "{path} is damaged ({reason}): {} of {n_written} messages, from t {from} to t {to}, are lost",
                n_written - n_kept
            );
            let lost = format!("{} messages up to t {to} are lost: {reason}", n_written - n_kept);
            self.log(Severity::Warning, &lost)?;
        }
        self.time = history.time;
        self.log(Severity::Info, "resumed")
    }

    fn send(&mut self, topic: &str, kind: Kind, message: &impl Serialize) -> io::Result<()> {
        let channel = self.channel(topic, || {
            Ok(Schema {
                id: 0,
                name: kind.schema_name().to_owned(),
                encoding: "jsonschema".to_owned(),
                data: Cow::Owned(serde_json::to_vec(&kind.schema())?),
            })
        })?;
        self.write(channel, nanoseconds(self.time), &serde_json::to_vec(message)?)
    }

    fn send_quantities(&mut self, values: &[f64]) -> io::Result<()> {
        let groups = std::mem::take(&mut self.groups);
        let sent = groups.iter().try_for_each(|group| {
            let channel = self.channel(&group.topic, || {
                Ok(Schema {
                    id: 0,
                    name: group.schema_name.clone(),
                    encoding: "jsonschema".to_owned(),
                    data: Cow::Owned(serde_json::to_vec(&group.schema)?),
                })
            })?;
            self.write(channel, nanoseconds(self.time), &group.message(values)?)
        });
        self.groups = groups;
        sent
    }

    /// The channel of a topic, made with its schema when it is first asked for.
    fn channel<'a>(
        &mut self,
        topic: &str,
        schema: impl FnOnce() -> io::Result<Schema<'a>>,
    ) -> io::Result<Channel> {
        if let Some(&channel) = self.channels.get(topic) {
            return Ok(channel);
        }
        let Some(writer) = &mut self.writer else { return Ok(Channel { file: 0, live: None }) };
        let Schema { name, encoding, data, .. } = schema()?;
        let schema = writer.add_schema(&name, &encoding, &data).map_err(to_io)?;
        let file = writer.add_channel(schema, topic, "json", &BTreeMap::new()).map_err(to_io)?;
        let live = self.live.as_ref().map(|live| {
            let schema = String::from_utf8_lossy(&data).into_owned();
            live.add_channel(LiveChannel { topic: topic.to_owned(), schema_name: name, schema })
        });
        let channel = Channel { file, live };
        self.channels.insert(topic.to_owned(), channel);
        Ok(channel)
    }

    fn write(&mut self, channel: Channel, time: u64, data: &[u8]) -> io::Result<()> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        let (channel_id, sequence) = (channel.file, self.sequence);
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.sequence = self.sequence.wrapping_add(1);
        if let (Some(live), Some(channel)) = (&self.live, channel.live) {
            live.publish(channel, time, data);
        }
        writer.write_to_known_channel(&header, data).map_err(to_io)
    }

    fn log(&mut self, severity: Severity, message: &str) -> io::Result<()> {
        self.send(LOG, Kind::Log, &foxglove::log(severity, message, self.time))
    }

    fn finish(&mut self) -> io::Result<()> {
        let Some(mut writer) = self.writer.take() else { return Ok(()) };
        writer.finish().map_err(to_io)?;
        writer.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
    }
}

impl<const D: usize> Observer<D> for MessageFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.step(snapshot).at(&self.path)
    }

    /// The messages up to a state are on the disk before it is.
    fn on_state(&mut self, _state: &Arc<SavedState<D>>) -> io::Result<()> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        writer.flush().map_err(to_io).at(&self.path)?;
        self.file.sync_data().at(&self.path)
    }

    fn on_failure(&mut self, error: &RunError, _last: Option<&LastState<'_, D>>) -> io::Result<()> {
        self.log(Severity::Error, &error.to_string()).at(&self.path)?;
        self.finish().at(&self.path)
    }
}

impl MessageFile {
    fn step<const D: usize>(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.time = snapshot.time;
        let is_first = !self.channels.contains_key(SCENE);
        if is_first {
            let title = format!("start: {}", self.title);
            self.log(Severity::Info, &title)?;
            let all = scene(&self.bodies, snapshot, Shown::All);
            self.send(SCENE, Kind::Scene, &all)?;
        }
        if self.groups.is_empty() {
            self.groups = Group::all(snapshot.names);
            let radii = self.bodies.iter().map(|body| body.shape.reach());
            self.longest_arrow = ARROW * radii.fold(0.0, f64::max);
        }
        if self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            self.row(snapshot)?;
            self.draw(snapshot, is_first)?;
        }
        if self.field_schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            self.scalars(snapshot)?;
        }
        if snapshot.is_last {
            self.log(Severity::Info, "end")?;
            return self.finish();
        }
        let is_due = snapshot.step < FLUSH_STEPS || snapshot.step.is_multiple_of(FLUSH_STEPS);
        match &mut self.writer {
            Some(writer) if is_due => writer.flush().map_err(to_io),
            _ => Ok(()),
        }
    }
}

impl MessageFile {
    /// What belongs to a row of the series.
    fn row<const D: usize>(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.send("/step", Kind::Step, &foxglove::step(snapshot))?;
        self.send_quantities(snapshot.values)?;
        let transforms = foxglove::transforms(snapshot.bodies, self.time);
        self.send("/tf", Kind::Transforms, &transforms)?;
        for (tracer, cloud) in snapshot.case.tracer.iter().zip(snapshot.tracers) {
            let message = point_cloud(cloud, self.time);
            self.send(&format!("/tracers/{}", tracer.name), Kind::Points, &message)?;
        }
        for report in snapshot.bodies {
            let message = foxglove::body(report, snapshot.step, self.time);
            self.send(&format!("/body/{}", report.name), Kind::Body, &message)?;
        }
        Ok(())
    }

    /// Scalars all over the fluid.
    fn scalars<const D: usize>(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        for (scalar, field) in snapshot.case.scalar.iter().zip(snapshot.scalars) {
            let message = scalar_cloud(snapshot.mesh, &field.now, self.time);
            self.send(&format!("/scalars/{}", scalar.name), Kind::Points, &message)?;
        }
        Ok(())
    }

    /// What is drawn besides: bodies that deform, walls that have moved, arms and forces.
    fn draw<const D: usize>(
        &mut self,
        snapshot: &Snapshot<'_, D>,
        is_first: bool,
    ) -> io::Result<()> {
        let time = self.time;
        if self.deforms && !is_first {
            let changed = scene(&self.bodies, snapshot, Shown::Deforming);
            self.send(SCENE, Kind::Scene, &changed)?;
        }
        let place = WallBox::of(snapshot.mesh);
        if let Some(place) = place.filter(|new| self.walls.is_none_or(|old| new.differs(&old))) {
            self.walls = Some(place);
            let drawn = walls(snapshot.mesh, snapshot.case.geometry, &place, time);
            self.send(WALLS, Kind::Scene, &drawn)?;
        }
        if !self.arms.is_empty() {
            self.send(ARMS, Kind::Scene, &arms(&self.arms, snapshot.bodies, time))?;
        }
        if !snapshot.bodies.is_empty() {
            let drawn = forces(snapshot.bodies, self.longest_arrow, time);
            self.send(FORCES, Kind::Scene, &drawn)?;
        }
        Ok(())
    }
}

fn to_io(error: McapError) -> io::Error {
    match error {
        McapError::Io(error) => error,
        other => io::Error::other(other),
    }
}
