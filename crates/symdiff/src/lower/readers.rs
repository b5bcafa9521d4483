//! The instructions of a list that read the results of others.

use super::node_table::NodeTable;
use crate::expr::Expr;

/// The instructions that read results of others.
pub(crate) struct Readers {
    /// Readers of each writer in turn, writers ascending.
    list: Vec<usize>,
    /// By writer, the start of its readers in `list`; and the end.
    begin: Vec<usize>,
}

impl Readers {
    /// The readers among `count` instructions. `needs` gives the values that one reads, `writer` the instruction that
    /// writes a value.
    pub fn of<N: Iterator<Item = Expr>>(count: usize, writer: &NodeTable, needs: impl Fn(usize) -> N) -> Self {
        let written_by = |index| needs(index).filter_map(|read| writer.get(read)).map(|writer| writer as usize);
        // Shifted by two: the counts of readers become their starts, and then, by filling, their ends.
        let mut begin = vec![0; count + 2];
        (0..count).flat_map(written_by).for_each(|writer| begin[writer + 2] += 1);
        (2..begin.len()).for_each(|place| begin[place] += begin[place - 1]);
        let mut list = vec![0; begin[count + 1]];
        for index in 0..count {
            for writer in written_by(index) {
                list[begin[writer + 1]] = index;
                begin[writer + 1] += 1;
            }
        }
        Self { list, begin }
    }

    /// By instruction, of `count`, how many results of others it reads.
    pub fn missing(&self, count: usize) -> Vec<usize> {
        let mut missing = vec![0; count];
        self.list.iter().for_each(|&index| missing[index] += 1);
        missing
    }

    /// The readers of one instruction's results, ascending.
    pub fn of_writer(&self, index: usize) -> &[usize] {
        &self.list[self.begin[index]..self.begin[index + 1]]
    }
}
