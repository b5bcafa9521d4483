//! The half car in space: its mirror, and samples of its 65 parameters, which no scan can have.

use mbint::Model;

use crate::common::random::Random;
use crate::common::{curve, nominal, read};

/// Without bumps both sides are alike.
#[test]
fn the_half_car_does_not_roll_on_a_level_road() {
    let text = include_str!("../../models/half_car.yaml").replace("bump_h:   { value: 40,", "bump_h:   { value: 0,");
    let bounds = nominal(&read(&text));
    assert!(curve(&bounds, "roll").iter().all(|roll| roll.abs() < 1e-9));
    assert!(curve(&bounds, "height").iter().any(|height| (height - 0.52).abs() > 1e-4), "it settles on its springs");
}

/// Corners of the box are the worst samples of monotonic outputs: the samples are corners drawn at random, and points
/// inside. They are simulated in joint coordinates, with half of the model's steps.
#[test]
#[ignore = "5 s"]
fn samples_of_the_half_car_lie_within_its_bounds() {
    const SAMPLES: u32 = 200;
    let text = include_str!("../../models/half_car.yaml");
    let model = Model::from_yaml_str("half_car", text).unwrap();
    let ranges: Vec<[f64; 2]> = model.uncertain().map(|(_, range)| range).collect();
    assert_eq!(ranges.len(), 65);
    let mut random = Random(2007);
    let mut point = |is_corner: bool| -> Vec<f64> {
        let share = |random: f64| if is_corner { random.round() } else { random };
        ranges.iter().map(|[lower, upper]| lower + share(random.uniform()) * (upper - lower)).collect()
    };
    let points: Vec<Vec<f64>> = (0..SAMPLES).map(|sample| point(sample % 2 == 0)).collect();
    let finer = text.replace("step: 2e-3,", "formulation: joint, step: 1e-3,");
    assert_ne!(finer, text);
    let samples = Model::from_yaml_str("half_car", &finer).unwrap().study().sample(&points).unwrap();
    assert_eq!((samples.not_assembled(), samples.stopped()), (0, 0));
    let result = model.study().run().unwrap();
    for output in result.outputs() {
        let band = output.bands().next().unwrap();
        for point in 0..points.len() {
            let course = samples.course(point, output.name()).unwrap();
            for (row, value) in course.iter().enumerate() {
                assert!(band.is_reliable(row), "{} in row {row}", output.name());
                let error = band.errors()[row];
                let is_within = (band.lower()[row] - error..=band.upper()[row] + error).contains(value);
                assert!(is_within, "{} in row {row}: {value} is beyond the bounds", output.name());
            }
        }
    }
}
