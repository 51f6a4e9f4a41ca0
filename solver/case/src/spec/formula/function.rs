//! `Function`: operators and functions of expressions.

/// An operator or a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    Negative,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Below,
    Above,
    AtMost,
    AtLeast,
    If,
    Min,
    Max,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Sqrt,
    Abs,
    Sign,
    Floor,
}

/// The functions by their names.
pub const NAMED: [(&str, Function); 20] = [
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("atan2", Function::Atan2),
    ("sinh", Function::Sinh),
    ("cosh", Function::Cosh),
    ("tanh", Function::Tanh),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("sign", Function::Sign),
    ("floor", Function::Floor),
    ("min", Function::Min),
    ("max", Function::Max),
    ("if", Function::If),
];

impl Function {
    /// The function of a name.
    pub fn named(name: &str) -> Option<Self> {
        NAMED.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
    }

    /// How many arguments it takes at least and at most.
    pub fn arguments(self) -> [usize; 2] {
        match self {
            Self::Min | Self::Max => [2, 16],
            Self::If => [3, 3],
            Self::Atan2
            | Self::Plus
            | Self::Minus
            | Self::Times
            | Self::Over
            | Self::Power
            | Self::Below
            | Self::Above
            | Self::AtMost
            | Self::AtLeast => [2, 2],
            _ => [1, 1],
        }
    }

    /// Its value by those of its arguments; a comparison is 1 where it holds and 0 elsewhere.
    pub fn value(self, at: impl Fn(usize) -> f64) -> f64 {
        let truth = |holds: bool| if holds { 1.0 } else { 0.0 };
        let given = || (2..16).map(&at).take_while(|value| !value.is_nan());
        match self {
            Self::Negative => -at(0),
            Self::Plus => at(0) + at(1),
            Self::Minus => at(0) - at(1),
            Self::Times => at(0) * at(1),
            Self::Over => at(0) / at(1),
            Self::Power => power(at(0), at(1)),
            Self::Below => truth(at(0) < at(1)),
            Self::Above => truth(at(0) > at(1)),
            Self::AtMost => truth(at(0) <= at(1)),
            Self::AtLeast => truth(at(0) >= at(1)),
            Self::If => at(if at(0) == 0.0 { 2 } else { 1 }),
            Self::Min => given().fold(at(0).min(at(1)), f64::min),
            Self::Max => given().fold(at(0).max(at(1)), f64::max),
            Self::Sin => at(0).sin(),
            Self::Cos => at(0).cos(),
            Self::Tan => at(0).tan(),
            Self::Asin => at(0).asin(),
            Self::Acos => at(0).acos(),
            Self::Atan => at(0).atan(),
            Self::Atan2 => at(0).atan2(at(1)),
            Self::Sinh => at(0).sinh(),
            Self::Cosh => at(0).cosh(),
            Self::Tanh => at(0).tanh(),
            Self::Exp => at(0).exp(),
            Self::Log => at(0).ln(),
            Self::Sqrt => at(0).sqrt(),
            Self::Abs => at(0).abs(),
            Self::Sign => {
                let value = at(0);
                if value == 0.0 { 0.0 } else { value.signum() }
            }
            Self::Floor => at(0).floor(),
        }
    }
}

/// A power; of small whole exponents by products, whose rounding is the same on all machines.
fn power(base: f64, exponent: f64) -> f64 {
    whole_exponent(exponent).map_or_else(|| base.powf(exponent), |whole| base.powi(whole))
}

/// An exponent that is whole and small.
pub fn whole_exponent(exponent: f64) -> Option<i32> {
    const LARGEST: f64 = 64.0;
    #[expect(clippy::cast_possible_truncation, reason = "it is whole and small")]
    (exponent.fract() == 0.0 && exponent.abs() <= LARGEST).then_some(exponent as i32)
}
