//! Disjoint sets (union–find).

/// Disjoint sets of the numbers below a limit.
pub struct Sets {
    /// Each number's parent; the smallest number of a set is its own parent.
    parent: Vec<usize>,
}

impl Sets {
    /// Each number in a set of its own.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count).collect() }
    }

    /// The representative of a number's set: its smallest number.
    pub fn of(&mut self, mut number: usize) -> usize {
        while self.parent[number] != number {
            self.parent[number] = self.parent[self.parent[number]];
            number = self.parent[number];
        }
        number
    }

    /// Unites two sets; returns whether they were different.
    pub fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.of(a), self.of(b));
        self.parent[a.max(b)] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smallest_member_represents_its_set() {
        let mut sets = Sets::new(5);
        assert!(sets.join(4, 2) && sets.join(1, 4));
        assert!(!sets.join(2, 1));
        assert_eq!((0..5).map(|number| sets.of(number)).collect::<Vec<_>>(), [0, 1, 1, 3, 1]);
    }
}
