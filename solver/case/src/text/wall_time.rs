//! `WallTime`: a time on the clock on the wall, such as "10 min".

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// Seconds of the units, the shortest last.
const UNITS: [(&str, f64); 4] = [("d", 86_400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0)];

/// A time on the clock on the wall, longer than zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(try_from = "String", into = "String")]
pub struct WallTime {
    seconds: f64,
}

impl WallTime {
    /// So many seconds.
    #[must_use]
    pub const fn from_seconds(seconds: f64) -> Self {
        Self { seconds }
    }

    /// The same as a duration.
    #[must_use]
    pub fn duration(self) -> Duration {
        Duration::from_secs_f64(self.seconds)
    }
}

impl std::str::FromStr for WallTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |unit: &str| text.trim().strip_suffix(unit)?.trim_end().parse::<f64>().ok();
        // "min" before "d": no unit is the end of another one
        let seconds = UNITS.iter().find_map(|(unit, seconds)| Some(number(unit)? * seconds));
        match seconds {
            // A thousand years at most, which any clock can count
            Some(seconds) if seconds > 0.0 && seconds < 3.2e10 => Ok(Self { seconds }),
            _ => Err(format!(
                "\"{text}\" is no time on a clock: write a positive number with its unit, such as \"90 s\", \
                 \"10 min\", \"2 h\" or \"1.5 d\""
            )),
        }
    }
}

impl TryFrom<String> for WallTime {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<WallTime> for String {
    fn from(time: WallTime) -> Self {
        time.to_string()
    }
}

impl fmt::Display for WallTime {
    /// In the longest unit of which it is a whole number, else in seconds.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_whole = |(_, of_unit): &&(&str, f64)| (self.seconds / of_unit).fract() == 0.0;
        let (unit, of_unit) = UNITS.iter().find(is_whole).unwrap_or(&UNITS[UNITS.len() - 1]);
        write!(f, "{} {unit}", self.seconds / of_unit)
    }
}

#[cfg(test)]
mod tests {
    use super::WallTime;

    #[test]
    fn times_are_read_and_written_with_their_unit() {
        for (text, seconds, again) in [
            ("10 min", 600.0, "10 min"),
            ("90s", 90.0, "90 s"),
            ("1.5 h", 5400.0, "90 min"),
            ("2 d", 172_800.0, "2 d"),
            ("0.5 s", 0.5, "0.5 s"),
        ] {
            let time: WallTime = text.parse().unwrap();
            assert_eq!(
                (time.duration().as_secs_f64(), time.to_string().as_str()),
                (seconds, again)
            );
        }
        for wrong in ["", "10", "min", "-1 s", "0 s", "nan s", "inf h", "1e300 d", "10 minutes"] {
            assert!(wrong.parse::<WallTime>().is_err(), "{wrong}");
        }
    }
}
