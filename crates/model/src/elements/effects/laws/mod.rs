//! Laws that several effects share: of friction, of impacts, of saturation, of a servo's goal.

pub(super) mod dry_friction;
pub(super) mod goal;
pub(super) mod impact;
pub(super) mod positive_part;
pub(super) mod saturation;
