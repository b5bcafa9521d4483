//! The same bytes on a processor that cannot fuse a multiplication with an addition: there, the C library takes other
//! functions.

#![cfg(all(target_os = "linux", target_env = "gnu"))]

use std::fs;

use crate::place::Place;

#[test]
fn results_do_not_depend_on_fused_multiplications() {
    let place = Place::new();
    let robot = "<robot name=\"r\"><link name=\"base\"/><link name=\"a\"><inertial><origin xyz=\"0.12 0.02 0.03\" rpy=\"0.7213 0 0.4\"/>\
        <mass value=\"1.3\"/><inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.15\" ixy=\"0.01\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
        <joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"a\"/><origin xyz=\"0 0 0.2\" rpy=\"0.7429 0.31 -1.2347\"/>\
        <axis xyz=\"0 1 0\"/></joint></robot>";
    fs::write(place.path().join("r.urdf"), robot).unwrap();
    let robot = "urdf: r.urdf\neffects: { w: { gravity: { acceleration: [0, 0, -9.81] } } }\noutputs: { a: j.angle }\n\
        simulation: { duration: 0.05, step: 1e-3 }\n";
    // The rod's angle follows from two lengths.
    let crank = "parameters: { l: { value: 0.4321, unit: m, tolerance: 1% } }\n\
        bodies:\n  crank: { mass: 1, inertia: 0.01, points: { a: [-0.1234, 0], b: [0.1234, 0] } }\n  \
        rod: { mass: 1, inertia: 0.02, points: { a: [-l/2, 0], b: [l/2, 0] } }\n  slider: { mass: 2, coordinates: [x] }\n\
        joints: { p: { revolute: [ground, crank.a] }, q: { revolute: [crank.b, rod.a] }, r: { revolute: [rod.b, slider] } }\n\
        initial: { crank.angle: 0.7429, crank.angular_velocity: 1.1 }\noutputs: { x: slider.x, phi: rod.angle }\n\
        simulation: { duration: 0.05, step: 1e-3 }\n\
        bounds: { chebyshev: { order: 3 }, taylor: { order: 2 }, scan: { points: 5 } }\n";
    for (name, model) in [("robot", robot), ("crank", crank)] {
        fs::write(place.path().join(format!("{name}.yaml")), model).unwrap();
        place.run(&format!("run -q {name}.yaml -o with"), 0);
        let mut other = place.command(&format!("run -q {name}.yaml -o without"));
        let other = other.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F").output().unwrap();
        assert!(other.status.success(), "{other:?}");
        for file in place.files("with") {
            let [with, without] =
                ["with", "without"].map(|folder| fs::read(place.path().join(folder).join(&file)).unwrap());
            assert!(with == without, "{name}: {file} differs");
        }
    }
}
