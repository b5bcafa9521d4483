//! From the ground's frame to the paper.

use nalgebra::{Vector2, Vector3};

/// A point on the paper, px; y points down.
pub(super) type Px = Vector2<f64>;

/// A direction of view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    /// Title for people: `from above (x, y)`.
    pub title: &'static str,
    /// Direction to the right on the paper.
    right: [f64; 3],
    /// Direction upwards on the paper.
    up: [f64; 3],
}

/// View of a plane mechanism, in its true shape.
pub(super) const PLANE: [Projection; 1] = [Projection { title: "", right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0] }];

/// Views of a spatial mechanism: from three quarters (an isometric view), from the front, from the side, from above.
pub(super) const SPACE: [Projection; 4] = [
    Projection {
        title: "three-quarter view",
        right: [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2, 0.0],
        // (1, 1, 2)/√6, tilted away from the reader.
        up: [0.408_248_290_463_863, 0.408_248_290_463_863, 0.816_496_580_927_726],
    },
    Projection { title: "along y: x right, z up", right: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0] },
    Projection { title: "along −x: y right, z up", right: [0.0, 1.0, 0.0], up: [0.0, 0.0, 1.0] },
    Projection { title: "along −z: x right, y up", right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0] },
];

impl Projection {
    /// The middle of some positions, and how far they reach to the right and up, m.
    fn extent(&self, positions: &[[f64; 3]]) -> (Vector2<f64>, Vector2<f64>) {
        let flat = || positions.iter().map(|&position| self.flat(position));
        let least = flat().reduce(|least, p| least.inf(&p)).unwrap_or_default();
        let most = flat().reduce(|most, p| most.sup(&p)).unwrap_or_default();
        (0.5 * (least + most), most - least)
    }

    /// Vertical extent of positions, m.
    pub fn height(&self, positions: &[[f64; 3]]) -> f64 {
        self.extent(positions).1.y
    }

    /// The scale at which positions fill a rectangle, px by m. A point is shown as if it were 1 m.
    pub fn scale(&self, positions: &[[f64; 3]], size: Px) -> f64 {
        let (_, extent) = self.extent(positions);
        let filled = [size.x / extent.x, size.y / extent.y].into_iter().filter(|scale| scale.is_finite());
        filled.reduce(f64::min).unwrap_or_else(|| size.min())
    }

    /// A position on the paper, m, y up.
    fn flat(&self, position: [f64; 3]) -> Vector2<f64> {
        let position = Vector3::from(position);
        Vector2::new(position.dot(&Vector3::from(self.right)), position.dot(&Vector3::from(self.up)))
    }
}

/// A view: a projection in a rectangle of the paper.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    projection: Projection,
    /// px by m.
    pub scale: f64,
    /// Position shown in the middle, m.
    middle: Vector2<f64>,
    /// Its point on the paper, px.
    centre: Px,
}

impl View {
    /// The view that shows the middle of some positions in the middle of a rectangle whose upper left corner is
    /// `corner`.
    pub fn centred(projection: Projection, positions: &[[f64; 3]], scale: f64, corner: Px, size: Px) -> Self {
        let (middle, _) = projection.extent(positions);
        Self { projection, scale, middle, centre: corner + 0.5 * size }
    }

    /// Title of the view, for people.
    pub fn title(&self) -> &'static str {
        self.projection.title
    }

    /// Point on the paper of a position, px.
    pub fn px(&self, position: [f64; 3]) -> Px {
        let from_middle = self.scale * (self.projection.flat(position) - self.middle);
        self.centre + Px::new(from_middle.x, -from_middle.y)
    }

    /// A direction on the paper, of length one; `None` if it points at the reader.
    pub fn direction(&self, direction: [f64; 3]) -> Option<Px> {
        let flat = self.projection.flat(direction);
        let seen = flat.norm() > 1e-3 * Vector3::from(direction).norm();
        seen.then(|| Px::new(flat.x, -flat.y).normalize())
    }

    /// Whether a side with this normal is turned to the reader.
    pub fn shows(&self, normal: &Vector3<f64>) -> bool {
        let towards = Vector3::from(self.projection.right).cross(&Vector3::from(self.projection.up));
        normal.dot(&towards) > 1e-9 * normal.norm()
    }

    /// The largest length of 1, 2 or 5 times a power of ten that is at most `px` pixels, m.
    pub fn round_length(&self, px: f64) -> f64 {
        let wanted = px / self.scale;
        let mut power = 1.0;
        while power > wanted {
            power /= 10.0;
        }
        while 10.0 * power <= wanted {
            power *= 10.0;
        }
        [5.0, 2.0].into_iter().map(|digit| digit * power).find(|&length| length <= wanted).unwrap_or(power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_in_view_and_in_scale() {
        let positions = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.5, -1.0, 0.0]];
        let (corner, size) = (Px::new(10.0, 20.0), Px::new(200.0, 100.0));
        let scale = PLANE[0].scale(&positions, size);
        assert!((scale * PLANE[0].height(&positions) - 100.0).abs() < 1e-9);
        let view = View::centred(PLANE[0], &positions, scale, corner, size);
        for position in positions {
            let px = view.px(position);
            assert!(px.x >= 10.0 - 1e-9 && px.x <= 210.0 + 1e-9 && px.y >= 20.0 - 1e-9 && px.y <= 120.0 + 1e-9);
        }
        assert!((view.scale - 50.0).abs() < 1e-12);
        assert!(view.px([0.0, 1.0, 0.0]).y < view.px([0.0, 0.0, 0.0]).y);
        assert!((view.round_length(120.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn views_of_space_are_orthogonal() {
        for projection in SPACE {
            let (right, up) = (Vector3::from(projection.right), Vector3::from(projection.up));
            assert!(
                right.dot(&up).abs() < 1e-12 && (right.norm() - 1.0).abs() < 1e-12 && (up.norm() - 1.0).abs() < 1e-12
            );
        }
    }

    #[test]
    fn axis_normal_to_the_view_has_no_direction() {
        let scale = PLANE[0].scale(&[], Px::new(2.0, 3.0));
        assert!((scale - 2.0).abs() < 1e-12);
        let view = View::centred(PLANE[0], &[], scale, Px::zeros(), Px::new(2.0, 3.0));
        assert_eq!(view.direction([0.0, 0.0, 1.0]), None);
        assert_eq!(view.direction([0.0, 2.0, 0.0]), Some(Px::new(0.0, -1.0)));
    }
}
