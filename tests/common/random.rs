//! Random numbers of a linear congruential generator (Knuth, The Art of Computer Programming 2, 3.3.4: MMIX): the same
//! ones each time.

/// The generator, from its seed.
pub struct Random(pub u64);

impl Random {
    /// Uniform between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
