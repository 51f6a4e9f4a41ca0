//! `Signals`: what an environment observes, pays and ends by, as functions of a few numbers in a row.

use crate::spec::environment::EnvironmentSpec;
use crate::spec::formula::Expression;
use crate::{Column, FormulaError, Model, columns};

/// What is wrong with an environment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake {
    /// Its key.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What is accepted.
    pub help: String,
}

/// A number that expressions depend on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Input {
    /// A quantity of a run.
    Quantity(Column),
    /// Time since the start of the episode (s).
    Time,
    /// A target, by its number in the order of their names.
    Target(usize),
    /// The last action, from -1 to 1, by its number.
    Action(usize),
}

/// A command that is an action.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// Name of the command.
    pub command: String,
    /// What is asked for by the actions -1 and 1.
    pub range: [f64; 2],
}

/// Expressions of an environment. They read a row of numbers: inputs first, then named values.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// What the row begins with.
    pub inputs: Vec<Input>,
    /// Named values, each after those it depends on.
    values: Vec<Expression>,
    /// Observations, before they are scaled.
    pub observations: Vec<Expression>,
    /// Terms of the reward, before they are weighted.
    pub rewards: Vec<Expression>,
    /// Conditions of `terminate`.
    pub terminate: Vec<Expression>,
    /// Conditions of `truncate`.
    pub truncate: Vec<Expression>,
    /// Actions.
    pub actions: Vec<Action>,
}

impl Action {
    /// What is asked for by an action, which is clipped to -1 and 1.
    #[inline]
    #[must_use]
    pub fn target(&self, action: f64) -> f64 {
        let [low, high] = self.range;
        low + (high - low) * 0.5 * (action.clamp(-1.0, 1.0) + 1.0)
    }
}

impl Signals {
    /// Those of a model with `[environment]`.
    ///
    /// # Errors
    /// All that is wrong.
    pub fn new(model: &Model, spec: &EnvironmentSpec) -> Result<Self, Vec<Mistake>> {
        Builder::new(model, spec).finish()
    }

    /// Length of the row.
    #[inline]
    #[must_use]
    pub fn n_numbers(&self) -> usize {
        self.inputs.len() + self.values.len()
    }

    /// Fills in the named values of a row whose inputs are there.
    #[inline]
    pub fn complete(&self, row: &mut [f64]) {
        for (nth, value) in self.values.iter().enumerate() {
            row[self.inputs.len() + nth] = value.at(row);
        }
    }
}

struct Builder<'a> {
    model: &'a Model,
    spec: &'a EnvironmentSpec,
    columns: Vec<Column>,
    /// Names that expressions may use: columns, the time, targets, actions, values.
    names: Vec<String>,
    mistakes: Vec<Mistake>,
}

fn mistake(key: &str, message: String, help: &str) -> Mistake {
    Mistake { key: key.to_owned(), message, help: help.to_owned() }
}

/// An expression that is not understood, as a mistake.
fn misread(key: &str, text: &str, error: &FormulaError) -> Mistake {
    let message = format!("\"{text}\" at character {}: {}", error.column, error.found);
    mistake(key, message, &error.accepted)
}

impl<'a> Builder<'a> {
    fn new(model: &'a Model, spec: &'a EnvironmentSpec) -> Self {
        let columns = columns(model);
        let quantities = columns.iter().map(|column| column.name.clone());
        let targets = spec.target.keys().map(|name| format!("target.{name}"));
        let actions = spec.actions.iter().map(|one| format!("action.{}", one.command()));
        let values = spec.value.keys().cloned();
        let time = std::iter::once("time".to_owned());
        let names = quantities.chain(time).chain(targets).chain(actions).chain(values).collect();
        Self { model, spec, columns, names, mistakes: Vec::new() }
    }

    /// Number of the first named value among the names.
    fn first_value(&self) -> usize {
        self.names.len() - self.spec.value.len()
    }

    fn expression(&mut self, key: &str, text: &str) -> Option<Expression> {
        match Expression::parse(text, &self.model.case.define, &self.names) {
            Ok(expression) => Some(expression),
            Err(error) => {
                self.mistakes.push(misread(key, text, &error));
                None
            }
        }
    }

