//! `figure!`: what a test measures, beside what it measured when `tests/figures.toml` was written.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Figures by the module of the test, then by their names.
type Figures = BTreeMap<String, BTreeMap<String, f64>>;

/// Part of a figure by which it may differ before that is shown. Bits are the same on one machine; on
/// another one iterations end elsewhere within their tolerance.
const DRIFT: f64 = 0.05;

/// Figures below are left by rounding or by iterations, of which only the order of magnitude counts.
const NOISE: f64 = 1e-8;

/// Factor by which those may differ.
const NOISE_DRIFT: f64 = 10.0;

/// Part of a figure that its three digits leave open.
const DIGITS: f64 = 0.005;

/// Figures below are as good as zero.
const ROUNDING: f64 = 1e-12;

/// Compares a figure that a test measures with the stored one, and shows by how much it differs: on the
/// terminal, though the test passes, where that is much, or in the output of the test. With `ALEWIFE_UPDATE` it
/// is stored. Thresholds stay in the test.
///
/// The name behind the figure is a format with its arguments.
#[macro_export]
macro_rules! figure {
    ($value:expr, $($name:tt)+) => {
        $crate::record(module_path!(), &format!($($name)+), $value)
    };
}

fn path() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/figures.toml"))
}

fn stored() -> &'static Mutex<Figures> {
    static STORED: OnceLock<Mutex<Figures>> = OnceLock::new();
    STORED.get_or_init(|| {
        let text = std::fs::read_to_string(path()).unwrap_or_default();
        Mutex::new(
            toml::from_str(&text).expect("tests/figures.toml has numbers by module and name"),
        )
    })
}

/// The figures as they are written: three digits, which show a drift and not the machine.
fn written(figures: &Figures) -> String {
    let mut text = String::from(
        "# What tests measure; `ALEWIFE_UPDATE=1 tests/long.sh` and `ALEWIFE_UPDATE=1 cargo test` \
         write it.\n",
    );
    for (module, figures) in figures {
        text += &format!("\n[{module:?}]\n");
        for (name, value) in figures {
            text += &format!("{name:?} = {value:.2e}\n");
        }
    }
    text
}

/// What is to be said of a figure that was another one, and whether that is much.
fn drift(was: f64, is: f64) -> Option<(String, bool)> {
    let message = format!("{is:.2e}, was {was:.2e}");
    if was.abs().max(is.abs()) < NOISE {
        let is_much = is.abs() > NOISE_DRIFT * was.abs().max(ROUNDING);
        return Some((message, is_much));
    }
    let part = (is - was) / was.abs();
    (part.abs() > DIGITS)
        .then(|| (format!("{message} ({:+.1} %)", 100.0 * part), part.abs() > DRIFT))
}

/// What [`figure!`] calls, with the module of the test.
///
/// # Panics
/// When the figure is no number, or `tests/figures.toml` cannot be read or written.
pub fn record(module: &str, name: &str, value: f64) {
    assert!(value.is_finite(), "{module}: {name} is {value}");
    let (_, module) = module.split_once("::").unwrap_or(("", module));
    let mut figures = stored().lock().unwrap_or_else(PoisonError::into_inner);
    let was = figures.get(module).and_then(|figures| figures.get(name)).copied();
    if std::env::var_os("ALEWIFE_UPDATE").is_some() {
        figures.entry(module.to_owned()).or_default().insert(name.to_owned(), value);
        std::fs::write(path(), written(&figures)).expect("tests/figures.toml can be written");
        return;
    }
    let Some(was) = was else {
        println!("{module}: {name} {value:.2e}, not in tests/figures.toml");
        return;
    };
    match drift(was, value) {
        // Past the capture of tests that pass
        Some((message, true)) => {
            let line = format!("drift: {module}: {name} {message}\n");
            std::io::stderr().write_all(line.as_bytes()).expect("the terminal takes it");
        }
        Some((message, false)) => println!("{module}: {name} {message}"),
        None => println!("{module}: {name} {value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Figures, drift, written};

    #[test]
    fn a_drift_is_much_by_its_part_and_that_of_noise_by_its_order() {
        let is_much = |was: f64, is: f64| drift(was, is).is_some_and(|(_, is_much)| is_much);
        assert!(is_much(2.0, 2.2) && is_much(-2.0, -1.8) && is_much(1e-3, 0.0));
        assert!(!is_much(2.0, 2.05) && drift(2.0, 2.0).is_none());
        assert!(!is_much(1e-11, 5e-11) && is_much(1e-11, 5e-10) && is_much(1e-11, 1e-7));
        assert!(!is_much(0.0, 1e-15) && is_much(0.0, 1e-10));
    }

    #[test]
    fn figures_are_read_as_they_are_written() {
        let text = written(&Figures::from([(
            "spatial::joints".to_owned(),
            [("off by \"law\"".to_owned(), 1.234e-7), ("order".to_owned(), -2.0)].into(),
        )]));
        let read: Figures = toml::from_str(&text).unwrap();
        assert_eq!(read["spatial::joints"]["off by \"law\""], 1.23e-7);
        assert_eq!(written(&read), text);
    }
}
