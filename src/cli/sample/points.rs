//! Points at which a model is sampled: a table, or a design over its tolerances.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::cli::Failure;
use crate::cli::args::PointArgs;
use crate::cli::tuning::TUNING;
use crate::model::is_standard_input;
use crate::numerics::{Design, MOST_AXES, ParameterBox};
use crate::store::AskedPoints;
use crate::syntax::table::{Cell, Table};

/// The requested points.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) enum Points {
    /// Points spread evenly over the tolerances.
    Design { design: Design, count: usize },
    /// A table: its path, names of its columns, and its rows.
    Table { path: PathBuf, names: Vec<String>, rows: Vec<Vec<f64>> },
}

impl Points {
    /// The points requested on the command line; `None` without a request.
    pub fn asked(args: &PointArgs) -> Result<Option<Self>, Failure> {
        match (&args.points, &args.design) {
            (Some(path), _) => Self::table(path).map(Some),
            (None, Some(design)) => Self::design(design, args.seed).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// The points of a study's plan.
    pub fn planned(asked: &AskedPoints) -> Result<Self, Failure> {
        match asked {
            AskedPoints::Table(path) => Self::table(path),
            AskedPoints::Design { design, seed } => Self::design(design, *seed),
        }
    }

    fn design(text: &str, seed: u64) -> Result<Self, Failure> {
        let wrong = || {
            Failure::wrong(format!("`{text}` is no design: `sobol:1000` and `lhs:1000` are, with any number of points"))
        };
        let (name, count) = text.split_once(':').ok_or_else(wrong)?;
        let design = match name {
            "sobol" => Design::Sobol,
            "lhs" => Design::LatinHypercube { seed },
            _ => return Err(wrong()),
        };
        let count: usize =
            count.parse().ok().filter(|count| (1..=TUNING.points_of_design).contains(count)).ok_or_else(wrong)?;
        Ok(Self::Design { design, count })
    }

    fn table(path: &Path) -> Result<Self, Failure> {
        let wrong = |message: String| Failure::wrong(format!("{}: {message}", path.display()));
        let mut text = String::new();
        let read = match is_standard_input(path) {
            true => std::io::stdin().lock().read_to_string(&mut text),
            false => File::open(path).and_then(|mut file| file.read_to_string(&mut text)),
        };
        read.map_err(|error| wrong(error.to_string()))?;
        let table = Table::read(&text);
        let headings = table.lines.first().map_or(&[][..], |line| &line.cells);
        let names: Vec<String> = headings.iter().map(|cell| cell.text.to_owned()).collect();
        if let Some(twice) = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name)) {
            return Err(wrong(format!("there are two columns `{}`", twice.1)));
        }
        let mut rows = Vec::new();
        for line in table.lines.iter().skip(1) {
            if let Some(message) = table.misfit(line) {
                return Err(wrong(format!("line {}: {message}", line.number)));
            }
            let number = |(name, cell): (&String, &Cell)| {
                table.number(cell).map_err(|message| {
                    wrong(format!("line {}, `{name}`: {message}; values are plain numbers in SI units", line.number))
                })
            };
            rows.push(names.iter().zip(&line.cells).map(number).collect::<Result<Vec<f64>, _>>()?);
        }
        if rows.is_empty() {
            return Err(wrong("there are no points".to_owned()));
        }
        Ok(Self::Table { path: path.to_owned(), names, rows })
    }

    /// The points for a model's uncertain parameters, given by name and unit.
    pub fn of<'p>(
        &'p self,
        parameters: &[(String, String)],
        domain: &'p ParameterBox,
    ) -> Result<ModelPoints<'p>, String> {
        match self {
            Self::Design { design: Design::Sobol, .. } if parameters.len() > MOST_AXES => {
                let (count, most) = (parameters.len(), MOST_AXES);
                Err(format!(
                    "{count} parameters are uncertain, and Sobol's sequence has {most} axes here; `lhs` has any number"
                ))
            }
            Self::Design { design, count } => Ok(ModelPoints::Design { design: *design, count: *count, domain }),
            Self::Table { path, names, rows } => {
                let known: Vec<&str> = parameters.iter().map(|(name, _)| name.as_str()).collect();
                if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
                    let known = known.join(", ");
                    return Err(format!(
                        "{}: `{unknown}` is no uncertain parameter of the model; there are: {known}",
                        path.display()
                    ));
                }
                let columns = known.iter().map(|known| names.iter().position(|name| name == known)).collect();
                Ok(ModelPoints::Table { rows, columns, domain })
            }
        }
    }
}

/// Points for a model.
pub(in crate::cli) enum ModelPoints<'p> {
    Design {
        design: Design,
        count: usize,
        domain: &'p ParameterBox,
    },
    /// With the column of each parameter, if it has one.
    Table {
        rows: &'p [Vec<f64>],
        columns: Vec<Option<usize>>,
        domain: &'p ParameterBox,
    },
}

impl ModelPoints<'_> {
    /// Number of points.
    pub fn count(&self) -> usize {
        match self {
            Self::Design { count, .. } => *count,
            Self::Table { rows, .. } => rows.len(),
        }
    }

    /// Parameters of a range of the points.
    pub fn at(&self, places: Range<usize>) -> Vec<Vec<f64>> {
        match self {
            Self::Design { design, count, domain } => {
                let points = design.points(domain.dimension(), *count, places).into_iter();
                let at = |(axis, u): (usize, f64)| domain.value(axis, 2.0 * u - 1.0);
                points.map(|point| point.into_iter().enumerate().map(at).collect()).collect()
            }
            Self::Table { rows, columns, domain } => {
                let of_row = |row: &Vec<f64>| {
                    let column = |(axis, column): (usize, &Option<usize>)| {
                        column.map_or(domain.nominal[axis], |column| row[column])
                    };
                    columns.iter().enumerate().map(column).collect()
                };
                rows[places].iter().map(of_row).collect()
            }
        }
    }
}
