//! `mbint verify --junit`: findings of a verification, as tests.

use std::fs;

use crate::place::Place;

#[test]
fn orders_and_balances_are_tests() {
    let place = Place::new();
    place.run(concat!("verify ", env!("CARGO_MANIFEST_DIR"), "/models/pendulum.yaml --quiet --junit orders.xml"), 0);
    let text = fs::read_to_string(place.path().join("orders.xml")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let cases: Vec<_> = document.descendants().filter(|node| node.has_tag_name("testcase")).collect();
    let names: Vec<_> = cases.iter().map(|case| case.attribute("name").unwrap()).collect();
    let derivatives = "absolute, derivatives: equations of motion by positions";
    for name in ["absolute, HHT-I3: positions", "absolute, HHT-I3: reactions", derivatives, "absolute: power"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(cases.iter().all(|case| !case.has_children()), "{text}");
}

/// A force with a corner everywhere has no smooth motion.
#[test]
fn unverified_model_is_a_junit_error() {
    let place = Place::new();
    let model = "model: kink\nbodies: { block: { mass: 1, coordinates: [x] } }\neffects: { push: { force: { on: block, value: [\"abs(sin(4000*t))\", 0] } } }\n\
                 outputs: { x: block.x }\nsimulation: { duration: 1, step: 1e-3 }\n";
    fs::write(place.path().join("kink.yaml"), model).unwrap();
    place.run("verify kink.yaml --quiet --junit orders.xml", 4);
    let text = fs::read_to_string(place.path().join("orders.xml")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let errors: Vec<_> = document.descendants().filter(|node| node.has_tag_name("error")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    assert!(errors[0].text().unwrap().contains("a contact, a stop or a condition switches"), "{text}");
}

/// The page has the verdict, the orders and the derivatives of every formulation, and no script.
#[test]
fn page_has_all_findings_of_a_verification() {
    let place = Place::new();
    place.run(concat!("verify ", env!("CARGO_MANIFEST_DIR"), "/models/slider_crank.yaml --quiet --html page.html"), 0);
    let page = fs::read_to_string(place.path().join("page.html")).unwrap();
    for words in ["Verified: ", "In absolute coordinates", "In joint coordinates", "default-src 'none'"] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(page.matches("<h2>Orders</h2>").count(), 2);
    assert!(page.contains("<td>Dormand–Prince 8(5,3), explicit</td><td>reactions</td>"));
    assert!(page.contains("<td>step of HHT-I3</td><td>accelerations and reactions</td>"));
    assert!(page.contains("<td>spring</td><td>spring_damper</td><td>taken</td>"));
    assert!(!page.contains("<script"));
}
