//! The moves that change a triangulation: flips, splits, insertions and merges.

use super::{Corner, REMOVED, Triangulation, WALL, mean_ratio};
use crate::Point;
use crate::number::index_u32;

impl Triangulation {
    /// Quality of the two triangles that a flip of a side would make, the worse one; `None` when
    /// the side is on the boundary or one of them would have two boundary edges.
    pub fn flipped_quality(&self, (t, s): Corner) -> Option<f64> {
        let (u, r) = self.behind((t, s))?;
        let wall = |triangle: usize, side: usize| self.across[triangle][side % 3] & WALL != 0;
        if (wall(t, s + 2) && wall(u, r + 1)) || (wall(t, s + 1) && wall(u, r + 2)) {
            return None;
        }
        let [a, b, c] = self.corners_from((t, s));
        let d = self.beside(self.triangles[u][(r + 2) % 3], a);
        Some(mean_ratio(a, d, c).min(mean_ratio(d, b, c)))
    }

    /// Replaces the common side of two triangles by the other diagonal.
    pub fn flip(&mut self, (t, s): Corner) {
        let (u, r) = self.behind((t, s)).expect("only inner sides are flipped");
        let [a, b, c] = [0, 1, 2].map(|i| self.triangles[t][(s + i) % 3]);
        let d = self.triangles[u][(r + 2) % 3];
        let [bc, ca] = [1, 2].map(|i| self.across[t][(s + i) % 3]);
        let [ad, db] = [1, 2].map(|i| self.across[u][(r + i) % 3]);
        self.triangles[t] = [a, d, c];
        self.across[t] = [ad, index_u32(u), ca];
        self.triangles[u] = [d, b, c];
        self.across[u] = [db, bc, index_u32(t)];
        self.repoint(ad, u, t);
        self.repoint(bc, t, u);
        self.incident[a as usize] = index_u32(t);
        self.incident[b as usize] = index_u32(u);
        self.incident[c as usize] = index_u32(t);
        self.incident[d as usize] = index_u32(t);
    }

    /// Adds a vertex.
    fn add(&mut self, point: Point<2>, size: f64, fixed: bool) -> u32 {
        self.points.push(point);
        self.sizes.push(size);
        self.fixed.push(fixed);
        self.incident.push(0);
        index_u32(self.points.len()) - 1
    }

    /// Puts a vertex on a side and cuts the triangles next to it in two.
    ///
    /// A boundary edge is cut in two edges; `parameter` is that of the new vertex on its piece.
    pub fn split(&mut self, (t, s): Corner, point: Point<2>, parameter: f64) -> u32 {
        let behind = self.behind((t, s));
        let ends = [0, 1].map(|i| self.sizes[self.triangles[t][(s + i) % 3] as usize]);
        let m = self.add(point, 0.5 * (ends[0] + ends[1]), behind.is_none());
        let (first_half, second_half) = if behind.is_none() {
            let edge = (self.across[t][s] & !WALL) as usize;
            let mut second = self.edges[edge];
            second.vertices[0] = m;
            second.parameters[0] = parameter;
            self.edges[edge].vertices[1] = m;
            self.edges[edge].parameters[1] = parameter;
            self.edges.push(second);
            ((index_u32(edge) | WALL), (index_u32(self.edges.len()) - 1) | WALL)
        } else {
            (0, 0)
        };
        let first = self.halve((t, s), m);
        if let Some((u, r)) = behind {
            let second = self.halve((u, r), m);
            // t keeps the side from a to m, u the one from b to m: they face the new ones
            self.across[t][s] = index_u32(second);
            self.across[second][0] = index_u32(t);
            self.across[u][r] = index_u32(first);
            self.across[first][0] = index_u32(u);
        } else {
            self.across[t][s] = first_half;
            self.across[first][0] = second_half;
        }
        m
    }

    /// Cuts a triangle from the middle of a side to the opposite corner; the new one holds the
    /// second half of the side as its side 0.
    fn halve(&mut self, (t, s): Corner, m: u32) -> usize {
        let [_, b, c] = [0, 1, 2].map(|i| self.triangles[t][(s + i) % 3]);
        let bc = self.across[t][(s + 1) % 3];
        let new = self.triangles.len();
        self.triangles.push([m, b, c]);
        self.across.push([0, bc, index_u32(t)]);
        self.triangles[t][(s + 1) % 3] = m;
        self.across[t][(s + 1) % 3] = index_u32(new);
        self.repoint(bc, t, new);
        self.incident[m as usize] = index_u32(new);
        self.incident[b as usize] = index_u32(new);
        self.incident[c as usize] = index_u32(new);
        new
    }

