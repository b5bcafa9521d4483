//! Zones that a point, an axis, a face or several parameters lie in.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::grammar::mapping::schema_only;

schema_only! {
    #[schemars(rename_all = "snake_case", inline)]
    pub enum ZoneLawName {
        /// Evenly over the zone. The default.
        Uniform,
        /// Normal in every direction, three standard deviations to the edge, cut off there.
        RadialNormal,
    }
}

grammar! {
    /// A zone of deviations. Exactly one of the first keys says which.
    ZoneFile is "a zone" {
        /// Diameter of a disc: `NAME_x` and `NAME_y` lie in it.
        disc: Option<Number>,
        /// Diameter of a sphere: `NAME_x`, `NAME_y` and `NAME_z`.
        sphere: Option<Number>,
        /// Diameter of a cylinder around an axis: `NAME_start_x` and `NAME_start_y` at one end, `NAME_end_x` and
        /// `NAME_end_y` at the other.
        cylinder: Option<Number>,
        /// Distance of two planes between which a face lies: `NAME_z`, half of it to either side.
        flatness: Option<Number>,
        /// Distance of two planes between which a face lies that tilts about two axes: `NAME_edge_x` and `NAME_edge_y`
        /// are heights of its edges, whose magnitudes together are half of it at most.
        parallelism: Option<Number>,
        /// Semi-axes of an ellipse or an ellipsoid, by the names of two or three deviations: `NAME_k1`.
        ellipsoid: Option<IndexMap<String, Number>>,
        /// Correlation of the two deviations of an ellipse, which is inclined then.
        correlation: Option<Number>,
        /// How it is distributed within; by default `uniform`.
        distribution: Option<ZoneLawName>,
        /// Description for people.
        description: Option<String>,
    }
}
