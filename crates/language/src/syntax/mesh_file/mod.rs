//! Triangles of mesh files: STL (text or binary) and OBJ, told apart by their content.

mod obj;
mod stl;

/// A triangle: three corners, in the file's unit.
pub type Triangle = [[f64; 3]; 3];

/// The triangles of a file.
///
/// # Errors
/// The reason, for people.
pub fn triangles(bytes: &[u8]) -> Result<Vec<Triangle>, String> {
    let found = match stl::binary(bytes) {
        Some(found) => found,
        None => {
            let text = std::str::from_utf8(bytes).map_err(|_| "it is no STL or OBJ file".to_owned())?;
            let is_stl = text.trim_start().starts_with("solid");
            if is_stl { stl::text(text)? } else { obj::triangles(text)? }
        }
    };
    if found.is_empty() {
        return Err("it has no triangles".to_owned());
    }
    if !found.iter().flatten().flatten().all(|number| number.is_finite()) {
        return Err("a coordinate in it is not finite".to_owned());
    }
    Ok(found)
}

/// Three numbers of a line.
fn point<'w>(mut words: impl Iterator<Item = &'w str>) -> Option<[f64; 3]> {
    let mut next = || words.next()?.parse().ok();
    Some([next()?, next()?, next()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: Triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];

    #[test]
    fn text_binary_and_obj_have_the_same_triangle() {
        let text =
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 .5\nendloop\nendfacet\n";
        assert_eq!(triangles(text.as_bytes()), Ok(vec![TRIANGLE]));
        let mut bytes = vec![0; 80];
        bytes.extend(1_u32.to_le_bytes());
        let numbers = [0.0_f32, 0.0, 1.0].into_iter().chain(TRIANGLE.as_flattened().iter().map(|&x| x as f32));
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
        assert_eq!(triangles(&bytes), Ok(vec![TRIANGLE]));
        let obj = "# corner\nv 0 0 0\nv 1 0 0\nvn 0 0 1\nv 0 1 0.5\nf 1//1 2//1 -1//1\n";
        assert_eq!(triangles(obj.as_bytes()), Ok(vec![TRIANGLE]));
    }

    #[test]
    fn faces_of_four_corners_are_two_triangles() {
        let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
        let found = triangles(obj.as_bytes()).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(found[1], [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text: &str| triangles(text.as_bytes()).unwrap_err();
        assert_eq!(error("v 0 0 0\nf 1 2 3\n"), "line 2: there is no corner `2`");
        assert_eq!(error("v 0 x 0\n"), "line 1: a corner has three numbers");
        assert_eq!(error("v 0 0 0\nf 1 1\n"), "line 2: a face has three corners or more");
        assert_eq!(error("solid a\nvertex 0 0\n"), "line 2: a corner has three numbers");
        assert_eq!(error("solid a\nvertex 0 0 0\n"), "a triangle in it has fewer than three corners");
        assert_eq!(error("<xml/>"), "it is no STL or OBJ file");
        assert_eq!(error("v 0 0 1e999\nf 1 1 1\n"), "a coordinate in it is not finite");
        assert_eq!(triangles(&[0xff; 130]).unwrap_err(), "it is no STL or OBJ file");
    }
}