    /// Puts a vertex inside a triangle.
    pub fn insert(&mut self, t: usize, point: Point<2>) -> u32 {
        let [a, b, c] = self.triangles[t];
        let size = [a, b, c].map(|v| self.sizes[v as usize]).iter().sum::<f64>() / 3.0;
        let m = self.add(point, size, false);
        let [ab, bc, ca] = self.across[t];
        let u = self.triangles.len();
        let w = u + 1;
        self.triangles[t] = [a, b, m];
        self.across[t] = [ab, index_u32(u), index_u32(w)];
        self.triangles.push([b, c, m]);
        self.across.push([bc, index_u32(w), index_u32(t)]);
        self.triangles.push([c, a, m]);
        self.across.push([ca, index_u32(t), index_u32(u)]);
        self.repoint(bc, t, u);
        self.repoint(ca, t, w);
        self.incident[a as usize] = index_u32(t);
        self.incident[b as usize] = index_u32(u);
        self.incident[c as usize] = index_u32(u);
        self.incident[m as usize] = index_u32(t);
        m
    }

    /// Worst quality after the inner vertex at a corner is merged into the next corner of the
    /// triangle; `None` when that would put two boundary edges on a triangle.
    pub fn merged_quality(&self, (t, s): Corner, star: &[Corner]) -> Option<f64> {
        let v = self.triangles[t][s];
        let into = self.triangles[t][(s + 1) % 3];
        debug_assert!(!self.is_fixed(v));
        let mut worst = f64::INFINITY;
        for (triangle, local) in star {
            let corners = self.triangles[*triangle];
            if corners.contains(&into) {
                continue;
            }
            let (x, y) = (corners[(local + 1) % 3], corners[(local + 2) % 3]);
            let p = self.points[into as usize];
            let [q, r] = [x, y].map(|v| self.beside(v, p));
            worst = worst.min(mean_ratio(p, q, r));
            let mut walls = usize::from(self.across[*triangle][(local + 1) % 3] & WALL != 0);
            for side in [*local, (local + 2) % 3] {
                // A dying neighbour hands its outer side over
                if let Some((dying, r)) = self.behind((*triangle, side))
                    && self.triangles[dying].contains(&into)
                {
                    let away = self.local(dying, v);
                    debug_assert!(r != (away + 1) % 3);
                    walls += usize::from(self.across[dying][(away + 1) % 3] & WALL != 0);
                }
            }
            if walls > 1 {
                return None;
            }
        }
        Some(worst)
    }

