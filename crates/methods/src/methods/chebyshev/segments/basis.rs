//! Terms of the polynomials of instants and motions.

use symdiff::jet::Monomials;

use super::tuning::TUNING;
use crate::numerics::{LeastSquares, PointSet, SparseBasis, largest, truncation};

/// Terms in ξ.
#[derive(Clone, Debug)]
pub(super) enum Basis {
    /// Terms of a grid's surrogate.
    Grid(SparseBasis),
    /// Terms in a part of the box, which are fitted to samples in it.
    Fitted(Fitted),
    /// Powers of distances from a centre, those of a jet.
    Taylor { monomials: Monomials, centre: Vec<f64> },
}

/// Products of Chebyshev polynomials up to a total degree.
#[derive(Clone, Debug)]
pub(super) struct Powers(Vec<Vec<u8>>);

/// Products up to a degree, and the same up to one less times the root of each depth behind a surface: behind the
/// surface on which an event is just grazed, instants and motions behind go with the root of the distance to it. Powers
/// are those of coordinates in a box about the samples: in a layer, which is thin, those of ξ would cancel.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    powers: Powers,
    depths: Vec<Level>,
    of_depths: Powers,
    /// Middle and half width of the box about the samples along each axis.
    about: Vec<(f64, f64)>,
    /// The axis whose ξ the root of a depth stands for, if one does: a layer is thin, and there everything changes with
    /// that root, which polynomials of ξ do not resolve.
    across: Option<(usize, Level)>,
}

/// A polynomial whose zeros are a surface in the box.
#[derive(Clone, Debug)]
pub(super) struct Level {
    powers: Powers,
    coefficients: Vec<f64>,
    /// Largest distance of its zero from the true one, in its own units.
    error: f64,
}

/// A surface that ends a part: a level's zero, or a surface parallel to it.
#[derive(Clone, Debug)]
pub(super) struct End {
    pub level: Level,
    /// The part is where this times the level is more than the offset.
    pub sign: f64,
    pub offset: f64,
}

impl Powers {
    pub fn up_to(degree: usize, k: usize) -> Self {
        let mut all = vec![Vec::new()];
        for _ in 0..k {
            let longer = |exponents: &Vec<u8>| {
                let left = degree - exponents.iter().map(|&own| usize::from(own)).sum::<usize>();
                (0..=left as u8).map(|own| [&exponents[..], &[own]].concat()).collect::<Vec<_>>()
            };
            all = all.iter().flat_map(longer).collect();
        }
        Self(all)
    }

    fn values(&self, xi: &[f64], into: &mut Vec<f64>) {
        let degree = self.0.iter().flatten().copied().max().unwrap_or(0);
        let chebyshev = |&xi: &f64| {
            let mut values = vec![1.0, xi];
            for index in 2..=usize::from(degree) {
                values.push(2.0 * xi * values[index - 1] - values[index - 2]);
            }
            values
        };
        let of_axes: Vec<Vec<f64>> = xi.iter().map(chebyshev).collect();
        let term = |exponents: &Vec<u8>| -> f64 {
            exponents.iter().zip(&of_axes).map(|(&exponent, values)| values[usize::from(exponent)]).product()
        };
        into.extend(self.0.iter().map(term));
    }
}

impl Level {
    /// Fits a level to the zeros of margins that are given at samples. Where one side's are no continuation of the
    /// other's, no polynomial has both: then it is fitted to shares of the largest margin on each side, or to the sides
    /// alone.
    pub fn through(samples: &[(&[f64], f64)]) -> Option<Self> {
        let margins: Vec<f64> = samples.iter().map(|(_, margin)| *margin).collect();
        let own = Self::of_values(samples, &margins)?;
        let size = |sign: f64| margins.iter().map(|margin| sign * margin).fold(0.0, f64::max);
        let sizes = [-1.0, 1.0].map(size);
        let shares: Vec<f64> = margins.iter().map(|margin| margin / sizes[usize::from(*margin > 0.0)]).collect();
        // Samples on the wrong side that are not near the surface.
        let misplaced = |level: &Self| {
            let is_off = |((xi, _), share): (&(&[f64], f64), &f64)| {
                share.abs() > TUNING.near_surface && level.at(xi) * share < 0.0
            };
            samples.iter().zip(&shares).filter(|own| is_off(*own)).count()
        };
        if misplaced(&own) == 0 {
            return Some(own);
        }
        let sides: Vec<f64> = margins.iter().map(|margin| margin.signum()).collect();
        let others = [&shares, &sides].into_iter().filter_map(|values| Self::of_values(samples, values));
        std::iter::once(own).chain(others).min_by_key(misplaced)
    }

