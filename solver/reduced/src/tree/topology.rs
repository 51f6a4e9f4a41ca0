//! `Tree`: links, joints and tendons, with the numbering of their coordinates.

use nalgebra::Vector3;

use super::error::TreeError;
use super::link::{Drive, JointKind, Link};
use super::spatial::{Number, Symmetric, real, vector};
use super::tendon::Tendon;

/// How the first link moves. A rail or springs are joints between it, held, and links without mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Root {
    /// Not at all.
    Held,
    /// Along x and y of the world, and about z.
    Planar,
    /// Freely in space.
    Free,
}

impl Root {
    /// Number of its velocities.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Held => 0,
            Self::Planar => 3,
            Self::Free => 6,
        }
    }
}

/// No velocity comes before.
pub(super) const NONE: usize = usize::MAX;

/// A tree of rigid links. Its velocities are those of the root in the frame of the first link (along x, y and
/// about z, or along and about all axes), then the rates of hinges and sliders in the order of the links.
#[derive(Debug, Clone)]
pub struct Tree<T: Number> {
    pub(super) root: Root,
    pub(super) links: Vec<Link<T>>,
    pub(super) tendons: Vec<Tendon<T>>,
    pub(super) gravity: Vector3<T>,
    /// Masses of links with those of the fluid about them, in their frames.
    pub(super) masses: Vec<Symmetric<T>>,
    /// The last velocity on the way from the root to each link, its own included.
    pub(super) last: Vec<usize>,
    /// The velocity before each on the way from the root.
    pub(super) before: Vec<usize>,
    /// The link that each velocity moves first.
    pub(super) moved: Vec<usize>,
    /// Whether each velocity is given.
    pub(super) given: Vec<bool>,
}

impl<T: Number> Tree<T> {
    /// A tree of links, each after its parent.
    ///
    /// # Errors
    /// `TreeError::Link` when a parent does not come before its link, or an axis is no unit vector.
    pub fn new(root: Root, links: Vec<Link<T>>) -> Result<Self, TreeError> {
        if links.is_empty() {
            return Err(TreeError::Given("a tree has one link at least".to_owned()));
        }
        let mut tree = Self {
            root,
            tendons: Vec::new(),
            gravity: vector([0.0; 3]),
            masses: Vec::new(),
            last: Vec::new(),
            before: Vec::new(),
            moved: vec![0; root.count()],
            given: vec![false; root.count()],
            links,
        };
        tree.before = (0..root.count()).map(|k| k.checked_sub(1).unwrap_or(NONE)).collect();
        for number in 0..tree.links.len() {
            tree.number_link(number)?;
        }
        Ok(tree)
    }

    /// Puts the coordinate of a link behind those there are, and sums up its masses.
    fn number_link(&mut self, number: usize) -> Result<(), TreeError> {
        let link = &self.links[number];
        let wrong = |what: String| Err(TreeError::Link { link: number, what });
        let mut last = self.root.count().checked_sub(1).unwrap_or(NONE);
        if number > 0 {
            if link.parent >= number {
                let what = format!("its parent, {}, has to come before it", link.parent);
                return wrong(what);
            }
            last = self.last[link.parent];
            let length = link.joint.axis.dot(&link.joint.axis).re();
            if (length - 1.0).abs() > 1e-9 {
                return wrong(format!(
                    "the axis of its joint has the length {}, not 1",
                    length.sqrt()
                ));
            }
            if link.joint.kind != JointKind::Fixed {
                self.before.push(last);
                self.moved.push(number);
                self.given.push(matches!(link.joint.drive, Drive::Given | Drive::Rate));
                last = self.before.len() - 1;
            }
        }
        self.last.push(last);
        let mut masses = link.inertia;
        for placed in &link.loads {
            let added = placed.load.added_mass();
            let added = placed.pose.as_ref().map_or(added, |pose| added.seen_from(pose));
            masses = masses.plus(&added, real(1.0));
        }
        self.masses.push(masses);
        Ok(())
    }

    /// The same tree with a field of gravity (m/s2).
    #[must_use]
    pub fn in_gravity(self, gravity: [f64; 3]) -> Self {
        Self { gravity: vector(gravity), ..self }
    }

    /// The same tree with tendons.
    ///
    /// # Errors
    /// `TreeError::Tendon` when one has fewer than two sites, or a site on a link that does not exist.
    pub fn with_tendons(self, tendons: Vec<Tendon<T>>) -> Result<Self, TreeError> {
        for (number, tendon) in tendons.iter().enumerate() {
            let wrong = |what: String| Err(TreeError::Tendon { tendon: number, what });
            if tendon.sites.len() < 2 {
                return wrong("it needs two sites at least".to_owned());
            }
            if let Some(site) = tendon.sites.iter().find(|site| site.link >= self.links.len()) {
                return wrong(format!("there is no link {}", site.link));
            }
        }
        Ok(Self { tendons, ..self })
    }

    /// Number of velocities.
    #[must_use]
    pub fn n_velocities(&self) -> usize {
        self.before.len()
    }

    /// Number of velocities of the root.
    #[must_use]
    pub fn n_root(&self) -> usize {
        self.root.count()
    }

    /// The links.
    #[must_use]
    pub fn links(&self) -> &[Link<T>] {
        &self.links
    }

    /// The tendons.
    #[must_use]
    pub fn tendons(&self) -> &[Tendon<T>] {
        &self.tendons
    }

    /// The velocity of the joint of a link; none of a link that is fixed.
    #[must_use]
    pub fn velocity_of(&self, link: usize) -> Option<usize> {
        (self.n_root()..self.n_velocities()).find(|velocity| self.moved[*velocity] == link)
    }
}
