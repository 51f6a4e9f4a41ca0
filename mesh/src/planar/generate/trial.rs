//! Trials on a copy: merge or split an edge near a bad triangle, relax, keep what is better.
//!
//! Where the connections themselves are wrong, as in narrow corners, neither flips nor smoothing
//! lead out; one vertex more or less does.

use super::relax::{flip_from, raise_worst};
use super::triangulation::{Corner, Triangulation, WALL};

/// Triangles below this mean ratio are worth a trial.
const BAD: f64 = 0.78;

/// The shortage of triangles is counted from this mean ratio down.
const FULL: f64 = 0.8;

/// Work allowed, in triangles looked at: a mesh of 100 000 has a few trials, a small one many.
const WORK: usize = 1_000_000;

/// Sweeps of relaxation after a move.
const SWEEPS: usize = 3;

/// Tries moves around the worst triangles; whether any was kept.
pub fn try_moves(mesh: &mut Triangulation) -> bool {
    let mut bad: Vec<(f64, usize)> = (0..mesh.triangles.len())
        .filter(|t| mesh.is_alive(*t))
        .map(|t| (mesh.quality(t), t))
        .filter(|(q, _)| *q < BAD)
        .collect();
    bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut trials = (WORK / mesh.triangles.len().max(1)).max(1);
    let mut has_gained = false;
    let mut shortage = total_shortage(mesh);
    for (_, t) in bad {
        if !mesh.is_alive(t) || mesh.quality(t) >= BAD {
            continue;
        }
        for change in moves(mesh, t) {
            if trials == 0 {
                return has_gained;
            }
            trials -= 1;
            let mut copy = mesh.clone();
            if !apply(&mut copy, change) {
                continue;
            }
            let then = total_shortage(&copy);
            if then < 0.9 * shortage {
                *mesh = copy;
                shortage = then;
                has_gained = true;
                break;
            }
        }
    }
    has_gained
}

/// Sum of the squared shortages of quality.
fn total_shortage(mesh: &Triangulation) -> f64 {
    (0..mesh.triangles.len())
        .filter(|t| mesh.is_alive(*t))
        .map(|t| (FULL - mesh.quality(t)).max(0.0).powi(2))
        .sum()
}

/// A change of the connections.
#[derive(Debug, Clone, Copy)]
enum Change {
    /// The side that starts at a corner is split.
    Split(Corner),
    /// The vertex at a corner is merged into the next one.
    Merge(Corner),
}

/// Changes of the inner sides of a triangle and of its neighbours, merges first.
fn moves(mesh: &Triangulation, t: usize) -> Vec<Change> {
    let around = mesh.across[t].into_iter().filter(|n| n & WALL == 0).map(|n| n as usize);
    let triangles: Vec<usize> = std::iter::once(t).chain(around).collect();
    let mut moves = Vec::new();
    for split in [false, true] {
        for triangle in &triangles {
            for side in 0..3 {
                let corner = (*triangle, side);
                let is_inner = mesh.across[*triangle][side] & WALL == 0;
                if is_inner && split {
                    moves.push(Change::Split(corner));
                } else if is_inner && !mesh.is_fixed(mesh.triangles[*triangle][side]) {
                    moves.push(Change::Merge(corner));
                }
            }
        }
    }
    moves
}

/// Makes a move and relaxes the patch around it; whether it was possible.
fn apply(mesh: &mut Triangulation, change: Change) -> bool {
    let (Change::Split((t, s)) | Change::Merge((t, s))) = change;
    let [a, b] = [0, 1].map(|i| mesh.triangles[t][(s + i) % 3]);
    let center = match change {
        Change::Split(corner) => {
            let from = mesh.points[a as usize];
            let middle = (from + mesh.beside(b, from)) * 0.5;
            mesh.split(corner, middle, 0.0)
        }
        Change::Merge(corner) => {
            let mut star = Vec::new();
            mesh.star(a, &mut star);
            if mesh.merged_quality(corner, &star).is_none_or(|quality| quality < 0.05) {
                return false;
            }
            mesh.merge(corner, &star);
            b
        }
    };
    for _ in 0..SWEEPS {
        let vertices = patch(mesh, center);
        let mut waiting: Vec<Corner> = Vec::new();
        let mut star = Vec::new();
        for v in &vertices {
            mesh.star(*v, &mut star);
            waiting.extend(star.iter().flat_map(|(t, _)| [(*t, 0), (*t, 1), (*t, 2)]));
        }
        flip_from(mesh, &mut waiting);
        for v in vertices {
            if !mesh.is_fixed(v) {
                raise_worst(mesh, v);
            }
        }
    }
    true
}

/// A vertex, its neighbours and theirs.
fn patch(mesh: &Triangulation, center: u32) -> Vec<u32> {
    let mut vertices = vec![center];
    let mut star = Vec::new();
    let mut from = 0;
    for _ in 0..2 {
        let ring = from..vertices.len();
        from = vertices.len();
        for i in ring {
            mesh.star(vertices[i], &mut star);
            for (t, _) in &star {
                for v in mesh.triangles[*t] {
                    if !vertices.contains(&v) {
                        vertices.push(v);
                    }
                }
            }
        }
    }
    vertices
}
