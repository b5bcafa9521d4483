//! Other programs, if they are installed: their versions, and whether they still compute their recorded motions.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::record::{Case, Figure, Run};

/// Python packages of peers, and the names of the programs.
const PEERS: [(&str, &str); 3] = [("mujoco", "MuJoCo"), ("pin", "Pinocchio"), ("exudyn", "Exudyn")];

/// Recorded robots without commands to actuators.
const ROBOTS: [&str; 4] = ["ball_and_free", "linkage", "spatial_arm", "welded"];

/// Times of the slider crank's reference, s, at which Exudyn is compared; it runs anew for each.
const TIMES: [f64; 4] = [0.5, 1.0, 1.5, 2.0];

/// The versions of installed peers, in the environments of `benches/peers/run` or outside of them. A whole run lets
/// them compute again.
pub fn peers(root: &Path, claim: &str, quick: bool) -> (Run, Vec<Case>) {
    let pinned = std::fs::read_to_string(root.join("benches/peers/run")).unwrap_or_default();
    let pythons = ["target/exudyn/bin/python", "target/robots/bin/python"].map(|python| root.join(python));
    let pythons: Vec<PathBuf> = pythons.into_iter().chain([PathBuf::from("python3")]).collect();
    let mut run = Run { command: "python3 -c 'importlib.metadata.version(PACKAGE)'".to_owned(), ..Run::default() };
    let mut cases = Vec::new();
    for (package, name) in PEERS {
        let asked = format!("import importlib.metadata as m; print(m.version('{package}'))");
        let found = pythons.iter().find_map(|python| Some((python, output(root, python, &["-c", &asked]).ok()?)));
        let version = found.as_ref().map_or("not installed", |(_, version)| version.trim());
        let figures = vec![Figure::words("version", version)];
        let source = Some(format!("last timed with {}", pin(&pinned, package)));
        cases.push(Case { case: format!("{name}, installed here"), source, figures, ..Case::default() });
        let Some((python, _)) = found.filter(|_| !quick) else { continue };
        let again = match package {
            "mujoco" => robots_again(root, python),
            "exudyn" => slider_crank_by_exudyn(root, python)
                .and_then(|first| Ok([first, mini_examples_by_exudyn(root, python)?].concat())),
            _ => Ok(Vec::new()),
        };
        match again {
            Ok(more) => cases.extend(more),
            Err(error) => run.error = Some(format!("{name}: {error}")),
        }
    }
    cases.iter_mut().for_each(|case| claim.clone_into(&mut case.claim));
    (run, cases)
}

fn output(root: &Path, python: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new(python).args(arguments).current_dir(root).output().map_err(|error| error.to_string())?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(String::from_utf8_lossy(&output.stderr).trim().to_owned())
    }
}

/// Recorded motions of robots, computed again by the installed MuJoCo. Its integrator's error is extrapolated from two
/// steps, and rows have ten digits.
fn robots_again(root: &Path, python: &Path) -> Result<Vec<Case>, String> {
    let folder = "tests/reference/mjcf";
    let case = |name: &str| {
        let robot = format!("{folder}/{name}.xml");
        let computed = output(root, python, &[&format!("{folder}/motion.py"), &robot])?;
        let recorded =
            std::fs::read_to_string(root.join(format!("{folder}/{name}.csv"))).map_err(|error| error.to_string())?;
        let figures = vec![distance(apart(&computed, &recorded), 1e-7)];
        Ok(Case {
            case: format!("MuJoCo, `{name}`, computed again"),
            source: Some(format!("`{folder}/{name}.csv`")),
            figures,
            ..Case::default()
        })
    };
    ROBOTS.into_iter().map(case).collect()
}

fn distance(value: f64, high: f64) -> Figure {
    Figure::number("largest distance, m or rad", value, None, Some(high))
}

