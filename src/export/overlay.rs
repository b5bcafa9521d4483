//! `x3.svg` beside the scenes' folders: an output's bounds in every scene that has it.

use plotters::prelude::*;

use super::figure::{Course, figure_svg};
use super::panel::Style;
use crate::results::{Band, Bounds, OutputBounds, foremost};

/// The bounds of a scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneBounds<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// The results of its run.
    pub bounds: &'a Bounds,
}

/// Colours that every colour vision distinguishes; further scenes repeat them, darker.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 130, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 60, 140),
    RGBColor(86, 180, 233),
    RGBColor(150, 40, 20),
    RGBColor(110, 110, 110),
];
const DARKER: f64 = 0.6;

/// The bands of one output in several scenes as an SVG document: for each scene the first method that is reliable to the end.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub fn overlay_svg(name: &str, scenes: &[SceneBounds]) -> Result<String, String> {
    let found: Vec<(usize, &SceneBounds, &OutputBounds, Option<&Band>)> = scenes
        .iter()
        .enumerate()
        .filter_map(|(place, scene)| {
            let output = scene.bounds.outputs.iter().find(|output| output.name == name)?;
            Some((place, scene, output, best(output)))
        })
        .collect();
    let Some((_, _, output, first)) = found.first() else { return Err("no scene has it".to_owned()) };
    let same = found.iter().all(|(.., band)| band.map(|band| band.method) == first.map(|band| band.method));
    let courses: Vec<Course> = found
        .iter()
        .map(|(place, scene, output, band)| {
            let color = color(*place);
            let bands = band.map(|band| {
                let method = if same { String::new() } else { format!(" ({})", band.method.name()) };
                let style =
                    Style { label: format!("{}{method}", scene.name), color, edge: 1.6, fill: 0.14, dashes: None };
                (band, style)
            });
            let label = if bands.is_some() { "" } else { scene.name };
            let times = &scene.bounds.times;
            Course { label, color, times, nominal: &output.nominal, bands: bands.into_iter().collect() }
        })
        .collect();
    figure_svg(name, &output.unit, &courses)
}

fn best(output: &OutputBounds) -> Option<&Band> {
    foremost(&output.bands, |band| band.error.unresolved_from().is_none())
}

fn color(place: usize) -> RGBColor {
    let RGBColor(r, g, b) = COLORS[place % COLORS.len()];
    let scale = DARKER.powi((place / COLORS.len()) as i32);
    let part = |part: u8| (f64::from(part) * scale) as u8;
    RGBColor(part(r), part(g), part(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Bounds, Method};

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
        let output = OutputBounds { name: "x3".into(), unit: "m".into(), nominal: nominal.clone(), bands };
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
        let svg = overlay_svg("x3", &scenes).unwrap();
        assert_eq!(svg, overlay_svg("x3", &scenes).unwrap(), "the same data, the same bytes");
        for (place, name) in names.iter().enumerate() {
            let RGBColor(r, g, b) = color(place);
            assert!(svg.contains(&format!("stroke=\"#{r:02X}{g:02X}{b:02X}\"")), "{name}");
        }
        // Chebyshev is the method of those that have one, the third has none, and the legend says so.
        for text in ["ideal (chebyshev)", "with friction (chebyshev)", "bare", "x3 [m]", "bound − nominal"] {
            assert!(svg.contains(text), "{text}");
        }
        let svg = overlay_svg("x3", &scenes[..2]).unwrap();
        assert!(!svg.contains("(chebyshev)") && svg.contains(">\nideal\n<"), "one method needs no name");
        assert!(svg.starts_with("<svg width=\"900\" height=\"560\""));
    }

    #[test]
    fn many_scenes_have_a_legend_of_several_rows_and_colours_of_their_own() {
        let bounds = bounds(1.0, 0.1, &[Method::Scan]);
        let names: Vec<String> = (0..20).map(|place| format!("variant {place}")).collect();
        let scenes: Vec<SceneBounds> = names.iter().map(|name| SceneBounds { name, bounds: &bounds }).collect();
        let svg = overlay_svg("x3", &scenes).unwrap();
        assert!(svg.starts_with("<svg width=\"900\" height=\"620\""), "{}", &svg[..60]);
        let colors: std::collections::HashSet<_> = (0..20).map(|place| format!("{:?}", color(place))).collect();
        assert_eq!(colors.len(), 20);
        assert!(names.iter().all(|name| svg.contains(name)));
    }

    #[test]
    fn a_band_that_is_resolved_goes_before_one_that_is_not() {
        let mut bounds = bounds(1.0, 0.1, &[Method::Chebyshev, Method::Scan]);
        bounds.outputs[0].bands[0].error.unresolved[50] = true;
        assert_eq!(best(&bounds.outputs[0]).unwrap().method, Method::Scan);
        bounds.outputs[0].bands[1].error.unresolved[90] = true;
        assert_eq!(best(&bounds.outputs[0]).unwrap().method, Method::Chebyshev);
    }
}
