//! `Equations`: the linear system of a step, by composite bodies, and its solution.

use nalgebra::Matrix3;

use super::cholesky::{factor, solve};
use super::error::TreeError;
use super::link::{Command, Drive, Joint, Link};
use super::spatial::{Number, Pose, Symmetric, Twist, Wrench, norm, real};
use super::state::{Motion, State};
use super::topology::{NONE, Tree};

/// What acts on a tree from outside. A function of time and link that gives commands is one.
pub trait Inputs<T: Number> {
    /// What is asked of the joint of a link at a time (s).
    fn command(&self, time: f64, link: usize) -> Command<T>;

    /// A wrench on a link about its origin, in its axes, besides all others. `rotation` has these axes in the
    /// world as its columns.
    fn wrench(&self, _time: f64, _link: usize, _rotation: &Matrix3<T>) -> Option<Wrench<T>> {
        None
    }
}

impl<T: Number, F: Fn(f64, usize) -> Command<T>> Inputs<T> for F {
    fn command(&self, time: f64, link: usize) -> Command<T> {
        self(time, link)
    }
}

/// How the equations of a stage are made linear about a state: what resists is taken at the new velocities.
#[derive(Debug, Clone)]
pub(super) struct Stage<T: Number> {
    /// Weight of resistances in the matrix (s).
    pub implicit: T,
    /// How much farther than the state coordinates are where springs are read.
    pub shift: Vec<T>,
    /// The velocities of the state less those that the step starts from.
    pub lag: Vec<T>,
    /// Whether these are others.
    pub is_late: bool,
}

impl<T: Number> Stage<T> {
    fn lag(&self) -> Option<&[T]> {
        self.is_late.then_some(&self.lag[..])
    }
}

/// The system (M + h D + h^2 K) x = f of a stage, with the scratch it is made in.
#[derive(Debug, Clone)]
pub(super) struct Equations<T: Number> {
    pub motion: Motion<T>,
    composites: Vec<Symmetric<T>>,
    wrenches: Vec<Wrench<T>>,
    /// Lower triangle by rows.
    matrix: Vec<T>,
    pub forces: Vec<T>,
    row: Vec<T>,
    free: Vec<usize>,
    factor: Vec<T>,
    right: Vec<T>,
}

impl<T: Number> Equations<T> {
    pub fn new(tree: &Tree<T>) -> Self {
        let (n, n_links) = (tree.n_velocities(), tree.links.len());
        let free: Vec<usize> = (0..n).filter(|k| !tree.given[*k]).collect();
        let zero = real(0.0);
        Self {
            motion: Motion::new(tree),
            composites: vec![Symmetric::zero(); n_links],
            wrenches: vec![Wrench::zero(); n_links],
            matrix: vec![zero; n * n],
            forces: vec![zero; n],
            row: vec![zero; n],
            factor: vec![zero; free.len() * free.len()],
            right: vec![zero; free.len()],
            free,
        }
    }

    /// Makes the system about a state.
    pub fn assemble(
        &mut self,
        tree: &Tree<T>,
        state: &State<T>,
        stage: &Stage<T>,
        inputs: &impl Inputs<T>,
    ) {
        self.motion.follow(tree, state);
        for number in 0..tree.links.len() {
            let rotation = &self.motion.poses[number].rotation;
            let outer = inputs.wrench(state.time, number, rotation);
            self.load_link(tree, number, stage, outer);
        }
        for number in (1..tree.links.len()).rev() {
            let parent = tree.links[number].parent;
            self.composites[parent] =
                self.composites[parent].plus(&self.composites[number], real(1.0));
            self.wrenches[parent] = self.wrenches[parent].plus(&self.wrenches[number], real(1.0));
        }
        self.project(tree);
        for velocity in tree.n_root()..tree.n_velocities() {
            let link = tree.moved[velocity];
            let command = inputs.command(state.time, link);
            self.add_joint(velocity, &tree.links[link].joint, state, stage, &command);
        }
        for tendon in 0..tree.tendons.len() {
            self.add_tendon(tree, tendon, state, stage);
        }
    }

