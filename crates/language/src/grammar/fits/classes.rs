//! Tolerance classes of ISO 286-1:2010: letters of the fundamental deviation, and a grade.

use super::large;
use super::tables::{FINER, GRADES, J, J_OF_HOLES, K, RANGES, fundamental, range};
use super::{ClassError, out_of_range};

/// Letters of shafts, from the loosest to the tightest; holes have the same in capitals.
const LETTERS: [&str; 28] = [
    "a", "b", "c", "cd", "d", "e", "ef", "f", "fg", "g", "h", "js", "j", "k", "m", "n", "p", "r", "s", "t", "u", "v",
    "x", "y", "z", "za", "zb", "zc",
];

/// Index of the last letters (h) of shafts that do not exceed the nominal size.
const LOOSE: usize = 10;

/// Grades as written, from the finest to the coarsest.
const GRADE_NAMES: [&str; 20] =
    ["01", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "17", "18"];

/// Index of a grade among the names.
const fn grade(number: usize) -> usize {
    number + 1
}

/// Sizes with Δ and all letters, and sizes with any limits, mm.
const LARGEST: f64 = 500.0;
const LARGEST_OF_ALL: f64 = 3150.0;

/// Feature that a class is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Feature {
    Hole,
    Shaft,
    /// `IT8`: half of the tolerance to either side.
    Either,
}

/// A class of ISO 286-1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FitClass {
    feature: Feature,
    letters: &'static str,
    /// Index among the grades.
    grade: usize,
}

/// Reads `H7`, `js9`, `IT8`; `None` if a text is not letters and a number.
pub(super) fn parse(text: &str) -> Option<Result<FitClass, ClassError>> {
    let digits = text.find(|letter: char| letter.is_ascii_digit())?;
    let (letters, number) = text.split_at(digits);
    let is_class = (1..=2).contains(&letters.len())
        && letters.chars().all(|letter| letter.is_ascii_alphabetic())
        && number.len() <= 2
        && number.chars().all(|letter| letter.is_ascii_digit());
    is_class.then(|| class(letters, number))
}

fn class(letters: &str, number: &str) -> Result<FitClass, ClassError> {
    let Some(grade) = GRADE_NAMES.iter().position(|name| *name == number) else {
        return Err(ClassError::Grade { grade: number.to_owned() });
    };
    if letters == "IT" {
        return Ok(FitClass { feature: Feature::Either, letters: "js", grade });
    }
    let small = letters.to_ascii_lowercase();
    let feature = match letters {
        _ if letters == small => Feature::Shaft,
        _ if letters == letters.to_ascii_uppercase() => Feature::Hole,
        _ => return Err(ClassError::Letters { letters: letters.to_owned() }),
    };
    let known = LETTERS.iter().find(|known| **known == small);
    known.map_or(Err(ClassError::Letters { letters: letters.to_owned() }), |letters| {
        Ok(FitClass { feature, letters, grade })
    })
}

impl FitClass {
    fn name(self) -> String {
        let letters = match self.feature {
            Feature::Shaft => self.letters.to_owned(),
            Feature::Hole => self.letters.to_ascii_uppercase(),
            Feature::Either => "IT".to_owned(),
        };
        letters + GRADE_NAMES[self.grade]
    }

    /// Lower and upper deviation from a size in mm, µm.
    pub(super) fn deviations(self, size: f64) -> Result<[f64; 2], ClassError> {
        let none = |range: &str| Err(out_of_range(self.name(), range, size));
        if size > LARGEST {
            return self.of_large(size);
        }
        let Some(index) = range(&RANGES, size) else { return none("above 0 mm, to 3150 mm") };
        if size <= 1.0 && (matches!(self.letters, "a" | "b") || self.grade >= grade(14)) {
            return none("above 1 mm, to 3150 mm");
        }
        let tolerance = f64::from(GRADES[self.grade][index]) / 10.0;
        let from_lower = |lower: f64| [lower, lower + tolerance];
        let from_upper = |upper: f64| [upper - tolerance, upper];
        if self.letters == "js" {
            return Ok([-tolerance / 2.0, tolerance / 2.0]);
        }
        let is_hole = self.feature == Feature::Hole;
        let found = match (self.letters, is_hole) {
            ("h", _) => Some(0),
            ("j", true) => self.j_of_holes(index),
            ("j", false) => self.j(index),
            ("k", true) if self.grade > grade(8) && size > 3.0 => None,
            ("k", true) => Some(K[index]),
            ("k", false) => Some(if (grade(4)..=grade(7)).contains(&self.grade) { K[index] } else { 0 }),
            (letters, _) => fundamental(letters, size),
        };
        let Some(deviation) = found.map(f64::from) else { return none(&self.sizes()) };
        let is_loose = LETTERS.iter().position(|letters| *letters == self.letters) <= Some(LOOSE);
        Ok(match (is_hole, is_loose) {
            (false, true) => from_upper(deviation),
            (true, true) => from_lower(-deviation),
            (false, false) => from_lower(deviation),
            (true, false) if self.letters == "j" => from_upper(deviation),
            (true, false) => from_upper(self.of_tight_hole(deviation, index, size)),
        })
    }

