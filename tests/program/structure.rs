//! Counts of `mbint check`, on mechanisms whose mobility is in textbooks.

use std::f64::consts::TAU;
use std::fs;

use serde_json::Value;

use super::place::Place;

const END: &str = "simulation: { duration: 0.1 }\nbounds: { scan: { points: 2 } }\n";

/// Report of `check` on a model, as JSON and as text.
#[track_caller]
fn checked(model: &str) -> (Value, String) {
    let place = Place::new();
    fs::write(place.path().join("m.yaml"), format!("model: m\n{model}{END}")).unwrap();
    let found: Value = serde_json::from_str(&place.run("check m.yaml --format json", 0).0).unwrap();
    (found[0].clone(), place.run("check m.yaml", 0).0)
}

/// Count, mobility, and by how much the mechanism is over-constrained.
#[track_caller]
fn mobility(found: &Value) -> [i64; 3] {
    ["count", "mobility", "over_constrained"].map(|key| found["mobility"][key].as_i64().unwrap())
}

/// Report of `check` on a model that comes with mbint.
#[track_caller]
fn shipped(name: &str) -> Value {
    let path = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let found: Value = serde_json::from_str(&Place::new().run(&format!("check --format json {path}"), 0).0).unwrap();
    found[0].clone()
}

fn triple(vector: [f64; 3]) -> String {
    let [x, y, z] = vector;
    format!("[{x:?}, {y:?}, {z:?}]")
}

/// A crank with a block that slides on the ground: the mass of crank and rod is 2 kg/m.
fn slider_crank(spatial: &str) -> String {
    format!(
        "parameters:
  r: {{ value: 0.1, unit: m }}
  l: {{ value: 0.3, unit: m, tolerance: 1% }}
  rho: {{ value: 2, unit: kg/m, tolerance: 5% }}
bodies:
  crank: {{ mass: rho*r, inertia: 0.001, points: {{ pin: [r, 0] }} }}
  rod: {{ mass: rho*l, inertia: 0.01, points: {{ big: [-l/2, 0], small: [l/2, 0] }} }}
  block: {{ mass: 0.4, inertia: 0.001 }}
joints:
  main: {{ revolute: {{ between: [ground, crank]{spatial} }} }}
  pin: {{ revolute: {{ between: [crank.pin, rod.big]{spatial} }} }}
  wrist: {{ revolute: {{ between: [rod.small, block]{spatial} }} }}
  guide: {{ prismatic: {{ between: [ground, block], axis: [1, 0] }} }}
outputs: {{ x: block.x }}
"
    )
}

#[test]
fn mechanisms_of_the_plane_are_counted_by_grubler() {
    for name in ["four_bar", "peaucellier", "jansen", "planetary_gear", "quick_return", "slider_crank"] {
        assert_eq!(mobility(&shipped(name)), [1, 1, 0], "{name}");
    }
    assert_eq!(mobility(&shipped("excavator")), [2, 2, 0]);
    let (crank, text) = checked(&slider_crank(""));
    assert_eq!(mobility(&crank), [1, 1, 0]);
    assert!(text.contains("4 bodies with the ground, 4 joints: Grübler's count 3·3 − 8 = 1, as found\n"), "{text}");
    assert!(text.ends_with("  nothing pulls or drives it: it stays at rest\n"), "{text}");
    // 2 kg/m (0.1 m + 0.3 m) + 0.4 kg; 1.9 (0.1 + 0.297) and 2.1 (0.1 + 0.303) at the ends.
    assert!(text.contains(", 1.2 kg (from 1.154 to 1.246 kg)\n"), "{text}");
    let mass = ["nominal", "lower", "upper"].map(|key| crank["mass"][key].as_f64().unwrap());
    for (mass, exact) in mass.into_iter().zip([1.2, 1.1543, 1.2463]) {
        assert!((mass - exact).abs() < 1e-12, "{mass} {exact}");
    }
    // A parallelogram with a third rod that is as long as the others moves for its lengths alone.
    let parallel = "bodies:
  ground: { points: { a: [0, 0], b: [0.2, 0], c: [0.5, 0] } }
  one: { mass: 1, inertia: 0.1, points: { top: [0, 0.3] } }
  two: { mass: 1, inertia: 0.1, points: { top: [0, 0.3] } }
  three: { mass: 1, inertia: 0.1, points: { top: [0, 0.3] } }
  bar: { mass: 1, inertia: 0.1, points: { a: [0, 0], b: [0.2, 0], c: [0.5, 0] } }
joints:
  a: { revolute: [ground.a, one] }
  b: { revolute: [ground.b, two] }
  c: { revolute: [ground.c, three] }
  d: { revolute: [one.top, bar.a] }
  e: { revolute: [two.top, bar.b] }
  f: { revolute: [three.top, bar.c] }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { one.angle: 0.4 }
outputs: { x: bar.x }
";
    let (parallel, text) = checked(parallel);
    assert_eq!(mobility(&parallel), [0, 1, 1], "{text}");
    assert!(text.contains("3·4 − 12 = 0, but the mobility is 1: over-constrained by 1"), "{text}");
    assert!(text.contains("gravity 9.81 m/s² along −y"), "{text}");
}