    /// Masses and resistance of one link, and what acts on it.
    fn load_link(
        &mut self,
        tree: &Tree<T>,
        number: usize,
        stage: &Stage<T>,
        outer: Option<Wrench<T>>,
    ) {
        let (link, masses) = (&tree.links[number], &tree.masses[number]);
        let pose = self.motion.poses[number];
        let twist = pose.twist_inside(&self.motion.twists[number]);
        let bias = pose.twist_inside(&self.motion.biases[number]);
        let gyration = twist.cross_momentum(&masses.times(&twist));
        let one: T = real(1.0);
        let mut wrench = Wrench::zero().plus(&gyration, -one).plus(&masses.times(&bias), -one);
        if let Some(outer) = outer {
            wrench = wrench.plus(&outer, one);
        }
        wrench = wrench.plus(&weigh(tree, link, &pose), one);
        let mut matrix = *masses;
        for placed in &link.loads {
            let met = placed.pose.as_ref().map_or(twist, |pose| pose.twist_inside(&twist));
            let resistance = placed.load.resist(&met);
            let (load, slope) = match &placed.pose {
                None => (resistance.wrench, resistance.slope),
                Some(pose) => {
                    (pose.wrench_outside(&resistance.wrench), resistance.slope.seen_from(pose))
                }
            };
            wrench = wrench.plus(&load, one);
            matrix = matrix.plus(&slope, stage.implicit);
            if let Some(lag) = stage.lag() {
                let late = pose.twist_inside(&self.motion.twist_by(tree, number, lag));
                wrench = wrench.plus(&slope.times(&late), one);
            }
        }
        self.composites[number] = matrix.seen_from(&pose);
        self.wrenches[number] = pose.wrench_outside(&wrench);
    }

    /// Masses and forces of velocities from those of composite bodies.
    fn project(&mut self, tree: &Tree<T>) {
        let n = tree.n_velocities();
        self.matrix.fill(real(0.0));
        for j in 0..n {
            let axis: Twist<T> = self.motion.axes[j];
            let momentum = self.composites[tree.moved[j]].times(&axis);
            let mut i = j;
            while i != NONE {
                self.matrix[j * n + i] = self.motion.axes[i].dot(&momentum);
                i = tree.before[i];
            }
            self.forces[j] = axis.dot(&self.wrenches[tree.moved[j]]);
        }
    }

    /// Spring, damper, stops and motor of a joint.
    fn add_joint(
        &mut self,
        velocity: usize,
        joint: &Joint<T>,
        state: &State<T>,
        stage: &Stage<T>,
        command: &Command<T>,
    ) {
        let n = self.forces.len();
        self.matrix[velocity * n + velocity] += joint.armature;
        let rate = state.velocities[velocity];
        let place = state.coordinates[velocity] + stage.shift[velocity];
        let (mut stiffness, mut damping) = (joint.stiffness, joint.damping);
        let mut effort = -joint.stiffness * (place - joint.rest) - joint.damping * rate;
        if let Some(stops) = &joint.stops {
            let end = if place.re() > stops.upper.re() { Some(stops.upper) } else { None };
            let end = if place.re() < stops.lower.re() { Some(stops.lower) } else { end };
            if let Some(end) = end {
                effort += -stops.stiffness * (place - end) - stops.damping * rate;
                stiffness += stops.stiffness;
                damping += stops.damping;
            }
        }
        match joint.drive {
            Drive::Given | Drive::Rate => {}
            Drive::Effort => effort += command.effort,
            Drive::Servo { gain, limit } => {
                // By the rate at the end of the step, so that a stiff one does not swing about its command, and by
                // the effort that is left then: the rate it starts from would ask for far more than the limit
                let whole = if stage.is_late { stage.implicit * 2.0 } else { stage.implicit };
                let mut before = rate;
                if let Some(lag) = stage.lag() {
                    before -= lag[velocity];
                }
                let asked = gain * (command.rate - before);
                let inertia = self.matrix[velocity * n + velocity];
                let reached = asked * inertia / (inertia + gain * whole);
                if reached.re().abs() <= limit.re() {
                    self.forces[velocity] += asked;
                    self.matrix[velocity * n + velocity] += gain * whole;
                } else {
                    effort += limit * asked.re().signum();
                }
            }
        }
        if let Some(lag) = stage.lag() {
            effort += damping * lag[velocity];
        }
        self.forces[velocity] += effort;
        let h = stage.implicit;
        self.matrix[velocity * n + velocity] += damping * h + stiffness * (h * h);
    }

    /// Tension of a tendon, where it is taut.
    fn add_tendon(&mut self, tree: &Tree<T>, number: usize, state: &State<T>, stage: &Stage<T>) {
        let tendon = &tree.tendons[number];
        let poses = &self.motion.poses;
        let place = |k: usize| {
            let site = &tendon.sites[k];
            poses[site.link].position + poses[site.link].rotation * site.place
        };
        self.row.fill(real(0.0));
        let mut length: T = real(0.0);
        for k in 1..tendon.sites.len() {
            let (from, to) = (place(k - 1), place(k));
            let way = to - from;
            let size = norm(&way);
            if size.re() <= 0.0 {
                continue;
            }
            length += size;
            let direction = way / size;
            for (link, point, sign) in
                [(tendon.sites[k - 1].link, from, -1.0), (tendon.sites[k].link, to, 1.0)]
            {
                let mut at = tree.last[link];
                while at != NONE {
                    let axis = &self.motion.axes[at];
                    let velocity = axis.linear + axis.angular.cross(&point);
                    self.row[at] += direction.dot(&velocity) * sign;
                    at = tree.before[at];
                }
            }
        }
        let along = |values: &[T]| {
            let zero: T = real(0.0);
            self.row.iter().zip(values).fold(zero, |sum, (r, v)| sum + *r * *v)
        };
        let stretch = length + along(&stage.shift) - tendon.rest;
        if stretch.re() <= 0.0 && !tendon.pushes {
            return;
        }
        let mut rate = along(&state.velocities);
        if let Some(lag) = stage.lag() {
            rate -= along(lag);
        }
        let tension = tendon.stiffness * stretch + tendon.damping * rate;
        let h = stage.implicit;
        let weight = tendon.damping * h + tendon.stiffness * (h * h);
        let n = self.forces.len();
        for j in 0..n {
            self.forces[j] -= self.row[j] * tension;
            for i in 0..=j {
                self.matrix[j * n + i] += self.row[j] * self.row[i] * weight;
            }
        }
    }

