//! The beta law on [0, 1].

use symdiff::math;

/// I_x(a, b): how much of the law lies below x. By its continued fraction (modified Lentz; W. H. Press et al.,
/// Numerical Recipes, section 6.4), where that converges fast, else by its symmetry.
pub fn beta_cdf(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    let front = math::exp(
        math::ln_gamma(a + b) - math::ln_gamma(a) - math::ln_gamma(b) + a * math::ln(x) + b * math::ln_1p(-x),
    );
    if x < (a + 1.0) / (a + b + 2.0) {
        front * fraction(x, a, b) / a
    } else {
        1.0 - front * fraction(1.0 - x, b, a) / b
    }
}

fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let kept = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let mut value = d;
    for m in 1..1000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for term in [even, odd] {
            d = 1.0 / kept(1.0 + term * d);
            c = kept(1.0 + term / c);
            change = c * d;
            value *= change;
        }
        if (change - 1.0).abs() < 1e-16 {
            break;
        }
    }
    value
}

/// The x below which p of the law lies, by bisection of the bracket and the secant within it (Illinois).
pub fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    let (mut below, mut above) = (-p, 1.0 - p);
    for round in 0..200 {
        let secant = low - below * (high - low) / (above - below);
        let middle = if round % 3 == 2 || !(secant > low && secant < high) { 0.5 * (low + high) } else { secant };
        let value = beta_cdf(middle, a, b) - p;
        if value < 0.0 {
            (low, below) = (middle, value);
            above *= 0.5;
        } else {
            (high, above) = (middle, value);
            below *= 0.5;
        }
        if high - low <= 1e-15 * high || value == 0.0 {
            return middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials() {
        // Beta(2, 3): I_x = 6x² − 8x³ + 3x⁴; Beta(2, 5): 1 − (1 − x)⁵ (1 + 5x).
        let x = beta_quantile(0.05, 2.0, 3.0);
        assert!((6.0 * x * x - 8.0 * x * x * x + 3.0 * x * x * x * x - 0.05).abs() < 1e-15);
        let x = beta_quantile(0.5, 2.0, 5.0);
        assert!((1.0 - (1.0 - x).powi(5) * (1.0 + 5.0 * x) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn closed_forms() {
        for i in 1..20 {
            let p = f64::from(i) / 20.0;
            // Beta(1, 1) is even, Beta(n, 1) is xⁿ, Beta(½, ½) the arcsine law, and Beta(2, 2) is 3x² − 2x³.
            assert!((beta_quantile(p, 1.0, 1.0) - p).abs() < 1e-14);
            assert!((beta_quantile(p, 2.0, 1.0) - p.sqrt()).abs() < 1e-14);
            let x = beta_quantile(p, 2.0, 2.0);
            assert!((3.0 * x * x - 2.0 * x * x * x - p).abs() < 1e-14);
            let sine = math::sin(0.5 * std::f64::consts::PI * p);
            assert!((beta_quantile(p, 0.5, 0.5) - sine * sine).abs() < 1e-12);
        }
    }
}
