//! Every element of the registries in an assembly: twins that are turned, mirrored, or carried along steadily move as
//! the original does.

use mbint::Model;
use mbint::results::Bounds;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use proptest::prelude::*;

use crate::common::registry::{Mechanism, OF_EFFECTS, OF_JOINTS, effects, joints};
use crate::common::{Subject, curve, nominal};

impl Mechanism {
    /// The model with these instances, of which all bodies are observed.
    fn with_twins(&self, spatial: bool, (keyword, example): (&str, &str), twins: &[Twin]) -> Result<Subject, String> {
        let mut instances = String::new();
        let mut outputs = String::new();
        for (index, twin) in twins.iter().enumerate() {
            instances += &format!("  i{index}: {{ of: all{} }}\n", twin.keys(spatial));
            for body in self.bodies {
                let letters: &[&str] =
                    if spatial { &["x", "y", "z", "omega.x", "omega.y", "omega.z"] } else { &["x", "y", "angle"] };
                for letter in letters {
                    outputs += &format!("  i{index}.{body}.{letter}: i{index}.{body}.{letter}\n");
                }
            }
            if !spatial {
                for body in self.turning {
                    outputs += &format!("  i{index}.{body}.angle: i{index}.{body}.angle\n");
                }
            }
        }
        let space = if spatial { "spatial" } else { "planar" };
        let text = format!(
            "space: {space}\n{}instances:\n{instances}outputs:\n{outputs}simulation: {{ duration: 0.04, step: 1e-3, extrapolation: 4, output_step: 0.01 }}\n",
            self.assembly(spatial, keyword, example)
        );
        Ok(Model::from_yaml_str("twins", &text).map_err(|wrong| wrong.to_string())?.into())
    }
}

/// An instance somewhere else.
#[derive(Clone, Copy, Debug)]
struct Twin {
    moved: [f64; 3],
    axis: [f64; 3],
    degrees: f64,
    mirror: Option<usize>,
}

const ORIGINAL: Twin = Twin { moved: [0.0; 3], axis: [0.0, 0.0, 1.0], degrees: 0.0, mirror: None };

impl Twin {
    fn keys(&self, spatial: bool) -> String {
        let [x, y, z] = self.moved;
        let [a, b, c] = self.axis;
        let mirror = self.mirror.map_or(String::new(), |axis| format!(", mirror: {}", ["x", "y", "z"][axis]));
        let at = match spatial {
            _ if self.degrees == 0.0 => String::new(),
            false => format!(", at: {{ position: [{x}, {y}], angle: {} deg }}", self.degrees),
            true => format!(
                ", at: {{ position: [{x}, {y}, {z}], rotation: {{ axis: [{a}, {b}, {c}], angle: {} deg }} }}",
                self.degrees
            ),
        };
        at + &mirror
    }

    /// R D
    fn image(&self) -> Matrix3<f64> {
        let turn =
            Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::from(self.axis)), self.degrees.to_radians());
        let signs = Vector3::from_fn(|axis, _| if self.mirror == Some(axis) { -1.0 } else { 1.0 });
        turn.matrix() * Matrix3::from_diagonal(&signs)
    }
}

const IN_PLANE: [Twin; 4] = [
    ORIGINAL,
    Twin { moved: [3.0, -2.0, 0.0], degrees: 40.0, ..ORIGINAL },
    Twin { moved: [1.0, 5.0, 0.0], degrees: -70.0, mirror: Some(0), ..ORIGINAL },
    Twin { moved: [-4.0, 1.0, 0.0], degrees: 25.0, mirror: Some(1), ..ORIGINAL },
];

const IN_SPACE: [Twin; 5] = [
    ORIGINAL,
    Twin { moved: [3.0, -2.0, 1.0], axis: [1.0, 2.0, -1.0], degrees: 50.0, mirror: None },
    Twin { moved: [1.0, 5.0, 0.5], axis: [0.3, -1.0, 0.4], degrees: -70.0, mirror: Some(0) },
    Twin { moved: [-4.0, 1.0, 2.0], axis: [-1.0, 0.2, 0.6], degrees: 25.0, mirror: Some(1) },
    Twin { moved: [-1.0, 3.0, -2.0], axis: [0.5, 0.5, 1.0], degrees: 110.0, mirror: Some(2) },
];

/// Compares an instance with the first one, row by row.
fn compare(mechanism: &Mechanism, spatial: bool, bounds: &Bounds, index: usize, twin: &Twin, what: &str) {
    let image = twin.image();
    let sign = image.determinant().signum();
    let rows = bounds.times.len();
    let value = |instance: usize, body: &str, letter: &str, row: usize| {
        curve(bounds, &format!("i{instance}.{body}.{letter}"))[row]
    };
    let close = |found: f64, wanted: f64, of: &str| {
        assert!(
            (found - wanted).abs() < 1e-7 * (1.0 + wanted.abs()),
            "{what}: {of} of twin {index} is {found}, not {wanted}"
        );
    };
    for row in 0..rows {
        for body in mechanism.bodies {
            let vector = |instance: usize, letters: [&str; 3]| {
                Vector3::from_iterator(
                    letters.map(|letter| if letter.is_empty() { 0.0 } else { value(instance, body, letter, row) }),
                )
            };
            let letters = ["x", "y", if spatial { "z" } else { "" }];
            let wanted = image * vector(0, letters) + Vector3::from(twin.moved);
            (0..if spatial { 3 } else { 2 }).for_each(|axis| close(vector(index, letters)[axis], wanted[axis], body));
            if spatial {
                let letters = ["omega.x", "omega.y", "omega.z"];
                let wanted = sign * (image * vector(0, letters));
                (0..3).for_each(|axis| close(vector(index, letters)[axis], wanted[axis], body));
            }
        }
        for body in mechanism.bodies.iter().chain(mechanism.turning).filter(|_| !spatial) {
            let wanted = sign * value(0, body, "angle", row) + twin.degrees.to_radians();
            close(value(index, body, "angle", row), wanted, body);
        }
    }
}

