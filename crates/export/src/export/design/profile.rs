//! The objective along a parameter through the best point, without deviations and in the worst case.

use super::{DesignStudy, criterion};
use crate::export::courses::{Across, BandedCourse, Shown, courses_svg};
use crate::export::figure::Caption;
use crate::export::figure::style::{Color, Hue};
use crate::grammar::display_unit::ShownUnit;
use crate::results::DesignProfile;

pub(super) fn drawn(design: &DesignStudy, profile: &DesignProfile) -> Result<String, serde_json::Error> {
    let own = &design.parameters[profile.parameter];
    let worst = criterion(design);
    let course = |index: usize, label, values| BandedCourse {
        group: format!("course-{index}"),
        label,
        hue: Hue::Color(Color::of(index)),
        width: 1.6,
        times: &profile.values,
        nominal: values,
        bands: Vec::new(),
    };
    let courses = [course(0, "without deviations", &profile.nominal), course(1, &worst, &profile.worst)];
    let prefix = format!("design-{}", profile.parameter);
    let shown = Shown {
        name: &design.objective.text,
        unit: ShownUnit::of(&design.objective.display, &design.objective.unit),
        across: Across { name: &own.name, unit: ShownUnit::of(&own.display, &own.unit) },
        noise: 0.0,
        courses: &courses,
        limits: &[],
    };
    courses_svg(Caption { model: &design.model, prefix: &prefix }, &shown)
}
