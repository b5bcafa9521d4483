//! The correction after a factorisation shares values with it: it is the one that computes them itself.

use mbint::inner::numerics::Sample;
use mbint::inner::simulate::Stepper;
use mbint::inner::study;

use crate::common::{load, model_files};

/// Over the first steps of every model, at w and λ off by 0.1 of their sizes: conditional effects are active in some
/// and not in others.
#[test]
fn first_correction_equals_the_general_correction() {
    let mut shorter = 0;
    for file in model_files() {
        let Ok(simulator) = study::prepare(load(&file).study().description()) else { continue };
        if simulator.system.analysis.is_without_steps() {
            continue;
        }
        let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let h = 1e-5;
        let start = simulator.assemble(4, h, |_| nominal.clone()).unwrap();
        let program = &simulator.program;
        let mut stepper = Stepper::new(program, &start);
        for step in 0..20 {
            stepper.step(h, f64::from(step + 1) * h);
            let mut tile = stepper.tile().clone();
            for (index, register) in program.layout.iterate.clone().chain(program.layout.lambda.clone()).enumerate() {
                for (lane, value) in tile.lane_mut(register).iter_mut().enumerate() {
                    *value *= 1.0 + 0.1 * ((index + 3 * lane) as f64).sin();
                }
            }
            tile.run(program.factor());
            let mut own = tile.clone();
            tile.run(program.first_correction());
            own.run(program.correct());
            let correction = program.layout.correction.clone();
            let size =
                correction.clone().flat_map(|register| own.lane(register)).fold(0.0, |size: f64, v| size.max(v.abs()));
            for register in correction {
                for (shared, own) in tile.lane(register).iter().zip(own.lane(register)) {
                    assert!((shared - own).abs() <= 1e-9 * size, "{}: {shared} {own} of {size}", file.display());
                }
            }
        }
        assert!(program.first_correction().len() <= program.correct().len(), "{}", file.display());
        shorter += usize::from(program.first_correction().len() < program.correct().len());
    }
    assert!(shorter >= 30, "{shorter}");
}
