//! `mbint explain --joints`: every joint of the language, from its own file.

use super::effects::element;
use crate::elements::JointKind;
use crate::overview::{Align, Table};

/// All joints, for people.
pub(super) fn text() -> String {
    let mut text = String::new();
    for joint in JointKind::docs() {
        text += &element(&joint.element);
        let mut rows = Table::new([("", Align::Left); 2]);
        for row in joint.rows {
            let name = if row.name.is_empty() { "its constraint" } else { row.name };
            rows.row([format!("{name}, {}", row.unit), format!("λ: {}", row.multiplier)]);
        }
        text += &format!("  Constraints and their multipliers:\n{}\n", rows.render(4));
    }
    text + "Reactions, observed as `joint.force` and `joint.torque`, are those on the second body, in the ground's axes, the\n\
            torque about the second point; the first body has the opposite at the same place. A = first, B = second point.\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_joint_is_documented_completely() {
        let plain = crate::overview::plain(&text());
        for joint in JointKind::docs() {
            let docs = &joint.element;
            assert!(plain.contains(docs.description), "{}", docs.keyword);
            assert!(!docs.formulas.is_empty() && !joint.rows.is_empty(), "{}", docs.keyword);
            assert!(docs.keys.iter().all(|key| !key.description.is_empty()), "{}", docs.keyword);
        }
    }

    #[test]
    fn a_joint_reads_well() {
        let plain = crate::overview::plain(&text());
        let gear = plain.split("\n\n").find(|part| part.starts_with("gear ")).unwrap();
        insta::assert_snapshot!(gear, @r"
        gear  Angles in a fixed ratio: angle of the second = ratio * angle of the first + offset.
          φ₂ − ratio φ₁ − offset = 0
          with a pressure angle: F = F_t t + |F_t| tan α/cos β m − F_t tan β g at the pitch point, F_t = τ₂/r₂
          Source: Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4.
          Example: { between: [pinion, wheel], ratio: -0.5 }
            between *       Two bodies (their angles about z) or two joints.
            ratio *         Angle of the second per angle of the first; negative for external gears.
            offset          Angle of the second where that of the first is zero, rad; by default 0.
            pressure_angle  Pressure angle of the teeth across their direction, e.g. `20 deg`; with it, bearings feel the teeth, rad; by default the torque alone is known, and bearings that the teeth push on have no known reactions.
            helix_angle     Helix angle: of the first gear's teeth against its axis, or of a bevel gear's against the cone; positive for a right-handed gear, rad; by default 0.
            face            Where the middle of the teeth is along the first joint's axis, from that joint's point; of parallel axes, m; by default 0.
            cone_distance   Distance from the point where the axes intersect to the middle of the teeth of bevel gears, m.
          Constraints and their multipliers:
            its constraint, rad  λ: N m: −λ is the torque on the second, +ratio λ that on the first
        ");
    }
}
