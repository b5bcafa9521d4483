//! Structure of a mechanism as an engineer counts it, for `mbint check`.

use crate::overview::{count, digits, significant};
use crate::results::{KindCount, MassRange, MobilityCount, Structure};

/// Lines for people: mobility, size and mass, acting effects.
pub(super) fn lines(structure: &Structure) -> String {
    let Structure { mobility, size, mass, .. } = structure;
    format!("  {}\n  {}, {}\n  {}\n", counted(mobility), extent(mobility, size), massed(mass), acting(structure))
}

/// `4 bodies with the ground, 4 joints: Grübler's count 3·3 − 8 = 1, as found`.
fn counted(mobility: &MobilityCount) -> String {
    let &MobilityCount { spatial, bodies, joints, constraints, held, drives, count: by_count, .. } = mobility;
    let (who, freedoms) = if spatial { ("Kutzbach's", 6) } else { ("Grübler's", 3) };
    let held = if held > 0 { format!(" − {held} held") } else { String::new() };
    let sum = format!("{freedoms}·{} − {constraints}{held} = {}", bodies - 1, by_count.to_string().replace('-', "−"));
    let found = match mobility.over_constrained {
        0 => "as found".to_owned(),
        over => format!("but the mobility is {}: over-constrained by {over}", mobility.mobility),
    };
    let driven = match (drives, drives == mobility.mobility) {
        (0, _) => String::new(),
        (_, true) => "; driven".to_owned(),
        _ => format!("; {drives} of it driven"),
    };
    let (bodies, joints) = (count(bodies, "body", "bodies"), count(joints, "joint", "joints"));
    format!("{bodies} with the ground, {joints}: {who} count {sum}, {found}{driven}")
}

/// `0.42 m × 0.2 m`
fn extent(mobility: &MobilityCount, size: &[f64; 3]) -> String {
    let axes = if mobility.spatial { 3 } else { 2 };
    let sides: Vec<String> = size[..axes].iter().map(|&side| format!("{} m", digits(side))).collect();
    format!("{} at the start", sides.join(" × "))
}

fn massed(mass: &MassRange) -> String {
    if mass.lower == mass.upper {
        return format!("{} kg", digits(mass.nominal));
    }
    // The fewest digits with which both ends differ from the middle, at most 12 for a narrow interval.
    let texts = |digits| [mass.nominal, mass.lower, mass.upper].map(|mass| significant(mass, digits));
    let differ = |[nominal, lower, upper]: &[String; 3]| nominal != lower && nominal != upper;
    let [nominal, lower, upper] = (4..12).map(texts).find(differ).unwrap_or_else(|| texts(12));
    format!("{nominal} kg (from {lower} to {upper} kg)")
}

/// Effects that pull, drive and resist.
fn acting(structure: &Structure) -> String {
    let counted = |kinds: &[KindCount]| {
        kinds.iter().map(|&KindCount { kind, count }| format!("{count} {kind}")).collect::<Vec<_>>()
    };
    let mut parts: Vec<String> =
        structure.gravity.filter(|g| g.iter().any(|&part| part != 0.0)).map(gravity).into_iter().collect();
    match structure.mobility.drives {
        0 => (),
        drives => parts.push(count(drives, "drive", "drives")),
    }
    parts.extend(counted(&structure.acting));
    let is_moved = !parts.is_empty();
    parts.extend(counted(&structure.resisting));
    let what = parts.join(", ");
    match (is_moved, structure.moves_at_start, what.is_empty()) {
        (true, ..) => what,
        (false, true, true) => "nothing pulls or drives it; it starts with a speed".to_owned(),
        (false, true, false) => format!("nothing pulls or drives it ({what}); it starts with a speed"),
        (false, false, true) => "nothing pulls or drives it: it stays at rest".to_owned(),
        (false, false, false) => format!("nothing pulls or drives it ({what}): it stays at rest"),
    }
}

/// `gravity 9.81 m/s² along −y`
fn gravity(acceleration: [f64; 3]) -> String {
    let along: Vec<usize> = (0..3).filter(|&axis| acceleration[axis] != 0.0).collect();
    match along[..] {
        [axis] => {
            let sign = if acceleration[axis] < 0.0 { "−" } else { "+" };
            format!("gravity {} m/s² along {sign}{}", digits(acceleration[axis].abs()), ["x", "y", "z"][axis])
        }
        _ => format!("gravity ({}) m/s²", acceleration.map(digits).join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mobility() -> MobilityCount {
        MobilityCount {
            spatial: false,
            bodies: 4,
            joints: 4,
            constraints: 8,
            held: 0,
            drives: 1,
            count: 1,
            mobility: 1,
            over_constrained: 0,
        }
    }

    #[test]
    fn mobility_is_counted_in_words() {
        assert_eq!(
            counted(&mobility()),
            "4 bodies with the ground, 4 joints: Grübler's count 3·3 − 8 = 1, as found; driven"
        );
        let bennett =
            MobilityCount { spatial: true, constraints: 20, drives: 0, count: -2, over_constrained: 3, ..mobility() };
        assert_eq!(
            counted(&bennett),
            "4 bodies with the ground, 4 joints: Kutzbach's count 6·3 − 20 = −2, but the mobility is 1: over-constrained by 3"
        );
        let held = MobilityCount { constraints: 6, held: 2, drives: 0, ..mobility() };
        assert!(counted(&held).contains("3·3 − 6 − 2 held = 1"));
    }

    #[test]
    fn mechanism_at_rest_is_described_as_such() {
        let mass = MassRange { nominal: 2.0, lower: 2.0, upper: 2.0 };
        let resisting = vec![KindCount { kind: "drag", count: 1 }];
        let mobility = MobilityCount { drives: 0, ..mobility() };
        let size = [150.0, 0.25, 0.0];
        let still = Structure {
            mobility,
            size,
            mass,
            gravity: Some([0.0; 3]),
            acting: vec![],
            resisting,
            moves_at_start: false,
        };
        assert_eq!(acting(&still), "nothing pulls or drives it (1 drag): it stays at rest");
        assert_eq!(extent(&mobility, &size), "150 m × 0.25 m at the start");
        let narrow = MassRange { nominal: 1.00096, lower: 1.00095, upper: 1.00097 };
        assert_eq!(massed(&narrow), "1.00096 kg (from 1.00095 to 1.00097 kg)");
        let pulled = Structure { gravity: Some([0.0, 9.81, 0.0]), ..still };
        assert_eq!(acting(&pulled), "gravity 9.81 m/s² along +y, 1 drag");
    }
}