#[test]
fn mechanisms_of_space_are_counted_by_kutzbach() {
    // The same crank in space: three parallel axes and a guide fix three motions twice.
    let (crank, text) = checked(&format!("space: spatial\n{}", slider_crank(", axis: [0, 0, 1]")));
    assert_eq!(mobility(&crank), [-2, 1, 3], "{text}");
    assert_eq!(mobility(&shipped("bricard")), [0, 1, 1]);
    assert_eq!(mobility(&shipped("delta_robot")), [3, 3, 0]);
    assert_eq!(mobility(&shipped("spatial_four_bar")), [1, 1, 0]);
    assert_eq!(mobility(&shipped("six_axis_arm")), [6, 6, 0]);

    // Bennett's: twists of 35° and 70°, lengths in the ratio of their sines.
    let places: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [0.12855752193730788, 0.1532088886237956, 0.0],
        [-0.13977784566030235, -0.02344769178158801, 0.06442200370824493],
        [-0.32766081771559674, 0.0, 0.0],
    ];
    let axes: [[f64; 3]; 4] = [
        [0.0, 0.0, 1.0],
        [0.43938504177070503, -0.3686878264946124, 0.8191520442889918],
        [-0.196611862710304, 0.5854617076559641, 0.7864975297546374],
        [0.0, 0.9396926207859084, 0.34202014332566866],
    ];
    let names = ["ground", "one", "two", "three"];
    let mut bodies = format!("  ground: {{ points: {{ e0: {}, e3: {} }} }}\n", triple(places[0]), triple(places[3]));
    let mut joints = String::new();
    for i in 0..4 {
        if i < 3 {
            bodies += &format!(
                "  {}: {{ mass: 1, inertia: 0.1, points: {{ e{i}: {}, e{}: {} }} }}\n",
                names[i + 1],
                triple(places[i]),
                i + 1,
                triple(places[i + 1])
            );
        }
        joints += &format!(
            "  j{i}: {{ revolute: {{ between: [{}.e{i}, {}.e{i}], axis: {} }} }}\n",
            names[i],
            names[(i + 1) % 4],
            triple(axes[i])
        );
    }
    let (bennett, text) = checked(&format!("bodies:\n{bodies}joints:\n{joints}outputs: {{ x: two.e2.x }}\n"));
    assert_eq!(mobility(&bennett), [-2, 1, 3], "{text}");
    assert!(text.contains("Kutzbach's count 6·3 − 20 = −2, but the mobility is 1: over-constrained by 3"), "{text}");
}