/// Exudyn's slider crank with its shortest steps, whose error is about 1e-6 m, against the reference of minimal
/// coordinates.
fn slider_crank_by_exudyn(root: &Path, python: &Path) -> Result<Vec<Case>, String> {
    let file = "tests/reference/slider_crank/nominal_states.csv";
    let reference = std::fs::read_to_string(root.join(file)).map_err(|error| format!("{file}: {error}"))?;
    let times = serde_json::to_string(&TIMES).map_err(|error| error.to_string())?;
    let printed = output(root, python, &["-W", "ignore", "benches/peers/exudyn_peer.py", &times])?;
    let report: Value = serde_json::from_str(&printed).map_err(|error| error.to_string())?;
    let shortest = report["slider_shorter"].as_array().and_then(|runs| runs.last()).ok_or("no run with short steps")?;
    let values: Vec<f64> = shortest["values"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    let exact: Vec<f64> = rows(&reference).filter(|row| TIMES.contains(&row[0])).map(|row| row[1]).collect();
    if (values.len(), exact.len()) != (TIMES.len(), TIMES.len()) {
        return Err(format!("{} values and {} rows of {} times", values.len(), exact.len(), TIMES.len()));
    }
    let worst = values.iter().zip(&exact).map(|(value, exact)| (value - exact).abs()).fold(0.0, f64::max);
    Ok(vec![Case {
        case: "Exudyn, slider crank".to_owned(),
        source: Some("the reference with which mbint agrees in section 3".to_owned()),
        figures: vec![distance(worst, 1e-5)],
        ..Case::default()
    }])
}

/// The mini examples of Exudyn against their recorded values: the largest difference, as a share.
fn mini_examples_by_exudyn(root: &Path, python: &Path) -> Result<Vec<Case>, String> {
    let file = "tests/peers/exudyn.csv";
    let table = std::fs::read_to_string(root.join(file)).map_err(|error| format!("{file}: {error}"))?;
    let printed = output(root, python, &["-W", "ignore", "tests/peers/in_exudyn.py"])?;
    // Its static solver prints text before.
    let computed = printed.find('{').map_or("", |first| &printed[first..]);
    let computed: Value = serde_json::from_str(computed).map_err(|error| error.to_string())?;
    let mut worst = 0.0_f64;
    for row in table.lines().skip(1) {
        let cells: Vec<&str> = row.splitn(6, ',').collect();
        let [recorded, again] = [cells[4].parse().unwrap_or(f64::NAN), computed[cells[0]].as_f64().unwrap_or(f64::NAN)];
        let apart = (again / recorded - 1.0).abs();
        // NaN persists.
        worst = if worst.is_nan() || apart <= worst { worst } else { apart };
    }
    Ok(vec![Case {
        case: "Exudyn, mini examples, computed again".to_owned(),
        source: Some(format!("`{file}`")),
        figures: vec![Figure::number("largest difference, as a share", worst, None, Some(1e-9))],
        ..Case::default()
    }])
}

/// Rows of numbers below a line of names.
fn rows(text: &str) -> impl Iterator<Item = Vec<f64>> {
    let number = |cell: &str| cell.trim().parse().unwrap_or(f64::NAN);
    text.lines().filter(|line| !line.starts_with('#')).skip(1).map(move |line| line.split(',').map(number).collect())
}

/// Largest difference of two tables; NaN if their sizes differ, or a cell is not a number.
fn apart(one: &str, other: &str) -> f64 {
    let [one, other] = [one, other].map(|text| rows(text).collect::<Vec<_>>());
    if one.iter().map(Vec::len).ne(other.iter().map(Vec::len)) || one.is_empty() {
        return f64::NAN;
    }
    let differences = one.iter().flatten().zip(other.iter().flatten()).map(|(one, other)| (one - other).abs());
    // NaN persists.
    differences.fold(0.0, |largest: f64, own| if largest.is_nan() || own <= largest { largest } else { own })
}

/// The version of `package==version` in a text.
fn pin(text: &str, package: &str) -> String {
    let after = text.split(&format!("\"{package}==")).nth(1).and_then(|rest| rest.split('"').next());
    after.unwrap_or("no version").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_compared_cell_by_cell() {
        assert!((apart("t,x\n0,1\n1,2.5\n", "# made so\nt,x\n0,1\n1,2.25\n") - 0.25).abs() < 1e-15);
        assert!(apart("t,x\n0,1\n", "t,x\n0,1\n1,2\n").is_nan());
        assert!(apart("t,x\n0,1\n1,2\n", "t,x\n0,x\n1,2\n").is_nan());
        assert!(apart("", "").is_nan());
    }

    #[test]
    fn pinned_versions_are_read() {
        let text = "EXUDYN = \"exudyn==1.13.6\"\nROBOTS = [\"mujoco==4.0.0\", \"pin==4.1.0\"]\n";
        assert_eq!(["exudyn", "pin", "drake"].map(|package| pin(text, package)), ["1.13.6", "4.1.0", "no version"]);
    }
}
