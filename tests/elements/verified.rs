//! Every element of the registries is verified by a manufactured motion of a mechanism with its example, and the table
//! of the orders is a page of the reference.

use std::fmt::Write;

use mbint::{Convergence, Exchange, FormulationVerification, Model, Verification};

use crate::common::measured::Case;
use crate::common::registry::{Mechanism, OF_EFFECTS, OF_JOINTS, effects, joints};

const HEAD: &str = "# Verification of the elements

Every effect and joint stands with the example of its reference in a small mechanism, in the plane, in space or in both,
and is verified as [`mbint verify`](../guides/verify.md) does it: a motion that is exact because its loads are added, with
steps of half the length until orders settle. The orders are the lowest of positions, velocities, accelerations, states and
reactions, in absolute and in joint coordinates; theory tells 2, 4 and 8 (explicit: at least 4, where rounding comes
first). Power is the largest defect of its balance, as a share of the powers; energy is what the effect does beside its
potential energy. Derivatives of all programs are off by no more than the table says from differences with 32 digits.
Where the equations switch, a part of the run before that and one behind are verified. `MBINT_UPDATE_DOCS=1 cargo test --test elements verified -- --ignored` writes this page; the same test fails where an
element is not verified.

| element | space | HHT-I3 | extrapolated | explicit | derivatives | power | energy |
|---|---|--:|--:|--:|--:|--:|---|
";

const CARRIED: &str = "
## Beams and superelements in motion

What an elastic part feels does not change where all of it is carried along at a constant velocity: the largest change of
its inner forces and of its energy at 20 m/s over 0.2 s, as a share of the largest. Positions of metres round off what
deformations of millimetres make. Steady turning is felt: [a rotating beam](../guides/flexible.md) has its own closed forms.

";

/// Elements whose examples have no smooth motion, with the words of the reason; their own tests measure orders.
const NOT_SMOOTH: [(&str, &str); 1] = [("sampled", "change at instants")];

/// The schemes, and the lowest order that agrees with theory.
const SCHEMES: [(&str, f64); 3] = [("HHT-I3", 1.9), ("extrapolated", 3.8), ("explicit", 4.0)];

/// Largest defect of the balance of power, as a share of the powers, and largest difference of a derivative.
const MOST_DEFECT: f64 = 1e-9;

/// The lowest order of a scheme in all formulations; `None` where errors are rounding's with steps of any length.
fn order(found: &Verification, scheme: usize) -> Option<f64> {
    let all = |own: &FormulationVerification| own.schemes[scheme].convergence.clone();
    let orders: Vec<f64> = found.formulations.iter().flat_map(all).filter_map(|own: Convergence| own.order).collect();
    orders.into_iter().reduce(f64::min)
}

/// Effect on the energy along the motion; empty for joints.
fn energy(found: &Verification) -> &'static str {
    let balance = found.formulations[0].balance.as_ref().unwrap();
    match balance.effects.iter().find(|effect| effect.effect == "it").map(|effect| effect.exchange()) {
        None => "",
        Some(Exchange::None) => "none",
        Some(Exchange::Conserves) => "kept",
        Some(Exchange::Dissipates) => "taken",
        Some(Exchange::Drives) => "put in",
    }
}

/// A row of the table; `None` if the example is refused in this space.
fn row(mechanism: &Mechanism, spatial: bool, keyword: &str, example: &str) -> Option<Result<String, String>> {
    let space = if spatial { "space" } else { "plane" };
    let case = Case::new("elements", &format!("`{keyword}`, {space}"));
    let model = Model::from_yaml_str("registry.yaml", &mechanism.text(spatial, keyword, example)).ok()?;
    let found = model.verify().unwrap_or_else(|error| panic!("{keyword}: {error}"));
    if let Some(why) = found.formulations.iter().find_map(|own| own.failure.as_ref()) {
        let is_known = NOT_SMOOTH.iter().any(|(of, words)| *of == keyword && why.contains(words));
        let row = format!("| `{keyword}` | {space} | | | | | | not verified: {why} |\n");
        if is_known {
            case.excepted(why).note();
        }
        return Some(if is_known { Ok(row) } else { Err(row) });
    }
    let defect = found.formulations.iter().map(|own| own.balance.as_ref().unwrap().defect).fold(0.0, f64::max);
    if !found.is_verified() {
        return Some(Err(format!("{keyword} in the {space}: {found:?}")));
    }
    let checks = found.formulations.iter().flat_map(|own| &own.derivatives);
    let derivatives = checks.map(|check| check.difference).fold(0.0, f64::max);
    let energy = energy(&found);
    // Orders of theory are 2, 4 and 8; the explicit method's shows where rounding does not come first.
    let noted =
        SCHEMES.into_iter().enumerate().fold(case, |case, (scheme, (name, least))| match order(&found, scheme) {
            Some(order) => case.at_least(name, order, least),
            None => case.text(name, "exact"),
        });
    noted
        .at_most("derivatives", derivatives, MOST_DEFECT)
        .at_most("power", defect, MOST_DEFECT)
        .text("energy", energy)
        .note();
    let [hht, extrapolated, explicit] =
        [0, 1, 2].map(|scheme| order(&found, scheme).map_or("exact".to_owned(), |order| format!("{order:.2}")));
    Some(Ok(format!(
        "| `{keyword}` | {space} | {hht} | {extrapolated} | {explicit} | {derivatives:.0e} | {defect:.0e} | {energy} |\n"
    )))
}

#[test]
#[ignore = "a minute: manufactured motions of all elements"]
fn every_element_is_verified() {
    let mut page = HEAD.to_owned();
    let mut wrong = String::new();
    for (mechanism, examples) in [(&OF_EFFECTS, effects()), (&OF_JOINTS, joints())] {
        for (keyword, example) in examples {
            let rows: Vec<_> =
                [false, true].into_iter().filter_map(|spatial| row(mechanism, spatial, keyword, &example)).collect();
            if rows.is_empty() {
                writeln!(wrong, "{keyword} stands in no mechanism").unwrap();
            }
            for row in rows {
                match row {
                    Ok(row) => page += &row,
                    Err(why) => writeln!(wrong, "{why}").unwrap(),
                }
            }
        }
    }
    page += CARRIED;
    page += &crate::carried::table();
    println!("{page}");
    assert!(wrong.is_empty(), "{wrong}");
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/verification.md");
    if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert!(std::fs::read_to_string(&path).unwrap() == page, "MBINT_UPDATE_DOCS=1 writes:\n{page}");
}