    /// Merges the inner vertex at a corner into the next corner of the triangle.
    pub fn merge(&mut self, (t, s): Corner, star: &[Corner]) {
        let v = self.triangles[t][s];
        let into = self.triangles[t][(s + 1) % 3];
        for (triangle, _) in star {
            if !self.triangles[*triangle].contains(&into) {
                let local = self.local(*triangle, v);
                self.triangles[*triangle][local] = into;
                self.incident[into as usize] = index_u32(*triangle);
            }
        }
        for (dying, _) in star {
            // Those that held both lose their common side: their other two become one
            let corners = self.triangles[*dying];
            if !(corners.contains(&v) && corners.contains(&into)) {
                continue;
            }
            let away = self.local(*dying, v);
            let outer = self.across[*dying][(away + 1) % 3];
            let gone = self.local(*dying, into);
            let kept =
                self.across[*dying][if (gone + 2) % 3 == away { (away + 2) % 3 } else { away }];
            let slot = self.slot(kept as usize, *dying);
            self.across[kept as usize][slot] = outer;
            self.repoint(outer, *dying, kept as usize);
            for c in corners {
                if c != v {
                    self.incident[c as usize] = kept;
                }
            }
            self.triangles[*dying] = REMOVED;
        }
        self.incident[v as usize] = u32::MAX;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::generate::edges::BoundaryEdge;
    use crate::planar::torus::Torus;
    use crate::planar::vector::cross;

    /// A hexagon of radius one around an inner vertex, boundary edge i from corner i.
    fn hexagon() -> Triangulation {
        let corner = |i: u32| {
            let angle = std::f64::consts::FRAC_PI_3 * f64::from(i);
            Point::<2>::new(angle.cos(), angle.sin())
        };
        let mut points: Vec<Point<2>> = (0..6).map(corner).collect();
        points.push(Point::<2>::zeros());
        let edge = |i: u32| BoundaryEdge {
            vertices: [i, (i + 1) % 6],
            piece: 0,
            parameters: [f64::from(i) / 6.0, f64::from(i + 1) / 6.0],
        };
        Triangulation::new(
            points,
            vec![1.0; 7],
            (0..6).map(|i| [i, (i + 1) % 6, 6]).collect(),
            (0..6).map(|i| [WALL | i, (i + 1) % 6, (i + 5) % 6]).collect(),
            (0..6).map(edge).collect(),
            Torus::default(),
        )
    }

    /// Neighbours know each other, stars are complete, the area is that of the hexagon.
    fn assert_consistent(mesh: &Triangulation) {
        let mut area = 0.0;
        for t in (0..mesh.triangles.len()).filter(|t| mesh.is_alive(*t)) {
            let [a, b, c] = mesh.corners(t);
            assert!(mesh.quality(t) > 0.0);
            area += 0.5 * cross(b - a, c - a);
            for s in 0..3 {
                let ends = [mesh.triangles[t][s], mesh.triangles[t][(s + 1) % 3]];
                if let Some((u, r)) = mesh.behind((t, s)) {
                    let other = [mesh.triangles[u][(r + 1) % 3], mesh.triangles[u][r]];
                    assert_eq!(other, ends);
                } else {
                    let edge = (mesh.across[t][s] & !WALL) as usize;
                    assert_eq!(mesh.edges[edge].vertices, ends);
                }
            }
        }
        assert!((area - 1.5 * 3.0_f64.sqrt()).abs() < 1e-14, "{area}");
        let mut star = Vec::new();
        for v in (0..index_u32(mesh.points.len())).filter(|v| mesh.is_used(*v)) {
            mesh.star(v, &mut star);
            let around = mesh.triangles.iter().filter(|corners| corners.contains(&v)).count();
            assert_eq!(star.len(), around);
            assert!(star.iter().all(|(t, local)| mesh.triangles[*t][*local] == v));
        }
    }

    #[test]
    fn every_move_keeps_the_triangulation_consistent() {
        let mut mesh = hexagon();
        assert_consistent(&mesh);
        let inner = mesh.insert(2, Point::<2>::new(-0.4, 0.55));
        assert_consistent(&mesh);
        let middle = (mesh.points[0] + mesh.points[6]) * 0.5;
        mesh.split((0, 2), middle, 0.0);
        assert_consistent(&mesh);
        let middle = (mesh.points[4] + mesh.points[5]) * 0.5;
        let wall = mesh.split((4, 0), middle, 0.75);
        assert!(mesh.is_fixed(wall) && !mesh.is_fixed(inner));
        assert_eq!(mesh.edges[6].parameters, [0.75, 5.0 / 6.0]);
        assert_consistent(&mesh);
        let mut n_flips = 0;
        for t in 0..mesh.triangles.len() {
            for s in 0..3 {
                if mesh.flipped_quality((t, s)).is_some_and(|q| q > 0.1) {
                    mesh.flip((t, s));
                    n_flips += 1;
                    assert_consistent(&mesh);
                }
            }
        }
        assert!(n_flips > 0);
    }

    #[test]
    fn merging_an_inner_vertex_undoes_its_insertion() {
        let mut mesh = hexagon();
        let inner = mesh.insert(3, Point::<2>::new(-0.5, -0.2));
        let mut star = Vec::new();
        mesh.star(inner, &mut star);
        let corner = star[0];
        assert!(mesh.merged_quality(corner, &star).is_some_and(|q| q > 0.99));
        mesh.merge(corner, &star);
        assert!(!mesh.is_used(inner));
        assert_consistent(&mesh);
        mesh.compact();
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (7, 6));
        assert_consistent(&mesh);
    }

    #[test]
    fn a_flip_never_gives_a_triangle_two_boundary_edges() {
        let mesh = hexagon();
        // The spokes end at the boundary: flipped, one triangle would have both edges there
        assert!((0..6).all(|t| mesh.flipped_quality((t, 1)).is_none()));
    }
}
