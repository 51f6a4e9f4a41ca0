//! `Model`: a soft case made ready to move: its body, its plan, its markers and what was recorded of them.

use crate::soft::{Angles, Bend, Gradient, Markers, Plan, SoftBody, SoftError, Tracks, Travel};
use alewife_solid::solid::Scheme;
use thiserror::Error;

use super::marked::markers;
use super::mesh::{Bodies, SolidOf};
use super::record::{Recorded, recorded};
use super::{mesh, solid};
use alewife_case::Diagnostic;
use alewife_case::soft::search::ObjectiveSpec;
use alewife_case::soft::spec::{SoftCase, SoftScheme};
use alewife_case::soft::stretch::Stretch;
use alewife_case::soft::{ParameterKey, SoftFile, check};

/// Why a soft case does not move.
#[derive(Debug, Error)]
pub enum TierError {
    /// The case is wrong.
    #[error("the case is wrong")]
    Case(Vec<Diagnostic>),
    /// A step failed.
    #[error(transparent)]
    Soft(#[from] SoftError),
}

impl From<Diagnostic> for TierError {
    fn from(one: Diagnostic) -> Self {
        Self::Case(vec![one])
    }
}

/// A soft case made ready to move.
#[derive(Debug, Clone)]
pub struct Model<const D: usize> {
    /// The case, with the numbers at hand.
    pub case: SoftCase,
    /// The body.
    pub body: SoftBody<D>,
    /// What it is told.
    pub plan: Plan,
    /// The nodes of the markers.
    pub nodes: Vec<usize>,
    /// What was recorded.
    pub recorded: Option<Recorded>,
}

impl<const D: usize> Model<D>
where
    Bodies: SolidOf<D>,
{
    /// Makes a case ready.
    ///
    /// # Errors
    /// [`TierError::Case`] with all that is wrong in it.
    pub fn new(file: &SoftFile) -> Result<Self, TierError> {
        let wrong = check(file);
        if !wrong.is_empty() {
            return Err(TierError::Case(wrong));
        }
        let Some(solid) = file.case.solid.first() else {
            return Err(TierError::Case(Vec::new()));
        };
        let recorded = recorded(file)?;
        let mesh = <mesh::Bodies as SolidOf<D>>::mesh(file, solid)?;
        let body = solid::body(file, solid, mesh)?;
        let nodes = markers(file, &body).map_err(TierError::Case)?;
        let soft = &file.case.soft;
        let scheme = match soft.scheme {
            SoftScheme::Euler => Scheme::ImplicitEuler,
            SoftScheme::Bdf2 => Scheme::Bdf2,
        };
        let empty = Plan::new(soft.frame, soft.substeps, vec![Vec::new(); soft.frames]);
        let plan = Plan { scheme, tolerance: soft.tolerance, ..empty };
        let mut model = Self { case: file.case.clone(), body, plan, nodes, recorded };
        model.apply()?;
        Ok(model)
    }

    /// Takes over the numbers of the case that a search may change.
    ///
    /// # Errors
    /// For numbers that no body can have.
    pub fn apply(&mut self) -> Result<(), SoftError> {
        let Some(spec) = self.case.solid.first() else { return Ok(()) };
        for (number, material) in solid::materials(spec).iter().enumerate() {
            self.body.solid.set_moduli(number, material.young, material.poisson)?;
        }
        for (set, fibre) in spec.fibre.iter().enumerate() {
            self.body.solid.set_fibre_stiffness(set, fibre.stiffness)?;
        }
        self.body.law = self.case.loads.as_ref().map(solid::loads).transpose()?;
        let told =
            |frame: usize| (0..spec.fibre.len()).map(|set| self.stretch(set, frame)).collect();
        self.plan.targets = (0..self.case.soft.frames).map(told).collect();
        Ok(())
    }

    /// The middle of a frame (s), at whose stretch its fibres are held.
    fn middle(&self, frame: usize) -> f64 {
        (frame as f64 + 0.5) * self.case.soft.frame
    }

    /// When a frame begins and ends (s).
    fn span(&self, frame: usize) -> [f64; 2] {
        [frame, frame + 1].map(|ends| ends as f64 * self.plan.frame)
    }

    /// The stretch that a set of fibres is told in a frame.
    fn stretch(&self, set: usize, frame: usize) -> f64 {
        match &self.case.solid[0].fibre[set].stretch {
            Stretch::Constant(value) => *value,
            Stretch::Wave(wave) => wave.value(self.middle(frame)),
            Stretch::Trapezoid(pulse) => pulse.value(self.span(frame)),
            Stretch::Frames(values) => values.get(frame).copied().unwrap_or(1.0),
            Stretch::Record(_) => {
                let told = self.recorded.as_ref().and_then(|all| all.stretches[set].as_ref());
                told.and_then(|told| told.get(frame)).copied().unwrap_or(1.0)
            }
        }
    }

    /// The derivative by a number of the case.
    #[must_use]
    pub fn slope(&self, gradient: &Gradient, key: ParameterKey) -> f64 {
        let over_frames = |set: usize, of: &dyn Fn(usize) -> f64| -> f64 {
            gradient.targets.iter().enumerate().map(|(k, by)| by[set] * of(k)).sum()
        };
        match key {
            ParameterKey::Young(material) => gradient.young[material],
            ParameterKey::Poisson(material) => gradient.poisson[material],
            ParameterKey::FibreStiffness(set) => gradient.fibre_stiffness[set],
            ParameterKey::Constant(set) => over_frames(set, &|_| 1.0),
            ParameterKey::Wave(set, of) => match &self.case.solid[0].fibre[set].stretch {
                Stretch::Wave(wave) => over_frames(set, &|k| wave.slopes(self.middle(k))[of]),
                _ => 0.0,
            },
            ParameterKey::Trapezoid(set, of) => match &self.case.solid[0].fibre[set].stretch {
                Stretch::Trapezoid(pulse) => over_frames(set, &|k| pulse.slopes(self.span(k))[of]),
                _ => 0.0,
            },
            ParameterKey::Frame(set, frame) => gradient.targets[frame][set],
            ParameterKey::Drag(point) => gradient.drag[point],
            ParameterKey::Thrust(point) => gradient.thrust[point],
        }
    }

    /// What compares the markers with displacements of them.
    #[must_use]
    pub fn markers(&self, displacements: Vec<Vec<Vec<f64>>>) -> Markers {
        Markers {
            dimension: D,
            nodes: self.nodes.clone(),
            weights: self.case.marker.iter().map(|marker| marker.weight).collect(),
            axes: (0..D).collect(),
            substeps: self.plan.substeps,
            displacements,
        }
    }

    /// The angles of the case.
    #[must_use]
    pub fn bends(&self) -> Vec<Bend> {
        let node = |name: &String| {
            let of_name = self.case.marker.iter().position(|marker| marker.name == *name);
            of_name.map_or(0, |marker| self.nodes[marker])
        };
        self.case
            .angle
            .iter()
            .map(|angle| Bend { nodes: angle.markers.each_ref().map(node) })
            .collect()
    }

    /// What compares marks and angles with a record.
    #[must_use]
    pub fn tracks(&self, recorded: &Recorded) -> Tracks {
        let angles = Angles {
            bends: self.bends(),
            weights: self.case.angle.iter().map(|angle| angle.weight).collect(),
            substeps: self.plan.substeps,
            changes: recorded.angles.clone(),
        };
        Tracks { markers: self.markers(recorded.displacements.clone()), angles }
    }

    /// What each frame counts in way and work.
    #[must_use]
    pub fn shares(&self, objective: &ObjectiveSpec) -> Vec<f64> {
        objective.shares(self.plan.targets.len(), self.plan.frame)
    }

    /// The way of the markers along the direction of an objective, with the sign that makes a long way a small number.
    #[must_use]
    pub fn travel(&self, objective: &ObjectiveSpec) -> Travel {
        let direction = objective.direction();
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        Travel {
            shares: self.shares(objective),
            substeps: self.plan.substeps,
            nodes: self.nodes.clone(),
            direction: direction.iter().map(|x| x / length).collect(),
        }
    }
}
