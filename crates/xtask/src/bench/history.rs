//! The committed table of releases: `docs/performance/record.csv`, a row a release. No cell has a comma.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Columns that identify a row.
pub const OF_ROW: [&str; 5] = ["version", "date", "commit", "processor", "compiler"];

/// Beginnings of columns: instructions of a step, and its time in turns of the reference loop.
pub const INSTRUCTIONS: &str = "instructions ";
pub const TIME: &str = "time ";

/// Beginning of the names of models that Exudyn ran.
pub const EXUDYN: &str = "Exudyn ";

/// A release: its cells by column.
pub type Row = BTreeMap<String, String>;

/// Columns in their order, and rows from the oldest on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
}

impl History {
    /// Reads the table; the error names the line.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<String>>();
        let columns = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
        if columns.len() < OF_ROW.len() || columns[..OF_ROW.len()] != OF_ROW {
            return Err(format!("line 1 does not begin with {}", OF_ROW.join(",")));
        }
        let mut rows = Vec::new();
        for (number, line) in lines {
            let own = cells(line);
            if own.len() != columns.len() {
                return Err(format!("line {} has {} cells, not {}", number + 1, own.len(), columns.len()));
            }
            rows.push(columns.iter().cloned().zip(own).filter(|(_, cell)| !cell.is_empty()).collect());
        }
        Ok(Self { columns, rows })
    }

    /// Adds a row in the order of dates, or replaces one of the same version. New columns come last.
    pub fn add(&mut self, row: Row) {
        if self.columns.is_empty() {
            self.columns = OF_ROW.map(str::to_owned).to_vec();
        }
        let new: Vec<String> = row.keys().filter(|column| !self.columns.contains(column)).cloned().collect();
        self.columns.extend(new);
        self.rows.retain(|own| own.get("version") != row.get("version"));
        self.rows.push(row);
        self.rows.sort_by_key(|own| own.get("date").cloned());
    }

    pub fn text(&self) -> String {
        let mut text = self.columns.join(",") + "\n";
        for row in &self.rows {
            let cells = self.columns.iter().map(|column| row.get(column).map_or("", String::as_str));
            _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join(","));
        }
        text
    }
}

/// The numbers of mbint in a row's columns with this beginning, by the rest of the columns' names.
pub fn numbers<'r>(row: &'r Row, beginning: &'static str) -> BTreeMap<&'r str, f64> {
    let own = row.iter().filter_map(move |(column, cell)| Some((column.strip_prefix(beginning)?, cell.parse().ok()?)));
    own.filter(|(name, _)| !name.starts_with(EXUDYN)).collect()
}

/// Times of peers in a row, by their columns' names without the beginning.
pub fn peers(row: &Row) -> Vec<(&str, f64)> {
    let own = row.iter().filter_map(|(column, cell)| Some((column.strip_prefix(TIME)?, cell.parse().ok()?)));
    own.filter(|(name, _)| name.starts_with(EXUDYN)).collect()
}

/// Geometric mean of the ratios of a row's numbers to another's, over those that both have.
pub fn mean_ratio(row: &Row, to: &Row, beginning: &'static str) -> Option<f64> {
    let (own, to) = (numbers(row, beginning), numbers(to, beginning));
    let ratios: Vec<f64> = own.iter().filter_map(|(name, value)| Some((value / to.get(name)?).ln())).collect();
    (!ratios.is_empty()).then(|| (ratios.iter().sum::<f64>() / ratios.len() as f64).exp())
}

/// Instructions of a step of each model with one factorisation, by name, from `docs/reference/instructions.md`: those
/// of step, factor, first correction and advance. The error names the missing part.
pub fn instructions(page: &str) -> Result<BTreeMap<String, u64>, String> {
    let mut rows = page.lines().filter(|line| line.starts_with('|')).map(|line| {
        let cells = line.trim_matches('|').split('|').map(str::trim);
        cells.collect::<Vec<_>>()
    });
    let head = rows.next().ok_or("the page of instructions has no table")?;
    let index = |stage: &&str| head.iter().position(|cell| cell == stage).ok_or(format!("no column {stage}"));
    let stages = ["step", "factor", "first correction", "advance"];
    let places = stages.iter().map(index).collect::<Result<Vec<usize>, _>>()?;
    let mut counts = BTreeMap::new();
    for row in rows.skip(1) {
        let count = |index: &usize| {
            let cell = row.get(*index).copied().unwrap_or_default();
            cell.parse::<u64>().map_err(|_| format!("{}: `{cell}` is no number of instructions", row[0]))
        };
        let sum: u64 = places.iter().map(count).sum::<Result<u64, String>>()?;
        counts.insert(row[0].replace(',', ""), sum);
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(cells: &[(&str, &str)]) -> Row {
        cells.iter().map(|(column, cell)| ((*column).to_owned(), (*cell).to_owned())).collect()
    }

    #[test]
    fn rows_are_sorted_by_date_with_one_per_version() {
        let mut history = History::default();
        history.add(row(&[("version", "0.2.0"), ("date", "2027-01-01"), ("time a.yaml", "8")]));
        history.add(row(&[("version", "0.1.0"), ("date", "2026-12-01"), ("instructions a.yaml", "50")]));
        history.add(row(&[("version", "0.2.0"), ("date", "2027-01-02"), ("instructions a.yaml", "60")]));
        let text = history.text();
        let expected = "version,date,commit,processor,compiler,time a.yaml,instructions a.yaml\n\
                        0.1.0,2026-12-01,,,,,50\n0.2.0,2027-01-02,,,,,60\n";
        assert_eq!(text, expected);
        assert_eq!(History::read(&text).unwrap(), history);
        let ratio = mean_ratio(&history.rows[1], &history.rows[0], INSTRUCTIONS).unwrap();
        assert!((ratio - 1.2).abs() < 1e-15, "{ratio}");
        assert_eq!(mean_ratio(&history.rows[1], &history.rows[0], TIME), None);
    }

    #[test]
    fn malformed_lines_are_named() {
        let head = OF_ROW.join(",");
        assert_eq!(History::read(&format!("{head},a\n1,2,3,4,5\n")).unwrap_err(), "line 2 has 5 cells, not 6");
        assert!(History::read("a,b\n").unwrap_err().starts_with("line 1 does not begin with version,date"));
    }

    #[test]
    fn a_step_is_the_sum_of_its_stages() {
        let page = "# Instructions\n\n| model | step | factor | first correction | correct | advance | observe |\n| --- | --: |\n\
                    | door.yaml, ideal | 6 | 0 | 12 | 12 | 4 | 10 |\n";
        assert_eq!(instructions(page).unwrap(), BTreeMap::from([("door.yaml ideal".to_owned(), 22)]));
        assert_eq!(instructions("| model | step |\n|---|\n").unwrap_err(), "no column factor");
        let wrong = instructions(&page.replace("| 6 |", "| six |")).unwrap_err();
        assert_eq!(wrong, "door.yaml, ideal: `six` is no number of instructions");
    }
}
