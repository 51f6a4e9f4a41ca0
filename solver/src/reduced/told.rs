//! `Told`: what a joint of a tree is told in time.

use alewife_reduced::tree::Command;

use crate::case::{DrivenLaw, Stroke, TimeFunction};

/// What a joint is told: its coordinate or its rate, or the effort of its motor.
#[derive(Debug, Clone)]
pub(super) enum Told {
    /// Nothing.
    Nothing,
    /// Its coordinate.
    Given(Stroke),
    /// Its coordinate, from where it starts.
    Way(Stroke),
    /// Its rate, with a factor in time.
    Rate(f64, Option<TimeFunction>),
    /// Its effort.
    Effort(Stroke),
}

impl Told {
    /// A motion that is given.
    pub fn driven(law: &DrivenLaw) -> Self {
        match law {
            DrivenLaw::Way(stroke) => Self::Way(stroke.clone()),
            DrivenLaw::Rate(rate) => Self::Rate(rate.value, rate.factor.clone()),
        }
    }

    /// What is asked at a time (s).
    pub fn command(&self, time: f64) -> Command<f64> {
        let none = Command::none();
        match self {
            Self::Nothing => none,
            Self::Given(stroke) => {
                let [place, rate] = stroke.at(time);
                Command { place, rate, ..none }
            }
            Self::Way(stroke) => {
                let ([place, rate], [start, _]) = (stroke.at(time), stroke.at(0.0));
                Command { place: place - start, rate, ..none }
            }
            Self::Rate(value, factor) => {
                let rate = value * factor.as_ref().map_or(1.0, |factor| factor.at(time));
                Command { rate, ..none }
            }
            Self::Effort(stroke) => Command { effort: stroke.at(time)[0], ..none },
        }
    }
}
