//! OBJ: lines `v x y z` and `f 1 2 3`, groups by `g` and `o`; all else is passed over.

use super::lines::{at_line, fan};
use super::{NamedTriangles, SurfaceFault, at_most};
use crate::Point;
use crate::number::index_u32;

/// Reads a text.
pub fn read(text: &str) -> Result<NamedTriangles, SurfaceFault> {
    let mut named = NamedTriangles::default();
    for (nth, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let mesh = &mut named.mesh;
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
                // A weight or a colour may follow
                let [x, y, z, ..] = numbers[..] else {
                    return Err(at_line(nth, "`v` is not followed by x y z"));
                };
                mesh.vertices.push(Point::<3>::new(x, y, z));
            }
            Some("f") => {
                let number = |word: &str| vertex(word, mesh.vertices.len());
                let polygon = words.map(number).collect::<Option<Vec<u32>>>();
                let Some(polygon) = polygon.filter(|polygon| polygon.len() >= 3) else {
                    let found = "`f` is not followed by numbers of three or more vertices above";
                    return Err(at_line(nth, found));
                };
                mesh.triangles.extend(fan(&polygon));
                at_most(mesh.triangles.len())?;
            }
            Some("g" | "o") => named.begin(words.next().unwrap_or_default()),
            _ => {}
        }
    }
    named.close();
    Ok(named)
}

/// The index of a vertex by its number from 1 on, or from the last one, -1, back; `7/1/3` is vertex 7.
fn vertex(word: &str, n: usize) -> Option<u32> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let n = i64::from(index_u32(n));
    let index = if number < 0 { n.checked_add(number)? } else { number - 1 };
    u32::try_from(index).ok().filter(|_| index < n)
}
