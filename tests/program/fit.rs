//! `mbint fit`: its files, and messages about tables that cannot be used.

use std::fs;

use crate::place::Place;

const LINE: &str = "
model: line
parameters: { x0: 0 m ± 1 m, v: 0 m/s ± 1 m/s }
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: x0, block.vx: v }
outputs: { height: { formula: block.x, unit: mm } }
simulation: { duration: 1, step: 0.1, output_step: 0.1 }
bounds: { chebyshev: { order: 1 } }
";

fn place(table: &str) -> Place {
    let place = Place::new();
    fs::write(place.path().join("line.yaml"), LINE).unwrap();
    fs::write(place.path().join("data.csv"), table).unwrap();
    place
}

/// Rows between output rows, of 300 mm − 400 mm/s t.
const TABLE: &str = "# a comment
time [ms], height, height_noise [m]
0, 301, 0.002
250, 199, 0.002
500, 101, 0.002
750,, 0.002
1000, -100.5, 0.002
";

#[test]
fn a_table_narrows_the_intervals() {
    let place = place(TABLE);
    let (printed, _) = place.run("fit line.yaml data.csv -o out", 0);
    assert!(printed.contains("4 measured values of height") && printed.contains("most open"), "{printed}");
    let files = place.files("out");
    assert_eq!(files, ["fit.csv", "fit.html", "fit.json", "fit.yaml", "height.fit.svg", "x0-v.set.svg"]);
    let table = fs::read_to_string(place.path().join("out/fit.csv")).unwrap();
    assert!(table.lines().nth(2).unwrap().starts_with("4,0.25,height,0.199,0.002,"), "{table}");
    // The overlay's intervals are the consistent ones: bounds with them are within the noise of the first row.
    place.run("run line.yaml --with out/fit.yaml -o run --no-report", 0);
    let bounds = fs::read_to_string(place.path().join("run/bounds.csv")).unwrap();
    let first: Vec<f64> = bounds.lines().nth(1).unwrap().split(',').take(4).map(|cell| cell.parse().unwrap()).collect();
    assert!(first[2] >= 0.2985 && first[3] <= 0.3035, "{first:?}");
    // JSON has the same, in SI.
    let (json, _) = place.run("fit line.yaml data.csv -o out --format json --quiet", 0);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["rows"][1]["measured"], 0.199);
    assert_eq!(
        json,
        serde_json::from_str::<serde_json::Value>(&fs::read_to_string(place.path().join("out/fit.json")).unwrap())
            .unwrap()
    );
    let page = fs::read_to_string(place.path().join("out/fit.html")).unwrap();
    assert!(page.contains("Principal axes") && page.matches("<svg").count() == 2, "{page}");
}

#[test]
fn tables_of_spreadsheets_are_the_same() {
    let fitted = |table: &str| {
        let place = place(table);
        let (json, _) = place.run("fit line.yaml data.csv -o out --format json --quiet", 0);
        serde_json::from_str::<serde_json::Value>(&json).unwrap()
    };
    let plain = fitted(TABLE);
    for separator in [";", "\t"] {
        let other = TABLE.replace(',', separator);
        assert_eq!(fitted(&other), plain, "{separator:?}");
        assert_eq!(fitted(&other.replace("-100.5", "-100,5").replace("0.002", "0,002")), plain, "{separator:?}");
    }
}

#[test]
fn unexplained_rows_are_named() {
    let place = place(&TABLE.replace("500, 101", "500, 2000"));
    let (_, error) = place.run("fit line.yaml data.csv -o out", 4);
    let named = "line 5 (height at t = 0.5 s) alone: missed by 498 mm beyond its noise";
    assert!(error.contains(named) && error.contains("without line 5"), "{error}");
    assert!(!place.files("out").contains(&"fit.yaml".to_owned()));
}

#[test]
fn unusable_tables_are_reported_with_positions() {
    let cases = [
        ("", "data.csv: the table is empty: it needs a heading, as `time, x`, and rows"),
        ("time, height\n", "data.csv: the table has no measured values below its heading"),
        ("t, height\n0.5, 1\n2.5, 1\n", "data.csv: line 2, column 6: the noise of `height` is not known"),
        (
            "t, height, height_noise\n2.5, 1, 1\n",
            "data.csv: line 2, column 1: the time 2.5 s is outside of the simulation, which is from 0 to 1 s",
        ),
        ("t, height, height_noise\n-0.1, 1, 1\n", "the time -0.1 s is outside of the simulation"),
        ("t, heigth\n0, 1\n", "data.csv: line 1, column 4: `heigth` is no output of the model; did you mean `height`?"),
        ("t, height [kg]\n0, 1\n", "line 1, column 4: `kg` is a unit of mass, but the column is length"),
        ("t [m], height\n0, 1\n", "line 1, column 1: `m` is a unit of length"),
        ("height, height_noise\n1, 1\n", "data.csv: line 1, column 1: there is no column `time`"),
        ("t\n1\n", "no column is an output of the model; there is only `height`"),
        ("t, height, height\n0, 1, 1\n", "line 1, column 12: there are two columns `height`"),
        ("t, height, height_noise\n0, 1x, 1\n", "data.csv: line 2, column 4: `1x` is not a number"),
        ("t, height, height_noise\n0, 1, 0\n", "line 2, column 7: a noise bound is greater than zero"),
        ("t, height, height_noise\n0, 1\n", "line 2, column 1: 2 cells, but the first line has 3"),
        ("t; height; height_noise\n0; 1,5; 0.1\n", "line 2, column 4: `1,5` has a decimal comma, but other numbers"),
        (
            "t, height, height_noise\n0, 1,5, 0,1, 0\n",
            "line 2, column 1: 6 cells, but the first line has 3: with decimal commas, separate columns by semicolons",
        ),
        ("t; height\n0 1; 2\n", "line 2, column 1: `0 1` is several numbers: separate columns by commas"),
        (", height, height_noise\n0, 1, 1\n", "line 1, column 1: `` is no output of the model"),
    ];
    for (table, message) in cases {
        let (_, error) = place(table).run("fit line.yaml data.csv -o out", 2);
        assert!(error.contains(message), "{table:?}\n{error}");
    }
    let place = place("t, height\n0, 1\n");
    for (noise, message) in [
        ("heigth=1", "noise `heigth=1`: `heigth` is no output of the model; did you mean `height`?"),
        ("height=1kg", "`kg` is a unit of mass"),
        ("height=-1", "a noise bound is greater than zero"),
        ("height=x", "it is no number with a unit, as `0.1 mm`"),
    ] {
        let (_, error) = place.run(&format!("fit line.yaml data.csv -o out --noise {noise}"), 2);
        assert!(error.contains(message), "{noise}\n{error}");
    }
    let (_, error) = place.run("fit line.yaml missing.csv -o out", 2);
    assert!(error.contains("missing.csv: "), "{error}");
    fs::write(place.path().join("line.yaml"), LINE.replace(" ± 1 m/s", "").replace(" ± 1 m,", ",")).unwrap();
    let (_, error) = place.run("fit line.yaml data.csv -o out --noise height=1mm", 2);
    assert!(error.contains("no parameter is uncertain"), "{error}");
}
