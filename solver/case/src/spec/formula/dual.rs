//! Expressions of numbers that carry derivatives along.

use num_dual::DualNum;

use super::function::{Function, whole_exponent};
use super::node::Node;

impl Node {
    /// Its value, with what it carries along, at x, y, z and t, or at what stands for them.
    pub fn dual<D: DualNum<Primitive = f64> + Copy>(&self, place: &[D; 4]) -> D {
        match self {
            Self::Number(value) => D::from(*value),
            Self::Variable(which) => place[*which],
            Self::Call(function, parts) => {
                let values: Vec<D> = parts.iter().map(|part| part.dual(place)).collect();
                if *function == Function::Power && !parts[1].has(&[0, 1, 2, 3]) {
                    let exponent = values[1].re();
                    let whole = whole_exponent(exponent);
                    return whole.map_or_else(|| values[0].powf(exponent), |n| values[0].powi(n));
                }
                dual_value(*function, &values)
            }
        }
    }
}

/// The value of a function by those of its arguments; comparisons, signs and parts of numbers have no rates.
fn dual_value<D: DualNum<Primitive = f64> + Copy>(function: Function, at: &[D]) -> D {
    let part = |nth: usize| at.get(nth).copied().unwrap_or(D::from(f64::NAN));
    let (first, second) = (part(0), part(1));
    let plain = || D::from(function.value(|nth| part(nth).re()));
    let chosen = |is_before: fn(f64, f64) -> bool| {
        at.iter().copied().fold(
            first,
            |best, one| {
                if is_before(one.re(), best.re()) { one } else { best }
            },
        )
    };
    match function {
        Function::Negative => -first,
        Function::Plus => first + second,
        Function::Minus => first - second,
        Function::Times => first * second,
        Function::Over => first / second,
        Function::Power => first.powd(second),
        Function::If => part(if first.re() == 0.0 { 2 } else { 1 }),
        Function::Min => chosen(|one, best| one < best),
        Function::Max => chosen(|one, best| one > best),
        Function::Sin => first.sin(),
        Function::Cos => first.cos(),
        Function::Tan => first.tan(),
        Function::Asin => first.asin(),
        Function::Acos => first.acos(),
        Function::Atan => first.atan(),
        Function::Atan2 => first.atan2(second),
        Function::Sinh => first.sinh(),
        Function::Cosh => first.cosh(),
        Function::Tanh => first.tanh(),
        Function::Exp => first.exp(),
        Function::Log => first.ln(),
        Function::Sqrt => first.sqrt(),
        Function::Abs => {
            if first.re() < 0.0 {
                -first
            } else {
                first
            }
        }
        Function::Below
        | Function::Above
        | Function::AtMost
        | Function::AtLeast
        | Function::Sign
        | Function::Floor => plain(),
    }
}
