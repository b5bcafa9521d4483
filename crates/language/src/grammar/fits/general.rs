//! General tolerances of linear sizes, ISO 2768-1:1989, table 1.

use super::{ClassError, out_of_range};

/// Class of ISO 2768-1: f fine, m medium, c coarse, v very coarse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeneralClass {
    /// Fine.
    F,
    /// Medium.
    M,
    /// Coarse.
    C,
    /// Very coarse.
    V,
}

/// Upper ends of the ranges of sizes, mm; the first begins at 0.5 mm.
const ENDS: [f64; 8] = [3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0];

/// Smallest size, mm.
const SMALLEST: f64 = 0.5;

/// Deviations, µm, by range; 0 if there is none.
const FINE: [u16; 8] = [50, 50, 100, 150, 200, 300, 500, 0];
const MEDIUM: [u16; 8] = [100, 100, 200, 300, 500, 800, 1200, 2000];
const COARSE: [u16; 8] = [200, 300, 500, 800, 1200, 2000, 3000, 4000];
const VERY_COARSE: [u16; 8] = [0, 500, 1000, 1500, 2500, 4000, 6000, 8000];

/// Reads `ISO 2768-m`; ignores a second letter for geometrical tolerances (`ISO 2768-mK`).
pub(super) fn parse(text: &str) -> Option<Result<GeneralClass, ClassError>> {
    let class = text.strip_prefix("ISO")?.trim_start().strip_prefix("2768")?.trim_start_matches(['-', '–', ' ']);
    let size = class.strip_suffix(['H', 'K', 'L']).unwrap_or(class);
    Some(match size {
        "f" => Ok(GeneralClass::F),
        "m" => Ok(GeneralClass::M),
        "c" => Ok(GeneralClass::C),
        "v" => Ok(GeneralClass::V),
        _ => Err(ClassError::General { class: class.to_owned() }),
    })
}

impl GeneralClass {
    fn table(self) -> (&'static str, [u16; 8]) {
        match self {
            Self::F => ("f", FINE),
            Self::M => ("m", MEDIUM),
            Self::C => ("c", COARSE),
            Self::V => ("v", VERY_COARSE),
        }
    }

    /// Lower and upper deviation from a size in mm, µm.
    pub(super) fn deviations(self, size: f64) -> Result<[f64; 2], ClassError> {
        let (letter, table) = self.table();
        let range = ENDS.iter().position(|&end| size <= end).filter(|_| size >= SMALLEST);
        let deviation = range.map_or(0, |range| table[range]);
        if deviation == 0 {
            let range = match self {
                Self::F => "from 0.5 mm to 2000 mm",
                Self::M | Self::C => "from 0.5 mm to 4000 mm",
                Self::V => "above 3 mm, to 4000 mm",
            };
            return Err(out_of_range(format!("ISO 2768-{letter}"), range, size));
        }
        Ok([-f64::from(deviation), f64::from(deviation)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_match_the_table() {
        for (class, size, wanted) in [
            ("ISO 2768-m", 25.0, 200.0),
            ("ISO 2768-mK", 30.0, 200.0),
            ("ISO2768-m", 30.5, 300.0),
            ("ISO 2768-f", 3.0, 50.0),
            ("ISO 2768-c", 400.0, 1200.0),
            ("ISO 2768-v", 2000.1, 8000.0),
        ] {
            let class = parse(class).unwrap().unwrap();
            assert_eq!(class.deviations(size), Ok([-wanted, wanted]));
        }
    }

    #[test]
    fn sizes_without_a_deviation_are_refused() {
        assert!(GeneralClass::V.deviations(2.0).is_err());
        assert!(GeneralClass::F.deviations(2500.0).is_err());
        assert!(GeneralClass::M.deviations(0.4).is_err());
        assert!(GeneralClass::M.deviations(f64::NAN).is_err());
        assert_eq!(parse("ISO 2768-x"), Some(Err(ClassError::General { class: "x".to_owned() })));
        assert_eq!(parse("H7"), None);
    }
}
