//! `March`: the motion of the bodies of a case without inertia, and of the same case with numbers slightly changed.

use std::rc::Rc;

use super::super::adjoint::{Derivatives, Ends, derivatives, ends};
use super::super::error::GradientError;
use super::super::flow::BaseFlow;
use super::super::moment::Moment;
use super::course::{Course, Rates};
use super::meshes::{Left, Meshes, StepBegin};
use super::unknowns::Unknowns;
use crate::body::Pose;
use crate::case::{CaseFile, Column, Unsteady};
use crate::coupling::Problem;
use crate::run::{CaseMesh, Dimension};
use crate::step::{INSIDE, STAGES};

/// Part of the shortest edge on a body, and an angle (rad), by which bodies are displaced for what their places change:
/// differences leave their squares.
const WAY: f64 = 0.01;
const TURN: f64 = 1e-4;

/// Part of a step that is rounding.
const NEAR: f64 = 1e-7;

/// The case at both sides of the value of one of its numbers.
pub(super) struct Sides {
    /// Below and above.
    pub files: [CaseFile; 2],
    /// How far each is from the value.
    pub step: f64,
}

/// The bodies of a case, and of the same case at both sides of the values of its numbers, which go where the linearised
/// flow takes them.
pub(super) struct March<'a, const D: usize> {
    meshes: Meshes<'a, D>,
    file: &'a CaseFile,
    numbers: &'a [Sides],
    unknowns: Unknowns,
    course: Course<D>,
    /// Below and above, for each number.
    beside: Vec<[Course<D>; 2]>,
}

/// What a flow says at a stage, and how that changes.
struct StageFlow {
    values: Vec<f64>,
    /// By each number, and by each motion of a body: for each value.
    by_numbers: Vec<Vec<f64>>,
    by_motions: Vec<Vec<f64>>,
}