    fn expressions<'b>(
        &mut self,
        keys: &str,
        last: &str,
        texts: impl Iterator<Item = &'b str>,
    ) -> Vec<Expression> {
        let read = |(nth, text)| self.expression(&format!("environment.{keys}.{nth}{last}"), text);
        texts.enumerate().filter_map(read).collect()
    }

    fn finish(mut self) -> Result<Signals, Vec<Mistake>> {
        let spec = self.spec;
        let mut values = Vec::new();
        for (name, text) in &spec.value {
            values.extend(self.expression(&format!("environment.value.{name}"), text));
        }
        let of = spec.observations.iter().map(crate::Observation::scaled);
        let of: Vec<String> = of.map(|scaled| scaled.of).collect();
        let observations = self.expressions("observations", "", of.iter().map(String::as_str));
        let rewards = spec.reward.iter().map(|term| term.of.as_str());
        let rewards = self.expressions("reward", ".of", rewards);
        let terminate = spec.terminate.iter().map(|ending| ending.when.as_str());
        let terminate = self.expressions("terminate", ".when", terminate);
        let truncate = spec.truncate.iter().map(|ending| ending.when.as_str());
        let truncate = self.expressions("truncate", ".when", truncate);
        let actions = self.actions();
        let order = if values.len() == spec.value.len() { self.order(&values) } else { Vec::new() };
        if !self.mistakes.is_empty() {
            return Err(self.mistakes);
        }
        let values = order.iter().map(|nth| values[*nth].clone()).collect();
        let inputs = Vec::new();
        let signals =
            Signals { inputs, values, observations, rewards, terminate, truncate, actions };
        Ok(self.numbered(signals, &order))
    }

    fn actions(&mut self) -> Vec<Action> {
        let commands = &self.model.commands;
        let mut actions: Vec<Action> = Vec::new();
        for (nth, action) in self.spec.actions.iter().enumerate() {
            let key = format!("environment.actions.{nth}");
            let name = action.command();
            let command = match commands.get(name) {
                Ok(command) => command,
                Err(error) => {
                    let help = "name a command: a joint or stroke that is { command = { ... } }";
                    self.mistakes.push(mistake(&key, error.to_string(), help));
                    continue;
                }
            };
            if actions.iter().any(|other| other.command == name) {
                let message = format!("`{name}` is an action twice");
                self.mistakes.push(mistake(&key, message, "name each command once"));
            }
            match action.range().or(command.limits) {
                Some([low, high]) if low < high => {
                    actions.push(Action { command: name.to_owned(), range: [low, high] });
                }
                Some([low, high]) => {
                    let message = format!("the range goes from {low} to {high}");
                    let help = "write range = [lowest, highest], the lowest below the highest";
                    self.mistakes.push(mistake(&key, message, help));
                }
                None => {
                    let message = format!("`{name}` has no limits, and the action no range");
                    let help = "write limits = [...] in the command, or { command = \"...\", range = [...] } here";
                    self.mistakes.push(mistake(&key, message, help));
                }
            }
        }
        actions
    }

    /// Values in an order in which each comes after those it depends on.
    fn order(&mut self, values: &[Expression]) -> Vec<usize> {
        let first = self.first_value();
        let needs: Vec<Vec<usize>> = values
            .iter()
            .map(|value| {
                value.variables().iter().filter_map(|one| one.checked_sub(first)).collect()
            })
            .collect();
        let mut order: Vec<usize> = Vec::new();
        while order.len() < values.len() {
            let is_next = |nth: &usize| {
                !order.contains(nth) && needs[*nth].iter().all(|one| order.contains(one))
            };
            match (0..values.len()).find(is_next) {
                Some(next) => order.push(next),
                None => {
                    let names: Vec<&String> = self.spec.value.keys().collect();
                    let rest = (0..values.len()).filter(|nth| !order.contains(nth));
                    let circle: Vec<&str> = rest.map(|nth| names[nth].as_str()).collect();
                    let key = format!("environment.value.{}", circle[0]);
                    let message = format!("values depend on each other: {}", circle.join(", "));
                    let help = "let each depend on quantities and on values that do not lead back";
                    self.mistakes.push(mistake(&key, message, help));
                    break;
                }
            }
        }
        order
    }

    /// The same with numbers for the names that are used, and only for them.
    fn numbered(&self, mut signals: Signals, order: &[usize]) -> Signals {
        let first = self.first_value();
        let all = [
            &signals.values,
            &signals.observations,
            &signals.rewards,
            &signals.terminate,
            &signals.truncate,
        ];
        let mut used: Vec<usize> =
            all.iter().flat_map(|list| list.iter().flat_map(Expression::variables)).collect();
        used.retain(|which| *which < first);
        used.sort_unstable();
        used.dedup();
        let n_inputs = used.len();
        let number = |which: usize| match which.checked_sub(first) {
            Some(value) => n_inputs + order.iter().position(|one| *one == value).unwrap_or(0),
            None => used.iter().position(|one| *one == which).unwrap_or(0),
        };
        for list in [
            &mut signals.values,
            &mut signals.observations,
            &mut signals.rewards,
            &mut signals.terminate,
            &mut signals.truncate,
        ] {
            list.iter_mut().for_each(|one| one.renumber(&number));
        }
        let n_columns = self.columns.len();
        let n_targets = self.spec.target.len();
        signals.inputs = used
            .iter()
            .map(|which| match self.columns.get(*which) {
                Some(column) => Input::Quantity(column.clone()),
                None if *which == n_columns => Input::Time,
                None if *which <= n_columns + n_targets => Input::Target(which - n_columns - 1),
                None => Input::Action(which - n_columns - 1 - n_targets),
            })
            .collect();
        signals
    }
}
