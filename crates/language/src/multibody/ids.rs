//! Numbers of the parts of a mechanism in all later rooms: that of a constraint cannot be taken for that of a
//! coordinate or of an equation. Lists of other rooms that are indexed by them say so where they are declared.

use serde::{Deserialize, Serialize};

macro_rules! ids {
    ($($(#[$documentation:meta])* $id:ident;)*) => {$(
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $id(usize);

        impl $id {
            /// The identifier with this number, from 0.
            pub const fn new(number: usize) -> Self {
                Self(number)
            }

            /// Its number, from 0.
            pub const fn number(self) -> usize {
                self.0
            }
        }
    )*};
}

ids! {
    /// A coordinate.
    CoordinateId;
    /// A constraint.
    ConstraintId;
    /// A condition at the start.
    ConditionId;
    /// An output.
    OutputId;
    /// An equation of a step: those of motion come first, one for each coordinate, then the constraints.
    EquationId;
}
