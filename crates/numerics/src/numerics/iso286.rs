//! Standard tolerance grades of ISO 286-1:2010.

/// Grades of the table.
const GRADES: std::ops::RangeInclusive<u8> = 5..=12;

/// Widths of tolerance zones in µm for IT5 to IT12, by size: up to and including this one in mm, above that of the row
/// before (ISO 286-1:2010, table 1).
const TABLE: [(f64, [u16; 8]); 21] = [
    (3.0, [4, 6, 10, 14, 25, 40, 60, 100]),
    (6.0, [5, 8, 12, 18, 30, 48, 75, 120]),
    (10.0, [6, 9, 15, 22, 36, 58, 90, 150]),
    (18.0, [8, 11, 18, 27, 43, 70, 110, 180]),
    (30.0, [9, 13, 21, 33, 52, 84, 130, 210]),
    (50.0, [11, 16, 25, 39, 62, 100, 160, 250]),
    (80.0, [13, 19, 30, 46, 74, 120, 190, 300]),
    (120.0, [15, 22, 35, 54, 87, 140, 220, 350]),
    (180.0, [18, 25, 40, 63, 100, 160, 250, 400]),
    (250.0, [20, 29, 46, 72, 115, 185, 290, 460]),
    (315.0, [23, 32, 52, 81, 130, 210, 320, 520]),
    (400.0, [25, 36, 57, 89, 140, 230, 360, 570]),
    (500.0, [27, 40, 63, 97, 155, 250, 400, 630]),
    (630.0, [32, 44, 70, 110, 175, 280, 440, 700]),
    (800.0, [36, 50, 80, 125, 200, 320, 500, 800]),
    (1000.0, [40, 56, 90, 140, 230, 360, 560, 900]),
    (1250.0, [47, 66, 105, 165, 260, 420, 660, 1050]),
    (1600.0, [55, 78, 125, 195, 310, 500, 780, 1250]),
    (2000.0, [65, 92, 150, 230, 370, 600, 920, 1500]),
    (2500.0, [78, 110, 175, 280, 440, 700, 1100, 1750]),
    (3150.0, [96, 135, 210, 330, 540, 860, 1350, 2100]),
];

/// The width of the tolerance zone of a grade from 5 to 12 for a nominal size up to 3.15 m, both in m.
pub fn tolerance(grade: u8, size: f64) -> Option<f64> {
    // A size of 0.05 m is 50 mm, but for rounding.
    let millimetres = (1e9 * size).round() / 1e6;
    let (_, widths) = TABLE.iter().find(|(most, _)| millimetres <= *most).filter(|_| size > 0.0)?;
    GRADES.contains(&grade).then(|| f64::from(widths[usize::from(grade - GRADES.start())]) / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Multiples of the tolerance factor for IT5 to IT12, and the factor in µm: i = 0.45 ∛D + 0.001 D up to 500 mm, I =
    /// 0.004 D + 2.1 above, where D is the geometric mean of the ends of the range of sizes, of that up to 3 mm √3 (ISO
    /// 286-1:1988, annex A).
    fn by_formula(grade: u8, above: f64, most: f64) -> f64 {
        let mean = if above == 0.0 { 3.0_f64.sqrt() } else { (above * most).sqrt() };
        let factor = if most <= 500.0 { 0.45 * mean.cbrt() + 0.001 * mean } else { 0.004 * mean + 2.1 };
        [7.0, 10.0, 16.0, 25.0, 40.0, 64.0, 100.0, 160.0][usize::from(grade) - 5] * factor
    }

    /// Largest sizes in mm, grades and widths in µm where the standard's table leaves its formulas by more than
    /// rounding.
    const FURTHER: [(f64, u8, f64); 7] = [
        (3.0, 7, 10.0),
        (3.0, 9, 25.0),
        (3.0, 10, 40.0),
        (3.0, 11, 60.0),
        (3.0, 12, 100.0),
        (6.0, 6, 8.0),
        (630.0, 5, 32.0),
    ];

    #[test]
    fn table_matches_rounded_formulas() {
        let mut above = 0.0;
        for (most, _) in TABLE {
            for grade in GRADES {
                let (found, formula) = (1e6 * tolerance(grade, 1e-3 * most).unwrap(), by_formula(grade, above, most));
                match FURTHER.iter().find(|(size, of, _)| (*size, *of) == (most, grade)) {
                    Some((_, _, width)) => assert!((found - width).abs() < 1e-9, "IT{grade} {most}: {found}"),
                    // Rounded to whole µm, and beyond to fives and tens.
                    None => assert!(
                        (found - formula).abs() <= 0.6_f64.max(0.05 * formula),
                        "IT{grade} {most}: {found} {formula}"
                    ),
                }
            }
            above = most;
        }
    }

    #[test]
    fn sizes_at_the_ends_of_ranges() {
        assert_eq!([0.05, 0.0501].map(|size| tolerance(7, size)), [Some(25e-6), Some(30e-6)]);
        let outside =
            [tolerance(6, 0.0), tolerance(4, 0.05), tolerance(13, 0.05), tolerance(6, 3.2), tolerance(6, -0.05)];
        assert_eq!(outside, [None; 5]);
    }
}