    /// The level of the degree with the smallest leave-one-out error.
    fn of_values(samples: &[(&[f64], f64)], values: &[f64]) -> Option<Self> {
        let k = samples.first()?.0.len();
        let size = largest(values.iter().copied());
        let weight = |value: &f64| TUNING.near_surface / (value.abs() / size + TUNING.near_surface);
        let weights: Vec<f64> = values.iter().map(weight).collect();
        let of_degree = |degree: usize| {
            let powers = Powers::up_to(degree, k);
            let terms = values_of(samples.iter().map(|(xi, _)| *xi), |xi, into| powers.values(xi, into));
            if samples.len() as f64 <= TUNING.samples_a_term * powers.0.len() as f64 {
                return None;
            }
            let (coefficients, left_out) = LeastSquares::new(&terms, weights.clone())?.fit(values)?;
            let error = largest(left_out.iter().zip(&weights).map(|(error, weight)| error * weight));
            Some(Self { powers, coefficients, error })
        };
        let highest = TUNING.surface_degrees.get(k.saturating_sub(1)).or(TUNING.surface_degrees.last()).copied()?;
        (1..=highest).filter_map(of_degree).min_by(|a, b| a.error.total_cmp(&b.error))
    }

    /// The level whose zero is at the middle of an axis.
    fn along(axis: usize, k: usize) -> Self {
        let exponents = (0..k).map(|other| u8::from(other == axis)).collect();
        Self { powers: Powers(vec![exponents]), coefficients: vec![1.0], error: 0.0 }
    }

    /// Largest distance of its zero from the true one, in its own units.
    pub fn error(&self) -> f64 {
        self.error
    }

    pub fn at(&self, xi: &[f64]) -> f64 {
        let mut terms = Vec::with_capacity(self.coefficients.len());
        self.powers.values(xi, &mut terms);
        terms.iter().zip(&self.coefficients).map(|(term, coefficient)| term * coefficient).sum()
    }

    /// Root of the depth behind the surface; zero before it.
    fn root(&self, xi: &[f64]) -> f64 {
        (-self.at(xi)).max(0.0).sqrt()
    }

    /// The axis along which it changes most, over some samples.
    pub fn steepest(&self, samples: &[Vec<f64>]) -> usize {
        let slope = |axis: usize| -> f64 { samples.iter().map(|xi| self.slope(xi, axis).abs()).sum() };
        let slopes = (0..samples.first().map_or(0, Vec::len)).map(slope).enumerate();
        slopes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(axis, _)| axis)
    }

    /// Its slope along an axis.
    fn slope(&self, xi: &[f64], axis: usize) -> f64 {
        let mut beside = xi.to_vec();
        beside[axis] += TUNING.step_of_surfaces;
        (self.at(&beside) - self.at(xi)) / TUNING.step_of_surfaces
    }
}

impl End {
    /// The plane at which an axis is at some ξ; the part is where this is above it (1), or below (−1).
    pub fn across(axis: usize, at: f64, sign: f64, k: usize) -> Self {
        Self { level: Level::along(axis, k), sign, offset: sign * at }
    }

    /// Distance from the surface, in the level's units; negative beyond it.
    pub fn margin(&self, xi: &[f64]) -> f64 {
        self.sign * self.level.at(xi) - self.offset
    }

    /// Whether a layer ends there, away from the surface behind which it is.
    pub fn is_far(&self) -> bool {
        self.offset < 0.0
    }

    /// Largest distance of the surface from the true one; zero for a surface that only divides a part.
    pub fn error(&self) -> f64 {
        if self.offset == 0.0 { self.level.error } else { 0.0 }
    }
}

impl Fitted {
    /// Terms for samples at these ξ.
    pub fn new(degree: usize, depths: &[Level], samples: &[Vec<f64>]) -> Self {
        Self::about(degree, depths, None, samples)
    }

    /// Terms with the root of a depth instead of the ξ along an axis.
    pub fn across(degree: usize, depth: &Level, axis: usize, samples: &[Vec<f64>]) -> Self {
        Self::about(degree, &[], Some((axis, depth.clone())), samples)
    }

