//! Triangles of OBJ files: `v x y z`, and `f` with polygons of corners, each `place`, `place/texture` or
//! `place/texture/normal`; negative places count from the last corner.

use super::Triangle;

pub fn triangles(text: &str) -> Option<Vec<Triangle>> {
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut found = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.take(3).map(|word| word.parse().ok()).collect::<Option<_>>()?;
                corners.push(numbers.try_into().ok()?);
            }
            Some("f") => {
                let corner = |word: &str| {
                    let place: isize = word.split('/').next()?.parse().ok()?;
                    let from_end = corners.len().checked_add_signed(place);
                    let place = if place < 0 { from_end? } else { usize::try_from(place).ok()?.checked_sub(1)? };
                    corners.get(place).copied()
                };
                let polygon: Vec<[f64; 3]> = words.map(corner).collect::<Option<_>>()?;
                let (first, rest) = polygon.split_first()?;
                found.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::triangles;

    #[test]
    fn polygons_are_fans_and_places_count_from_either_end() {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n# a comment\nvn 0 0 1\nv 0 1 0\n";
        let square = [[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], [[0.0; 3], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]];
        for face in ["f 1 2 3 4", "f 1/1/1 2//1 3/3 4", "f -4 -3 -2 -1"] {
            assert_eq!(triangles(&format!("{corners}{face}\n")).as_deref(), Some(&square[..]), "{face}");
        }
        for wrong in ["f 1 2 5", "f 0 1 2", "f -5 1 2", "f a b c", "v 1 2", "v 1 x 3"] {
            assert_eq!(triangles(&format!("{corners}{wrong}\n")), None, "{wrong}");
        }
    }
}
