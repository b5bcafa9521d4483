//! Indices in a [`System`]'s lists, as other stages name them: a constraint's cannot be taken for that of a coordinate,
//! of an output or of a condition of the start, nor for a row in which constraints follow coordinates.

use std::ops::Index;

use super::system::{ConstraintInfo, CoordinateInfo, OutputInfo, StartCondition, System};
use crate::multibody::{ConditionId, ConstraintId, CoordinateId, OutputId};

macro_rules! lists {
    ($($id:ident: $info:ty, $($list:ident).+;)*) => {$(
        impl Index<$id> for System {
            type Output = $info;

            fn index(&self, id: $id) -> &$info {
                &self.$($list).+[id.number()]
            }
        }
    )*};
}

lists! {
    CoordinateId: CoordinateInfo, coordinates;
    ConstraintId: ConstraintInfo, constraints;
    ConditionId: StartCondition, start.conditions;
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
