//! Things that belong together.

/// Disjoint sets of the numbers below a limit.
pub struct Sets {
    /// A number nearer to the one that stands for its set, or that one itself.
    above: Vec<usize>,
}

impl Sets {
    /// Each number alone.
    pub fn new(count: usize) -> Self {
        Self { above: (0..count).collect() }
    }

    /// The number that stands for a number's set: the smallest in it.
    pub fn of(&mut self, mut number: usize) -> usize {
        while self.above[number] != number {
            self.above[number] = self.above[self.above[number]];
            number = self.above[number];
        }
        number
    }

    /// Makes two sets one; whether they were two.
    pub fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.of(a), self.of(b));
        self.above[a.max(b)] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_stands_for_all() {
        let mut sets = Sets::new(5);
        assert!(sets.join(4, 2) && sets.join(1, 4));
        assert!(!sets.join(2, 1));
        assert_eq!((0..5).map(|number| sets.of(number)).collect::<Vec<_>>(), [0, 1, 1, 3, 1]);
    }
}
