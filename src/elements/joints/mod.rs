//! Joints, one file each: what a joint is between, what it leaves free, and what follows for the other stages.
//!
//! A joint is between two points A and B with frames. Axes are directions in both frames alike (any length but zero):
//! where the joint's angle is zero, the frames' axes are parallel.
//!
//! To add a joint: its file here and its line in [`joints!`]. No other stage names a kind of joint: each asks for a
//! capability of the trait [`Joint`].

mod capabilities;

pub use capabilities::{Joint, Mobilizer, Orientation, Placement, Separation};

/// Declares the joints: their modules, the closed enum of them, and its dispatch to [`Joint`].
macro_rules! joints {
    ($($module:ident::$Kind:ident,)*) => {
        $(mod $module; pub use $module::$Kind;)*

        /// A joint with its details.
        #[derive(Clone, Debug)]
        pub enum JointKind {
            $(#[doc = concat!("See [`", stringify!($Kind), "`].")] $Kind($Kind),)*
        }

        impl std::ops::Deref for JointKind {
            type Target = dyn Joint;

            fn deref(&self) -> &Self::Target {
                match self { $(Self::$Kind(joint) => joint,)* }
            }
        }

        impl std::ops::DerefMut for JointKind {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self { $(Self::$Kind(joint) => joint,)* }
            }
        }

        $(impl From<$Kind> for JointKind {
            fn from(joint: $Kind) -> Self {
                Self::$Kind(joint)
            }
        })*
    };
}

joints! {
    revolute::Revolute,
    prismatic::Prismatic,
    fixed::Fixed,
    pin_in_slot::PinInSlot,
    cylindrical::Cylindrical,
    screw::Screw,
    spherical::Spherical,
    universal::Universal,
    planar::Planar,
    point_on_line::PointOnLine,
    point_on_plane::PointOnPlane,
    distance::Distance,
    gear::Gear,
    rack::Rack,
    motor::Motor,
    equation::Equation,
}

pub use motor::{Prescribed, Profile};
