//! Pairs of keys, the value of the second larger than that of the first.

use symdiff::Formula;

use super::reader::Reader;
use super::report::Fields;
use super::symbols::SymbolTable;
use crate::syntax::codes::Code;

impl<S: SymbolTable> Reader<'_, S> {
    /// Reports an error if the second of two keys is not larger than the first.
    pub fn ordered(&mut self, fields: &Fields, low: &str, first: &Formula, high: &str, second: &Formula) {
        for corner in 0..self.corners.len() {
            let values = self.evaluate(first, corner).zip(self.evaluate(second, corner));
            if let Some((first, second)) = values.filter(|(first, second)| first >= second) {
                let label = &self.corners[corner].label;
                let message = format!("`{high}` ({second}) must be larger than `{low}` ({first}){label}");
                self.error(Code::ReversedRange, fields.key_span(high), message, None);
                return;
            }
        }
    }
}
