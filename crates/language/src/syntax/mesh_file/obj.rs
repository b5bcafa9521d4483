//! OBJ: corners (`v`) and faces of three or more of them (`f`); all else is appearance.

use super::{Triangle, point};

/// Faces, each as a fan of triangles.
pub fn triangles(text: &str) -> Result<Vec<Triangle>, String> {
    let (mut corners, mut found) = (Vec::new(), Vec::new());
    let mut is_obj = false;
    for (line, text) in text.lines().enumerate() {
        let wrong = |reason: String| format!("line {}: {reason}", line + 1);
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => {
                is_obj = true;
                corners.push(point(words).ok_or_else(|| wrong("a corner has three numbers".to_owned()))?);
            }
            Some("f") => {
                is_obj = true;
                let face = words.map(|word| corner(word, &corners)).collect::<Result<Vec<_>, _>>().map_err(wrong)?;
                let [first, rest @ ..] = face.as_slice() else { continue };
                if rest.len() < 2 {
                    return Err(wrong("a face has three corners or more".to_owned()));
                }
                found.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    if is_obj { Ok(found) } else { Err("it is no STL or OBJ file".to_owned()) }
}

/// The corner of `corner/texture/normal`: counted from 1, or backwards from the last one.
fn corner(word: &str, corners: &[[f64; 3]]) -> Result<[f64; 3], String> {
    let number = word.split('/').next().unwrap_or_default();
    let index = match number.parse::<i64>() {
        Ok(count) if count > 0 => usize::try_from(count - 1).ok(),
        Ok(back) => usize::try_from(back.unsigned_abs()).ok().and_then(|back| corners.len().checked_sub(back)),
        Err(_) => None,
    };
    let known = index.and_then(|index| corners.get(index));
    known.copied().ok_or_else(|| format!("there is no corner `{}`", super::super::suggest::clip(number)))
}
