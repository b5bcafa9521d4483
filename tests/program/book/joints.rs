//! `docs/reference/joints.md`: every joint with its keys, equations and multipliers, from the joints' own files.

/// The page.
pub fn page() -> String {
    let mut page = "# Joints\n\nMade from the joints' own files: `MBINT_UPDATE_DOCS=1 cargo test --test program book` writes it, and \
        `mbint explain --joints` prints the same.\nKeys marked with * are required.\n\n\
        A is the first point of `between`, B the second; r is a position in the ground's frame, e the vector part of the\n\
        rotation of the second point's frame against the first's. The equations of motion are M w = Q − Φ_qᵀ λ.\n\
        The outputs `joint.force` (its magnitude), `joint.force.x`, …, N, and `joint.torque`, `joint.torque.x`, …, N m, are the\n\
        reaction on the second body in the ground's axes, the torque about B; the first body has the opposite at the same place.\n\
        Joints that turn have `angle` (rad), `angular_velocity` and `angular_acceleration` about their axis; joints that slide have\n\
        `displacement` (m), `velocity` and `acceleration` along it: of the second frame against the first.\n"
        .to_owned();
    for joint in mbint::inner::elements::JointKind::docs() {
        let docs = joint.element;
        page +=
            &format!("\n## {}\n\n{}\n\n```text\n{}\n```\n\n", docs.keyword, docs.description, docs.formulas.join("\n"));
        if !docs.keys.is_empty() {
            page += "| key | |\n|---|---|\n";
            for key in &docs.keys {
                let star = if key.required { " *" } else { "" };
                page += &format!("| `{}`{star} | {} |\n", key.name, key.description);
            }
            page.push('\n');
        }
        page += "| constraint | residual | multiplier λ |\n|---|---|---|\n";
        for row in joint.rows {
            let name = if row.name.is_empty() { "the joint's own".to_owned() } else { format!("`{}`", row.name) };
            page += &format!("| {name} | {} | {} |\n", row.unit, row.multiplier.replace('|', "\\|"));
        }
        page += &format!(
            "\nExample: `{}: {}`. Source: {}.\n",
            docs.keyword,
            docs.example,
            docs.source.trim_end_matches('.')
        );
    }
    page
}
