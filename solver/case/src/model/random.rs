//! `SplitMix64`: numbers at random that are those of their seed, on any machine.

use std::f64::consts::TAU;

use nalgebra::{Quaternion, UnitQuaternion};

/// Pseudo-random numbers that are the same on every machine and in every version (@steele2014).
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// The next one in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A rotation, all of them equally likely (@shoemake1992).
    pub fn rotation(&mut self) -> UnitQuaternion<f64> {
        let [part, first, second] = [self.uniform(), self.uniform(), self.uniform()];
        let [near, far] = [(1.0 - part).sqrt(), part.sqrt()];
        let [first, second] = [TAU * first, TAU * second];
        UnitQuaternion::new_normalize(Quaternion::new(
            far * second.cos(),
            near * first.sin(),
            near * first.cos(),
            far * second.sin(),
        ))
    }
}
