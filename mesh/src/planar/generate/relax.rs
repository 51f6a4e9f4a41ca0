//! Relaxation of a triangulation: flips, and vertices moved to where their triangles are better.

use super::triangulation::{Corner, Triangulation, WALL, mean_ratio};
use crate::Point;
use crate::interrupt::is_requested;
use crate::number::index_u32;

/// Triangles above this mean ratio may lose a little in favour of their neighbours.
const GOOD: f64 = 0.85;

/// A change must improve by more than rounding.
const PROGRESS: f64 = 1e-9;

/// Flips sides as long as the worse triangle of a pair becomes better, or until the work is to end.
pub fn flip_all(mesh: &mut Triangulation) {
    let mut waiting: Vec<Corner> = Vec::new();
    for t in (0..mesh.triangles.len()).rev().filter(|t| mesh.is_alive(*t)) {
        waiting.extend([2, 1, 0].map(|s| (t, s)).iter().filter(|(_, s)| {
            let other = mesh.across[t][*s];
            other & WALL == 0 && (other as usize) > t
        }));
    }
    flip_from(mesh, &mut waiting);
}

pub fn flip_from(mesh: &mut Triangulation, waiting: &mut Vec<Corner>) {
    while let Some((t, s)) = waiting.pop() {
        if is_requested() {
            return;
        }
        let Some((u, _)) = mesh.behind((t, s)) else { continue };
        let now = mesh.quality(t).min(mesh.quality(u));
        if mesh.flipped_quality((t, s)).is_some_and(|then| then > now + PROGRESS) {
            mesh.flip((t, s));
            waiting.extend([(t, 0), (t, 2), (u, 0), (u, 1)]);
        }
    }
}

/// One sweep of smoothing over all inner vertices.
pub fn smooth_all(mesh: &mut Triangulation) {
    let mut star = Vec::new();
    for v in (0..index_u32(mesh.points.len())).take_while(|_| !is_requested()) {
        if !mesh.is_fixed(v) && mesh.is_used(v) {
            mesh.star(v, &mut star);
            smooth(mesh, v, &star);
        }
    }
}

/// How good the triangles around a vertex are.
#[derive(Debug, Clone, Copy)]
struct RingQuality {
    /// Sum of (1/q - 1)².
    energy: f64,
    /// The worst quality.
    worst: f64,
}

fn ring_quality(ring: &[[Point<2>; 2]], place: Point<2>) -> RingQuality {
    let mut sum = 0.0;
    let mut worst = f64::INFINITY;
    for [a, b] in ring {
        let q = mean_ratio(place, *a, *b);
        worst = worst.min(q);
        let excess = 1.0 / q.max(1e-9) - 1.0;
        sum += excess * excess;
    }
    RingQuality { energy: sum, worst }
}

fn ring(mesh: &Triangulation, star: &[Corner]) -> Vec<[Point<2>; 2]> {
    star.iter()
        .map(|(t, local)| {
            let corners = mesh.triangles[*t];
            [1, 2].map(|i| {
                mesh.beside(corners[(local + i) % 3], mesh.points[corners[*local] as usize])
            })
        })
        .collect()
}

/// Moves a vertex towards the mean apex of equilateral triangles on the sides around it.
fn smooth(mesh: &mut Triangulation, v: u32, star: &[Corner]) {
    let ring = ring(mesh, star);
    let here = mesh.points[v as usize];
    let mut target = Point::<2>::zeros();
    for [a, b] in &ring {
        let along = b - a;
        target += (a + b) * 0.5 + Point::<2>::new(-along.y, along.x) * (0.5 * 3.0_f64.sqrt());
    }
    target /= ring.len() as f64;
    let now = ring_quality(&ring, here);
    let mut step = target - here;
    for _ in 0..3 {
        let place = here + step;
        let then = ring_quality(&ring, place);
        if then.energy < now.energy * (1.0 - 1e-4) && then.worst >= now.worst.min(GOOD) {
            mesh.points[v as usize] = place;
            return;
        }
        step *= 0.5;
    }
}

/// Moves a vertex to where its worst triangle is best: a pattern search; whether it gained.
pub fn raise_worst(mesh: &mut Triangulation, v: u32) -> bool {
    let mut star = Vec::new();
    mesh.star(v, &mut star);
    let ring = ring(mesh, &star);
    let mut place = mesh.points[v as usize];
    let start = ring_quality(&ring, place).worst;
    let mut worst = start;
    let reach = ring.iter().map(|[a, _]| (a - place).norm()).fold(f64::INFINITY, f64::min);
    let mut step = 0.3 * reach;
    while step > 1e-3 * reach {
        let mut moved = false;
        for k in 0..8 {
            let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
            let there = place + Point::<2>::new(cos, sin) * step;
            let quality = ring_quality(&ring, there).worst;
            if quality > worst + PROGRESS {
                (place, worst, moved) = (there, quality, true);
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    mesh.points[v as usize] = place;
    worst > start + 1e-4
}