    /// The same above 500 mm: limits of holes are those of shafts with the other sign.
    fn of_large(self, size: f64) -> Result<[f64; 2], ClassError> {
        let none = |range: &str| Err(out_of_range(self.name(), range, size));
        let Some(tolerance) = self.grade.checked_sub(grade(0)).and_then(|number| large::tolerance(number, size)) else {
            return none(if self.grade < grade(1) { "to 500 mm" } else { "above 0 mm, to 3150 mm" });
        };
        if self.letters == "js" {
            return Ok([-tolerance / 2.0, tolerance / 2.0]);
        }
        let is_hole = self.feature == Feature::Hole;
        let found = large::fundamental(self.letters, size).filter(|_| self.letters != "k" || self.grade <= grade(8));
        let Some(deviation) = found else { return none(&self.sizes()) };
        let is_loose = LETTERS.iter().position(|letters| *letters == self.letters) <= Some(LOOSE);
        let of_shaft = if is_loose { [deviation - tolerance, deviation] } else { [deviation, deviation + tolerance] };
        let [lower, upper] = of_shaft;
        // No negative zero.
        Ok(if is_hole { [0.0 - upper, 0.0 - lower] } else { of_shaft })
    }

    /// ES of a hole K to ZC, by the deviation of the shaft with the same letters (ISO 286-1:2010, 4.3.2).
    fn of_tight_hole(self, deviation: f64, index: usize, size: f64) -> f64 {
        let finest = if matches!(self.letters, "k" | "m" | "n") { grade(8) } else { grade(7) };
        if self.grade > finest {
            return if self.letters == "n" && size > 3.0 { 0.0 } else { -deviation };
        }
        let has_delta = size > 3.0 && self.grade > grade(2);
        let delta = if has_delta { GRADES[self.grade][index] - GRADES[self.grade - 1][index] } else { 0 };
        // The table's only exception.
        let is_m6 = self.letters == "m" && self.grade == grade(6) && RANGES[index] == 315.0;
        -deviation + f64::from(delta) / 10.0 + if is_m6 { 2.0 } else { 0.0 }
    }

    /// ei of a shaft j.
    fn j(self, index: usize) -> Option<i16> {
        match self.grade {
            own if own == grade(5) || own == grade(6) => Some(J[0][index]),
            own if own == grade(7) => Some(J[1][index]),
            own if own == grade(8) && index == 0 => Some(-6),
            _ => None,
        }
    }

    /// ES of a hole J.
    fn j_of_holes(self, index: usize) -> Option<i16> {
        Some(J_OF_HOLES.get(self.grade.checked_sub(grade(6))?)?[index])
    }

