//! What a record says of the markers and of the control of a soft case.

use std::f64::consts::TAU;

use crate::soft::{Gaps, Record, SoftError};

use alewife_case::Diagnostic;
use alewife_case::soft::SoftFile;
use alewife_case::soft::spec::{AngleUnit, RecordGaps, RecordSpec};
use alewife_case::soft::stretch::Stretch;

/// Largest relative difference of the time between rows of a record from that of a frame.
const APART: f64 = 1e-2;

/// Places of the marks, angles between them and contractions of tendons, frame by frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Displacements (m) from the first frame, by frame, marker and axis; not a number where nothing is known.
    pub displacements: Vec<Vec<Vec<f64>>>,
    /// Changes of angles (rad) from the first frame, by frame and angle; not a number where nothing is known.
    pub angles: Vec<Vec<f64>>,
    /// The stretches that sets of fibres are told, for those that the record tells, frame by frame.
    pub stretches: Vec<Option<Vec<f64>>>,
}

/// Reads the record of a case.
///
/// # Errors
/// What is wrong in it, with the row, or with what the case says of it.
pub fn recorded(file: &SoftFile) -> Result<Option<Recorded>, Diagnostic> {
    let (Some(spec), Some(beside)) = (&file.case.record, &file.record) else { return Ok(None) };
    let has_begin = spec.begins_with.is_some();
    // Rows without the control are left out, which is told from it alone
    let kept = has_begin || spec.gaps == RecordGaps::Kept;
    let gaps = if kept { Gaps::Kept } else { Gaps::Refused };
    let text = String::from_utf8_lossy(&beside.bytes);
    let record = Record::parse(&beside.name, &text, gaps).map_err(|error| {
        let help = match &error {
            SoftError::Record { what, .. } if what.contains("gaps") => {
                "write a number there, or record.gaps = \"kept\", which leaves such values out"
            }
            _ => "write a time that rises and one number for each column in every row",
        };
        file.error("record.file", error.to_string(), help)
    })?;
    let reader = Reader { file, spec, record };
    let rows = reader.rows()?;
    let displacements = reader.displacements(&rows)?;
    let angles = reader.angles(&rows)?;
    Ok(Some(Recorded { displacements, angles, stretches: reader.stretches(&rows)? }))
}

/// A column, with the sign of its values.
#[derive(Debug, Clone, Copy)]
struct Signed {
    column: usize,
    sign: f64,
}

struct Reader<'a> {
    file: &'a SoftFile,
    spec: &'a RecordSpec,
    record: Record,
}

