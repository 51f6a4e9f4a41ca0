//! Arithmetic on arrays of lanes that fill vector registers.

use pulp::Simd;

/// x y + z, fused where that is one instruction.
#[inline(always)]
pub fn multiply_add<S: Simd>(x: f64, y: f64, z: f64) -> f64 {
    if S::IS_SCALAR { x * y + z } else { x.mul_add(y, z) }
}

/// sum += x y, lane by lane.
#[inline(always)]
pub fn add_product<S: Simd, const L: usize>(sum: &mut [f64; L], x: &[f64; L], y: f64) {
    for lane in 0..L {
        sum[lane] = multiply_add::<S>(x[lane], y, sum[lane]);
    }
}

/// sum += x y, lane by lane.
#[inline(always)]
pub fn add_scaled<S: Simd, const L: usize>(sum: &mut [f64; L], x: &[f64; L], y: &[f64; L]) {
    for lane in 0..L {
        sum[lane] = multiply_add::<S>(x[lane], y[lane], sum[lane]);
    }
}

/// x y, lane by lane.
#[inline(always)]
pub fn product<const L: usize>(x: &[f64; L], y: &[f64; L]) -> [f64; L] {
    let mut result = [0.0; L];
    for lane in 0..L {
        result[lane] = x[lane] * y[lane];
    }
    result
}

/// x y, lane by lane.
#[inline(always)]
pub fn scaled<const L: usize>(x: &[f64; L], y: f64) -> [f64; L] {
    let mut result = [0.0; L];
    for lane in 0..L {
        result[lane] = x[lane] * y;
    }
    result
}

/// Every entry times `factor`.
#[inline(always)]
pub fn scaled_rows<const D: usize, const L: usize>(
    rows: &[[f64; L]; D],
    factor: f64,
) -> [[f64; L]; D] {
    let mut result = *rows;
    for row in &mut result {
        *row = scaled(row, factor);
    }
    result
}