    fn about(degree: usize, depths: &[Level], across: Option<(usize, Level)>, samples: &[Vec<f64>]) -> Self {
        let k = samples.first().map_or(0, Vec::len);
        let mut own = Self {
            powers: Powers::up_to(degree, k),
            depths: depths.to_vec(),
            of_depths: Powers::up_to(degree.saturating_sub(1), k),
            about: vec![(0.0, 1.0); k],
            across,
        };
        let places: Vec<Vec<f64>> = samples.iter().map(|xi| own.place(xi)).collect();
        let of_axis = |axis: usize| {
            let along = places.iter().map(|place| place[axis]);
            let (low, high) = (along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max));
            (0.5 * (low + high), if high > low { 0.5 * (high - low) } else { 1.0 })
        };
        own.about = (0..k).map(of_axis).collect();
        own
    }

    pub fn len(&self) -> usize {
        self.powers.0.len() + self.depths.len() * self.of_depths.0.len()
    }

    /// Coordinates of some ξ in the box about the samples.
    fn place(&self, xi: &[f64]) -> Vec<f64> {
        let mut place = xi.to_vec();
        if let Some((axis, depth)) = &self.across {
            place[*axis] = depth.root(xi);
        }
        place.iter_mut().zip(&self.about).for_each(|(own, (middle, half))| *own = (*own - middle) / half);
        place
    }

    fn values(&self, xi: &[f64], into: &mut Vec<f64>) {
        let place = self.place(xi);
        self.powers.values(&place, into);
        for depth in &self.depths {
            let root = depth.root(xi);
            let first = into.len();
            self.of_depths.values(&place, into);
            into[first..].iter_mut().for_each(|term| *term *= root);
        }
    }
}

impl Basis {
    pub fn len(&self) -> usize {
        match self {
            Self::Grid(basis) => basis.len(),
            Self::Fitted(fitted) => fitted.len(),
            Self::Taylor { monomials, .. } => monomials.len(),
        }
    }

    /// Highest degree in an axis.
    pub fn degree(&self) -> usize {
        match self {
            Self::Grid(basis) => basis.orders().iter().copied().max().map_or(0, usize::from),
            Self::Fitted(fitted) => fitted.powers.0.iter().flatten().copied().max().map_or(0, usize::from),
            Self::Taylor { monomials, .. } => monomials.order(),
        }
    }

    /// Values of all terms, point by point.
    pub fn values(&self, xi: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let points = xi.iter().map(Vec::as_slice);
        match self {
            Self::Grid(basis) => basis.terms(PointSet::of(xi).points()),
            Self::Fitted(fitted) => values_of(points, |xi, into| fitted.values(xi, into)),
            Self::Taylor { monomials, centre } => {
                let power = |(xi, (centre, &exponent)): (&f64, (&f64, &usize))| (xi - centre).powi(exponent as i32);
                let term = |xi: &[f64], term: usize| -> f64 {
                    xi.iter().zip(centre.iter().zip(monomials.exponents(term))).map(power).product()
                };
                values_of(points, |xi, into| into.extend((0..monomials.len()).map(|number| term(xi, number))))
            }
        }
    }

    /// Size of the terms beyond the coefficients; zero for a fit or a jet, whose errors other samples give.
    pub fn truncation(&self, coefficients: &[f64]) -> f64 {
        match self {
            Self::Grid(basis) => truncation(basis, coefficients),
            Self::Fitted(_) | Self::Taylor { .. } => 0.0,
        }
    }
}

