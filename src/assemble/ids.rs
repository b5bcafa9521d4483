//! Places in a [`System`]'s lists, as other stages name them: a constraint's cannot be taken for that of a coordinate, of an output or
//! of a condition of the start, nor for a row in which constraints follow coordinates.

use std::ops::Index;

use super::system::{ConstraintInfo, CoordinateInfo, OutputInfo, StartCondition, System};

macro_rules! ids {
    ($($(#[$documentation:meta])* $id:ident: $info:ty, $($list:ident).+;)*) => {$(
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub struct $id(usize);

        impl $id {
            /// With this number, from 0.
            pub const fn new(number: usize) -> Self {
                Self(number)
            }

            /// Its number, from 0.
            pub const fn number(self) -> usize {
                self.0
            }
        }

        impl Index<$id> for System {
            type Output = $info;

            fn index(&self, id: $id) -> &$info {
                &self.$($list).+[id.0]
            }
        }
    )*};
}

ids! {
    /// A coordinate.
    CoordinateId: CoordinateInfo, coordinates;
    /// A constraint.
    ConstraintId: ConstraintInfo, constraints;
    /// A condition of the start.
    ConditionId: StartCondition, start.conditions;
    /// An output.
    OutputId: OutputInfo, outputs;
}

impl System {
    /// Names of constraints.
    pub fn constraint_names(&self, constraints: &[ConstraintId]) -> Vec<String> {
        constraints.iter().map(|&constraint| self[constraint].name.clone()).collect()
    }

    /// Names of outputs.
    pub fn output_names(&self, outputs: &[OutputId]) -> Vec<String> {
        outputs.iter().map(|&output| self[output].name.clone()).collect()
    }
}