/// Twins of one example in the plane or in space: the number of twins that were compared, and of those the mirrored
/// ones; `None` where the example is of the other space.
fn twins_of(
    mechanism: &Mechanism,
    spatial: bool,
    example: (&str, &str),
    twins: &[Twin],
    refused: &[(&str, &str)],
) -> Option<[usize; 2]> {
    mechanism.with_twins(spatial, example, &[ORIGINAL]).ok()?;
    let what = format!("{} {}", example.0, if spatial { "in space" } else { "in the plane" });
    let mut chosen = twins.to_vec();
    for (_, words) in refused.iter().filter(|(keyword, _)| *keyword == example.0) {
        let (kept, out): (Vec<_>, Vec<_>) =
            chosen.into_iter().partition(|twin| mechanism.with_twins(spatial, example, &[ORIGINAL, *twin]).is_ok());
        for twin in out {
            let message = mechanism.with_twins(spatial, example, &[twin]).err().unwrap_or_default();
            assert!(message.contains(words), "{what}: {message}");
        }
        chosen = kept;
    }
    let description = mechanism.with_twins(spatial, example, &chosen).unwrap_or_else(|wrong| panic!("{what}: {wrong}"));
    let bounds = nominal(&description);
    for (index, twin) in chosen.iter().enumerate().skip(1) {
        compare(mechanism, spatial, &bounds, index, twin, &what);
    }
    Some([chosen.len() - 1, chosen.iter().filter(|twin| twin.mirror.is_some()).count()])
}

/// Twins of the examples; the number of examples in the plane and in space, and of mirrored twins.
fn twins(mechanism: &Mechanism, examples: &[(&str, &str)], refused: &[(&str, &str)]) -> [usize; 3] {
    let mut compared = [0; 3];
    for &example in examples {
        let before = compared;
        for (spatial, twins) in [(false, &IN_PLANE[..]), (true, &IN_SPACE)] {
            if let Some([_, mirrored]) = twins_of(mechanism, spatial, example, twins, refused) {
                compared[usize::from(spatial)] += 1;
                compared[2] += mirrored;
            }
        }
        assert!(compared != before || refused.contains(&(example.0, "every body")), "{} is in no mechanism", example.0);
    }
    compared
}

/// Effects without an image in some instances, with the words of the message.
const REFUSED_EFFECTS: [(&str, &str); 3] =
    [("gravity", "every body"), ("superelement", "`matrices`"), ("tyre", "level ground")];

/// Joints without an image in some instances, with the words of the message.
const REFUSED_JOINTS: [(&str, &str); 1] = [("cam", "`lift`")];

fn borrowed<'e>(examples: &'e [(&'static str, String)]) -> Vec<(&'static str, &'e str)> {
    examples.iter().map(|(keyword, example)| (*keyword, example.as_str())).collect()
}

#[test]
#[ignore = "2 s"]
fn twins_of_every_effect_move_equally() {
    let [plane, space, mirrored] = twins(&OF_EFFECTS, &borrowed(&effects()), &REFUSED_EFFECTS);
    assert!(plane >= 28 && space >= 18 && mirrored >= 105, "{plane} {space} {mirrored}");
}

#[test]
#[ignore = "4 s"]
fn twins_of_every_joint_move_equally() {
    let [plane, space, mirrored] = twins(&OF_JOINTS, &borrowed(&joints()), &REFUSED_JOINTS);
    assert!(plane >= 12 && space >= 15 && mirrored >= 60, "{plane} {space} {mirrored}");
}

/// An instance anywhere, turned by any angle about any axis, mirrored or not. In the plane the axis is z.
fn any_twin(spatial: bool) -> impl Strategy<Value = Twin> {
    let place = [-5.0..5.0, -5.0..5.0, -5.0..5.0_f64];
    let axis = [-1.0..1.0, -1.0..1.0, 0.1..1.0_f64];
    let mirror = proptest::option::of(0..if spatial { 3 } else { 2_usize });
    (place, axis, -180.0..180.0_f64, mirror).prop_map(move |(moved, axis, degrees, mirror)| match spatial {
        true => Twin { moved, axis, degrees, mirror },
        false => Twin { moved: [moved[0], moved[1], 0.0], degrees, mirror, ..ORIGINAL },
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, max_shrink_iters: 8, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn twin_at_any_position_moves_equally(
        index in any::<prop::sample::Index>(),
        in_plane in any_twin(false),
        in_space in any_twin(true),
    ) {
        let (effects, joints) = (effects(), joints());
        let index = index.index(effects.len() + joints.len());
        let (mechanism, (keyword, example), refused) = match effects.get(index) {
            Some(effect) => (&OF_EFFECTS, effect, &REFUSED_EFFECTS[..]),
            None => (&OF_JOINTS, &joints[index - effects.len()], &REFUSED_JOINTS[..]),
        };
        for (spatial, twin) in [(false, in_plane), (true, in_space)] {
            twins_of(mechanism, spatial, (keyword, example), &[ORIGINAL, twin], refused);
        }
    }
}
