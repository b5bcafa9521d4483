//! Tables of numbers: lines of cells between commas, semicolons or tabs; measured rows, points, and tables of models.
//!
//! The separator is that of the first line: tabs if it has some, else semicolons, else commas. With tabs and
//! semicolons, numbers may have decimal commas, all of a table or none. Empty lines, and those that begin with `#`, do
//! not count; a cell may be in double quotes.

use std::ops::Range;

use super::suggest::clip;

/// A cell, without blanks and quotes around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell<'t> {
    /// Its text.
    pub text: &'t str,
    /// Offset of its text in the table's text, bytes.
    pub start: usize,
    /// The column of its first character in its line, from 1.
    pub column: usize,
}

/// A line that has cells.
#[derive(Clone, Debug)]
pub struct Line<'t> {
    /// From 1.
    pub number: usize,
    /// Its cells; at least one.
    pub cells: Vec<Cell<'t>>,
}

/// A table.
#[derive(Clone, Debug)]
pub struct Table<'t> {
    /// Its lines with cells, in order.
    pub lines: Vec<Line<'t>>,
    separator: char,
    /// Whether some cell is a number with a decimal point.
    has_points: bool,
}

impl Cell<'_> {
    /// Its bytes in the table's text.
    pub fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }
}

impl<'t> Table<'t> {
    /// Splits a text.
    pub fn read(text: &'t str) -> Self {
        let mut lines = Vec::new();
        let mut separator = None;
        let mut start = 0;
        for (index, whole) in text.split_inclusive('\n').enumerate() {
            let mark = if index == 0 { whole.len() - whole.trim_start_matches('\u{feff}').len() } else { 0 };
            let line = whole[mark..].trim_end_matches(['\n', '\r']);
            if !line.trim().is_empty() && !line.starts_with('#') {
                let separator = *separator.get_or_insert_with(|| separator_of(line));
                lines.push(Line { number: index + 1, cells: cells(line, separator, start + mark) });
            }
            start += whole.len();
        }
        let separator = separator.unwrap_or(',');
        let is_point = |cell: &Cell| cell.text.contains('.') && cell.text.parse::<f64>().is_ok();
        let has_points = lines.iter().flat_map(|line| &line.cells).any(is_point);
        Self { lines, separator, has_points }
    }

    /// Whether a line has names: some cell of it is no number.
    pub fn is_heading(&self, line: &Line) -> bool {
        line.cells.iter().any(|cell| self.parsed(cell).is_none())
    }

    /// A cell's number, and whether it has a decimal comma.
    fn parsed(&self, cell: &Cell) -> Option<(f64, bool)> {
        let with_point = cell.text.replacen(',', ".", 1);
        let has_comma = with_point != cell.text && !cell.text.contains('.') && self.separator != ',';
        let number = if has_comma { &with_point } else { cell.text }.parse::<f64>().ok();
        number.filter(|number| number.is_finite()).map(|number| (number, has_comma))
    }

    /// The number in a cell.
    ///
    /// # Errors
    /// If it is not a finite number, in words.
    pub fn number(&self, cell: &Cell) -> Result<f64, String> {
        match self.parsed(cell) {
            Some((_, true)) if self.has_points => Err(format!(
                "`{}` has a decimal comma, but other numbers of the table have a decimal point: write all with one of them",
                clip(cell.text)
            )),
            Some((number, _)) => Ok(number),
            None if self.is_apart_by_blanks(cell) => {
                Err(format!("`{}` is several numbers: separate columns by commas, semicolons or tabs", clip(cell.text)))
            }
            None => Err(format!("`{}` is not a number", clip(cell.text))),
        }
    }

    /// Error of a line with another number of cells than the first, in words; `None` if the numbers are equal.
    pub fn misfit(&self, line: &Line) -> Option<String> {
        let (count, wanted) = (line.cells.len(), self.lines.first()?.cells.len());
        let cells = |count: usize| if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") };
        let message = format!("{}, but the first line has {wanted}", cells(count));
        // `0,5,1,2` are two numbers with decimal commas.
        let has_commas = self.separator == ',' && count == 2 * wanted;
        let help = if has_commas { ": with decimal commas, separate columns by semicolons or tabs" } else { "" };
        (count != wanted).then(|| message + help)
    }

