//! `mbint verify --junit`: what a verification found, as tests.

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
    for name in ["absolute, HHT-I3: positions", "absolute, HHT-I3: reactions", "absolute: power"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(cases.iter().all(|case| !case.has_children()), "{text}");
}

/// A clearance that meets its limit at once has no smooth motion in absolute coordinates.
#[test]
fn what_is_not_verified_is_an_error() {
    let place = Place::new();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/slider_crank_clearance.yaml");
    place.run(&format!("verify {model} --quiet --junit orders.xml"), 4);
    let text = fs::read_to_string(place.path().join("orders.xml")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let errors: Vec<_> = document.descendants().filter(|node| node.has_tag_name("error")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    assert!(errors[0].text().unwrap().contains("a contact, a stop or a condition switches"), "{text}");
}
