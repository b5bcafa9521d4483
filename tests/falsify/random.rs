//! Random numbers: the same from the same seed, on every machine.

/// SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
pub struct Random(u64);

impl Random {
    /// The numbers of one draw of a seed: they do not depend on the other draws.
    pub fn new(seed: u64, draw: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0xD134_2543_DE82_EF95) ^ draw.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly from a to b, of three digits.
    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        digits(a + (b - a) * self.unit(), 3)
    }

    /// Evenly in the logarithm from a to b, both positive, of three digits.
    pub fn scale(&mut self, a: f64, b: f64) -> f64 {
        digits(a * (b / a).powf(self.unit()), 3)
    }

    pub fn whole(&mut self, least: usize, most: usize) -> usize {
        least + (self.unit() * (most - least + 1) as f64) as usize
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.whole(0, from.len() - 1)]
    }
}

/// The nearest number of `digits` significant digits.
pub fn digits(x: f64, digits: usize) -> f64 {
    // Text of this form is a number.
    format!("{x:.*e}", digits - 1).parse().unwrap()
}
