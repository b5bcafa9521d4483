//! `witness.NAME.csv`: the functions of excitations under which an output or a reduced output moves farthest, or a
//! requirement fails.

use crate::grammar::display_unit::ShownUnit;
use crate::model::deviation_of;
use crate::results::{FunctionWitness, ParameterSummary};

use super::csv::number;

/// A table with a column for each excitation, which `mbint run --witness` replays and `tables` read (`interpolation:
/// linear`). Comments name the output, and give the values of parameters.
pub fn function_witness_csv(witness: &FunctionWitness, parameters: &[ParameterSummary]) -> String {
    let unit = ShownUnit::of(&witness.display, &witness.unit);
    let value = number(unit.of_si(witness.value));
    let time = witness.time.map_or_else(String::new, |time| format!(" at t = {} s", number(time)));
    let value = format!("{value} {}", unit.text);
    let mut text = format!("# {} is {}{time} under these functions\n", witness.name, value.trim_end());
    for (parameter, value) in parameters.iter().zip(&witness.parameters) {
        // Constant deviations of these excitations have no value here.
        let is_excitation = witness.functions.iter().any(|own| parameter.name == deviation_of(&own.name));
        if !is_excitation {
            text += &format!("# parameter {} = {}\n", parameter.name, number(*value));
        }
    }
    text += "t";
    witness.functions.iter().for_each(|own| text += &format!(",{}", own.name));
    text += "\n";
    let mut times: Vec<f64> =
        witness.functions.iter().flat_map(|own| own.points.iter().map(|(time, _)| *time)).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    for time in times {
        text += &number(time);
        witness.functions.iter().for_each(|own| text += &format!(",{}", number(at(&own.points, time))));
        text += "\n";
    }
    text
}

/// The value at a time, on the straight line between the points around it.
fn at(points: &[(f64, f64)], time: f64) -> f64 {
    let after = points.partition_point(|(own, _)| *own < time);
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (_, Some(&(own, value))) if own == time => value,
        (Some((from, a)), Some(&(to, b))) => a + (b - a) * (time - from) / (to - from),
        (Some((_, value)), None) | (None, Some(&(_, value))) => value,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::WitnessFunction;

    #[test]
    fn functions_share_their_times() {
        let function =
            |name: &str, points: &[(f64, f64)]| WitnessFunction { name: name.into(), points: points.to_vec() };
        let functions = vec![function("road", &[(0.0, 0.0), (2.0, 1.0)]), function("gust", &[(0.0, 5.0), (1.0, 5.0)])];
        let witness = FunctionWitness {
            name: "x".into(),
            unit: "m".into(),
            display: None,
            output: Some(0),
            time: Some(2.0),
            value: 0.5,
            parameters: vec![3.0, 0.0],
            functions,
        };
        let parameter = |name: &str| ParameterSummary {
            name: name.into(),
            unit: String::new(),
            display: None,
            nominal: 1.0,
            lower: 0.0,
            upper: 4.0,
        };
        let text = function_witness_csv(&witness, &[parameter("k"), parameter("road.deviation")]);
        let expected =
            "# x is 0.5 m at t = 2 s under these functions\n# parameter k = 3\nt,road,gust\n0,0,5\n1,0.5,5\n2,1,5\n";
        assert_eq!(text, expected);
    }
}