fn values_of<'x>(xi: impl Iterator<Item = &'x [f64]>, of: impl Fn(&[f64], &mut Vec<f64>)) -> Vec<Vec<f64>> {
    xi.map(|xi| {
        let mut values = Vec::new();
        of(xi, &mut values);
        values
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surface_is_the_zero_set_of_margins() {
        // A circle of radius ½ about (0.1, 0), the margin twice as steep inside.
        let margin = |xi: &[f64]| {
            let distance = (xi[0] - 0.1).powi(2) + xi[1] * xi[1] - 0.25;
            if distance < 0.0 { distance * (2.0 + distance) / 2.0 } else { distance }
        };
        let points = crate::numerics::spread(2, 60);
        let samples: Vec<(&[f64], f64)> = points.iter().map(|xi| (xi.as_slice(), margin(xi))).collect();
        let level = Level::through(&samples).unwrap();
        for angle in [0.0_f64, 1.0, 2.0, 4.0] {
            let on = [0.1 + 0.5 * angle.cos(), 0.5 * angle.sin()];
            assert!(level.at(&on).abs() < level.error.max(1e-3), "{} at {angle}", level.at(&on));
        }
        assert!(level.error < 0.02, "{}", level.error);
    }

    /// Margins that are flat and wavy on one side, and steep on the other: no polynomial has both.
    #[test]
    fn surface_separates_samples_of_any_margins() {
        let margin = |x: f64| if x < 0.05 { 1e-3 * (1.2 + (9.0 * x).sin()) } else { 0.05 - x - 0.01 };
        let points = crate::numerics::spread(1, 60);
        let samples: Vec<(&[f64], f64)> = points.iter().map(|xi| (&xi[..], margin(xi[0]))).collect();
        let level = Level::through(&samples).unwrap();
        assert!(Level::of_values(&samples, &samples.iter().map(|own| own.1).collect::<Vec<_>>()).unwrap().error > 1e-3);
        for (xi, margin) in samples.iter().filter(|(_, margin)| !(0.0..2e-4).contains(margin)) {
            assert!(level.at(xi) * margin > 0.0, "{} at {xi:?}, not {margin}", level.at(xi));
        }
    }

    #[test]
    fn basis_has_roots_behind_a_surface() {
        let f = |x: f64| 1.0 + 0.3 * x + if x > 0.2 { (x - 0.2).sqrt() * (0.5 - 0.1 * x) } else { 0.0 };
        let margins: Vec<Vec<f64>> = (0..20).map(|index| vec![f64::from(index) / 10.0 - 0.95]).collect();
        let level = Level::through(&margins.iter().map(|xi| (&xi[..], 0.2 - xi[0])).collect::<Vec<_>>()).unwrap();
        let inside: Vec<Vec<f64>> = margins.into_iter().filter(|xi| xi[0] > 0.2).collect();
        let basis = Basis::Fitted(Fitted::new(2, &[level], &inside));
        let values: Vec<f64> = inside.iter().map(|xi| f(xi[0])).collect();
        let squares = LeastSquares::new(&basis.values(&inside), vec![1.0; inside.len()]).unwrap();
        let (coefficients, left_out) = squares.fit(&values).unwrap();
        assert!(largest(left_out) < 1e-9);
        let [terms] = &basis.values(&[vec![0.201]])[..] else { panic!() };
        let value: f64 = terms.iter().zip(&coefficients).map(|(term, coefficient)| term * coefficient).sum();
        assert!((value - f(0.201)).abs() < 1e-8);
    }

    /// Samples of a layer 2e-3 wide: between them a line has the values at them.
    #[test]
    fn terms_of_a_layer_do_not_cancel() {
        let line = |x: f64| 1.28 - 0.3 * x;
        let samples: Vec<Vec<f64>> = (0..31).map(|index| vec![-0.009 + 8e-5 * f64::from(index)]).collect();
        let margins: Vec<f64> = samples.iter().map(|xi| -0.0066 - xi[0]).collect();
        let all: Vec<(&[f64], f64)> = samples.iter().zip(&margins).map(|(xi, margin)| (&xi[..], -margin)).collect();
        let basis = Basis::Fitted(Fitted::new(4, &[Level::through(&all).unwrap()], &samples));
        let squares = LeastSquares::new(&basis.values(&samples), vec![1.0; samples.len()]).unwrap();
        let values: Vec<f64> = samples.iter().map(|xi| line(xi[0])).collect();
        let (coefficients, _) = squares.fit(&values).unwrap();
        for index in 0..300 {
            let xi = -0.009 + 8e-6 * f64::from(index);
            let [terms] = &basis.values(&[vec![xi]])[..] else { panic!() };
            let value: f64 = terms.iter().zip(&coefficients).map(|(term, coefficient)| term * coefficient).sum();
            assert!((value - line(xi)).abs() < 1e-12, "{:e} at {xi}", value - line(xi));
        }
    }

    /// A layer in which a contact's length goes with atan √d: from 1e-7 to 1e-5 deep behind a curved surface.
    #[test]
    fn layers_are_resolved_by_the_root_of_their_depth() {
        let margin = |xi: &[f64]| xi[0] - 0.2 * xi[1] * xi[1];
        let of = |xi: &[f64]| (1.0 + 0.1 * xi[1]) * (3e2 * (-margin(xi)).sqrt()).atan();
        let at = |index: usize, count: usize| {
            let (along, deep) = (index as f64 / count as f64 * 2.0 - 1.0, (index * 7 % count) as f64 / count as f64);
            let root = 3e-4 + deep * (3e-3 - 3e-4);
            vec![0.2 * along * along - root * root, along]
        };
        let points = crate::numerics::spread(2, 60);
        let all: Vec<(&[f64], f64)> = points.iter().map(|xi| (&xi[..], margin(xi))).collect();
        let level = Level::through(&all).unwrap();
        let xi: Vec<Vec<f64>> = (0..40).map(|index| at(index, 40)).collect();
        let values: Vec<f64> = xi.iter().map(|xi| of(xi)).collect();
        let worst = |fitted: Fitted| {
            let basis = Basis::Fitted(fitted);
            let (own, _) = LeastSquares::new(&basis.values(&xi), vec![1.0; 40]).unwrap().fit(&values).unwrap();
            let others: Vec<Vec<f64>> = (0..97).map(|index| at(index, 97)).collect();
            let found = basis.values(&others).into_iter();
            let value = |terms: Vec<f64>| -> f64 { terms.iter().zip(&own).map(|(term, own)| term * own).sum() };
            largest(found.map(value).zip(&others).map(|(value, xi)| value - of(xi)))
        };
        let across = worst(Fitted::across(5, &level, level.steepest(&xi), &xi));
        let along = worst(Fitted::new(4, std::slice::from_ref(&level), &xi));
        assert!(across < 2e-3 && across < 0.2 * along, "{across} {along}");
    }
}
