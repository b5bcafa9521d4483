//! The mechanisms in which every element of the registries stands, with its example.

use mbint::inner::elements::JointKind;
use mbint::inner::model::EffectKind;

/// Bodies, points and joints that the examples name: for effects as in `explain --effects`, for joints as in their own
/// test. Bodies that only turn are omitted in space.
pub struct Mechanism {
    ground: &'static str,
    pub bodies: &'static [&'static str],
    pub turning: &'static [&'static str],
    points: fn(&str) -> &'static str,
    joints: &'static str,
    of_plane: &'static str,
    starts: &'static str,
    section: &'static str,
}

pub const OF_EFFECTS: Mechanism = Mechanism {
    ground: "",
    bodies: &["arm", "cart", "ball"],
    turning: &["pinion", "wheel", "spur", "rim"],
    points: |body| match body {
        "arm" => "pin: [-0.2, 0], tip: [0.2, 0], socket: [0.3, 2]",
        "cart" => "hook: [0.1, 0.1]",
        _ => "",
    },
    joints: "hinge: { revolute: [ground, arm.pin] }, rail: { prismatic: { between: [ground, cart], axis: x } }",
    of_plane: ", mesh: { gear: { between: [spur, rim], ratio: -0.5 } }",
    starts: "hinge.angle: 0, hinge.angular_velocity: 0.4, rail.displacement: 1, rail.velocity: -0.3",
    section: "effects",
};

const OF_EFFECTS_AT_REST: &str = "hinge.angle: 0, hinge.angular_velocity: 0, rail.displacement: 1, rail.velocity: 0";

pub const OF_JOINTS: Mechanism = Mechanism {
    ground: "beside: [0.05, 0.05]",
    bodies: &[
        "arm", "bead", "bob", "cart", "disc", "crank", "follower", "foot", "fork", "frame", "gear", "lever", "link",
        "nut", "puck", "rod", "shaft", "slider", "spindle",
    ],
    turning: &["wheel", "pinion"],
    points: |body| match body {
        "arm" => "P: [0.2, 0]",
        "crank" => "A: [-0.1, 0], P: [0.1, 0]",
        "foot" => "P: [0, -0.1]",
        "fork" => "A: [-0.1, 0]",
        "link" => "S: [0.1, 0]",
        "rod" => "A: [-0.2, 0]",
        "shaft" => "P: [0.1, 0]",
        _ => "",
    },
    joints: "axle: { revolute: [ground, gear] }, guide: { prismatic: { between: [ground, cart], axis: x } }, \
             pivot: { revolute: [ground, lever] }, thread: { revolute: THREAD }",
    of_plane: "",
    starts: "",
    section: "joints",
};

impl Mechanism {
    /// Text of a model of it alone with an element, in the plane or in space.
    pub fn text(&self, spatial: bool, keyword: &str, example: &str) -> String {
        let sections: String = self
            .assembly(spatial, keyword, example)
            .lines()
            .skip(2)
            .map(|line| format!("{}\n", line.strip_prefix("    ").unwrap_or(line)))
            .collect();
        let space = if spatial { "spatial" } else { "planar" };
        let run = "outputs: { energy: energy }\nsimulation: { duration: 0.1, step: 1e-3 }\n";
        format!("model: {keyword}\nspace: {space}\n{sections}{run}")
    }

    /// The assembly `all` with an element, in the plane or in space.
    pub fn assembly(&self, spatial: bool, keyword: &str, example: &str) -> String {
        let mut bodies = format!("      ground: {{ points: {{ {} }} }}\n", self.ground);
        for (index, body) in self.bodies.iter().enumerate() {
            let inertia = if spatial { "[0.02, 0.03, 0.04]" } else { "0.03" };
            bodies += &format!(
                "      {body}: {{ mass: {}, inertia: {inertia}, points: {{ {} }} }}\n",
                1.0 + 0.1 * index as f64,
                (self.points)(body)
            );
        }
        let turning = if spatial { &[] } else { self.turning };
        for body in turning {
            bodies += &format!("      {body}: {{ inertia: 0.01, coordinates: [angle] }}\n");
        }
        let it = format!("it: {{ {keyword}: {example} }}");
        let mut effects = String::new();
        for (index, body) in self.bodies.iter().enumerate() {
            let push = 1.0 + 0.3 * index as f64;
            effects += &format!(
                "push_{body}: {{ force: {{ on: {body}, value: [{push}, -0.7] }} }}, turn_{body}: {{ torque: {{ on: {body}, value: 0.02 }} }}, "
            );
        }
        for body in turning {
            effects += &format!("turn_{body}: {{ torque: {{ on: {body}, value: 0.02 }} }}, ");
        }
        let thread =
            if spatial { "{ between: [ground.beside, spindle], axis: x }" } else { "[ground.beside, spindle]" };
        let mut joints = self.joints.replace("THREAD", thread) + if spatial { "" } else { self.of_plane };
        match self.section {
            "joints" => joints += &format!(", {it}"),
            _ => effects += &it,
        }
        let starts = if self.starts.is_empty() {
            // The distance of a start from the guess weighs angles against lengths of the model's size, so that the
            // wheel's angle is given.
            let wheel = if spatial { "" } else { "wheel.angle: 0" };
            let index = if spatial { ["0.5, bob.z: 0", "0, follower.z: 0"] } else { ["0.5", "0.03"] };
            format!(
                "initial: {{ {} }}\n    guess: {{ bob.y: 0, bob.x: {}, follower.x: 0, follower.y: {} }}",
                wheel, index[0], index[1]
            )
        } else {
            let free = if spatial {
                "ball.z: 0, ball.vz: 0.1, ball.omega: [0.1, 0.2, 0.3]"
            } else {
                "ball.angle: 0.1, ball.angular_velocity: 0.3"
            };
            // A flexible body starts as a rigid one, and this one between two joints at rest.
            let rest = if keyword == "superelement" { OF_EFFECTS_AT_REST } else { self.starts };
            format!("initial: {{ {}, ball.x: 0.5, ball.y: 2, ball.vx: 0.2, ball.vy: -0.1, {free} }}", rest)
        };
        format!(
            "assemblies:\n  all:\n    bodies:\n{bodies}    joints: {{ {joints} }}\n    effects: {{ {effects} }}\n    {starts}\n"
        )
    }
}

/// Examples of effects, by their keywords.
pub fn effects() -> Vec<(&'static str, String)> {
    // Impacts of microseconds are nothing for these steps.
    EffectKind::docs().iter().map(|docs| (docs.keyword, docs.example.replace("1e9", "1e4"))).collect()
}

/// Examples of joints, by their keywords.
pub fn joints() -> Vec<(&'static str, String)> {
    JointKind::docs().iter().map(|docs| (docs.element.keyword, docs.element.example.to_owned())).collect()
}