    fn entry(&self, i: usize, j: usize) -> T {
        let n = self.forces.len();
        let (low, high) = if i < j { (i, j) } else { (j, i) };
        self.matrix[high * n + low]
    }

    /// Changes of the velocities over a time (s), of which those of given joints are known, and what these
    /// joints take.
    ///
    /// # Errors
    /// The velocity that neither mass nor resistance holds.
    pub fn solve(
        &mut self,
        tree: &Tree<T>,
        step: T,
        changes: &mut [T],
        efforts: &mut [T],
    ) -> Result<(), usize> {
        let n = self.forces.len();
        let m = self.free.len();
        for a in 0..m {
            let i = self.free[a];
            let mut right = self.forces[i] * step;
            for (g, change) in changes.iter().enumerate().filter(|(g, _)| tree.given[*g]) {
                right -= self.entry(i, g) * *change;
            }
            self.right[a] = right;
            for b in 0..=a {
                self.factor[a * m + b] = self.matrix[i * n + self.free[b]];
            }
        }
        factor(&mut self.factor, m).map_err(|row| self.free[row])?;
        solve(&self.factor, &mut self.right);
        for a in 0..m {
            changes[self.free[a]] = self.right[a];
        }
        for g in (0..n).filter(|g| tree.given[*g]) {
            let mut sum: T = real(0.0);
            for (j, change) in changes.iter().enumerate() {
                sum += self.entry(g, j) * *change;
            }
            efforts[g] = sum / step - self.forces[g];
        }
        Ok(())
    }
}

/// Weight less buoyancy of a link, about its origin in its axes.
fn weigh<T: Number>(tree: &Tree<T>, link: &Link<T>, pose: &Pose<T>) -> Wrench<T> {
    let Some(weight) = &link.weight else { return Wrench::zero() };
    let gravity = pose.rotation.tr_mul(&tree.gravity);
    let force = gravity * (weight.mass - weight.displaced);
    let arm = weight.mass_center * weight.mass - weight.buoyancy_center * weight.displaced;
    Wrench { force, torque: arm.cross(&gravity) }
}

impl<T: Number> Tree<T> {
    /// What the fluid does to each link at the end of a step, about the link's origin in its axes, the
    /// inertia of the fluid included.
    #[must_use]
    pub fn fluid_wrenches(&self, state: &State<T>) -> Vec<Wrench<T>> {
        let mut motion = Motion::new(self);
        motion.follow(self, state);
        let one: T = real(1.0);
        (0..self.links.len())
            .map(|number| {
                let (link, pose) = (&self.links[number], motion.poses[number]);
                let twist = pose.twist_inside(&motion.twists[number]);
                let changed = motion.twist_by(self, number, &state.accelerations);
                let acceleration = pose.twist_inside(&changed.plus(&motion.biases[number], one));
                let added = self.masses[number].plus(&link.inertia, -one);
                let mut wrench = Wrench::zero()
                    .plus(&added.times(&acceleration), -one)
                    .plus(&twist.cross_momentum(&added.times(&twist)), -one);
                for placed in &link.loads {
                    let frame = placed.pose.unwrap_or_else(Pose::identity);
                    let load = placed.load.resist(&frame.twist_inside(&twist)).wrench;
                    wrench = wrench.plus(&frame.wrench_outside(&load), one);
                }
                wrench
            })
            .collect()
    }

    /// Momentum of links and of the fluid about them: linear, and angular about the world's origin.
    #[must_use]
    pub fn momentum(&self, state: &State<T>) -> Wrench<T> {
        let mut motion = Motion::new(self);
        motion.follow(self, state);
        let mut sum = Wrench::zero();
        for (number, pose) in motion.poses.iter().enumerate() {
            let inside = pose.twist_inside(&motion.twists[number]);
            let momentum = pose.wrench_outside(&self.masses[number].times(&inside));
            sum = sum.plus(&momentum, real(1.0));
        }
        sum.torque += state.root.position.cross(&sum.force);
        sum
    }
}

/// The error of a velocity that nothing holds.
pub(super) fn singular(time: f64, coordinate: usize) -> TreeError {
    TreeError::Singular { time, coordinate }
}