    fn is_apart_by_blanks(&self, cell: &Cell) -> bool {
        let parts: Vec<&str> = cell.text.split_whitespace().collect();
        parts.len() > 1 && parts.iter().all(|part| part.replacen(',', ".", 1).parse::<f64>().is_ok())
    }
}

fn separator_of(line: &str) -> char {
    ['\t', ';'].into_iter().find(|&mark| line.contains(mark)).unwrap_or(',')
}

fn cells(line: &str, separator: char, start: usize) -> Vec<Cell<'_>> {
    let mut is_quoted = false;
    let is_end = |character: char| {
        is_quoted ^= character == '"';
        character == separator && !is_quoted
    };
    let mut begin = 0;
    let parts = line.split(is_end);
    let cell = |part: &'_ str| {
        let trimmed = part.trim();
        let inner = trimmed.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(trimmed, str::trim);
        // The parts of a line are slices of it.
        let first = begin + part.find(inner).unwrap_or(0);
        begin += part.len() + separator.len_utf8();
        (first, first + inner.len())
    };
    let ends: Vec<(usize, usize)> = parts.map(cell).collect();
    let of = |(first, end): (usize, usize)| Cell {
        text: &line[first..end],
        start: start + first,
        column: 1 + line[..first].chars().count(),
    };
    ends.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> Vec<Vec<Result<f64, String>>> {
        let table = Table::read(text);
        table.lines.iter().map(|line| line.cells.iter().map(|cell| table.number(cell)).collect()).collect()
    }

    #[test]
    fn all_separators_and_both_decimal_marks() {
        let wanted = vec![vec![Ok(0.5), Ok(-1e-3)], vec![Ok(1.0), Ok(2.25)]];
        for text in [
            "0.5, -1e-3\n1, 2.25\n",
            "0.5; -1e-3\r\n1;2.25",
            "\u{feff}0,5;-1e-3\n\n# a comment; of two\n1;2,25\n",
            "0,5\t-1e-3\n1\t2,25\n",
            "\"0.5\",\"-1e-3\"\n1,\" 2.25\"\n",
        ] {
            assert_eq!(numbers(text), wanted, "{text:?}");
        }
    }

    #[test]
    fn ambiguous_numbers_are_refused() {
        for (text, message) in [
            ("1.5;2,5", "`2,5` has a decimal comma, but other numbers of the table have a decimal point"),
            ("1;2.500,5", "`2.500,5` is not a number"),
            ("1;2,500,5", "`2,500,5` is not a number"),
            ("1;0.5 2", "`0.5 2` is several numbers: separate columns by commas, semicolons or tabs"),
            ("1;inf", "`inf` is not a number"),
        ] {
            let error = numbers(text)[0][1].clone().unwrap_err();
            assert!(error.starts_with(message), "{error}");
        }
        let table = Table::read("t, x\n0,5,1,2\n1\n");
        assert_eq!(
            table.misfit(&table.lines[1]).unwrap(),
            "4 cells, but the first line has 2: with decimal commas, separate columns by semicolons or tabs"
        );
        assert_eq!(table.misfit(&table.lines[2]).unwrap(), "1 cell, but the first line has 2");
        assert_eq!(table.misfit(&table.lines[0]), None);
    }

    #[test]
    fn cells_have_columns_and_spans() {
        let text = "# ü\nµ ; \"a; b\"\n";
        let table = Table::read(text);
        let [line] = &table.lines[..] else { panic!("{table:?}") };
        assert_eq!(line.number, 2);
        assert_eq!(line.cells.iter().map(|cell| (cell.text, cell.column)).collect::<Vec<_>>(), [("µ", 1), ("a; b", 6)]);
        line.cells.iter().for_each(|cell| assert_eq!(&text[cell.span()], cell.text));
    }
}
