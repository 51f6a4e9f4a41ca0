//! Improvement of a triangulation: flips, smoothing, merged and split edges, worst cells first.
//!
//! No move makes the worst triangle of those it touches worse, except that moves between good
//! triangles may trade a little quality for a lower energy Σ (1/q - 1)².

use super::relax::{flip_all, flip_from, raise_worst, smooth_all};
use super::trial::try_moves;
use super::triangulation::{Corner, Triangulation, WALL};
use crate::interrupt;
use crate::mesh::jacobian_coefficients;
use crate::planar::boundary::BoundaryLoops;
use crate::planar::vector::cross;

/// Triangles below this mean ratio are repaired one by one; an isosceles one with 30 degrees at its
/// tip has 0.76, with twice 30 at its base 0.60.
const POOR: f64 = 0.8;

/// Triangles below this mean ratio justify to split their boundary edge.
const BAD: f64 = 0.65;

/// A curved triangle whose det J falls below this part of its mean counts as folded.
const FOLDED: f64 = 0.2;

/// Edges shorter than this many h are merged.
const SHORT: f64 = 0.62;

/// Edges longer than this many h are split.
const LONG: f64 = 1.5;

/// Rounds of trials, and rounds in which boundary edges may be split.
const ROUNDS: usize = 4;

/// Improves a triangulation until the repairs no longer help; see the file's sentence.
///
/// Boundary edges are split, on the exact curve, only where nothing else helps. Those of periodic
/// sides never are, since their partners would have to follow.
pub fn improve(mesh: &mut Triangulation, border: &BoundaryLoops, is_curved: bool) {
    open_corners(mesh);
    flip_all(mesh);
    for _ in 0..3 {
        smooth_all(mesh);
        flip_all(mesh);
    }
    for _ in 0..2 {
        if interrupt::check().is_err() {
            return;
        }
        fit_edges(mesh);
        flip_all(mesh);
        for _ in 0..2 {
            smooth_all(mesh);
            flip_all(mesh);
        }
    }
    repair(mesh);
    for _ in 0..ROUNDS {
        if interrupt::check().is_err() || !try_moves(mesh) {
            break;
        }
        repair(mesh);
    }
    for _ in 0..ROUNDS {
        if interrupt::check().is_err() || !split_boundary(mesh, border, is_curved) {
            break;
        }
        flip_all(mesh);
        repair(mesh);
    }
    mesh.compact();
}

/// Gives every triangle at most one boundary edge, so that no corner locks pressure or velocity.
pub fn open_corners(mesh: &mut Triangulation) {
    for t in 0..mesh.triangles.len() {
        if mesh.n_walls(t) < 2 {
            continue;
        }
        let inner = (0..3).find(|s| mesh.across[t][*s] & WALL == 0);
        match inner.map(|s| ((t, s), mesh.flipped_quality((t, s)))) {
            Some((side, Some(quality))) if quality > 0.3 => mesh.flip(side),
            _ => {
                let [a, b, c] = mesh.corners(t);
                mesh.insert(t, (a + b + c) / 3.0);
            }
        }
    }
}

/// Merges edges that are much too short and splits those much too long.
fn fit_edges(mesh: &mut Triangulation) {
    let mut star = Vec::new();
    for t in 0..mesh.triangles.len() {
        for s in 0..3 {
            if !mesh.is_alive(t) || mesh.across[t][s] & WALL != 0 {
                continue;
            }
            let [a, b] = [0, 1].map(|i| mesh.triangles[t][(s + i) % 3]);
            let p = mesh.points[a as usize];
            let q = mesh.beside(b, p);
            let size = 0.5 * (mesh.sizes[a as usize] + mesh.sizes[b as usize]);
            let length = (q - p).norm() / size;
            if length < SHORT {
                let Some((u, r)) = mesh.behind((t, s)) else { continue };
                let corner = if !mesh.is_fixed(a) {
                    (t, s)
                } else if !mesh.is_fixed(b) {
                    (u, r)
                } else {
                    continue;
                };
                mesh.star(mesh.triangles[corner.0][corner.1], &mut star);
                if mesh.merged_quality(corner, &star).is_some_and(|q| q > 0.4) {
                    mesh.merge(corner, &star);
                }
            } else if length > LONG {
                mesh.split((t, s), (p + q) * 0.5, 0.0);
            }
        }
    }
}

/// Splits boundary edges that are the longest side of a bad triangle or fold a curved one.
fn split_boundary(mesh: &mut Triangulation, border: &BoundaryLoops, is_curved: bool) -> bool {
    let mut has_split = false;
    for t in 0..mesh.triangles.len() {
        let Some(s) = (0..3).find(|s| mesh.is_alive(t) && mesh.across[t][*s] & WALL != 0) else {
            continue;
        };
        let edge = mesh.edges[(mesh.across[t][s] & !WALL) as usize];
        let piece = edge.piece as usize;
        if border.is_periodic(piece) {
            continue;
        }
        let [a, b, c] = mesh.corners_from((t, s));
        let is_longest = (b - a).norm() > (c - b).norm().max((a - c).norm());
        let middle = border.cut(piece, edge.parameters[0], edge.parameters[1], 0.5);
        let place = border.point(piece, middle);
        let is_folded = is_curved && !border.is_straight(piece) && {
            let nodes = [a, b, c, place, (b + c) * 0.5, (c + a) * 0.5];
            let lowest = jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
            lowest < FOLDED * cross(b - a, c - a)
        };
        if is_folded || (is_longest && mesh.quality(t) < BAD) {
            mesh.split((t, s), place, middle);
            has_split = true;
        }
    }
    has_split
}

/// Repairs the poor triangles, worst first, until a round no longer helps.
fn repair(mesh: &mut Triangulation) {
    for _ in 0..12 {
        let mut poor: Vec<(f64, usize)> = (0..mesh.triangles.len())
            .filter(|t| mesh.is_alive(*t))
            .map(|t| (mesh.quality(t), t))
            .filter(|(q, _)| *q < POOR)
            .collect();
        poor.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut gained = false;
        for (_, t) in poor {
            if mesh.is_alive(t) && mesh.quality(t) < POOR {
                gained |= repair_one(mesh, t);
            }
        }
        if !gained {
            break;
        }
    }
}

fn repair_one(mesh: &mut Triangulation, t: usize) -> bool {
    let mut gained = false;
    for v in mesh.triangles[t] {
        if !mesh.is_fixed(v) {
            gained |= raise_worst(mesh, v);
        }
    }
    let mut waiting: Vec<Corner> = (0..3).map(|s| (t, s)).collect();
    let before = mesh.quality(t);
    flip_from(mesh, &mut waiting);
    gained || mesh.quality(t) > before
}
