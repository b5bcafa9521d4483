//! Labels next to their points, without overlap.

use svg::node::element::Text;

use super::glyph::px;
use super::view::Px;

/// Width of a character and height of a line over the font's size.
const CHARACTER: f64 = 0.58;
const LINE: f64 = 1.15;

/// Labels so far, as rectangles.
#[derive(Default)]
pub(super) struct Labels {
    taken: Vec<[Px; 2]>,
    named: Vec<(String, Px)>,
}

impl Labels {
    /// A name next to a point, preferably in the direction `away`; `None` if there is no room, or if the name is there
    /// already.
    pub fn beside(&mut self, at: Px, away: Px, name: &str, size: f64, class: &str) -> Option<Text> {
        if self.named.iter().any(|(known, place)| known == name && (place - at).norm() < 3.0) {
            return None;
        }
        let extent = Px::new(CHARACTER * size * name.chars().count() as f64, LINE * size);
        let mut directions: Vec<Px> = [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1)]
            .map(|(x, y)| Px::new(f64::from(x), f64::from(y)))
            .to_vec();
        // Stable, so that equal directions stay in order.
        directions.sort_by(|a, b| b.normalize().dot(&away).total_cmp(&a.normalize().dot(&away)));
        let rectangle = |direction: &Px, distance: f64| {
            let middle = at + direction.component_mul(&(0.5 * extent)) + distance * direction.normalize();
            [middle - 0.5 * extent, middle + 0.5 * extent]
        };
        let places = [9.0, 18.0].into_iter().flat_map(|distance| directions.iter().map(move |d| (d, distance)));
        let free =
            places.map(|(direction, distance)| rectangle(direction, distance)).find(|place| self.is_free(place))?;
        self.taken.push(free);
        self.named.push((name.to_owned(), at));
        let [least, most] = free;
        Some(
            Text::new(name)
                .set("x", px(0.5 * (least.x + most.x)))
                .set("y", px(most.y - 0.25 * size))
                .set("font-size", size)
                .set("text-anchor", "middle")
                .set("class", class),
        )
    }

    /// Keeps names off a square about a point.
    pub fn occupy(&mut self, at: Px, half: f64) {
        self.taken.push([at - Px::repeat(half), at + Px::repeat(half)]);
    }

    fn is_free(&self, place: &[Px; 2]) -> bool {
        self.taken.iter().all(|taken| {
            place[1].x <= taken[0].x || place[0].x >= taken[1].x || place[1].y <= taken[0].y || place[0].y >= taken[1].y
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_overlap() {
        let mut labels = Labels::default();
        let mut beside =
            |number: i32| labels.beside(Px::zeros(), Px::new(0.0, -1.0), &format!("crank{number}"), 12.0, "name");
        let placed = (0..40).filter_map(&mut beside).count();
        assert!((3..=16).contains(&placed), "{placed}");
        assert!(labels.beside(Px::new(1.0, 0.0), Px::new(1.0, 0.0), "crank0", 12.0, "name").is_none());
        let overlap = |a: &[Px; 2], b: &[Px; 2]| a[0] < b[1] && b[0] < a[1];
        for (index, label) in labels.taken.iter().enumerate() {
            assert!(labels.taken[..index].iter().all(|other| !overlap(label, other)));
        }
    }
}
