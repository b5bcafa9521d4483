//! Classes of sizes above 500 mm, to 3150 mm (ISO 286-1:2010, tables 1 to 5): no Δ, and fewer letters.

use super::tables::range;

/// Upper ends of the ranges of grades, mm, from 500 mm on.
const RANGES: [f64; 8] = [630.0, 800.0, 1000.0, 1250.0, 1600.0, 2000.0, 2500.0, 3150.0];

/// Upper ends of the ranges of r to u, mm.
const FINER: [f64; 16] = [
    560.0, 630.0, 710.0, 800.0, 900.0, 1000.0, 1120.0, 1250.0, 1400.0, 1600.0, 1800.0, 2000.0, 2240.0, 2500.0, 2800.0,
    3150.0,
];

/// Standard tolerances, µm, grade by grade from IT1 on, by range.
const GRADES: [[u16; 8]; 18] = [
    [9, 10, 11, 13, 15, 18, 22, 26],
    [11, 13, 15, 18, 21, 25, 30, 36],
    [16, 18, 21, 24, 29, 35, 41, 50],
    [22, 25, 28, 33, 39, 46, 55, 68],
    [32, 36, 40, 47, 55, 65, 78, 96],
    [44, 50, 56, 66, 78, 92, 110, 135],
    [70, 80, 90, 105, 125, 150, 175, 210],
    [110, 125, 140, 165, 195, 230, 280, 330],
    [175, 200, 230, 260, 310, 370, 440, 540],
    [280, 320, 360, 420, 500, 600, 700, 860],
    [440, 500, 560, 660, 780, 920, 1100, 1350],
    [700, 800, 900, 1050, 1250, 1500, 1750, 2100],
    [1100, 1250, 1400, 1650, 1950, 2300, 2800, 3300],
    [1750, 2000, 2300, 2600, 3100, 3700, 4400, 5400],
    [2800, 3200, 3600, 4200, 5000, 6000, 7000, 8600],
    [4400, 5000, 5600, 6600, 7800, 9200, 11000, 13500],
    [7000, 8000, 9000, 10500, 12500, 15000, 17500, 21000],
    [11000, 12500, 14000, 16500, 19500, 23000, 28000, 33000],
];

/// Deviations of shafts by range: es of d to h, ei of k to p.
const SHAFTS: [(&str, [i16; 8]); 9] = [
    ("d", [-260, -290, -320, -350, -390, -430, -480, -520]),
    ("e", [-145, -160, -170, -195, -220, -240, -260, -290]),
    ("f", [-76, -80, -86, -98, -110, -120, -130, -145]),
    ("g", [-22, -24, -26, -28, -30, -32, -34, -38]),
    ("h", [0; 8]),
    ("k", [0; 8]),
    ("m", [26, 30, 34, 40, 48, 58, 68, 76]),
    ("n", [44, 50, 56, 66, 78, 92, 110, 135]),
    ("p", [78, 88, 100, 120, 140, 170, 195, 240]),
];

/// ei of r to u by finer range.
const FINER_SHAFTS: [(&str, [i16; 16]); 4] = [
    ("r", [150, 155, 175, 185, 210, 220, 250, 260, 300, 330, 370, 400, 440, 460, 550, 580]),
    ("s", [280, 310, 340, 380, 430, 470, 520, 580, 640, 720, 820, 920, 1000, 1100, 1250, 1400]),
    ("t", [400, 450, 500, 560, 620, 680, 780, 840, 960, 1050, 1200, 1350, 1500, 1650, 1900, 2100]),
    ("u", [600, 660, 740, 840, 940, 1050, 1150, 1300, 1450, 1600, 1850, 2000, 2300, 2500, 2900, 3200]),
];

/// Fundamental deviation of a shaft with these small letters, µm, for a size above 500 mm; that of a hole has the other
/// sign. `None` if the tables have none.
pub(super) fn fundamental(letters: &str, size: f64) -> Option<f64> {
    let coarse = SHAFTS.iter().find(|(own, _)| *own == letters).map(|(_, values)| (&RANGES[..], &values[..]));
    let fine = || FINER_SHAFTS.iter().find(|(own, _)| *own == letters).map(|(_, values)| (&FINER[..], &values[..]));
    let (ends, values) = coarse.or_else(fine)?;
    range(ends, size).map(|index| f64::from(values[index]))
}

/// Standard tolerance of a grade from 1 to 18, µm, for a size above 500 mm.
pub(super) fn tolerance(grade: usize, size: f64) -> Option<f64> {
    let widths = GRADES.get(grade.checked_sub(1)?)?;
    range(&RANGES, size).map(|index| f64::from(widths[index]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// D of a range, mm: the geometric mean of its ends.
    fn mean(ends: &[f64], index: usize) -> f64 {
        (ends[index] * if index == 0 { 500.0 } else { ends[index - 1] }).sqrt()
    }

    /// Multiples of I = 0.004 D + 2.1 (ISO 286-1:1988, annex A); the table rounds, and IT5 to 630 mm is further.
    #[test]
    fn grades_match_rounded_formulas() {
        let multiples = [
            2.0, 2.7, 3.7, 5.0, 7.0, 10.0, 16.0, 25.0, 40.0, 64.0, 100.0, 160.0, 250.0, 400.0, 640.0, 1e3, 1.6e3, 2.5e3,
        ];
        for (grade, multiple) in (1..).zip(multiples) {
            for (index, &end) in RANGES.iter().enumerate() {
                let formula = multiple * (0.004 * mean(&RANGES, index) + 2.1);
                let found = tolerance(grade, end).unwrap();
                assert!((found - formula).abs() <= 0.8_f64.max(0.06 * formula), "IT{grade} {end}: {found} {formula}");
            }
        }
    }

    /// The formulas of ISO 286-1:1988, table 8, from which the table was rounded.
    #[test]
    fn deviations_match_rounded_formulas() {
        type Formula = fn(f64) -> f64;
        let formulas: [(&str, Formula); 7] = [
            ("d", |d| -16.0 * d.powf(0.44)),
            ("e", |d| -11.0 * d.powf(0.41)),
            ("f", |d| -5.5 * d.powf(0.41)),
            ("g", |d| -2.5 * d.powf(0.34)),
            ("m", |d| 0.024 * d + 12.6),
            ("n", |d| 0.04 * d + 21.0),
            ("p", |d| 0.072 * d + 37.8),
        ];
        for (letters, formula) in formulas {
            for (index, &end) in RANGES.iter().enumerate() {
                let (found, wanted) = (fundamental(letters, end).unwrap(), formula(mean(&RANGES, index)));
                assert!(
                    (found - wanted).abs() <= 1.0_f64.max(0.06 * wanted.abs()),
                    "{letters} {end}: {found} {wanted}"
                );
            }
        }
        let by_width: [(&str, f64); 3] = [("s", 0.4), ("t", 0.63), ("u", 1.0)];
        for (index, &end) in FINER.iter().enumerate() {
            let of = |letters: &str| fundamental(letters, end).unwrap();
            for (letters, share) in by_width {
                let wanted = tolerance(7, end).unwrap() + share * mean(&FINER, index);
                assert!((of(letters) / wanted - 1.0).abs() <= 0.05, "{letters} {end}: {wanted}");
            }
            assert!((of("r") / (of("p") * of("s")).sqrt() - 1.0).abs() <= 0.06, "r {end}");
        }
    }
}
