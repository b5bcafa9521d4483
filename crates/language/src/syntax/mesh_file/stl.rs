//! STL: triangles alone, as text or in binary.

use super::{Triangle, point};

/// Reads 80 bytes, the number of triangles, and for each of them 12 numbers, normal first, and two bytes; `None` if the
/// file has another form.
pub fn binary(bytes: &[u8]) -> Option<Vec<Triangle>> {
    let count = u32::from_le_bytes(bytes.get(80..84)?.try_into().ok()?) as usize;
    let triangles = bytes.get(84..)?;
    if count.checked_mul(50)? != triangles.len() {
        return None;
    }
    let number = |bytes: &[u8], index: usize| {
        let four = bytes.get(4 * index..4 * index + 4)?.try_into().ok()?;
        Some(f64::from(f32::from_le_bytes(four)))
    };
    let corner = |bytes: &[u8], index: usize| {
        let first = 3 + 3 * index;
        Some([number(bytes, first)?, number(bytes, first + 1)?, number(bytes, first + 2)?])
    };
    let triangle = |bytes: &[u8]| Some([corner(bytes, 0)?, corner(bytes, 1)?, corner(bytes, 2)?]);
    triangles.chunks_exact(50).map(triangle).collect()
}

/// Reads lines, of which those with `vertex` are corners.
pub fn text(text: &str) -> Result<Vec<Triangle>, String> {
    let mut corners = Vec::new();
    for (line, text) in text.lines().enumerate() {
        let Some(rest) = text.trim().strip_prefix("vertex") else { continue };
        let corner = point(rest.split_whitespace());
        corners.push(corner.ok_or_else(|| format!("line {}: a corner has three numbers", line + 1))?);
    }
    let (triangles, rest) = corners.as_chunks();
    if rest.is_empty() {
        Ok(triangles.to_vec())
    } else {
        Err("a triangle in it has fewer than three corners".to_owned())
    }
}
