//! `<visual>`: appearance of a link. It is for pictures only: unreadable parts are omitted.

use super::robot::{Visual, VisualShape};
use crate::robots::xml::{Element, child, children, plain};

/// Appearance of a robot's links.
pub struct Visuals<'a, 'i> {
    root: Element<'a, 'i>,
}

impl<'a, 'i> Visuals<'a, 'i> {
    pub fn of(root: Element<'a, 'i>) -> Self {
        Self { root }
    }

    /// A link's.
    pub fn link(&self, link: Element<'a, 'i>) -> Vec<Visual> {
        children(link, "visual").filter_map(|visual| self.visual(visual)).collect()
    }

    fn visual(&self, visual: Element<'a, 'i>) -> Option<Visual> {
        let origin = child(visual, "origin");
        let part = |name| origin.and_then(|origin| numbers(origin, name)).unwrap_or([0.0; 3]);
        let shape = shape(child(visual, "geometry")?)?;
        Some(Visual { xyz: part("xyz"), rpy: part("rpy"), shape, color: self.color(visual) })
    }

    /// Colour of its own material, or of the robot's material of that name.
    fn color(&self, visual: Element<'a, 'i>) -> Option<[f64; 3]> {
        let material = child(visual, "material")?;
        let rgb = |material: Element| {
            let [r, g, b, _] = numbers(child(material, "color")?, "rgba")?;
            Some([r, g, b])
        };
        let name = plain(material, "name")?.value();
        let named = |other: &Element| plain(*other, "name").is_some_and(|own| own.value() == name);
        rgb(material).or_else(|| children(self.root, "material").find(named).and_then(rgb))
    }
}

fn shape(geometry: Element) -> Option<VisualShape> {
    let found = geometry.children().find(Element::is_element)?;
    let one = |name| numbers(found, name).map(|[number]| number);
    match found.tag_name().name() {
        "box" => numbers(found, "size").map(VisualShape::Box),
        "cylinder" => Some(VisualShape::Cylinder { radius: one("radius")?, length: one("length")? }),
        "sphere" => one("radius").map(VisualShape::Sphere),
        "mesh" => {
            let file = plain(found, "filename")?.value().to_owned();
            Some(VisualShape::Mesh { file, scale: numbers(found, "scale").unwrap_or([1.0; 3]) })
        }
        _ => None,
    }
}

/// The `N` finite numbers of an attribute.
fn numbers<const N: usize>(element: Element, name: &str) -> Option<[f64; N]> {
    let numbers = plain(element, name)?.value().split_whitespace().map(|word| word.parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    numbers.try_into().ok().filter(|numbers: &[f64; N]| numbers.iter().all(|number| number.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_and_colours_are_read_and_invalid_ones_omitted() {
        let text = r#"<robot><material name="red"><color rgba="1 0 0 1"/></material><link name="a">
            <visual><origin xyz="0 0 1"/><geometry><box size="1 2 3"/></geometry><material name="red"/></visual>
            <visual><geometry><cylinder radius="0.5" length="2"/></geometry></visual>
            <visual><geometry><sphere radius="x"/></geometry></visual>
            <visual><geometry><mesh filename="package://arm/a.stl"/></geometry></visual></link></robot>"#;
        let document = roxmltree::Document::parse(text).unwrap();
        let root = document.root_element();
        let found = Visuals::of(root).link(child(root, "link").unwrap());
        assert_eq!(found.len(), 3);
        assert_eq!(found[0].xyz, [0.0, 0.0, 1.0]);
        assert_eq!(found[0].color, Some([1.0, 0.0, 0.0]));
        assert_eq!(found[1].shape, VisualShape::Cylinder { radius: 0.5, length: 2.0 });
        assert!(
            matches!(&found[2].shape, VisualShape::Mesh { file, scale: [1.0, 1.0, 1.0] } if file == "package://arm/a.stl")
        );
    }
}
