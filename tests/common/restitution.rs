//! The closed form of impacts by Hunt and Crossley's formula.

/// The coefficient of restitution e of an impact with dissipation, d = χ v: d − ln(1 + d) = −d e − ln(1 − d e)
/// (Marhefka & Orin).
pub fn restitution(d: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0_f64.min(1.0 / d));
    for _ in 0..100 {
        let e = 0.5 * (low + high);
        if -d * e - (-d * e).ln_1p() > d - d.ln_1p() { high = e } else { low = e }
    }
    low
}
