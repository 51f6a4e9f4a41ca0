//! What a calibration has found, as text and as the file `calibrated.toml`.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use toml::{Table, Value};

use super::Calibrated;
use super::record::Origin;
use crate::case::{FitBy, significant};

/// The file with the case and all that was found, where that is more than coefficients.
pub const RUN: &str = "case.toml";

impl Calibrated {
    /// Why a value says little, if it does.
    fn doubt(&self, nth: usize) -> Option<&'static str> {
        let (value, error) = (self.fit.parameters[nth], self.fit.uncertainties[nth]);
        let [lower, upper] = self.bounds[nth];
        if !self.has_effect[nth] {
            Some("without effect")
        } else if value <= lower || value >= upper {
            Some("at its bound")
        } else if !error.is_finite() || error > value.abs() {
            Some("undetermined")
        } else {
            None
        }
    }

    /// Roots of the sums of squares of what is left, at the end and at the start.
    fn misfits(&self) -> [f64; 2] {
        [self.fit.cost, self.fit.start_cost].map(|cost| (2.0 * cost).sqrt())
    }

    /// Lines for the terminal.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (nth, name) in self.names.iter().enumerate() {
            let (value, error) = (self.fit.parameters[nth], self.fit.uncertainties[nth]);
            let doubt = self.doubt(nth).map_or_else(String::new, |doubt| format!("  {doubt}"));
            // Writing to a text cannot fail
            let _ = writeln!(
                text,
                "{name:28} {:>12} +- {}{doubt}",
                significant(value),
                significant(error)
            );
        }
        let [left, start] = self.misfits();
        let _ = writeln!(text, "left {}, {} at the start", significant(left), significant(start));
        if let Some(tally) = &self.tally {
            let _ = writeln!(text, "{}", tally.text());
        }
        if let Some(remark) = &self.remark {
            let _ = writeln!(text, "{remark}");
        }
        for is_held_out in [false, true] {
            let own: Vec<_> =
                self.deviations.iter().filter(|one| one.is_held_out == is_held_out).collect();
            if own.is_empty() {
                continue;
            }
            let _ = writeln!(text, "\n{}", if is_held_out { "held out" } else { "fitted" });
            for one in own {
                let _ = writeln!(
                    text,
                    "  {:24} {:36} {:>12} {:>12} {:+8.1} %",
                    one.record,
                    one.quantity,
                    significant(one.model),
                    significant(one.recorded),
                    100.0 * one.relative
                );
            }
        }
        text
    }

    /// The case with all that was found, where other numbers than coefficients were, as a text.
    #[must_use]
    pub fn run(&self) -> Option<&str> {
        self.run.as_deref()
    }

    /// The file that a case names as `reduced.calibrated`; where there is more to it than coefficients, all is in
    /// [`Self::run`].
    #[must_use]
    pub fn to_toml(&self) -> String {
        if self.run.is_some() {
            let mut file = Table::new();
            file.insert("calibrated".to_owned(), self.facts().into());
            let head = format!("# Written by `alewife calibrate`. What was found is in {RUN}.\n\n");
            return toml::to_string(&file).map_or_else(|_| String::new(), |text| head + &text);
        }
        let mut reduced = Table::new();
        reduced.insert("loads".to_owned(), self.spec.loads.name().into());
        let values = self.spec.coefficients.iter();
        let values: Table = values.map(|(name, value)| (name.clone(), (*value).into())).collect();
        reduced.insert("coefficients".to_owned(), values.into());
        let table = |own: &BTreeMap<String, f64>| -> Table {
            own.iter().map(|(name, value)| (name.clone(), (*value).into())).collect()
        };
        let bodies = self.spec.body.iter().filter(|(_, own)| !own.is_empty());
        let bodies: Table = bodies.map(|(name, own)| (name.clone(), table(own).into())).collect();
        if !bodies.is_empty() {
            reduced.insert("body".to_owned(), bodies.into());
        }
        let mut file = Table::new();
        file.insert("reduced".to_owned(), reduced.into());
        file.insert("calibrated".to_owned(), self.facts().into());
        let head = "# Written by `alewife calibrate`. A case takes the coefficients by\n\
                    # reduced.calibrated = { file = \"calibrated.toml\" }\n\n";
        toml::to_string(&file).map_or_else(|_| String::new(), |text| format!("{head}{text}"))
    }

    /// Rows of `tracks.csv`: tracks of all runs and records over those of the model.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = "from,holdout,track,time,model,recorded\n".to_owned();
        for one in &self.overlays {
            let rows = one.times.iter().zip(&one.model).zip(&one.recorded);
            for ((time, model), recorded) in rows {
                let name = one.record.replace(['"', ',', '\n'], "_");
                // Writing to a text cannot fail
                let _ = writeln!(
                    text,
                    "{name},{},{},{time:?},{model:?},{recorded:?}",
                    one.is_held_out, one.track
                );
            }
        }
        text
    }

    fn facts(&self) -> Table {
        let mut facts = Table::new();
        facts.insert("case".to_owned(), self.case.clone().into());
        let by = match self.by {
            FitBy::Loads => "loads",
            FitBy::Tracks => "tracks",
            FitBy::Both => "both",
        };
        facts.insert("by".to_owned(), by.into());
        if self.run.is_some() {
            facts.insert("run".to_owned(), RUN.into());
        }
        let texts = |all: &[String]| Value::from(all.to_vec());
        facts.insert("bodies".to_owned(), texts(&self.bodies));
        let fitted = || self.origins.iter().filter(|one| !one.is_held_out);
        let ranges = [
            ("periods", fitted().flat_map(|one| one.periods.clone()).collect::<Vec<f64>>()),
            ("amplitudes", fitted().flat_map(|one| one.amplitudes.clone()).collect()),
            ("viscosities", fitted().map(|one| one.viscosity).collect()),
        ];
        for (name, values) in ranges {
            let finite: Vec<f64> = values.into_iter().filter(|one| one.is_finite()).collect();
            let least = finite.iter().copied().reduce(f64::min);
            let most = finite.iter().copied().reduce(f64::max);
            if let (Some(least), Some(most)) = (least, most) {
                facts.insert(name.to_owned(), vec![least, most].into());
            }
        }
        let [left, start] = self.misfits();
        facts.insert("left".to_owned(), left.into());
        facts.insert("left_at_start".to_owned(), start.into());
        if let Some(tally) = &self.tally {
            let count = |n: usize| Value::from(i64::try_from(n).unwrap_or(i64::MAX));
            let [with, without] = tally.shares();
            let mut search = Table::new();
            search.insert("proposer".to_owned(), tally.proposer.name().into());
            search.insert("evaluations".to_owned(), count(tally.n_evaluations));
            search.insert("proposals".to_owned(), count(tally.n_proposals));
            search.insert("accepted".to_owned(), with.into());
            search.insert("accepted_as_proposed".to_owned(), without.into());
            search.insert("ended".to_owned(), tally.ended.word().into());
            facts.insert("search".to_owned(), search.into());
        }
        facts.insert("coefficient".to_owned(), self.coefficients().into());
        let from: Vec<Value> = self.origins.iter().map(Origin::table).collect();
        facts.insert("from".to_owned(), from.into());
        let errors = self.deviations.iter().map(|one| {
            let mut table = Table::new();
            table.insert("from".to_owned(), one.record.clone().into());
            table.insert("holdout".to_owned(), one.is_held_out.into());
            table.insert("quantity".to_owned(), one.quantity.clone().into());
            table.insert("model".to_owned(), one.model.into());
            table.insert("recorded".to_owned(), one.recorded.into());
            table.insert("relative".to_owned(), one.relative.into());
            Value::from(table)
        });
        let errors: Vec<Value> = errors.collect();
        facts.insert("error".to_owned(), errors.into());
        facts
    }

    fn coefficients(&self) -> Vec<Value> {
        let one = |(nth, name): (usize, &String)| {
            let mut table = Table::new();
            table.insert("name".to_owned(), name.clone().into());
            table.insert("value".to_owned(), self.fit.parameters[nth].into());
            table.insert("uncertainty".to_owned(), self.fit.uncertainties[nth].into());
            table.insert("bounds".to_owned(), self.bounds[nth].to_vec().into());
            if let Some(doubt) = self.doubt(nth) {
                table.insert("doubt".to_owned(), doubt.into());
            }
            table.into()
        };
        self.names.iter().enumerate().map(one).collect()
    }
}

impl Origin {
    fn table(&self) -> Value {
        let mut table = Table::new();
        table.insert("name".to_owned(), self.name.clone().into());
        table.insert("hash".to_owned(), self.hash.clone().into());
        table.insert("holdout".to_owned(), self.is_held_out.into());
        table.insert("rows".to_owned(), i64::try_from(self.rows).unwrap_or(i64::MAX).into());
        table.into()
    }
}
