//! Axes across which something is mirrored.

/// Reflections at planes through the origin, one for each axis at most: a mirror in the same mirror shows the original
/// again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mirrors([bool; 3]);

impl Mirrors {
    /// One reflection across an axis, 0 to 2 for x to z.
    pub fn across(axis: usize) -> Self {
        Self([0, 1, 2].map(|other| other == axis))
    }

    /// The reflections of both, in any order.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self([0, 1, 2].map(|axis| self.0[axis] != other.0[axis]))
    }

    /// The axes.
    pub fn axes(self) -> impl Iterator<Item = usize> {
        (0..3).filter(move |&axis| self.0[axis])
    }

    /// Whether a polar vector's component along the axis has the other sign.
    pub fn flips(self, axis: usize) -> bool {
        self.0[axis]
    }

    /// Whether an axial vector's component along the axis, such as a rate of rotation about it, has the other sign.
    pub fn turns_back(self, axis: usize) -> bool {
        self.is_odd() != self.flips(axis)
    }

    /// Whether left and right are exchanged, so that angles about axes that are reflected count the other way.
    pub fn is_odd(self) -> bool {
        self.axes().count() % 2 == 1
    }
}
