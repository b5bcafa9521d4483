//! The part of URDF that decides how a robot moves: elements, their attributes, and which of their numbers may be
//! uncertain.
//!
//! From <http://wiki.ros.org/urdf/XML>, with URDF 1.1 (`quat_xyzw`) and 1.2 (`acceleration`, `deceleration`, `jerk`).

use super::robot::UrdfJointType;

/// An element of the format.
pub struct Rule {
    pub tag: &'static str,
    pub attributes: &'static [Attribute],
    /// Elements in it that decide the motion.
    pub elements: &'static [&'static Rule],
    /// Whether there may be several.
    pub repeats: bool,
    /// The value of all attributes where urdf-rs wants the element and the file does not have it.
    pub absent: Option<&'static str>,
    /// Elements in it that do not: appearance, sensors, other programs' settings.
    pub others: &'static [&'static str],
    /// Numbers of which an `mbint:` attribute says how uncertain they are.
    pub uncertain: &'static [&'static str],
}

/// An attribute without prefix.
pub struct Attribute {
    pub name: &'static str,
    pub shape: AttributeContent,
    /// Replacement of a wrong value; NaN if no other value would do, as it satisfies no further check.
    pub instead: &'static str,
    pub absent: Absent,
}

/// Content of an attribute.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum AttributeContent {
    Text,
    /// One of these.
    Word(&'static [&'static str]),
    /// This many numbers.
    Numbers(usize),
}

/// Treatment of an absent attribute.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// The format's default.
    Default,
    /// As if the value were `instead`.
    Instead,
    /// An error.
    Error,
}

const fn text(name: &'static str, instead: &'static str) -> Attribute {
    // A missing text is reported with the name of its link or joint.
    Attribute { name, shape: AttributeContent::Text, instead, absent: Absent::Instead }
}

const fn number(name: &'static str, instead: &'static str, absent: Absent) -> Attribute {
    numbers(name, 1, instead, absent)
}

const fn numbers(name: &'static str, count: usize, instead: &'static str, absent: Absent) -> Attribute {
    Attribute { name, shape: AttributeContent::Numbers(count), instead, absent }
}

const EMPTY: Rule =
    Rule { tag: "", attributes: &[], elements: &[], repeats: false, absent: None, others: &[], uncertain: &[] };

pub const ROBOT: Rule = Rule {
    tag: "robot",
    attributes: &[text("name", "robot"), text("version", "1.0")],
    elements: &[&LINK, &JOINT],
    others: &["material", "transmission", "gazebo", "sensor", "ros2_control", "mujoco"],
    ..EMPTY
};

const LINK: Rule = Rule {
    tag: "link",
    attributes: &[text("name", "")],
    elements: &[&INERTIAL],
    repeats: true,
    others: &["visual", "collision", "contact", "sensor", "material", "gazebo", "verbose", "self_collision_checking"],
    ..EMPTY
};

const INERTIAL: Rule = Rule { tag: "inertial", elements: &[&ORIGIN, &MASS, &INERTIA], ..EMPTY };

const ORIGIN: Rule = Rule {
    tag: "origin",
    attributes: &[
        numbers("xyz", 3, "0 0 0", Absent::Default),
        numbers("rpy", 3, "0 0 0", Absent::Default),
        numbers("quat_xyzw", 4, "0 0 0 1", Absent::Default),
    ],
    uncertain: &["x", "y", "z", "roll", "pitch", "yaw"],
    ..EMPTY
};

const MASS: Rule = Rule {
    tag: "mass",
    attributes: &[number("value", "NaN", Absent::Error)],
    absent: Some("NaN"),
    uncertain: &["mass"],
    ..EMPTY
};

const INERTIA: Rule = Rule {
    tag: "inertia",
    attributes: &[
        number("ixx", "NaN", Absent::Error),
        number("iyy", "NaN", Absent::Error),
        number("izz", "NaN", Absent::Error),
        number("ixy", "0", Absent::Instead),
        number("ixz", "0", Absent::Instead),
        number("iyz", "0", Absent::Instead),
    ],
    absent: Some("0"),
    uncertain: &["xx", "yy", "zz", "xy", "xz", "yz"],
    ..EMPTY
};

const TYPE: Attribute = Attribute {
    name: "type",
    shape: AttributeContent::Word(&UrdfJointType::WORDS),
    instead: "fixed",
    absent: Absent::Instead,
};

const JOINT: Rule = Rule {
    tag: "joint",
    attributes: &[text("name", ""), TYPE],
    elements: &[&ORIGIN, &PARENT, &CHILD, &AXIS, &LIMIT, &DYNAMICS, &MIMIC],
    repeats: true,
    others: &["calibration", "safety_controller", "gazebo", "hardwareInterface"],
    ..EMPTY
};

const PARENT: Rule = Rule { tag: "parent", attributes: &[text("link", "")], absent: Some(""), ..EMPTY };
const CHILD: Rule = Rule { tag: "child", attributes: &[text("link", "")], absent: Some(""), ..EMPTY };
const AXIS: Rule = Rule { tag: "axis", attributes: &[numbers("xyz", 3, "1 0 0", Absent::Instead)], ..EMPTY };

const LIMIT: Rule = Rule {
    tag: "limit",
    attributes: &[
        number("lower", "-inf", Absent::Default),
        number("upper", "inf", Absent::Default),
        number("effort", "inf", Absent::Instead),
        // urdf-rs wants it before URDF 1.2; many files do not have it.
        number("velocity", "inf", Absent::Instead),
        number("acceleration", "inf", Absent::Default),
        number("deceleration", "inf", Absent::Default),
        number("jerk", "inf", Absent::Default),
    ],
    uncertain: &["lower", "upper", "effort", "velocity"],
    ..EMPTY
};

const DYNAMICS: Rule = Rule {
    tag: "dynamics",
    attributes: &[number("damping", "0", Absent::Default), number("friction", "0", Absent::Default)],
    uncertain: &["damping", "friction"],
    ..EMPTY
};

const MIMIC: Rule = Rule {
    tag: "mimic",
    attributes: &[
        text("joint", ""),
        number("multiplier", "1", Absent::Default),
        number("offset", "0", Absent::Default),
    ],
    ..EMPTY
};