/// Gough and Stewart's platform. With spherical joints at both ends each leg also turns about itself.
#[test]
#[ignore = "2 s"]
fn platforms_have_six_degrees_of_freedom_and_idle_ones() {
    for (foot, expected) in [("spherical", 12), ("universal", 6)] {
        let (mut feet, mut heads, mut bodies, mut joints) = Default::default();
        let add = |text: &mut String, more: String| *text += &more;
        for leg in 0..6 {
            let turn = |third: usize, sign: f64| TAU * third as f64 / 3.0 + 0.25 * sign;
            let side = if leg % 2 == 0 { -1.0 } else { 1.0 };
            let (low, high) = (turn(leg / 2, side), turn(leg.div_ceil(2), -side) - TAU / 6.0);
            let base = [0.5 * low.cos(), 0.5 * low.sin(), 0.0];
            let head = [0.3 * high.cos(), 0.3 * high.sin(), 0.0];
            let way = [head[0] - base[0], head[1] - base[1], 0.7];
            let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
            let [a, b, c] = way.map(|part| part / length);
            let flat = (a * a + b * b).sqrt();
            let first = [-b / flat, a / flat, 0.0];
            let second = [b * first[2] - c * first[1], c * first[0] - a * first[2], a * first[1] - b * first[0]];
            let half = triple(way.map(|part| part / 2.0));
            add(&mut feet, format!("b{leg}: {}, ", triple(base)));
            add(&mut heads, format!("h{leg}: {}, ", triple(head)));
            for (name, end) in [("lower", "end"), ("upper", "top")] {
                add(
                    &mut bodies,
                    format!("  {name}{leg}: {{ mass: 0.5, inertia: 0.01, points: {{ {end}: {half} }} }}\n"),
                );
            }
            add(
                &mut joints,
                match foot {
                    "universal" => format!(
                        "  foot{leg}: {{ universal: {{ between: [ground.b{leg}, lower{leg}], axes: [{}, {}] }} }}\n",
                        triple(first),
                        triple(second)
                    ),
                    _ => format!("  foot{leg}: {{ spherical: [ground.b{leg}, lower{leg}] }}\n"),
                },
            );
            add(
                &mut joints,
                format!(
                    "  leg{leg}: {{ prismatic: {{ between: [lower{leg}.end, upper{leg}], axis: {} }} }}
  head{leg}: {{ spherical: [upper{leg}.top, plate.h{leg}] }}\n",
                    triple([a, b, c])
                ),
            );
        }
        let (platform, text) = checked(&format!(
            "bodies:
  ground: {{ points: {{ {feet} }} }}
  plate: {{ mass: 5, inertia: 0.2, points: {{ {heads} }} }}
{bodies}joints:
{joints}initial: {{ plate.x: 0, plate.y: 0, plate.z: 0.7, plate.orientation: {{ quaternion: [1, 0, 0, 0] }} }}
outputs: {{ z: plate.z }}
"
        ));
        assert_eq!(mobility(&platform), [expected, expected, 0], "{text}");
        assert_eq!(platform["mobility"]["bodies"], 14);
        assert_eq!(platform["size"][2], 0.7);
    }
}

#[test]
fn drives_and_distant_points_are_reported() {
    let model = "bodies:
  ground: { points: { post: [0, 0.5], unused: [0, 9e5 m] } }
  cart: { mass: 2, inertia: 0.1, coordinates: [x] }
  shaken: { mass: 1, inertia: 0.1, coordinates: [angle], held: { x: 0.01*sin(t/(1 s)), y: 0.2 } }
  arm: { mass: 1, inertia: 0.1, points: { tip: [150 m, 0] } }
joints:
  pivot: { revolute: [ground.post, arm] }
  drive: { motor: { on: pivot, speed: 2 } }
effects:
  spring: { spring_damper: { between: [ground, cart], along: x, stiffness: 10, damping: 0, free_length: 0.1 } }
  air: { drag: { on: cart, linear: 1 } }
initial: { cart.x: 0.1, shaken.angle: 0 }
outputs: { x: cart.x, y: arm.tip.y, a: shaken.angle }
";
    let (found, text) = checked(model);
    // Three bodies with nine freedoms, three held; two drives are left to move one each.
    assert_eq!(mobility(&found), [4, 4, 0], "{text}");
    let count = |key: &str| found["mobility"][key].as_u64().unwrap();
    assert_eq!(["bodies", "joints", "held", "drives"].map(count), [4, 1, 3, 2], "{text}");
    assert!(text.contains("3·3 − 2 − 3 held = 4, as found; 2 of it driven\n  150 m × "), "{text}");
    assert!(text.ends_with("\n  2 drives, 1 spring_damper, 1 drag\n"), "{text}");
}
