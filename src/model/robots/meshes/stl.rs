//! Triangles of STL files, as text or in binary.

/// The corners (triangle, corner, 3) of a file's triangles; `None` where it is no STL.
pub fn stl_corners(bytes: &[u8]) -> Option<Vec<f32>> {
    binary(bytes).or_else(|| text(std::str::from_utf8(bytes).ok()?))
}

/// 80 bytes, the number of triangles, and of each 12 numbers, normal first, and two bytes.
fn binary(bytes: &[u8]) -> Option<Vec<f32>> {
    let count = u32::from_le_bytes(bytes.get(80..84)?.try_into().ok()?) as usize;
    let triangles = bytes.get(84..)?;
    if count.checked_mul(50)? != triangles.len() {
        return None;
    }
    let number = |four: &[u8]| Some(f32::from_le_bytes(four.try_into().ok()?));
    triangles.chunks_exact(50).flat_map(|triangle| triangle[12..48].chunks_exact(4).map(number)).collect()
}

fn text(text: &str) -> Option<Vec<f32>> {
    if !text.trim_start().starts_with("solid") {
        return None;
    }
    let corners = text.lines().filter_map(|line| line.trim().strip_prefix("vertex"));
    let corners = corners.flat_map(str::split_whitespace).map(|word| word.parse().ok());
    let corners: Vec<f32> = corners.collect::<Option<_>>()?;
    corners.len().is_multiple_of(9).then_some(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_binary_have_the_same_triangle() {
        let written =
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n";
        let corners = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        assert_eq!(stl_corners(written.as_bytes()), Some(corners.clone()));
        let mut bytes = vec![0; 80];
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend([0.0_f32, 0.0, 1.0].iter().chain(&corners).flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
        assert_eq!(stl_corners(&bytes), Some(corners));
        assert_eq!(stl_corners(&bytes[..130]), None);
        assert_eq!(stl_corners(b"<xml/>"), None);
    }
}
