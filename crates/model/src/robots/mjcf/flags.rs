//! `<flag>`: which forces and constraints of the file act.

/// Kinds of forces and constraints, and whether they act.
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

    /// Flags after a `<flag>`; `is_off` says whether it disables a name. Every name is asked for, so that a wrong word
    /// is reported.
    pub fn after(self, is_off: &mut dyn FnMut(&str) -> bool) -> Self {
        let [passive, constraint] = ["passive", "constraint"].map(&mut *is_off);
        Self {
            gravity: self.gravity & !is_off("gravity"),
            springs: self.springs & !is_off("spring") && !passive,
            dampers: self.dampers & !is_off("damper") && !passive,
            equalities: self.equalities & !is_off("equality") && !constraint,
            friction: self.friction & !is_off("frictionloss") && !constraint,
            limits: self.limits & !is_off("limit") && !constraint,
            clamps_controls: self.clamps_controls & !is_off("clampctrl"),
            actuators: self.actuators & !is_off("actuation"),
        }
    }
}

/// Factor of a number: 1 if it acts, 0 if not.
pub fn on(acts: bool) -> f64 {
    f64::from(u8::from(acts))
}
