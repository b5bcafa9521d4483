//! The examples in the documentation of joints are run. (Those of effects are run where their costs are counted.)

use mbint::Model;

use crate::common::registry::joints;
use crate::common::{Subject, nominal};

/// Mechanism that the examples of joints name, each body by itself.
const MECHANISM: &str = "
space: SPACE
bodies:
  ground: { points: { beside: [0.05, 0.05] } }
  arm: { mass: 1, inertia: 0.01, points: { P: [0.2, 0] } }
  bead: { mass: 1, inertia: 0.01 }
  bob: { mass: 1, inertia: 0.01 }
  cart: { mass: 1, inertia: 0.01 }
  disc: { mass: 1, inertia: 0.01 }
  crank: { mass: 1, inertia: 0.01, points: { A: [-0.1, 0], P: [0.1, 0] } }
  follower: { mass: 1, inertia: 0.01 }
  foot: { mass: 1, inertia: 0.01, points: { P: [0, -0.1] } }
  fork: { mass: 1, inertia: 0.01, points: { A: [-0.1, 0] } }
  frame: { mass: 1, inertia: 0.01 }
  gear: { mass: 1, inertia: 0.01 }
  lever: { mass: 1, inertia: 0.01 }
  link: { mass: 1, inertia: 0.01, points: { S: [0.1, 0] } }
  nut: { mass: 1, inertia: 0.01 }
  puck: { mass: 1, inertia: 0.01 }
  rod: { mass: 1, inertia: 0.01, points: { A: [-0.2, 0] } }
  shaft: { mass: 1, inertia: 0.01, points: { P: [0.1, 0] } }
  slider: { mass: 1, inertia: 0.01 }
  spindle: { mass: 1, inertia: 0.01 }
  wheel: { inertia: 0.02, coordinates: [angle] }
  pinion: { inertia: 0.01, coordinates: [angle] }
joints:
  axle: { revolute: [ground, gear] }
  guide: { prismatic: { between: [ground, cart], axis: x } }
  pivot: { revolute: [ground, lever] }
  thread: { revolute: THREAD }
  it: { KEYWORD: EXAMPLE }
guess: { bob.x: 0.5, follower.y: 0.03 }
outputs: { energy: kinetic_energy }
simulation: { duration: 0.02, step: 1e-3 }
";

/// The example in the plane or else in space.
fn with(keyword: &str, example: &str) -> Subject {
    let text = MECHANISM.replace("KEYWORD", keyword).replace("EXAMPLE", example);
    let read = |space: &str, thread: &str| {
        Model::from_yaml_str("example", &text.replace("SPACE", space).replace("THREAD", thread))
    };
    read("planar", "[ground.beside, spindle]")
        .or_else(|_| read("spatial", "{ between: [ground.beside, spindle], axis: x }"))
        .unwrap_or_else(|wrong| panic!("{keyword}: {wrong}"))
        .into()
}

#[test]
fn every_example_of_a_joint_is_run() {
    let examples = joints();
    assert!(examples.len() >= 16);
    for (keyword, example) in examples {
        let bounds = nominal(&with(keyword, &example));
        assert!(bounds.outputs[0].nominal.iter().all(|energy| energy.is_finite()), "{keyword}");
    }
}
