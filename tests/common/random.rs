//! Reproducible random numbers of all tests: a sequence differs from seed to seed, but not from run to run.
#![allow(dead_code)]

use nalgebra::Vector3;

/// Linear congruential generator of Knuth's MMIX, of which the upper bits are used.
pub struct Random(u64);

impl Random {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
        random.unit();
        random.unit();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// In [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// In [low, high), its logarithm evenly.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// A whole number in 0 to n - 1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// One of a list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        (self.next() >> 56) as u8
    }

    /// A number for hostile calls: one time in six an extreme, else within a thousandth of a sensible one.
    pub fn number(&mut self, sensible: f64) -> f64 {
        let wild = [0.0, -1.0, 1e300, -1e300, 1e-300, f64::NAN, f64::INFINITY, 1e9];
        if self.below(6) == 0 { self.pick(&wild) } else { sensible * (1.0 + 1e-3 * self.symmetric()) }
    }
}

/// Number k of a fixed scattered sequence in [-1, 1], by its index.
pub fn number(k: usize) -> f64 {
    (12.9898 * (k as f64 + 1.0)).sin()
}

/// Vector of the numbers 3 k to 3 k + 2 of that sequence.
pub fn vector(k: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| number(3 * k + i))
}
