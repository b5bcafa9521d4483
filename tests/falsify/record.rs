//! Scores of draws in a file, as they come: a run that ends early keeps them and continues where it ended, and the
//! files of two runs, of different draws, can be put together.

use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::str::FromStr;

use crate::table::{Kind, Score, Scored, Table};

/// A file with a line for each draw.
pub struct Record {
    file: File,
    /// Numbers of the draws that it had when it was opened.
    known: BTreeSet<u64>,
}

impl Record {
    /// Opens a file for appending, and adds its draws to a table.
    pub fn open(path: &Path, table: &mut Table) -> Self {
        let mut known = BTreeSet::new();
        for line in std::fs::read_to_string(path).unwrap_or_default().lines() {
            // A line may have been cut short.
            if let Some((number, scored)) = read(line)
                && known.insert(number)
            {
                table.add(&scored);
            }
        }
        let file = OpenOptions::new().create(true).append(true).open(path).expect("the record can be written");
        Self { file, known }
    }

    pub fn has(&self, number: u64) -> bool {
        self.known.contains(&number)
    }

    pub fn add(&mut self, number: u64, scored: &Scored) {
        // One that was cut short before ends here.
        self.file.write_all(format!("\n{}\n", write(number, scored)).as_bytes()).expect("the record can be written");
    }
}

/// The last field of a whole line.
const END: &str = "end";

/// Number, family, outcome, and for each band its label and its numbers, separated by tabs.
fn write(number: u64, scored: &Scored) -> String {
    let mut fields = vec![number.to_string(), scored.family.clone()];
    match &scored.outcome {
        Ok((scores, seconds)) => {
            fields.push(format!("{seconds:?}"));
            for score in scores {
                let counts = [score.rows, score.flagged, score.misses, score.contradicted].map(|count| count as f64);
                let sums = [score.stated, score.off];
                let numbers = counts.iter().chain(&sums).chain(&score.ratios);
                fields.push(score.label.clone());
                fields.push(numbers.map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" "));
            }
        }
        Err(kind) => fields.push(kind.name().to_owned()),
    }
    fields.push(END.to_owned());
    fields.join("\t")
}

fn read(line: &str) -> Option<(u64, Scored)> {
    let fields: Vec<&str> = line.split('\t').collect();
    let [number, family, outcome, scores @ .., END] = fields.as_slice() else { return None };
    let outcome = match Kind::ALL.into_iter().find(|kind| kind.name() == *outcome) {
        Some(kind) => Err(kind),
        None => Ok((scores.chunks(2).map(read_score).collect::<Option<_>>()?, outcome.parse().ok()?)),
    };
    Some((number.parse().ok()?, Scored { family: (*family).to_owned(), outcome }))
}

fn read_score(fields: &[&str]) -> Option<Score> {
    let [label, numbers] = fields else { return None };
    let numbers: Vec<f64> = numbers.split(' ').map(f64::from_str).collect::<Result<_, _>>().ok()?;
    let [rows, flagged, misses, contradicted, stated, off, ratios @ ..] = numbers.as_slice() else { return None };
    let [rows, flagged, misses, contradicted] = [rows, flagged, misses, contradicted].map(|count| *count as usize);
    let (label, ratios) = ((*label).to_owned(), ratios.to_vec());
    Some(Score { label, rows, flagged, misses, contradicted, stated: *stated, off: *off, ratios })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_continues_after_a_truncated_line() {
        let score = Score {
            label: "chebyshev to a tolerance".to_owned(),
            rows: 21,
            flagged: 3,
            misses: 1,
            contradicted: 0,
            stated: f64::INFINITY,
            off: 0.1,
            ratios: vec![1.5, f64::INFINITY, 1e-300],
        };
        let judged = Scored { family: "driven crank".to_owned(), outcome: Ok((vec![score.clone(), score], 2.25)) };
        let late = Scored { family: "top".to_owned(), outcome: Err(Kind::OutOfTime) };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record");
        let mut record = Record::open(&path, &mut Table::default());
        record.add(7, &judged);
        record.add(3, &late);
        let whole = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, whole.clone() + &whole[..whole.len() / 2].replace('7', "8")).unwrap();
        let mut table = Table::default();
        let mut record = Record::open(&path, &mut table);
        assert!(record.has(7) && record.has(3) && !record.has(8));
        record.add(8, &late);
        let again = Record::open(&path, &mut Table::default());
        assert!(again.has(7) && again.has(3) && again.has(8));
        let mut expected = Table::default();
        [&judged, &late].into_iter().for_each(|scored| expected.add(scored));
        assert_eq!(table.to_string(), expected.to_string());
    }
}
