//! Dependencies of the project: licences, and no unsafe code of its own where none is needed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The licences that `deny.toml` allows.
fn allowed() -> BTreeSet<String> {
    let text = fs::read_to_string(Path::new(ROOT).join("deny.toml")).unwrap();
    let list = text.split("allow = [").nth(1).unwrap().split(']').next().unwrap();
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Whether one of the ways in which an SPDX expression can be fulfilled is allowed.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    // `(A OR B) AND C`: no licence here has more than one level of parentheses.
    let mut conditions = vec![String::new()];
    let mut depth = 0;
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    for word in spaced.split_whitespace() {
        match word {
            "(" => depth += 1,
            ")" => depth -= 1,
            "AND" if depth == 0 => conditions.push(String::new()),
            word => conditions.last_mut().unwrap().push_str(&format!("{word} ")),
        }
    }
    conditions.iter().all(|condition| condition.split(" OR ").any(|licence| allowed.contains(licence.trim())))
}

#[test]
fn licences_of_all_dependencies_are_allowed() {
    let allowed = allowed();
    assert!(allowed.contains("MIT") && is_allowed("(GPL-3.0 OR MIT) AND Zlib", &allowed));
    assert!(!is_allowed("(MIT OR Apache-2.0) AND GPL-3.0", &allowed) && !is_allowed("GPL-2.0/AGPL-3.0", &allowed));
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--manifest-path"])
        .arg(Path::new(ROOT).join("Cargo.toml"))
        .output()
        .unwrap();
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 50);
    let wrong: Vec<String> = packages
        .iter()
        .filter(|package| !is_allowed(package["license"].as_str().unwrap_or("none"), &allowed))
        .map(|package| format!("{} {}: {}", package["name"], package["version"], package["license"]))
        .collect();
    assert!(wrong.is_empty(), "not in deny.toml: {wrong:#?}");
}

/// Its kernels fuse where the processor can, and give other bits there; nalgebra's feature `std` brings it.
#[test]
fn no_dependency_has_fused_matrix_kernels() {
    let lock = fs::read_to_string(Path::new(ROOT).join("Cargo.lock")).unwrap();
    assert!(lock.contains("name = \"nalgebra\"") && !lock.contains("matrixmultiply"));
}

/// The evaluation of programs has two functions that the compiler makes twice, units of FMI are native libraries, and a
/// page shares its module's memory; nothing else is unsafe.
#[test]
fn unsafe_code_is_forbidden_in_every_crate_but_three() {
    let folders = fs::read_dir(Path::new(ROOT).join("crates")).unwrap().map(|entry| entry.unwrap().path().join("src"));
    let sources: Vec<PathBuf> = folders.chain([Path::new(ROOT).join("src")]).collect();
    let roots = sources.iter().flat_map(|source| ["lib.rs", "main.rs"].map(|root| source.join(root)));
    let mut allowing = Vec::new();
    for root in roots.filter(|root| root.exists()) {
        let text = fs::read_to_string(&root).unwrap();
        if !text.lines().any(|line| line == "#![forbid(unsafe_code)]") {
            allowing.push(root.strip_prefix(ROOT).unwrap().to_owned());
        }
    }
    allowing.sort();
    let three = ["crates/fmu/src/lib.rs", "crates/playground/src/lib.rs", "crates/symdiff/src/lib.rs"];
    assert_eq!(allowing, three.map(Path::new));
    let [units, page] = [0, 1].map(|index| fs::read_to_string(Path::new(ROOT).join(&allowing[index])).unwrap());
    assert!([&units, &page].iter().all(|root| root.contains("#![deny(unsafe_code)]")));
    // The page has it in its functions of C alone; units have it in the room `native` alone.
    let allowed = page.matches("#[allow(unsafe_code").count();
    assert!(allowed == 1 && page.contains("linear memory is shared with the page\")]\nmod abi;"));
    let mut folders = vec![Path::new(ROOT).join("crates/fmu/src")];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true if !path.ends_with("native") => folders.push(path),
                true => {}
                false => {
                    let text = fs::read_to_string(&path).unwrap();
                    assert!(!text.contains("allow(unsafe_code)"), "{}", path.display());
                }
            }
        }
    }
}

/// A tag can be moved to other code.
#[test]
fn workflows_name_actions_by_commit() {
    let workflows = fs::read_dir(Path::new(ROOT).join(".github/workflows")).unwrap();
    let texts: Vec<String> = workflows.map(|entry| fs::read_to_string(entry.unwrap().path()).unwrap()).collect();
    let lines = texts.iter().flat_map(|text| text.lines()).map(str::trim);
    let used: Vec<&str> = lines.filter_map(|line| line.trim_start_matches("- ").strip_prefix("uses:")).collect();
    let is_commit = |action: &str| {
        let commit = action.split_once('@').map_or("", |(_, rest)| rest.split(' ').next().unwrap_or(""));
        commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit())
    };
    let others: Vec<&&str> = used.iter().filter(|action| !is_commit(action)).collect();
    assert!(used.len() > 10 && others.is_empty(), "{others:?}");
}

/// Crates that `cargo tree` lists with these arguments, each with its features.
fn features(arguments: &[&str]) -> BTreeSet<String> {
    let tree = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--target", "all", "--prefix", "none", "--no-dedupe", "--format", "{p} {f}"])
        .args(arguments)
        .current_dir(ROOT)
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    String::from_utf8(tree.stdout).unwrap().lines().map(str::to_owned).collect()
}

/// The program that is tested is then the one that is built, and it is compiled once.
#[test]
fn tests_and_the_program_share_features_of_their_dependencies() {
    let program = features(&["--package", "mbint", "--edges", "normal,build"]);
    let tests = features(&["--workspace", "--edges", "normal,build,dev"]);
    let others: Vec<&String> = program.difference(&tests).collect();
    assert!(program.len() > 50 && others.is_empty(), "of the program alone: {others:#?}");
}
