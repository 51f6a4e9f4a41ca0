//! `plot`: quantities of a run over time, drawn as text.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::complete;
use super::exit::{Exit, Failure};
use super::style::say;
use crate::case::{several_nearest, significant};
use crate::observer::{columns_of, read_series};
use crate::run::Series;

/// Fewest and most columns of the curve.
const WIDTHS: [usize; 2] = [4, 400];
/// Dots of a character of Braille: across, and along.
const DOTS: [usize; 2] = [2, 4];
/// The bits of these dots, by rows.
const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// What `plot` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife plot runs/squirmer-pair flow.minimum_gap
  alewife plot runs/fish fish.velocity.x fish.power --height 8")]
pub struct Options {
    /// Directory of a run, finished or under way
    #[arg(value_hint = ValueHint::DirPath)]
    run: PathBuf,
    /// Columns of its series.csv
    #[arg(required = true, value_name = "QUANTITY", add = complete::quantity())]
    quantities: Vec<String>,
    /// Rows of each curve
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u16).range(2..=200))]
    height: u16,
    /// Columns; by default those of the terminal, or 80
    #[arg(long, value_parser = clap::value_parser!(u16).range(20..=400))]
    width: Option<u16>,
}

/// Draws quantities.
pub fn plot(options: &Options) -> Result<Exit, Failure> {
    let series = read_series(&options.run).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => {
            Failure::new(Exit::NoInput, format!("{error}; give the directory of a run"))
        }
        _ => error.into(),
    })?;
    let width = options.width.map_or_else(|| columns_of(io::stdout()), usize::from);
    let columns: Vec<Vec<f64>> = options
        .quantities
        .iter()
        .map(|name| column(&series, name, &options.run))
        .collect::<Result<_, _>>()?;
    for (nth, (name, values)) in options.quantities.iter().zip(columns).enumerate() {
        if nth > 0 {
            say("");
        }
        let points = series.times.iter().zip(values).map(|(&time, value)| [time, value]);
        let points: Vec<[f64; 2]> = points.filter(|p| p.iter().all(|x| x.is_finite())).collect();
        say(name);
        match points.last() {
            None => say("  no value yet"),
            Some([_, last]) => {
                curve(&points, [width, usize::from(options.height)]).iter().for_each(|l| say(l));
                say(&format!("last {}, {} values", significant(*last), points.len()));
            }
        }
    }
    Ok(Exit::Done)
}

/// The column of a name, or the nearest names there are.
fn column(series: &Series, name: &str, run: &Path) -> Result<Vec<f64>, Failure> {
    if let Some(values) = series.column(name) {
        return Ok(values);
    }
    let run = run.display();
    let known: Vec<&str> = series.names.iter().map(String::as_str).collect();
    let nearest: Vec<String> =
        several_nearest(name, &known).iter().map(|found| format!("`{found}`")).collect();
    let what = match (known.is_empty(), nearest.is_empty()) {
        (true, _) => "nothing is written yet".to_owned(),
        (false, true) => format!("it has {}", known.join(", ")),
        (false, false) => format!("nearest are {}", nearest.join(", ")),
    };
    Err(Failure::new(Exit::Usage, format!("the series of {run} has no column `{name}`; {what}")))
}

