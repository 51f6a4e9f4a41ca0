//! `Recording`: what was asked for in a session and where it paused, as `commands.csv` has it.

use csv::{ReaderBuilder, StringRecord, Trim};
use serde::{Deserialize, Serialize};

use crate::model::commands::Asked;

/// Columns of the file.
const COLUMNS: [&str; 3] = ["time", "command", "target"];

/// What was asked for, and the times up to which a run went at once.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// What was asked for, by time.
    pub asked: Vec<Asked>,
    /// Times at which the run paused (s), ascending: those of what was asked for among them.
    pub pauses: Vec<f64>,
}

impl Recording {
    /// The head of the file.
    #[must_use]
    pub fn header() -> String {
        COLUMNS.join(",") + "\n"
    }

    /// The row of something that was asked for. Numbers have the digits to read the same number back.
    #[must_use]
    pub fn row(asked: &Asked) -> String {
        let Asked { time, command, target } = asked;
        format!("{time:?},{command},{target:?}\n")
    }

    /// The row of a time (s) at which a run paused.
    #[must_use]
    pub fn pause(time: f64) -> String {
        format!("{time:?},,\n")
    }

    /// The whole file.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = Self::header();
        let mut asked = self.asked.iter().peekable();
        for pause in &self.pauses {
            while let Some(one) = asked.next_if(|one| one.time < *pause) {
                text += &Self::row(one);
            }
            text += &Self::pause(*pause);
        }
        asked.for_each(|one| text += &Self::row(one));
        text
    }

    /// Adds something that is asked for, in place of what was asked of the same command at the same time.
    pub fn ask(&mut self, asked: Asked) {
        self.pause_at(asked.time);
        let same = self.asked.partition_point(|other| other.time < asked.time);
        match self.asked[same..].iter().position(|other| other.command == asked.command) {
            Some(nth) => self.asked[same + nth] = asked,
            None => self.asked.push(asked),
        }
    }

    /// Adds a time (s) at which a run pauses.
    pub fn pause_at(&mut self, time: f64) {
        if self.pauses.last().is_none_or(|last| *last < time) {
            self.pauses.push(time);
        }
    }

    /// Reads such a file.
    ///
    /// # Errors
    /// What is wrong with it, with the number of the line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader =
            ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| error.to_string())?.clone();
        if header.iter().ne(COLUMNS) {
            let found: Vec<&str> = header.iter().collect();
            return Err(format!(
                "line 1: the columns are `{}`, and `{}` are wanted, as a session writes them",
                found.join(","),
                COLUMNS.join(",")
            ));
        }
        let mut recording = Self::default();
        for row in reader.records() {
            let row = row.map_err(|error| error.to_string())?;
            let line = row.position().map_or(0, csv::Position::line);
            recording.add(&row).map_err(|what| format!("line {line}: {what}"))?;
        }
        Ok(recording)
    }

    fn add(&mut self, row: &StringRecord) -> Result<(), String> {
        let number = |column: usize| -> Result<f64, String> {
            let text = row.get(column).unwrap_or_default();
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| format!("{} is `{text}`; write a finite number", COLUMNS[column]))
        };
        let time = number(0)?;
        if time < 0.0 {
            return Err(format!("time {time} is before the start of a run, 0"));
        }
        if let Some(last) = self.pauses.last().filter(|last| **last > time) {
            return Err(format!("time {time} comes after {last}; times must not fall"));
        }
        let command = row.get(1).unwrap_or_default();
        if !command.is_empty() {
            let target = number(2)?;
            self.ask(Asked { time, command: command.to_owned(), target });
        } else if row.get(2).is_some_and(|target| !target.is_empty()) {
            return Err("a target without a command; write its name before it".to_owned());
        }
        self.pause_at(time);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_is_read_as_it_is_written() {
        let ask = |time: f64, command: &str, target: f64| Asked {
            time,
            command: command.to_owned(),
            target,
        };
        let third = 1.0 / 3.0;
        let recording = Recording {
            asked: vec![ask(0.0, "eel.joint.1", third), ask(third, "eel.joint.2", -1e-300)],
            pauses: vec![0.0, 0.1, third, 0.5],
        };
        assert_eq!(Recording::parse(&recording.to_csv()).unwrap(), recording);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let wrong =
            |rows: &str| Recording::parse(&format!("time,command,target\n{rows}")).unwrap_err();
        assert!(wrong("0.0,a,nan").starts_with("line 2: target is `nan`"));
        assert!(wrong("0.0,a,1\n0.5,,\n0.4,a,1").starts_with("line 4: time 0.4 comes after 0.5"));
        assert!(wrong("x,a,1").starts_with("line 2: time is `x`"));
        assert!(wrong("-1,a,1").contains("before the start"));
        assert!(wrong("0.0,,1").contains("without a command"));
        assert!(Recording::parse("time,name\n").unwrap_err().contains("the columns are"));
        assert!(wrong("0.0,a").contains("line"));
    }
}