impl<'a, const D: usize> March<'a, D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Begins where a case has its bodies; `problem` is made of each file.
    pub fn new(
        meshes: Meshes<'a, D>,
        file: &'a CaseFile,
        numbers: &'a [Sides],
        with_powers: bool,
    ) -> Result<Self, GradientError> {
        let problem = |file: &CaseFile| -> Result<Problem<D>, GradientError> {
            Ok(meshes.now().point(file.clone(), &Moment::START)?.problem)
        };
        let course = Course::new(problem(file)?);
        let mut beside = Vec::new();
        for Sides { files: [below, above], .. } in numbers {
            beside.push([Course::new(problem(below)?), Course::new(problem(above)?)]);
        }
        let unknowns = Unknowns::new(course.problem(), with_powers);
        Ok(Self { meshes, file, numbers, unknowns, course, beside })
    }

    /// Makes all steps of a run.
    pub fn run(&mut self, settings: &Unsteady) -> Result<(), GradientError> {
        for index in 0..settings.n_steps() {
            let target = ((index + 1) as f64 * settings.step).min(settings.end);
            let near = NEAR * settings.step;
            let jumps = self.course.problem().rate_discontinuities.as_ref();
            let from = self.course.time();
            let mut ends = jumps.map_or_else(Vec::new, |jumps| jumps(from + near, target - near));
            ends.push(target);
            for end in ends {
                let time = self.course.time();
                let begin = StepBegin { step: index + 1, time, poses: self.course.poses() };
                self.meshes.renew(self.file, &begin)?;
                self.step(end - time)?;
                self.all().for_each(|course| course.round_time(end));
            }
        }
        Ok(())
    }

    /// What is of use to another march.
    pub fn end(self) -> Left<D> {
        self.meshes.end()
    }

    /// The value of a quantity at the end.
    pub fn value(&self, column: &Column) -> f64 {
        self.course.value(column)
    }

    /// Its derivatives by the numbers.
    pub fn slopes(&self, column: &Column) -> Vec<f64> {
        let slope = |(sides, [below, above]): (&Sides, &[Course<D>; 2])| {
            (above.value(column) - below.value(column)) / (2.0 * sides.step)
        };
        self.numbers.iter().zip(&self.beside).map(slope).collect()
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Course<D>> {
        std::iter::once(&mut self.course).chain(self.beside.iter_mut().flatten())
    }

    /// A step of a size (s) by the explicit scheme of runs.
    fn step(&mut self, size: f64) -> Result<(), GradientError> {
        self.all().for_each(|course| course.begin(size));
        let begin: (f64, &[f64]) = (0.0, &[]);
        let within = STAGES[..STAGES.len() - 1].iter().map(|stage| (stage.part, stage.weights));
        for (part, weights) in std::iter::once(begin).chain(within) {
            let poses = self.course.poses_at(part, weights);
            let time = self.course.time() + part * size;
            let rates_at = if part == 0.0 { time + INSIDE * size } else { time };
            let moment = Moment { time, rates_at, poses: Some(poses.clone()) };
            let found = self.flow(&moment)?;
            for (nth, sides) in self.beside.iter_mut().enumerate() {
                for (side, course) in sides.iter_mut().enumerate() {
                    let own = course.poses_at(part, weights);
                    let change = [-1.0, 1.0][side] * self.numbers[nth].step;
                    let ways = self.unknowns.displacements(&poses, &own);
                    let rates = found.beside(&self.unknowns, nth, change, &ways);
                    course.add_stage(&own, rates);
                }
            }
            self.course.add_stage(&poses, self.unknowns.rates(&found.values));
        }
        self.all().for_each(Course::end);
        Ok(())
    }

    /// The flow of the case at a moment, and what it changes by.
    fn flow(&mut self, moment: &Moment) -> Result<StageFlow, GradientError> {
        let mesh = Rc::clone(self.meshes.now());
        let point = mesh.point(self.file.clone(), moment)?;
        if mesh.is_degenerate(&point) {
            return Err(self.too_far(moment.time));
        }
        let mut work = self.meshes.take_work();
        work.mesh.clone_from(&point.mesh);
        work.system.move_to(&point.problem, &point.mesh);
        let columns = self.unknowns.columns();
        let names = vec![String::new(); columns.len()];
        let mut flow = BaseFlow::at(Rc::clone(&mesh), point, work, columns)?;
        let (n_numbers, mut found) = (self.numbers.len(), Vec::new());
        let values = flow.values().to_vec();
        if n_numbers > 0 {
            let poses = moment.poses(self.course.problem());
            let n_changes = n_numbers + self.unknowns.n_motions();
            found = derivatives(&mut flow, &names, n_changes, &mut |flow, nth| match self
                .numbers
                .get(nth)
            {
                Some(Sides { files, step }) => {
                    let [below, above] = files.each_ref();
                    let at = |file: &CaseFile| mesh.point(file.clone(), moment);
                    Ok(Ends { points: [at(below)?, at(above)?], step: *step })
                }
                None => self.ends_by_motion(flow, moment, &poses, nth - n_numbers),
            })?;
        }
        self.meshes.give_back(flow.into_work());
        let by = |nth: usize| found.iter().map(|of: &Derivatives| of.by[nth]).collect();
        let n_motions = if found.is_empty() { 0 } else { self.unknowns.n_motions() };
        Ok(StageFlow {
            by_numbers: (0..n_numbers).map(by).collect(),
            by_motions: (n_numbers..n_numbers + n_motions).map(by).collect(),
            values,
        })
    }

    /// The case with a body displaced to both sides along one of its motions.
    fn ends_by_motion(
        &self,
        flow: &BaseFlow<D>,
        moment: &Moment,
        poses: &[Pose],
        nth: usize,
    ) -> Result<Ends<D>, GradientError> {
        let at = |way: f64| {
            let poses = Some(self.unknowns.displaced(poses, nth, way));
            flow.mesh.point(self.file.clone(), &Moment { poses, ..moment.clone() })
        };
        let first =
            if self.unknowns.is_rotation(nth) { TURN } else { WAY * flow.mesh.shortest_edge() };
        ends(&flow.mesh, &flow.point, first, &at)
    }

    fn too_far(&self, time: f64) -> GradientError {
        GradientError::refused(
            self.file,
            "time",
            format!("at t = {time:.6}, within a step, the bodies have torn a cell of the mesh"),
            "take shorter steps: meshes are made between them",
        )
    }
}

impl StageFlow {
    /// What the linearised flow says of a course beside that of the case, with a number larger by a change, whose motions
    /// have brought the bodies so far from those of the case.
    fn beside(&self, unknowns: &Unknowns, number: usize, change: f64, ways: &[f64]) -> Rates {
        let mut values = self.values.clone();
        for (value, by) in values.iter_mut().zip(&self.by_numbers[number]) {
            *value += by * change;
        }
        for (way, by) in ways.iter().zip(&self.by_motions) {
            values.iter_mut().zip(by).for_each(|(value, by)| *value += by * way);
        }
        unknowns.rates(&values)
    }
}
