//! `<flag>`: which forces and constraints of the file act.

use super::document::Item;
use super::values::Values;

/// What acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flags {
    pub gravity: bool,
    pub springs: bool,
    pub dampers: bool,
    pub equalities: bool,
    pub friction: bool,
    pub limits: bool,
    pub clamps_controls: bool,
    pub actuators: bool,
}

impl Flags {
    /// Everything.
    pub const ALL: Self = Self {
        gravity: true,
        springs: true,
        dampers: true,
        equalities: true,
        friction: true,
        limits: true,
        clamps_controls: true,
        actuators: true,
    };

    /// What a file leaves on.
    pub fn of(root: &Item, values: &mut Values) -> Self {
        let mut flags = Self::ALL;
        for flag in root.of("option").flat_map(|option| option.of("flag")) {
            let mut is_off = |name| values.choice(flag, name, &[("enable", false), ("disable", true)]) == Some(true);
            let [passive, constraint] = ["passive", "constraint"].map(&mut is_off);
            flags.gravity &= !is_off("gravity");
            flags.springs &= !(is_off("spring") || passive);
            flags.dampers &= !(is_off("damper") || passive);
            flags.equalities &= !(is_off("equality") || constraint);
            flags.friction &= !(is_off("frictionloss") || constraint);
            flags.limits &= !(is_off("limit") || constraint);
            flags.clamps_controls &= !is_off("clampctrl");
            flags.actuators &= !is_off("actuation");
        }
        flags
    }
}

/// By what a number is multiplied that acts or does not.
pub fn on(acts: bool) -> f64 {
    f64::from(u8::from(acts))
}
