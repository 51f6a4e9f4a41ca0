//! Small repairs: vertices that are nearly one, triangles without area, triangles seen from inside.

use std::collections::{BTreeSet, HashMap, VecDeque};

use super::TriangleMesh;
use super::edges::edges_of;
use crate::Point;
use crate::number::index_u32;

/// Part of the extent within which vertices are one.
const SAME: f64 = 1e-6;

/// Triangles that were repaired.
#[derive(Debug, Clone, PartialEq)]
pub struct Repaired {
    /// What they are now.
    pub mesh: TriangleMesh,
    /// What was done.
    pub repairs: Repairs,
}

/// What was repaired.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Vertices that were put into others.
    pub welded: usize,
    /// Triangles that had no area, or were there twice.
    pub dropped: usize,
    /// Triangles that were turned.
    pub turned: usize,
}

impl TriangleMesh {
    /// The same with near vertices welded, triangles without area dropped, and the others seen from
    /// outside; and what was done.
    #[must_use]
    pub fn repaired(&self) -> Repaired {
        let mut repairs = Repairs::default();
        let mut mesh = self.welded(&mut repairs);
        mesh.drop_flat(&mut repairs);
        mesh.orient(&mut repairs);
        Repaired { mesh, repairs }
    }

    fn welded(&self, repairs: &mut Repairs) -> Self {
        let near = SAME * self.extent();
        let cell = |at: &Point<3>, axis: usize| (at[axis] / near).floor();
        let mut grid: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
        let mut mesh = Self::default();
        let mut numbers = Vec::with_capacity(self.vertices.len());
        for at in &self.vertices {
            let home = [0, 1, 2].map(|axis| cell(at, axis));
            let mut known = None;
            for step in 0..27_u8 {
                let steps = [step % 3, step / 3 % 3, step / 9].map(|step| f64::from(step) - 1.0);
                let key = [0, 1, 2].map(|axis| (home[axis] + steps[axis] + 0.0).to_bits());
                let there = grid.get(&key).into_iter().flatten();
                let is_near = |one: &&u32| (mesh.vertices[**one as usize] - at).norm() <= near;
                known = known.or_else(|| there.copied().find(|one| is_near(&one)));
            }
            numbers.push(known.unwrap_or_else(|| {
                mesh.vertices.push(*at);
                let number = index_u32(mesh.vertices.len() - 1);
                grid.entry(home.map(|x| (x + 0.0).to_bits())).or_default().push(number);
                number
            }));
        }
        let renamed = self.triangles.iter().map(|triangle| triangle.map(|v| numbers[v as usize]));
        mesh.triangles = renamed.collect();
        repairs.welded = self.vertices.len() - mesh.vertices.len();
        mesh
    }

    fn drop_flat(&mut self, repairs: &mut Repairs) {
        let mut known: BTreeSet<[u32; 3]> = BTreeSet::new();
        let before = self.triangles.len();
        let kept = (0..before).filter(|triangle| {
            let mut key = self.triangles[*triangle];
            key.sort_unstable();
            !self.is_flat(*triangle) && known.insert(key)
        });
        let kept: Vec<[u32; 3]> = kept.map(|triangle| self.triangles[triangle]).collect();
        self.triangles = kept;
        repairs.dropped = before - self.triangles.len();
    }

    /// Turns triangles as the first of their shell, and each shell outwards.
    fn orient(&mut self, repairs: &mut Repairs) {
        let n = self.triangles.len();
        let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); n];
        for beside in edges_of(self).values().filter(|beside| beside.len() == 2) {
            let agree = beside[0].is_forward != beside[1].is_forward;
            neighbours[beside[0].triangle].push((beside[1].triangle, agree));
            neighbours[beside[1].triangle].push((beside[0].triangle, agree));
        }
        let mut is_turned: Vec<Option<bool>> = vec![None; n];
        for start in 0..n {
            if is_turned[start].is_some() {
                continue;
            }
            let mut shell = vec![start];
            let mut waiting = VecDeque::from([start]);
            is_turned[start] = Some(false);
            while let Some(triangle) = waiting.pop_front() {
                let own = is_turned[triangle].unwrap_or_default();
                for (other, agree) in &neighbours[triangle] {
                    if is_turned[*other].is_none() {
                        is_turned[*other] = Some(own == *agree);
                        shell.push(*other);
                        waiting.push_back(*other);
                    }
                }
            }
            let volume: f64 = shell
                .iter()
                .map(|triangle| {
                    let [a, b, c] = self.corners(*triangle).map(|corner| corner - self.vertices[0]);
                    let sign = if is_turned[*triangle] == Some(true) { -1.0 } else { 1.0 };
                    sign * a.dot(&b.cross(&c))
                })
                .sum();
            if volume < 0.0 {
                for triangle in shell {
                    is_turned[triangle] = is_turned[triangle].map(|turned| !turned);
                }
            }
        }
        for (triangle, _) in
            is_turned.iter().enumerate().filter(|(_, turned)| **turned == Some(true))
        {
            self.triangles[triangle].swap(1, 2);
            repairs.turned += 1;
        }
    }
}
