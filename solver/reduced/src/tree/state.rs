//! `State`: coordinates and velocities of a tree, and where its links are then.

use super::error::TreeError;
use super::link::{Joint, JointKind};
use super::placement::Placement;
use super::spatial::{Number, Pose, Twist, real, rotation, vector};
use super::topology::{NONE, Root, Tree};

/// What evolves.
#[derive(Debug, Clone, PartialEq)]
pub struct State<T: Number> {
    /// Time (s).
    pub time: f64,
    /// Where the root is.
    pub root: Placement<T>,
    /// Coordinates of hinges and sliders (rad, m); the first ones, as many as the root has velocities, are
    /// not used.
    pub coordinates: Vec<T>,
    /// Velocities, as `Tree` has them.
    pub velocities: Vec<T>,
    /// Changes of the velocities over the last step, a time.
    pub accelerations: Vec<T>,
    /// What given joints took over the last step (N m, N); zero for all others.
    pub efforts: Vec<T>,
}

/// Where links are and how they move, about the origin of the root in axes of the world.
#[derive(Debug, Clone)]
pub(super) struct Motion<T: Number> {
    pub poses: Vec<Pose<T>>,
    pub twists: Vec<Twist<T>>,
    /// Accelerations of links where no velocity changes.
    pub biases: Vec<Twist<T>>,
    /// The twist of every link that a velocity moves, when it is one.
    pub axes: Vec<Twist<T>>,
}

impl<T: Number> Motion<T> {
    pub fn new(tree: &Tree<T>) -> Self {
        let n = tree.links.len();
        Self {
            poses: vec![Pose::identity(); n],
            twists: vec![Twist::zero(); n],
            biases: vec![Twist::zero(); n],
            axes: vec![Twist::zero(); tree.n_velocities()],
        }
    }

    /// Follows the tree from its root.
    pub fn follow(&mut self, tree: &Tree<T>, state: &State<T>) {
        self.place_root(tree, state);
        for number in 1..tree.links.len() {
            let link = &tree.links[number];
            let parent = link.parent;
            let joint = self.poses[parent].then(&link.at);
            let (twist, bias) = (self.twists[parent], self.biases[parent]);
            let velocity = tree.last[number];
            if velocity == tree.last[parent] {
                self.poses[number] = joint;
                self.twists[number] = twist;
                self.biases[number] = bias;
                continue;
            }
            let rate = state.velocities[velocity];
            let Beyond { pose, axis } = beyond(&joint, &link.joint, state.coordinates[velocity]);
            self.poses[number] = pose;
            self.axes[velocity] = axis;
            self.twists[number] = twist.plus(&axis, rate);
            self.biases[number] = bias.plus(&twist.cross(&axis), rate);
        }
    }

    fn place_root(&mut self, tree: &Tree<T>, state: &State<T>) {
        let turned = state.root.rotation();
        self.poses[0] = Pose { rotation: turned, position: vector([0.0; 3]) };
        let none = vector([0.0; 3]);
        let column = |k: usize| turned.column(k).into_owned();
        let along = |k: usize| Twist { linear: column(k), angular: none };
        let about = |k: usize| Twist { linear: none, angular: column(k) };
        match tree.root {
            Root::Held => {}
            Root::Planar => {
                self.axes[..3].copy_from_slice(&[along(0), along(1), about(2)]);
            }
            Root::Free => {
                for k in 0..3 {
                    self.axes[k] = along(k);
                    self.axes[3 + k] = about(k);
                }
            }
        }
        let mut twist = Twist::zero();
        for k in 0..tree.n_root() {
            twist = twist.plus(&self.axes[k], state.velocities[k]);
        }
        self.twists[0] = twist;
        // Of a twist constant in the frame of the body that it moves the commutator vanishes
        self.biases[0] = Twist::zero();
    }

    /// The twist of a link with other velocities.
    pub fn twist_by(&self, tree: &Tree<T>, link: usize, velocities: &[T]) -> Twist<T> {
        let mut twist = Twist::zero();
        let mut at = tree.last[link];
        while at != NONE {
            twist = twist.plus(&self.axes[at], velocities[at]);
            at = tree.before[at];
        }
        twist
    }
}

/// What is beyond a joint: the pose of the link, and its twist by the rate of the joint.
struct Beyond<T: Number> {
    pose: Pose<T>,
    axis: Twist<T>,
}

fn beyond<T: Number>(at: &Pose<T>, joint: &Joint<T>, coordinate: T) -> Beyond<T> {
    let direction = at.rotation * joint.axis;
    if joint.kind == JointKind::Slider {
        let position = at.position + direction * coordinate;
        let axis = Twist { linear: direction, angular: vector([0.0; 3]) };
        return Beyond { pose: Pose { rotation: at.rotation, position }, axis };
    }
    let rotation = at.rotation * rotation(&joint.axis, coordinate);
    let axis = Twist { linear: at.position.cross(&direction), angular: direction };
    Beyond { pose: Pose { rotation, position: at.position }, axis }
}

impl<T: Number> Tree<T> {
    /// The state at rest at time zero, all coordinates zero.
    #[must_use]
    pub fn rest(&self) -> State<T> {
        let zeros = vec![real(0.0); self.n_velocities()];
        State {
            time: 0.0,
            root: Placement::identity(),
            coordinates: zeros.clone(),
            velocities: zeros.clone(),
            accelerations: zeros.clone(),
            efforts: zeros,
        }
    }

    /// Where all links are in the world.
    #[must_use]
    pub fn poses(&self, state: &State<T>) -> Vec<Pose<T>> {
        let mut motion = Motion::new(self);
        motion.follow(self, state);
        let shift = state.root.position;
        for pose in &mut motion.poses {
            pose.position += shift;
        }
        motion.poses
    }

    /// How all links move: velocities of their origins and angular velocities, in axes of the world.
    #[must_use]
    pub fn twists(&self, state: &State<T>) -> Vec<Twist<T>> {
        let mut motion = Motion::new(self);
        motion.follow(self, state);
        let at = |(twist, pose): (&Twist<T>, &Pose<T>)| Twist {
            linear: twist.linear + twist.angular.cross(&pose.position),
            angular: twist.angular,
        };
        motion.twists.iter().zip(&motion.poses).map(at).collect()
    }

    /// Kinetic energy of links and of the fluid about them (J).
    #[must_use]
    pub fn kinetic_energy(&self, state: &State<T>) -> T {
        let mut motion = Motion::new(self);
        motion.follow(self, state);
        let mut energy: T = real(0.0);
        for ((twist, pose), masses) in motion.twists.iter().zip(&motion.poses).zip(&self.masses) {
            let inside = pose.twist_inside(twist);
            energy += inside.dot(&masses.times(&inside)) * 0.5;
        }
        energy
    }

    /// # Errors
    /// `TreeError::BlowUp` when a velocity is no number.
    pub(super) fn check_finite(&self, state: &State<T>) -> Result<(), TreeError> {
        if state.velocities.iter().all(|velocity| velocity.re().is_finite()) {
            return Ok(());
        }
        Err(TreeError::BlowUp { time: state.time })
    }
}
