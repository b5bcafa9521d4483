//! Many numbers in few characters: base64 of 32-bit floats, or of 16-bit whole numbers with a scale.

use data_encoding::BASE64;
use serde::Serialize;

/// 32-bit floats, little-endian.
pub(super) fn floats(values: &[f64]) -> String {
    BASE64.encode(&values.iter().flat_map(|&value| (value as f32).to_le_bytes()).collect::<Vec<u8>>())
}

/// Numbers as whole multiples, up to ±32767, of scales that repeat with a fixed period.
#[derive(Serialize)]
pub(super) struct Packed {
    /// Scale of each index of the period.
    scales: Vec<f32>,
    /// 16-bit integers, little-endian.
    data: String,
}

impl Packed {
    /// Number i has scale i modulo `places`.
    pub fn new(values: &[f64], places: usize) -> Self {
        let mut largest = vec![0.0_f64; places.max(1)];
        for (index, value) in values.iter().enumerate() {
            let largest = &mut largest[index % places];
            *largest = largest.max(value.abs());
        }
        // Rounded up, so that the largest does not leave the range.
        let scales: Vec<f32> = largest.iter().map(|largest| (largest / 32766.0) as f32).collect();
        let whole = |(index, value): (usize, &f64)| match f64::from(scales[index % places]) {
            0.0 => 0,
            scale => (value / scale).round() as i16,
        };
        let bytes: Vec<u8> = values.iter().enumerate().flat_map(|item| whole(item).to_le_bytes()).collect();
        Self { scales, data: BASE64.encode(&bytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_numbers_are_restored_within_half_a_unit() {
        let values: Vec<f64> = (0..300).map(|i| if i % 3 == 0 { 1e-7 } else { 5.0 } * f64::from(i - 150)).collect();
        let packed = Packed::new(&values, 3);
        let bytes = BASE64.decode(packed.data.as_bytes()).unwrap();
        for (index, (pair, value)) in bytes.chunks_exact(2).zip(&values).enumerate() {
            let scale = f64::from(packed.scales[index % 3]);
            let found = scale * f64::from(i16::from_le_bytes([pair[0], pair[1]]));
            assert!((found - value).abs() <= 0.501 * scale, "{index}: {found} {value}");
        }
        assert_eq!(floats(&[1.0]), "AACAPw==");
    }
}
