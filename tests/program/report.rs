//! `report.html`: its content, and that it can be made again.

use std::fs;

use crate::place::Place;

#[test]
fn a_report_is_made_again_to_the_byte() {
    let place = Place::new();
    place.model("crank");
    assert!(place.command("run -q -m scan crank.yaml").status().unwrap().success());
    let page = place.path().join("results/crank/report.html");
    let first = fs::read(&page).unwrap();
    fs::remove_file(&page).unwrap();
    let done = place.command("report results/crank").output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(fs::read(&page).unwrap() == first, "another page");
    // On one thread too.
    assert!(place.command("run -q -m scan -j 1 crank.yaml").status().unwrap().success());
    assert!(fs::read(&page).unwrap() == first, "another page on one thread");
}

#[test]
fn run_without_report_writes_the_same_other_files() {
    let place = Place::new();
    place.model("crank");
    let bounds = || fs::read(place.path().join("results/crank/bounds.csv")).unwrap();
    assert!(place.command("run -q -m scan crank.yaml").status().unwrap().success());
    let with = bounds();
    assert!(place.files("results/crank").contains(&"motion.json".to_owned()));
    assert!(place.command("run -q -m scan --no-report crank.yaml").status().unwrap().success());
    let files = place.files("results/crank");
    assert!(!files.iter().any(|name| name == "motion.json" || name == "report.html"), "{files:?}");
    assert!(bounds() == with, "other bounds");
    // Plots and tables alone; the next run removes it.
    assert!(place.command("report results/crank").status().unwrap().success());
    assert!(place.command("run -q -m scan --no-report crank.yaml").status().unwrap().success());
    assert!(!place.files("results/crank").contains(&"report.html".to_owned()));
}

#[test]
fn a_report_of_modes_with_responses_has_the_mechanism() {
    let place = Place::new();
    fs::write(place.path().join("modes.yaml"), include_str!("../../docs/examples/modes.yaml")).unwrap();
    assert!(place.command("run -q modes.yaml").status().unwrap().success());
    let motion = fs::read_to_string(place.path().join("results/two_masses/motion.json")).unwrap();
    assert!(motion.contains("\"drawing\"") && !motion.contains("internal error"), "{motion}");
}

/// A throw at 5 m/s ± 10 % meets a ceiling at 1.3 m beyond √(2 · 9.81 · 1.3) = 5.0503 m/s: in 44.97 % of the box.
#[test]
fn events_in_a_part_of_the_box_are_in_the_page() {
    let place = Place::new();
    let model = "
model: ceiling
parameters: { v0: { value: 5, unit: m/s, tolerance: 10% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ceiling: { force: { on: ball, value: [0, \"-1e5*max(ball.y - 1.3, 0)\"] } }
initial: { ball.y: 0, ball.vy: v0 }
outputs: { y: ball.y, hit: { when: ball.y > 1.3 m } }
simulation: { duration: 0.6, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 5 } }
";
    fs::write(place.path().join("ceiling.yaml"), model).unwrap();
    place.run("run -q ceiling.yaml", 0);
    let page = fs::read_to_string(place.path().join("results/ceiling/report.html")).unwrap();
    assert!(page.contains(" samples, 45.0&#8239;% of the box</td>"), "no share");
    let events = page.split("<section class=\"events\">").nth(1).unwrap().split("</section>").next().unwrap();
    assert!(events.contains("ball.y - 1.3") && events.contains("v0 = 5.05"), "{events}");
    assert!(page.contains("between events</td>"), "another scheme");
}

#[test]
fn a_folder_without_results_is_named() {
    let place = Place::new();
    let done = place.command("report nowhere").output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    let message = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(message.contains("there is no folder nowhere"), "{message}");
    assert_eq!(place.files(""), [""; 0]);
}

/// The files of a folder may be anyone's.
#[test]
fn active_content_of_plots_is_disabled_in_the_report() {
    let place = Place::new();
    place.model("crank");
    place.run("run -q -m scan crank.yaml", 0);
    let folder = place.path().join("results/crank");
    let plain = fs::read_to_string(folder.join("report.html")).unwrap();
    let plots = plain.matches("<svg").count();
    assert!(plain.contains("script-src 'nonce-") && !plain.contains("script-src 'unsafe-inline'"));
    let plot = folder.join("force.svg");
    let text = fs::read_to_string(&plot).unwrap();
    let hostile = text.replacen("<rect", "<script>alert(1)</script><rect onload=\"alert(2)\"", 1);
    assert_ne!(text, hostile);
    fs::write(&plot, hostile).unwrap();
    place.run("report results/crank", 0);
    let page = fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(!page.contains("alert(") && page.contains("<img alt=\"force\" src=\"data:image/svg+xml;base64,"));
    assert_eq!(page.matches("<svg").count(), plots - 1);
    let nonce = |page: &str| page.split("'nonce-").nth(1).unwrap().split('\'').next().unwrap().to_owned();
    assert_ne!(nonce(&page), nonce(&plain));
    assert!(page.contains(&format!("<script type=\"module\" nonce=\"{}\">", nonce(&page))));
}
