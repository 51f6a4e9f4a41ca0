//! `Near`: a reduced model and those beside it, at other values of one number of its case.

use alewife_reduced::tree::{
    Command, Drive, Dual64, Joint, Link, Placement, State, Tree, TreeError, real,
};

use super::error::{SlopeError, unsteady};
use crate::case::{CaseError, CaseFile, Model};
use crate::reduced::build::Reduced;
use crate::reduced::lift;

/// Part of the size of a number by which it is changed. A difference of fourth order leaves a part of
/// (2 pi n)^4 1e-16 / 30 of the derivative of a sine after n periods, 5e-11 after ten, and rounding 1e-12.
const STEP: f64 = 1e-4;

/// Where models are made, in steps from the value, and what each weighs in the difference.
const BESIDE: [[f64; 2]; 4] =
    [[-2.0, 1.0 / 12.0], [-1.0, -8.0 / 12.0], [1.0, 8.0 / 12.0], [2.0, -1.0 / 12.0]];

/// Part of the number of steps that is rounding.
const ROUNDING: f64 = 1e-9;

/// A model beside another one.
struct Beside {
    reduced: Reduced,
    /// Its step (s).
    step: f64,
    /// Of each swimmer (s).
    periods: Vec<Option<f64>>,
}

impl Beside {
    fn of(reduced: Reduced, model: &Model) -> Result<Self, SlopeError> {
        let step = unsteady(model)?.step;
        let periods = model.swimmers.iter().map(|swimmer| swimmer.period).collect();
        Ok(Self { reduced, step, periods })
    }
}

/// A model, and how it changes with a number.
pub struct Near<'a> {
    /// The model.
    pub at: &'a Reduced,
    own: Beside,
    beside: Vec<Beside>,
    /// Of the number.
    step: f64,
}

impl<'a> Near<'a> {
    /// The model of a case, and those of the case with a number of this size changed.
    pub fn new(
        at: &'a Reduced,
        model: &Model,
        nth: usize,
        size: f64,
        changed: &dyn Fn(f64) -> Result<CaseFile, CaseError>,
    ) -> Result<Self, SlopeError> {
        let step = STEP * if size > 0.0 { size } else { 1.0 };
        let own = Beside::of(at.clone(), model)?;
        let mut beside = Vec::new();
        for [place, _] in BESIDE {
            let file = changed(place * step)?;
            let other = Reduced::new(&file.model)?;
            let differs = different(at, &other).or_else(|| different_steps(at, model, &file.model));
            if let Some(what) = differs {
                return Err(SlopeError::Number { nth, what: what.to_owned() });
            }
            beside.push(Beside::of(other, &file.model)?);
        }
        Ok(Self { at, own, beside, step })
    }

    /// A number of the model, with its derivative.
    fn number(&self, pick: impl Fn(&Beside) -> f64) -> Dual64 {
        self.of(pick(&self.own), |nth| pick(&self.beside[nth]))
    }

    /// A value with its derivative, by what it is beside.
    fn of(&self, value: f64, beside: impl Fn(usize) -> f64) -> Dual64 {
        let slope: f64 = (0..4).map(|nth| BESIDE[nth][1] * beside(nth)).sum();
        Dual64::new(value, slope / self.step)
    }

    /// What all times are multiplied by.
    pub fn pace(&self) -> Dual64 {
        self.number(|one| one.step / self.own.step)
    }

    /// The period of a swimmer.
    pub fn period(&self, swimmer: usize) -> Option<Dual64> {
        self.own.periods[swimmer]?;
        Some(self.number(|one| one.periods[swimmer].unwrap_or(f64::NAN)))
    }

    /// What the joint of a link is told.
    pub fn command(&self, time: f64, link: usize) -> Command<Dual64> {
        let own = self.at.command(time, link);
        let told = |nth: usize| {
            let one = &self.beside[nth];
            // The same step of each: later where steps are longer
            one.reduced.command(time * (one.step / self.own.step), link)
        };
        let beside = [told(0), told(1), told(2), told(3)];
        let pick = |what: fn(&Command<f64>) -> f64| self.of(what(&own), |nth| what(&beside[nth]));
        Command {
            place: pick(|told| told.place),
            rate: pick(|told| told.rate),
            effort: pick(|told| told.effort),
        }
    }