    /// Sizes that the class has limits for, in words.
    fn sizes(self) -> String {
        match (self.letters, self.feature) {
            ("j", Feature::Hole) => return "to 500 mm in the grades 6 to 8".to_owned(),
            ("j", _) => return "to 500 mm in the grades 5 to 7".to_owned(),
            ("k", _) => return "to 3150 mm in the grades to 8".to_owned(),
            _ => {}
        }
        let has = |end: &f64| fundamental(self.letters, *end).is_some();
        let first = FINER.iter().position(has).unwrap_or(0);
        let last = FINER.iter().rev().copied().find(has).unwrap_or(0.0);
        let from = if first == 0 { 0.0 } else { FINER[first - 1] };
        let last = if large::fundamental(self.letters, LARGEST_OF_ALL).is_some() { LARGEST_OF_ALL } else { last };
        format!("above {from} mm, to {last} mm")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(class: &str, size: f64) -> [f64; 2] {
        parse(class).unwrap().unwrap().deviations(size).unwrap()
    }

    /// Limits as printed in tables of ISO 286-2, in textbooks: lower and upper deviation, µm.
    #[test]
    fn deviations_match_published_tables() {
        for (class, size, lower, upper) in [
            ("H7", 12.0, 0.0, 18.0),
            ("g6", 12.0, -17.0, -6.0),
            ("H7", 50.0, 0.0, 25.0),
            ("s6", 50.0, 43.0, 59.0),
            ("s6", 20.0, 35.0, 48.0),
            ("js9", 25.0, -26.0, 26.0),
            ("JS7", 100.0, -17.5, 17.5),
            ("IT8", 25.0, -16.5, 16.5),
            ("K7", 25.0, -15.0, 6.0),
            ("K6", 10.0, -7.0, 2.0),
            ("M6", 300.0, -41.0, -9.0),
            ("M7", 25.0, -21.0, 0.0),
            ("N9", 8.0, -36.0, 0.0),
            ("N9", 3.0, -29.0, -4.0),
            ("P9", 8.0, -51.0, -15.0),
            ("P7", 25.0, -35.0, -14.0),
            ("R7", 100.0, -73.0, -38.0),
            ("k6", 45.0, 2.0, 18.0),
            ("k8", 45.0, 0.0, 39.0),
            ("j6", 20.0, -4.0, 9.0),
            ("J7", 20.0, -9.0, 12.0),
            ("f7", 150.0, -83.0, -43.0),
            ("F8", 30.0, 20.0, 53.0),
            ("D10", 10.0, 40.0, 98.0),
            ("A11", 4.0, 270.0, 345.0),
            ("E8", 100.0, 72.0, 126.0),
            ("f9", 300.0, -186.0, -56.0),
            ("A13", 340.0, 1200.0, 2090.0),
            ("R10", 20.0, -112.0, -28.0),
            ("zc11", 500.0, 2600.0, 3000.0),
            ("x8", 14.0, 40.0, 67.0),
            ("x8", 14.5, 45.0, 72.0),
            ("fg6", 9.0, -17.0, -8.0),
            ("h01", 2.0, -0.3, 0.0),
            ("H7", 630.0, 0.0, 70.0),
            ("H7", 1000.0, 0.0, 90.0),
            ("h6", 900.0, -56.0, 0.0),
            ("f7", 600.0, -146.0, -76.0),
            ("g6", 1200.0, -94.0, -28.0),
            ("F8", 700.0, 80.0, 205.0),
            ("JS9", 2000.0, -185.0, 185.0),
            ("k6", 560.0, 0.0, 44.0),
            ("K7", 560.0, -70.0, 0.0),
            ("N7", 800.0, -130.0, -50.0),
            ("p6", 1600.0, 140.0, 218.0),
            ("P7", 3150.0, -450.0, -240.0),
            ("r6", 560.0, 150.0, 194.0),
            ("r6", 561.0, 155.0, 199.0),
            ("s7", 2500.0, 1100.0, 1275.0),
            ("u8", 3150.0, 3200.0, 3530.0),
        ] {
            assert_eq!(of(class, size), [lower, upper], "{class} of {size} mm");
        }
    }

    /// A shaft in a hole of the same letters, one grade finer, has the clearance of the same pair turned
    /// round (ISO 286-1:2010, 4.3.2): Δ is there for it.
    #[test]
    fn fits_of_hole_and_of_shaft_are_the_same() {
        for letters in ["p", "r", "s", "u", "x"] {
            for size in [5.0, 9.0, 12.0, 28.0, 45.0, 70.0, 110.0, 300.0, 480.0] {
                let [hole, shaft] = [of("H7", size), of(&format!("{letters}6"), size)];
                let [own_hole, own_shaft] = [of(&format!("{}7", letters.to_uppercase()), size), of("h6", size)];
                assert_eq!(hole[1] - shaft[0], own_hole[1] - own_shaft[0], "{letters} of {size} mm");
                assert_eq!(hole[0] - shaft[1], own_hole[0] - own_shaft[1], "{letters} of {size} mm");
            }
        }
    }

    #[test]
    fn classes_without_limits_are_refused() {
        let refused = |class: &str, size: f64| parse(class).unwrap().unwrap().deviations(size).unwrap_err().to_string();
        assert_eq!(refused("H7", 3200.0), "`H7` has limits for sizes above 0 mm, to 3150 mm, but this one is 3200 mm");
        assert_eq!(refused("x7", 600.0), "`x7` has limits for sizes above 0 mm, to 500 mm, but this one is 600 mm");
        assert_eq!(refused("t6", 20.0), "`t6` has limits for sizes above 24 mm, to 3150 mm, but this one is 20 mm");
        assert_eq!(refused("h0", 600.0), "`h0` has limits for sizes to 500 mm, but this one is 600 mm");
        assert_eq!(refused("CD8", 12.0), "`CD8` has limits for sizes above 0 mm, to 10 mm, but this one is 12 mm");
        assert!(parse("H7").unwrap().unwrap().deviations(f64::NAN).is_err());
        assert!(parse("K9").unwrap().unwrap().deviations(20.0).is_err());
        assert_eq!(parse("q7"), Some(Err(ClassError::Letters { letters: "q".to_owned() })));
        assert_eq!(parse("Js7"), Some(Err(ClassError::Letters { letters: "Js".to_owned() })));
        assert_eq!(parse("H19"), Some(Err(ClassError::Grade { grade: "19".to_owned() })));
        for text in ["mm", "7", "H", "H7a", "abc7", "H123", ""] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
