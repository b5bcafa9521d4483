//! Joints, couplings and motors.

use schemars::JsonSchema;

use super::*;

grammar! {
    /// A joint: one kind with its details.
    Joint is "a joint" with "minProperties" = 1 with "maxProperties" = 1 {
        /// Two points coincide, and the bodies turn about an axis against one another.
        revolute: Option<OrBetween<AboutAxis>>,
        /// The second point moves along a line through the first, without turning against the first body.
        prismatic: Option<Prismatic>,
        /// Two points coincide and the bodies do not turn against one another.
        fixed: Option<OrBetween<Fixed>>,
        /// The second point moves along a line through the first, fixed in the first body; it may turn about z.
        pin_in_slot: Option<PinInSlot>,
        /// The second point moves along an axis through the first, and the bodies turn about it.
        cylindrical: Option<OrBetween<AboutAxis>>,
        /// A cylindrical joint that advances as it turns.
        screw: Option<Screw>,
        /// Two points coincide.
        spherical: Option<OrBetween<Between>>,
        /// Two points coincide, and an axis of the first frame stays perpendicular to one of the second.
        universal: Option<OrBetween<Universal>>,
        /// The second point moves in a plane through the first, and the bodies turn about its normal.
        planar: Option<OrBetween<InPlane>>,
        /// The second point moves along a line through the first, fixed in the first body.
        point_on_line: Option<PinInSlot>,
        /// The second point moves in a plane through the first, fixed in the first body.
        point_on_plane: Option<OrBetween<InPlane>>,
        /// Two points keep their distance.
        distance: Option<Distance>,
        /// Angles in a fixed ratio: angle of the second = ratio * angle of the first + offset.
        gear: Option<Gear>,
        /// A displacement in a fixed ratio to an angle: displacement of the rack = radius * angle of the pinion + offset.
        rack: Option<Rack>,
        /// A joint's coordinate moves as is prescribed.
        motor: Option<Motor>,
        /// `left = right` between coordinates, parameters and t, e.g. `crank.angle = omega*t`.
        equation: Option<String>,
    }

    /// Two points.
    Between is "a spherical joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
    }

    /// A joint that turns about an axis.
    AboutAxis is "a joint about an axis" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        axis: Option<Direction>,
    }

    /// A screw joint.
    Screw is "a screw joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        axis: Option<Direction>,
        /// Advance of the second point in a turn, m; positive for a right-handed thread.
        pitch: Number,
    }

    /// A universal joint.
    Universal is "a universal joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// The arms of the cross: one in the first point's frame, one in the second's; by default [x, y].
        axes: Option<[Direction; 2]>,
    }

    /// A joint that keeps a point in a plane.
    InPlane is "a joint on a plane" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        normal: Option<Direction>,
    }

    /// A prismatic joint.
    Prismatic is "a prismatic joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in the first body's frame.
        axis: Direction,
        /// Angle of the second body against the first, rad; by default 0.
        angle: Option<Number>,
    }

    /// A fixed joint.
    Fixed is "a fixed joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Angle of the second body against the first, rad; by default 0.
        angle: Option<Number>,
    }

    /// A pin in a slot.
    PinInSlot is "a pin in a slot" {
        /// A point of the slot's line, then the pin; each `body.point` or `body`.
        between: [String; 2],
        /// Direction of the slot in the first body's frame.
        axis: Direction,
    }

    /// A massless rod between two points.
    Distance is "a distance joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// m
        length: Number,
    }

    /// A rack and pinion.
    Rack is "a rack" {
        /// The joint about which the pinion turns.
        pinion: String,
        /// The joint along which the rack slides.
        rack: String,
        /// m a radian; negative where the rack goes against the angle.
        radius: Number,
        /// m; by default 0.
        offset: Option<Number>,
    }

    /// A prescribed motion; one of `position`, `speed` and `to` says which.
    Motor is "a motor" {
        /// A revolute, prismatic, cylindrical or screw joint.
        on: String,
        /// Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
        coordinate: Option<JointCoordinateName>,
        /// The coordinate over time, rad or m: a formula of t, twice differentiable.
        position: Option<Number>,
        /// rad/s or m/s: from the beginning, also as a formula of t, or, with a `profile`, from rest within the `duration`.
        speed: Option<Number>,
        /// Where a move from rest to rest ends, rad or m.
        to: Option<Number>,
        /// Where the motion begins, rad or m; by default 0.
        from: Option<Number>,
        /// How the coordinate (of a move) or the speed (of a run-up) gets from the one to the other.
        profile: Option<ProfileName>,
        /// s; by default 0.
        start: Option<Number>,
        /// s
        duration: Option<Number>,
        /// Part of the duration that a trapezoidal profile takes to its full rate, and again to rest; by default 0.25.
        ramp: Option<Number>,
    }

    /// A gear pair.
    Gear is "a gear" {
        /// Two bodies (their angles about z) or two joints.
        between: [String; 2],
        /// Angle of the second per angle of the first; negative for external gears.
        ratio: Number,
        /// rad; by default 0.
        offset: Option<Number>,
    }
}