    /// The state at the start.
    pub fn start(&self) -> State<Dual64> {
        let all = |values: fn(&State<f64>) -> &Vec<f64>| {
            let n = values(&self.at.start).len();
            (0..n).map(|k| self.number(|one| values(&one.reduced.start)[k])).collect()
        };
        let mut state = lift::state(&self.at.start);
        let root = |pick: &dyn Fn(&Placement<f64>) -> f64| {
            self.number(|one| pick(&one.reduced.start.root))
        };
        for k in 0..3 {
            state.root.position[k] = root(&|place| place.position[k]);
        }
        for k in 0..4 {
            state.root.quaternion[k] = root(&|place| place.quaternion[k]);
        }
        state.coordinates = all(|state| &state.coordinates);
        state.velocities = all(|state| &state.velocities);
        state
    }

    /// The tree.
    pub fn tree(&self) -> Result<Tree<Dual64>, TreeError> {
        self.at.tree_of(
            |body, own| {
                let coefficient = |k| self.number(|one| one.reduced.parts[body].coefficients[k]);
                (0..own.len()).map(coefficient).collect()
            },
            |link, made: &mut Joint<Dual64>| {
                let pick = |what: &dyn Fn(&Joint<f64>) -> f64| {
                    self.number(|one| what(&one.reduced.tree.links()[link].joint))
                };
                made.stiffness = pick(&|joint| joint.stiffness);
                made.damping = pick(&|joint| joint.damping);
                made.rest = pick(&|joint| joint.rest);
                made.armature = pick(&|joint| joint.armature);
                let gain = |joint: &Joint<f64>| match joint.drive {
                    Drive::Servo { gain, .. } => gain,
                    _ => 0.0,
                };
                if let Drive::Servo { gain: made, .. } = &mut made.drive {
                    *made = pick(&gain);
                }
            },
        )
    }
}

/// A link without what has derivatives.
fn bare(links: &[Link<f64>]) -> Vec<Link<f64>> {
    let bare = |link: &Link<f64>| {
        let Joint { kind, drive, stops, .. } = link.joint;
        let axis: [f64; 3] = link.joint.axis.into();
        let drive = match drive {
            Drive::Servo { limit, .. } => Drive::Servo { gain: 0.0, limit },
            other => other,
        };
        Link { joint: Joint { drive, stops, ..Joint::new(kind, axis) }, ..link.clone() }
    };
    links.iter().map(bare).collect()
}

/// What of two models differs that has no derivative, if something does.
fn different(one: &Reduced, other: &Reduced) -> Option<&'static str> {
    if one.parts.len() != other.parts.len() || one.told.len() != other.told.len() {
        return Some("how many bodies there are");
    }
    // The other one's bodies with the coefficients of this one
    let with = |reduced: &Reduced| {
        reduced.tree_with(|body, _| one.parts[body].coefficients.iter().map(|c| real(*c)).collect())
    };
    let links = [one, other].map(|reduced| with(reduced).map(|tree| bare(tree.links())));
    let same_parts = one
        .parts
        .iter()
        .zip(&other.parts)
        .all(|(a, b)| a.mass == b.mass && a.inertia == b.inertia && a.inside == b.inside);
    let [Ok(own), Ok(others)] = links else { return Some("whether there is a model") };
    if own != others || !same_parts || one.gravity != other.gravity {
        return Some("masses, shapes or places of bodies, or the fluid");
    }
    if one.tree.tendons() != other.tree.tendons() {
        return Some("tendons");
    }
    // As they are printed: the shortest decimals that read back as the same bits
    let pushes = |reduced: &Reduced| format!("{:?}{:?}", reduced.pulls, reduced.propellers);
    if pushes(one) != pushes(other) {
        return Some("forces from outside or thrusters");
    }
    let table = |reduced: &Reduced| format!("{:?}", reduced.connection);
    (table(one) != table(other)).then_some("the table of the connection")
}

/// Whether steps become longer without the run, or the other way round.
fn different_steps(at: &Reduced, one: &Model, other: &Model) -> Option<&'static str> {
    let (Ok(own), Ok(others)) = (unsteady(one), unsteady(other)) else {
        return Some("whether there are steps in time");
    };
    let ratio = (own.end / own.step) / (others.end / others.step);
    if (ratio - 1.0).abs() > ROUNDING {
        return Some(
            "how many steps are made: a number that changes `time.unsteady.step` changes \
             `time.unsteady.end` in proportion, and the other way round",
        );
    }
    let has_pushes = !at.pulls.is_empty() || !at.propellers.is_empty();
    (own.step != others.step && has_pushes)
        .then_some("times at which forces from outside or thrusters act")
}
