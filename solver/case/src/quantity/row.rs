//! `Quantity`: a row of a table of quantities, its shape, and the conditions under which it exists.

/// A row of a table of quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity<T> {
    /// Which one it is.
    pub id: T,
    /// Name after that of its owner, such as `force`; that of its axes follows.
    pub name: &'static str,
    /// What it consists of.
    pub shape: Shape,
    /// Unit; that of planar cases in parentheses where it differs.
    pub unit: &'static str,
    /// When it exists: all of them hold.
    pub when: &'static [Condition],
    /// What it is.
    pub meaning: &'static str,
}

/// What a quantity consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A number.
    Scalar,
    /// A vector: two numbers in the plane, three in space.
    Vector,
    /// What belongs to a rotation: a number in the plane, a vector in space.
    Rotation {
        /// What it is in space.
        in_space: &'static str,
    },
    /// A quaternion.
    Quaternion,
}

/// A number of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// A scalar itself.
    Whole,
    /// The real part of a quaternion.
    W,
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z; of a rotation in the plane the only one.
    Z,
}

/// Where a quantity exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// In planar and axisymmetric cases.
    Planar,
    /// In three dimensions.
    Spatial,
    /// There are `[scales]` and a density, so that coefficients can be formed.
    Scales,
    /// There is `[contact]`.
    Contact,
    /// The joint is a pivot.
    Pivot,
    /// The joint is an arm.
    Arm,
    /// The swimmer has more than one body.
    SeveralBodies,
    /// The swimmer has two bodies that are not on one pivot.
    SeparateBodies,
    /// The swimmer has a period, and the run is unsteady.
    Cycles,
    /// The swimmer has no cycles.
    NoCycles,
    /// The resistance of the swimmer is known.
    Resistance,
    /// All work on the fluid is that of bodies and waving sheets.
    IdleSides,
    /// The fluid is convected in time around bodies, and does not cross the sides.
    ClosedSides,
    /// There is `[flow]`.
    MeanFlow,
    /// The fluid is convected.
    Convection,
    /// The run is unsteady.
    Unsteady,
    /// The mesh moves.
    MovingMesh,
    /// The body has a magnetic moment in a field.
    Moment,
    /// The magnetic field differs from place to place.
    FieldGradient,
    /// The body is an elastic rod.
    Rod,
    /// It is one with muscles or motors.
    Activation,
    /// It is one with loads at its ends.
    EndLoad,
    /// It is one whose head is attached.
    Attached,
    /// The tracers have a region.
    Region,
    /// The scalar has a difference, and the surface is a body's.
    Difference,
}

impl Condition {
    /// It, if it holds.
    pub(super) fn holding_if(self, holds: bool) -> Option<Self> {
        holds.then_some(self)
    }

    /// The same in words, for a table.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Planar => "planar, axisymmetric",
            Self::Spatial => "spatial",
            Self::Scales => "`scales`",
            Self::Contact => "[`contact`](#contact)",
            Self::Pivot => "pivots (`bent`, `hinge`, `ball`)",
            Self::Arm => "`arm`, `slider`",
            Self::SeveralBodies => "several bodies",
            Self::SeparateBodies => "two bodies that share no pivot",
            Self::Cycles => "a period",
            Self::NoCycles => "no period",
            Self::Resistance => "`resistance`",
            Self::IdleSides => "bodies or a waving sheet, and other sides that do no work",
            Self::ClosedSides => "`navier-stokes`, unsteady, bodies, sides that nothing crosses",
            Self::MeanFlow => "[`flow`](#flow)",
            Self::Convection => "`navier-stokes`",
            Self::Unsteady => "unsteady",
            Self::MovingMesh => "a moving mesh",
            Self::Moment => "[`magnetic_moment`](#field)",
            Self::FieldGradient => "a [field](#field) of place",
            Self::Rod => "[`rod`](#bodies-that-bend-by-themselves)",
            Self::Activation => "[`activation`](#bodies-that-bend-by-themselves)",
            Self::EndLoad => "[`rod.load`](#bodies-that-bend-by-themselves)",
            Self::Attached => "[`attached`](#bodies-that-bend-by-themselves)",
            Self::Region => "`region`",
            Self::Difference => "`difference`, bodies",
        }
    }
}

/// A number of a quantity as it is named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedComponent {
    /// Name after that of the owner, such as `force.x`.
    pub name: String,
    /// Which number it is.
    pub component: Component,
    /// Unit; that of planar cases in parentheses where it differs.
    pub unit: &'static str,
    /// When it exists: all of them hold.
    pub when: Vec<Condition>,
    /// What it is.
    pub meaning: &'static str,
}

impl NamedComponent {
    /// Whether it exists where these conditions hold.
    pub(super) fn exists_where(&self, known: &[Condition]) -> bool {
        self.when.iter().all(|condition| known.contains(condition))
    }
}

impl<T> Quantity<T> {
    /// Its numbers, those of all dimensions.
    #[must_use]
    pub fn components(&self) -> Vec<NamedComponent> {
        let named = |component, also: Option<Condition>| {
            let axis = match component {
                Component::Whole => "",
                Component::W => "w",
                Component::X => "x",
                Component::Y => "y",
                Component::Z => "z",
            };
            let between = if self.name.is_empty() || axis.is_empty() { "" } else { "." };
            let more = also.filter(|condition| !self.when.contains(condition));
            NamedComponent {
                name: format!("{}{between}{axis}", self.name),
                component,
                unit: self.unit,
                when: self.when.iter().copied().chain(more).collect(),
                meaning: self.meaning,
            }
        };
        let spatial = Some(Condition::Spatial);
        match self.shape {
            Shape::Scalar => vec![named(Component::Whole, None)],
            Shape::Vector => {
                let [x, y] = [Component::X, Component::Y].map(|axis| named(axis, None));
                vec![x, y, named(Component::Z, spatial)]
            }
            Shape::Rotation { in_space } => {
                let name = self.name.to_owned();
                let in_plane = named(Component::Z, Some(Condition::Planar));
                let unit = self.unit.split(" (").next().unwrap_or_default();
                let [x, y, z] = [Component::X, Component::Y, Component::Z]
                    .map(|axis| NamedComponent { unit, meaning: in_space, ..named(axis, spatial) });
                vec![NamedComponent { name, ..in_plane }, x, y, z]
            }
            Shape::Quaternion => {
                let all = [Component::W, Component::X, Component::Y, Component::Z];
                all.map(|component| named(component, None)).to_vec()
            }
        }
    }
}
