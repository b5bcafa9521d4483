//! `--root`: files that a model names, of a folder next to its own.

use std::fs;

use super::place::Place;

const ARM: &str = r#"<mujoco><include file="../common/weight.xml"/><worldbody>
    <body name="arm"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"#;

const WEIGHT: &str = r#"<mujoco><option gravity="0 0 -3.7"/></mujoco>"#;

const CART: &str = "space: planar\nbodies: { cart: { mass: 1, coordinates: [x] } }\n\
    tables: { push: { file: ../common/push.csv } }\n\
    effects: { pushed: { force: { on: cart, value: [push(t/(1 s)), 0] } } }\n\
    outputs: { x: cart.x }\nsimulation: { duration: 0.1, step: 1e-2 }\n";

#[test]
fn models_name_files_below_the_root() {
    let place = Place::new();
    for folder in ["all/arm", "all/common", "elsewhere"] {
        fs::create_dir_all(place.path().join(folder)).unwrap();
    }
    for (name, text) in [
        ("all/arm/arm.xml", ARM),
        ("all/common/weight.xml", WEIGHT),
        ("all/arm/cart.yaml", CART),
        ("all/common/push.csv", "0,1\n1,2\n2,2\n"),
        (
            "all/arm/robot.yaml",
            "mjcf: ../arm/arm.xml\nparameters: { p: 1 ± 10% }\noutputs: { h: arm.z*p/p }\nsimulation: { duration: 0.1, step: 1e-2 }\n",
        ),
    ] {
        fs::write(place.path().join(name), text).unwrap();
    }
    for model in ["all/arm/arm.xml", "all/arm/cart.yaml"] {
        let (_, refused) = place.run(&format!("check {model}"), 2);
        assert!(refused.contains("is not within the model's folder") && refused.contains("--root DIR"), "{refused}");
        let (_, refused) = place.run(&format!("check {model} --root elsewhere"), 2);
        assert!(refused.contains("nor within `elsewhere`"), "{refused}");
        place.run(&format!("check {model} --root all"), 0);
    }
    // The included gravity acts: −3.7 m/s² · (0.1 s)² / 2.
    place.run("sample all/arm/robot.yaml --root all --design sobol:1 --output fall.csv", 0);
    let table = fs::read_to_string(place.path().join("fall.csv")).unwrap();
    let height: f64 = table.trim_end().rsplit(',').next().unwrap().parse().unwrap();
    assert!((height + 0.0185).abs() < 1e-9, "{table}");
    // Shards find the files again.
    place.run("plan all/arm/cart.yaml --root all --output study", 0);
    place.run("merge study --quiet --output merged", 0);
    assert!(fs::read_to_string(place.path().join("study/plan.json")).unwrap().contains("\"root\""));
}
