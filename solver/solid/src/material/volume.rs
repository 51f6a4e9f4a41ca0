//! The stretches of volume ratio one that are nearest to given ones.

use num_dual::DualNum;

/// Steps at most; from stretches a cell survives it takes five to ten.
const N_STEPS: usize = 100;

/// A step of Newton's method, so short that its end is exact; derivatives are after two more.
const CONVERGED: f64 = 1e-8;

/// Where the search starts for stretches that are smaller, or negative.
const LEAST: f64 = 0.1;

/// Newton's method starts here; farther away each step solves for the volume alone, which is slow and safe.
const NEAR: f64 = 1e-2;

/// The stretches p nearest to s with p_1 p_2 p_3 = 1, and with them the derivatives that s carries.
///
/// They obey p_i (s_i - p_i) = kappa.
pub(super) fn nearest_of_unit_volume<T: DualNum<Primitive = f64> + Copy>(s: [T; 3]) -> [T; 3] {
    let mut p = s.map(|s| if s.re() < LEAST { T::from(LEAST) } else { s });
    let mut change = f64::INFINITY;
    let (mut left, mut is_found) = (N_STEPS, false);
    while left > 0 {
        let next = if change < NEAR { newton(s, p) } else { linearised(s, p) };
        let now: f64 = (0..3).map(|i| (next[i].re() - p[i].re()).abs()).sum();
        p = next;
        left -= 1;
        if now < CONVERGED && !is_found && change < NEAR {
            is_found = true;
            left = left.min(2 * usize::from(T::NDERIV > 0));
        }
        change = now;
    }
    p
}

/// The nearest stretches whose volume is one to first order about p.
fn linearised<T: DualNum<Primitive = f64> + Copy>(s: [T; 3], p: [T; 3]) -> [T; 3] {
    let normal = [p[1] * p[2], p[2] * p[0], p[0] * p[1]];
    let excess = p[0] * p[1] * p[2] - 1.0;
    let dot = |a: [T; 3], b: [T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let apart = [p[0] - s[0], p[1] - s[1], p[2] - s[2]];
    let length = (dot(normal, apart) - excess) / dot(normal, normal);
    std::array::from_fn(|i| s[i] + length * normal[i])
}

/// Newton's step for p_i (s_i - p_i) = kappa and a volume of one.
fn newton<T: DualNum<Primitive = f64> + Copy>(s: [T; 3], p: [T; 3]) -> [T; 3] {
    let slope: [T; 3] = std::array::from_fn(|i| s[i] - p[i] * 2.0);
    let value: [T; 3] = std::array::from_fn(|i| p[i] * (s[i] - p[i]));
    let volume = p[0] * p[1] * p[2];
    let excess = (volume - 1.0) / volume;
    let sum = |part: &dyn Fn(usize) -> T| part(0) + part(1) + part(2);
    let kappa =
        (sum(&|i| value[i] / (slope[i] * p[i])) - excess) / sum(&|i| (slope[i] * p[i]).recip());
    std::array::from_fn(|i| p[i] + (kappa - value[i]) / slope[i])
}
