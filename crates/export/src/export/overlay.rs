//! `x3.svg` next to the scenes' folders: an output's bounds in every scene that has it.

use super::courses::{Across, BandedCourse, CourseBand, Shown, TIME, courses_svg};
use super::figure::Caption;
use super::figure::panel::Style;
use super::figure::style::{Color, Hue, PALETTE};
use super::plot::noise;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Band, Bounds, OutputBounds, foremost};

/// The bounds of a scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneBounds<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// The results of its run.
    pub bounds: &'a Bounds,
}

/// Lengths of dashes and gaps, px: they distinguish scenes in addition to their colours.
const DASHES: [&[f64]; 5] = [&[], &[9.0, 3.0], &[3.0, 2.0], &[9.0, 3.0, 2.0, 3.0], &[16.0, 4.0]];

/// The bands of one output in several scenes as an SVG document: for each scene the edges of the first method that is
/// reliable to the end.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn overlay_svg(caption: Caption, name: &str, scenes: &[SceneBounds]) -> Result<String, serde_json::Error> {
    let found: Vec<(usize, &SceneBounds, &OutputBounds, Option<&Band>)> = scenes
        .iter()
        .enumerate()
        .filter_map(|(index, scene)| {
            let output = scene.bounds.outputs.iter().find(|output| output.name == name)?;
            Some((index, scene, output, best(output)))
        })
        .collect();
    let mut methods = found.iter().map(|(.., band)| band.map(|band| band.method));
    let first = methods.next();
    let same = methods.all(|method| Some(method) == first);
    let courses: Vec<BandedCourse> = found
        .iter()
        .map(|(index, scene, output, band)| {
            let bands = band.map(|band| {
                let method = if same { String::new() } else { format!(" ({})", band.method.name()) };
                let style = style(*index, format!("{}{method}", scene.name));
                CourseBand { group: format!("scene-{index}"), band, style }
            });
            // The bands of a scene show its nominal course, which is thin and without a label then.
            let (label, width) = if bands.is_some() { ("", 0.5) } else { (scene.name, 1.4) };
            let (group, hue) = (format!("scene-{index}-nominal"), Hue::Color(Color::of(*index)));
            let bands = bands.into_iter().collect();
            BandedCourse { group, label, hue, width, times: &scene.bounds.times, nominal: &output.nominal, bands }
        })
        .collect();
    let unit =
        found.first().map_or(ShownUnit::from(""), |(_, _, output, _)| ShownUnit::of(&output.display, &output.unit));
    let noise = found.iter().map(|(_, scene, output, _)| noise(scene.bounds, output)).fold(0.0, f64::max);
    let across = Across { name: TIME, unit: ShownUnit::from("s") };
    courses_svg(caption, &Shown { name, unit, across, noise, courses: &courses, limits: &[] })
}

/// The edges of one of several bands.
pub(super) fn style(index: usize, label: String) -> Style {
    let dashes = DASHES[index % DASHES.len()];
    let dashes = (!dashes.is_empty()).then(|| dashes.to_vec());
    // Beyond the palette, colours are darker, and lines wider.
    let edge = 1.5 + 0.4 * (index / PALETTE.len()) as f64;
    let slant = [45.0, -45.0][index % 2];
    Style { label, color: Color::of(index), edge, fill: 0.0, dashes, slant }
}

fn best(output: &OutputBounds) -> Option<&Band> {
    foremost(&output.bands, |band| band.error.unresolved_from().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::Method;

    const CAPTION: Caption = Caption { model: "door", prefix: "o" };

    fn bounds(duration: f64, half: f64, methods: &[Method]) -> Bounds {
        let times: Vec<f64> = (0..101).map(|row| duration * f64::from(row) / 100.0).collect();
        let nominal: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
        let band = |method: &Method| Band {
            method: *method,
            lower: nominal.iter().map(|x| x - half).collect(),
            upper: nominal.iter().map(|x| x + half).collect(),
            error: BandError { total: vec![0.0; 101], unresolved: vec![false; 101], ..BandError::default() },
        };
        let bands = methods.iter().map(band).collect();
        let output =
            OutputBounds { name: "x3".into(), unit: "m".into(), display: None, nominal: nominal.clone(), bands };
        Bounds { times, outputs: vec![output], ..Bounds::default() }
    }

    #[test]
    fn every_scene_has_its_colour_and_its_name() {
        let all = [
            bounds(2.0, 0.01, &[Method::Chebyshev, Method::Scan]),
            bounds(1.0, 0.02, &[Method::Chebyshev]),
            bounds(2.0, 0.0, &[]),
        ];
        let names = ["ideal", "with friction", "bare"];
        let scenes: Vec<SceneBounds> =
            names.iter().zip(&all).map(|(name, bounds)| SceneBounds { name, bounds }).collect();
        let svg = overlay_svg(CAPTION, "x3", &scenes).unwrap();
        assert_eq!(svg, overlay_svg(CAPTION, "x3", &scenes).unwrap(), "the same data, the same bytes");
        for (index, name) in names.iter().enumerate() {
            assert!(svg.contains(&format!("color=\"{}\"", Color::of(index).hex())), "{name}");
        }
        // The first two have Chebyshev's method, the third has none, and the legend says so.
        for text in ["ideal (chebyshev)", "with friction (chebyshev)", "bare", "x3 [m]", "bound − nominal"] {
            assert!(svg.contains(text), "{text}");
        }
        let svg = overlay_svg(CAPTION, "x3", &scenes[..2]).unwrap();
        assert!(!svg.contains("(chebyshev)") && svg.contains(">ideal<"), "one method needs no name");
        assert!(!svg.contains("fill-opacity=\"0.1"), "edges only");
    }

    #[test]
    fn many_scenes_have_several_rows_of_legend() {
        let bounds = bounds(1.0, 0.1, &[Method::Scan]);
        let names: Vec<String> = (0..20).map(|index| format!("variant {index}")).collect();
        let scenes: Vec<SceneBounds> = names.iter().map(|name| SceneBounds { name, bounds: &bounds }).collect();
        let svg = overlay_svg(CAPTION, "x3", &scenes).unwrap();
        assert!(svg.contains("height=\"640\""), "{}", &svg[..160]);
        assert!(names.iter().all(|name| svg.contains(name)));
    }

    #[test]
    fn resolved_bands_are_preferred() {
        let mut bounds = bounds(1.0, 0.1, &[Method::Chebyshev, Method::Scan]);
        bounds.outputs[0].bands[0].error.unresolved[50] = true;
        assert_eq!(best(&bounds.outputs[0]).unwrap().method, Method::Scan);
        bounds.outputs[0].bands[1].error.unresolved[90] = true;
        assert_eq!(best(&bounds.outputs[0]).unwrap().method, Method::Chebyshev);
    }
}