/// A curve with its axes, in lines of so many columns and rows.
fn curve(points: &[[f64; 2]], [width, height]: [usize; 2]) -> Vec<String> {
    let range = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        [values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max)]
    };
    let [times, values] = [range(0), range(1)];
    let labels = [significant(values[1]), significant(values[0])];
    let margin = labels.iter().map(String::len).max().unwrap_or(0);
    let n_columns = width.saturating_sub(margin + 2).clamp(WIDTHS[0], WIDTHS[1]);
    let mut canvas = Canvas::new(n_columns, height);
    let mut before = None;
    for point in points {
        // Later times are to the right, larger values above
        let at = [
            canvas.place(0, point[0], times),
            canvas.dots[1] - 1 - canvas.place(1, point[1], values),
        ];
        canvas.draw(before.unwrap_or(at), at);
        before = Some(at);
    }
    let mut lines: Vec<String> = canvas
        .cells
        .chunks_exact(n_columns)
        .enumerate()
        .map(|(row, cells)| {
            let label = match row {
                0 => labels[0].as_str(),
                _ if row + 1 == height => labels[1].as_str(),
                _ => "",
            };
            let text: String = cells.iter().map(|&bits| braille(bits)).collect();
            format!("{label:>margin$} |{}", text.trim_end())
        })
        .collect();
    let [start, end] = times.map(significant);
    // Where there is no space for both, the end alone
    let start = if start.len() + end.len() < n_columns { start } else { String::new() };
    let gap = n_columns.saturating_sub(start.len() + end.len());
    lines.push(format!("{:margin$} +{}", "", "-".repeat(n_columns)));
    lines.push(format!("{:margin$}  {start}{:gap$}{end}", "", ""));
    lines
}

fn braille(bits: u32) -> char {
    match bits {
        0 => ' ',
        _ => char::from_u32(0x2800 + bits).unwrap_or(' '),
    }
}

/// Characters of Braille that are drawn on dot by dot.
struct Canvas {
    n_columns: usize,
    cells: Vec<u32>,
    dots: [usize; 2],
}

impl Canvas {
    fn new(n_columns: usize, n_rows: usize) -> Self {
        let dots = [n_columns * DOTS[0], n_rows * DOTS[1]];
        Self { n_columns, cells: vec![0; n_columns * n_rows], dots }
    }

    /// Dot of a value within a range along an axis; in the middle where all are equal.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and n")]
    fn place(&self, axis: usize, value: f64, [low, high]: [f64; 2]) -> usize {
        let last = (self.dots[axis] - 1) as f64;
        // Halves, so that the range of the largest numbers is finite
        let extent = 0.5 * high - 0.5 * low;
        let part = if extent > 0.0 { (0.5 * value - 0.5 * low) / extent } else { 0.5 };
        (part.clamp(0.0, 1.0) * last).round() as usize
    }

    /// A straight line between two dots.
    fn draw(&mut self, from: [usize; 2], to: [usize; 2]) {
        let n = from[0].abs_diff(to[0]).max(from[1].abs_diff(to[1]));
        for nth in 0..=n {
            let along = |axis: usize| {
                let [a, b] = [from[axis], to[axis]];
                let way = (a.abs_diff(b) * nth + n / 2).checked_div(n).unwrap_or(0);
                if b > a { a + way } else { a - way }
            };
            let [x, y] = [along(0), along(1)];
            let cell = y / DOTS[1] * self.n_columns + x / DOTS[0];
            self.cells[cell] |= BITS[y % DOTS[1]][x % DOTS[0]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rising_line_goes_from_corner_to_corner_and_no_line_is_too_long() {
        for (width, scale) in [(40, 1.0), (80, 1e300), (20, 1e-300)] {
            let points: Vec<[f64; 2]> =
                (0..=50).map(|i| [f64::from(i), (f64::from(i) - 25.0) * scale]).collect();
            let lines = curve(&points, [width, 6]);
            assert_eq!(lines.len(), 8);
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
            // The last dot is the upper right one of the first row, the first the lower left one of the last
            let bits = |of: char| of as u32 - 0x2800;
            assert_ne!(bits(lines[0].chars().last().unwrap()) & BITS[0][1], 0);
            let first = lines[5].split_once('|').unwrap().1.chars().next().unwrap();
            assert_ne!(bits(first) & BITS[3][0], 0);
        }
    }

    #[test]
    fn one_value_and_equal_values_are_drawn() {
        for points in [vec![[0.0, 3.0]], vec![[0.0, 3.0], [1.0, 3.0]], vec![[1.0, f64::MAX]]] {
            assert_eq!(curve(&points, [30, 2]).len(), 4);
        }
    }
}