impl Reader<'_> {
    /// The column of a name, with the sign of its values.
    fn column(&self, key: &str, name: &str) -> Result<Signed, Diagnostic> {
        let (name, sign) = match name.strip_prefix('-') {
            Some(rest) if !self.record.names.iter().any(|own| own == name) => (rest, -1.0),
            _ => (name, 1.0),
        };
        let found = self.record.names.iter().position(|own| own == name);
        found.map(|column| Signed { column, sign }).ok_or_else(|| {
            let message = format!("the record has no column `{name}`");
            let help = format!("its columns: {}", self.record.names.join(", "));
            self.file.error(key, message, &help)
        })
    }

    /// The rows of the frames, of which there is one more than frames: the last ends at the next row.
    fn rows(&self) -> Result<Vec<usize>, Diagnostic> {
        let frames = self.file.case.soft.frames;
        let mut rows: Vec<usize> = (0..self.record.rows.len()).collect();
        if let Some(name) = &self.spec.begins_with {
            let key = "record.begins_with";
            let Signed { column, .. } = self.column(key, name)?;
            rows.retain(|row| !self.record.rows[*row][column].is_nan());
            let value = |row: &usize| self.record.rows[*row][column];
            let first = rows.first().map(value);
            let begin = rows.iter().position(|row| Some(value(row)) != first).ok_or_else(|| {
                let message = format!("`{name}` never changes in the record");
                self.file.error(key, message, "name another column, or take the key out")
            })?;
            rows.drain(..begin);
        }
        let n = rows.len();
        if n <= frames {
            let message = format!(
                "the control has {frames} frames, which take {} rows of the record, and it has {n} from where \
                 it begins",
                frames + 1
            );
            let help = format!("write soft.frames = {} or less", n.saturating_sub(1));
            return Err(self.file.error("soft.frames", message, &help));
        }
        rows.truncate(frames + 1);
        self.check_times(&rows)?;
        Ok(rows)
    }

    fn check_times(&self, rows: &[usize]) -> Result<(), Diagnostic> {
        let time = |row: usize| self.record.times[row] * self.spec.time_unit;
        let frame = self.file.case.soft.frame;
        for (k, pair) in rows.windows(2).enumerate() {
            let apart = time(pair[1]) - time(pair[0]);
            if (apart - frame).abs() <= APART * frame {
                continue;
            }
            let message = format!(
                "row {} of the record is {apart:.4e} s after the one before, and a frame takes {frame:.4e} s",
                pair[1] + 2
            );
            let (key, help) = if k == 0 {
                (
                    "soft.frame",
                    "write the time between rows, or another record.time_unit".to_owned(),
                )
            } else {
                ("record.file", "record evenly, or fewer soft.frames that end before".to_owned())
            };
            return Err(self.file.error(key, message, &help));
        }
        Ok(())
    }

    fn displacements(&self, rows: &[usize]) -> Result<Vec<Vec<Vec<f64>>>, Diagnostic> {
        let n = self.file.case.geometry.dimensions();
        let mut columns: Vec<Vec<Option<Signed>>> = Vec::new();
        for (index, marker) in self.file.case.marker.iter().enumerate() {
            let mut own = Vec::new();
            for (name, axis) in marker.columns.each().into_iter().zip(["x", "y", "z"]).take(n) {
                let key = format!("marker.{index}.columns.{axis}");
                own.push(name.map(|name| self.column(&key, name)).transpose()?);
            }
            columns.push(own);
        }
        let value = |row: usize, Signed { column, sign }: Signed| {
            sign * self.spec.length_unit * self.record.rows[row][column]
        };
        let start = rows[0];
        for (index, own) in columns.iter().enumerate() {
            for Signed { column, .. } in own.iter().flatten() {
                self.check_gaps(rows, *column, &format!("marker.{index}.columns"))?;
            }
        }
        let moved = |row: usize, column: Option<Signed>| {
            column.map_or(f64::NAN, |column| value(row, column) - value(start, column))
        };
        let frame = |row: &usize| -> Vec<Vec<f64>> {
            columns.iter().map(|own| own.iter().map(|c| moved(*row, *c)).collect()).collect()
        };
        Ok(rows.iter().map(frame).collect())
    }

    /// Changes of angles (rad) from the first frame.
    fn angles(&self, rows: &[usize]) -> Result<Vec<Vec<f64>>, Diagnostic> {
        let mut columns = Vec::new();
        for (index, angle) in self.file.case.angle.iter().enumerate() {
            let key = format!("angle.{index}.column");
            let column = angle.column.as_ref().map(|name| self.column(&key, name)).transpose()?;
            if let Some(Signed { column, .. }) = column {
                self.check_gaps(rows, column, &key)?;
                self.check_unit(rows, column)?;
            }
            columns.push(column);
        }
        let unit = self.spec.angle_unit.radians();
        let changed = |row: usize, column: &Option<Signed>| {
            let change = |Signed { column, sign }: &Signed| {
                sign * unit * (self.record.rows[row][*column] - self.record.rows[rows[0]][*column])
            };
            column.as_ref().map_or(f64::NAN, change)
        };
        let frame = |row: &usize| columns.iter().map(|column| changed(*row, column)).collect();
        Ok(rows.iter().map(frame).collect())
    }

    /// Refuses angles that are degrees, by their name or as no bend changes by more than a turn, and are read as radians.
    fn check_unit(&self, rows: &[usize], column: usize) -> Result<(), Diagnostic> {
        let name = &self.record.names[column];
        let is_deg = self.spec.angle_unit == AngleUnit::Deg;
        let change =
            |row: &usize| self.record.rows[*row][column] - self.record.rows[rows[0]][column];
        let far = rows.iter().find(|row| change(row).abs() > TAU);
        let message = match far {
            _ if is_deg => return Ok(()),
            _ if name.to_lowercase().contains("deg") => {
                format!("`{name}` is a column of degrees by its name, and is read in radians")
            }
            Some(row) => {
                let change = change(row);
                format!(
                    "`{name}` changes by {change:.3} rad until row {}, more than a turn",
                    row + 2
                )
            }
            None => return Ok(()),
        };
        let help =
            "write record.angle_unit = \"deg\" if these are degrees, or another name of the column";
        Err(self.file.error("record.angle_unit", message, help))
    }

    /// Refuses gaps in a column of a key, where they are not kept or are in the first frame.
    fn check_gaps(&self, rows: &[usize], column: usize, key: &str) -> Result<(), Diagnostic> {
        let start = rows[0];
        let is_gap = |row: usize| self.record.rows[row][column].is_nan();
        let gap = rows.iter().find(|row| is_gap(**row));
        let is_refused = self.spec.gaps == RecordGaps::Refused || is_gap(start);
        match gap.filter(|_| is_refused) {
            Some(row) => Err(self.gap(key, *row, column, *row == start)),
            None => Ok(()),
        }
    }

    fn gap(&self, key: &str, row: usize, column: usize, is_start: bool) -> Diagnostic {
        let name = &self.record.names[column];
        let message = format!("row {} of the record has no number in `{name}`", row + 2);
        let help = if is_start {
            "changes count from this row: begin at another one"
        } else {
            "write a number there, or record.gaps = \"kept\", which leaves such values out"
        };
        self.file.error(key, message, help)
    }

    fn stretches(&self, rows: &[usize]) -> Result<Vec<Option<Vec<f64>>>, Diagnostic> {
        let fibres = self.file.case.solid.iter().flat_map(|solid| &solid.fibre);
        let mut all = Vec::new();
        for (n, fibre) in fibres.enumerate() {
            let Stretch::Record(told) = &fibre.stretch else {
                all.push(None);
                continue;
            };
            let key = format!("solid.0.fibre.{n}.stretch.record.contraction");
            let Signed { column, sign } = self.column(&key, &told.contraction)?;
            let scale = sign * self.spec.length_unit / told.length;
            let mut own = Vec::new();
            for row in &rows[..rows.len() - 1] {
                let stretch = 1.0 - scale * self.record.rows[*row][column];
                if stretch.is_nan() || stretch <= 0.0 {
                    let message =
                        format!("row {} of the record tells the stretch {stretch}", row + 2);
                    let help = "a stretch is above 0: check the units, the column and the length";
                    return Err(self.file.error(&key, message, help));
                }
                own.push(stretch);
            }
            all.push(Some(own));
        }
        Ok(all)
    }
}
