//! Formulas with units, conditions and jumps, in motions whose closed forms are known.

use std::f64::consts::PI;

use mbint::results::Method;

use crate::common::{band, curve, largest, nominal, output, read, run};

/// A mass on which a force acts.
fn pushed(force: &str) -> String {
    format!(
        "
parameters: {{ m: 2 kg, d: 0.1 m, L: 2 m, F: 3 N }}
tables: {{ lobe: {{ points: [[0, 0], [0.1, 1], [0.2, 0], [0.3, -1], [0.4, 0]], periodic: true }} }}
bodies: {{ b: {{ mass: m, coordinates: [x] }} }}
effects: {{ push: {{ force: {{ on: b, value: [\"{force}\", 0] }} }} }}
initial: {{ b.x: 0.05, b.vx: 0 }}
outputs: {{ x: b.x, v: b.vx, f: \"{force}\" }}
simulation: {{ duration: 1.9, tolerance: 1e-7, output_step: 0.05 }}
bounds: {{ chebyshev: {{ order: 1 }} }}
"
    )
}

/// A square wave, on for the first half of every 0.4 s: pieces of parabolas.
fn square_wave(t: f64) -> f64 {
    let (acceleration, half) = (1.5, 0.2);
    let whole = (t / (2.0 * half)).floor();
    let rest = t - whole * 2.0 * half;
    let speed = whole * acceleration * half;
    // Each period adds half² a/2 + half² a to the way at the speed of its beginning.
    let begun =
        whole * (1.5 * acceleration * half * half) + (whole * (whole - 1.0) / 2.0) * acceleration * half * 2.0 * half;
    let on = rest.min(half);
    let within = acceleration * on * on / 2.0 + acceleration * half * (rest - on);
    0.05 + begun + speed * rest + within
}

#[test]
fn steps_see_the_jumps_of_every_function() {
    for force in [
        "if(mod(t, 0.4) < 0.2, F, 0)",
        "F*(mod(t, 400 ms) < 0.2 s)",
        "if(mod(t, 0.4 s) >= 200 ms, 0, F)",
        "F*(1 - mod(floor(t/0.2), 2))",
        "F*(mod(t, 0.4) >= 0 and not mod(t, 0.4) >= 0.2)",
        "F*(mod(ceil(t/0.2 - 1), 2) == 0)",
        "if(round(mod(t/0.4, 1)) > 0 or t < 0, 0 N, 3 N)",
        "F*clamp(1e9*(0.2 - mod(t, 0.4)), 0, 1)",
    ] {
        let bounds = nominal(&read(&pushed(force)));
        let worst = largest(bounds.times.iter().zip(curve(&bounds, "x")).map(|(&t, &x)| (x - square_wave(t)).abs()));
        assert!(worst < 1e-6, "{force}: {worst:e}");
    }
}

/// A staircase of the position: between two stairs the force is constant, so that energy is conserved.
#[test]
fn a_staircase_of_the_position_keeps_the_energy() {
    for stairs in ["floor(b.x/d + 0.5)", "round(b.x/d)", "ceil(b.x/d - 0.5)"] {
        let text = pushed(&format!("-40 N*{stairs}")).replace("b.x: 0.05, b.vx: 0", "b.x: 0.02, b.vx: 1.3");
        let bounds = nominal(&read(&text));
        let potential = |x: f64| {
            let stair = (x / 0.1 + 0.5).floor();
            let edges = 0.1 * stair.abs() * stair.abs() / 2.0;
            40.0 * (stair.abs() * x.abs() - edges)
        };
        let energy: Vec<f64> =
            curve(&bounds, "x").iter().zip(curve(&bounds, "v")).map(|(x, v)| v * v + potential(*x)).collect();
        let worst = largest(energy.iter().map(|value| (value - 1.69).abs()));
        assert!(worst < 1e-5, "{stairs}: {worst:e}");
    }
}

#[test]
fn a_smooth_step_and_units_inside_give_their_closed_form() {
    let bounds = nominal(&read(&pushed("3 N*smoothstep(0.5, 1500 ms, t)")));
    let worst = largest(bounds.times.iter().zip(curve(&bounds, "v")).map(|(&t, &v)| {
        let u = (t - 0.5).clamp(0.0, 1.0);
        // The integral of 3u² − 2u³, and then of 1.
        let speed = 1.5 * (u.powi(3) - u.powi(4) / 2.0 + (t - 1.5).max(0.0));
        (v - speed).abs()
    }));
    assert!(worst < 1e-6, "{worst:e}");
}

/// A periodic table continues with its slope and curvature: here it is the sine that it was made of, but for h⁴.
#[test]
fn a_periodic_table_drives_for_ever() {
    let points: Vec<String> = (0..=40)
        .map(|i| format!("[{}, {:?}]", 9 * i, if i == 40 { 0.0 } else { (PI * f64::from(i) / 20.0).sin() }))
        .collect();
    let text = pushed("F*wave(2*pi*t - 7)").replace(
        "tables: {",
        &format!("tables: {{ wave: {{ points: [{}], units: [deg, 1], periodic: true }},", points.join(", ")),
    );
    let [table, sine] = [text.clone(), text.replace("F*wave(", "F*sin(")].map(|text| nominal(&read(&text)));
    let apart = crate::common::distance(curve(&table, "x"), curve(&sine, "x"));
    assert!(apart < 2e-5, "{apart:e}");
}

/// Units in formulas of parameters: the same values as without.
#[test]
fn formulas_may_contain_units() {
    let value = |formula: &str| {
        // A mass called `m` would make `N*m` ambiguous.
        let text = pushed("F").replace("m: 2 kg", "M: 2 kg").replace("mass: m", "mass: M");
        let text = text.replace("F: 3 N }", &format!("F: 3 N, p: \"{formula}\" }}"));
        let model = read(&text);
        let outputs = text.replace("f: \"F\"", "f: p");
        let bounds = nominal(&read(&outputs));
        assert!(model.study().description().parameters.iter().any(|parameter| parameter.name == "p"));
        curve(&bounds, "f")[0]
    };
    for (formula, wanted) in [
        ("cos(60 deg)", 0.5),
        ("250 kg/m * L", 500.0),
        ("L + 3 mm", 2.003),
        ("2*(1 m + 20 cm)/L", 1.2),
        ("max(1 mm, d)", 0.1),
        ("10 N / F", 10.0 / 3.0),
        ("F*L/(2 N*m)", 3.0),
        ("deg(asin(0.5 + 0*d/d))", 30.0),
        ("if(L > 1500 mm and M < 3 kg, 7, 8)", 7.0),
        ("1 km/h * 3.6", 1.0),
    ] {
        let found = value(formula);
        assert!((found - wanted).abs() < 1e-12 * wanted, "{formula}: {found}");
    }
}

/// The names of outputs stand for their formulas, unless the model has something of that name.
#[test]
fn outputs_may_refer_to_earlier_outputs() {
    let text = pushed("F");
    let outputs = |outputs: &str| text.replace("outputs: { x: b.x, v: b.vx, f: \"F\" }", outputs);
    let named = "outputs: { v: b.vx, d: 2*b.x, power: F*v, twice: 2*power + F*v, shifted: b.x + d }";
    let written = "outputs: { v: b.vx, d: 2*b.x, power: F*b.vx, twice: 2*(F*b.vx) + F*b.vx, shifted: b.x + d }";
    let [named, written] = [named, written].map(|text| nominal(&read(&outputs(text))));
    for name in ["power", "twice", "shifted"] {
        assert_eq!(curve(&named, name), curve(&written, name), "{name}");
    }
}

/// A jump in the box: the bounds of a scan show both of its sides, whatever its points.
#[test]
fn a_jump_by_a_parameter_is_inside_the_bounds() {
    let text = pushed("if(d > 0.1, F, -F)")
        .replace("d: 0.1 m", "d: 0.1 m ± 10%")
        .replace("bounds: { chebyshev: { order: 1 } }", "bounds: { scan: { points: 5 } }");
    let bounds = run(&read(&text).tolerance(1e-6));
    let v = band(output(&bounds, "v"), Method::Scan);
    let last = v.upper.len() - 1;
    assert!((v.upper[last] - 2.85).abs() < 1e-6 && (v.lower[last] + 2.85).abs() < 1e-6);
}
