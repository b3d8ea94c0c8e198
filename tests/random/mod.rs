//! Random choices that differ from seed to seed but not from run to run.
#![allow(dead_code)]

/// Marsaglia's xorshift (2003).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9))
    }

    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// Mostly sensible, sometimes wild.
    pub fn number(&mut self, sensible: f64) -> f64 {
        let wild = [0.0, -1.0, 1e300, -1e300, 1e-300, f64::NAN, f64::INFINITY, 1e9];
        let factor = 1.0 + 1e-3 * (self.below(2001) as f64 - 1000.0) / 1000.0;
        if self.below(6) == 0 { self.pick(&wild) } else { sensible * factor }
    }
}
