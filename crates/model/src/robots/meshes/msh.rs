//! Triangles of MuJoCo's MSH files: numbers of corners, normals, points of textures and triangles as 32-bit integers;
//! then corners, normals and points of textures as 32-bit floats, and three indices of corners a triangle.

use super::{Triangle, indexed};

pub fn triangles(bytes: &[u8]) -> Option<Vec<Triangle>> {
    let (words, []) = bytes.as_chunks::<4>() else { return None };
    let count = |index: usize| usize::try_from(i32::from_le_bytes(*words.get(index)?)).ok();
    let [corners, normals, textures, faces] = [count(0)?, count(1)?, count(2)?, count(3)?];
    let floats = [corners.checked_mul(3)?, normals.checked_mul(3)?, textures.checked_mul(2)?];
    let first_face = floats.iter().try_fold(4_usize, |sum, more| sum.checked_add(*more))?;
    if first_face.checked_add(faces.checked_mul(3)?)? != words.len() {
        return None;
    }
    let (corners, _) = words[4..4 + floats[0]].as_chunks::<3>();
    let corners: Vec<[f64; 3]> =
        corners.iter().map(|corner| corner.map(|word| f64::from(f32::from_le_bytes(word)))).collect();
    let (faces, _) = words[first_face..].as_chunks::<3>();
    // A negative index is past every corner.
    let index = |word: [u8; 4]| u32::from_le_bytes(word) as usize;
    indexed(&corners, faces.iter().map(|face| face.map(index)))
}

#[cfg(test)]
mod tests {
    use super::triangles;

    #[test]
    fn a_triangle_is_read_and_a_file_of_another_length_is_not() {
        let mut bytes: Vec<u8> = [3, 0, 0, 1].into_iter().flat_map(i32::to_le_bytes).collect();
        bytes.extend([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.0].into_iter().flat_map(f32::to_le_bytes));
        bytes.extend([0, 1, 2].into_iter().flat_map(i32::to_le_bytes));
        assert_eq!(triangles(&bytes), Some(vec![[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]]]));
        assert_eq!(triangles(&bytes[..bytes.len() - 4]), None);
        let last = bytes.len() - 4;
        bytes[last] = 3;
        assert_eq!(triangles(&bytes), None);
    }
}
