//! A kd-tree of size sources: the lower envelope of cones, exact by branch and bound.

use crate::Point;
use crate::number::index_u32;

/// Sources in one leaf.
const LEAF: usize = 8;

/// A point with a wanted size.
#[derive(Debug, Clone, Copy)]
pub struct SizeSource {
    /// Where (m).
    pub point: Point<2>,
    /// Wanted edge length there (m).
    pub size: f64,
}

/// Points with a wanted size, ready for min_i (h_i + growth |x - x_i|).
#[derive(Debug, Clone)]
pub struct SizeTree {
    sources: Vec<SizeSource>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    min: Point<2>,
    max: Point<2>,
    smallest: f64,
    from: u32,
    to: u32,
    /// Index of the right child; the left one follows its parent. Zero in a leaf.
    right: u32,
}

impl SizeTree {
    /// Tree over places and their sizes (m).
    pub fn new(mut sources: Vec<SizeSource>) -> Self {
        let mut nodes = Vec::new();
        let n = sources.len();
        if n > 0 {
            split(&mut sources, 0, n, &mut nodes);
        }
        Self { sources, nodes }
    }

    /// The places and their sizes.
    pub fn sources(&self) -> &[SizeSource] {
        &self.sources
    }

    /// min(limit, min_i (h_i + growth |x - x_i|)), at most `slack` (relative) above it.
    ///
    /// Far from a surface many cones are equal within a hair; a little slack skips them.
    pub fn envelope(&self, point: Point<2>, growth: f64, limit: f64, slack: f64) -> f64 {
        let mut best = limit;
        let mut stack = [(0_u32, 0.0_f64); 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let (index, bound) = stack[depth];
            if bound >= best * (1.0 - slack) {
                continue;
            }
            let node = self.nodes[index as usize];
            if node.right == 0 {
                for source in &self.sources[node.from as usize..node.to as usize] {
                    best = best.min(source.size + growth * (point - source.point).norm());
                }
                continue;
            }
            let left = (index + 1, self.bound(index + 1, point, growth));
            let right = (node.right, self.bound(node.right, point, growth));
            // The more promising child is looked at first
            let (near, far) = if left.1 <= right.1 { (left, right) } else { (right, left) };
            stack[depth] = far;
            stack[depth + 1] = near;
            depth += 2;
        }
        best
    }

    fn bound(&self, node: u32, point: Point<2>, growth: f64) -> f64 {
        let node = &self.nodes[node as usize];
        let x = (node.min.x - point.x).max(point.x - node.max.x).max(0.0);
        let y = (node.min.y - point.y).max(point.y - node.max.y).max(0.0);
        node.smallest + growth * (x * x + y * y).sqrt()
    }
}

fn split(sources: &mut [SizeSource], from: usize, to: usize, nodes: &mut Vec<Node>) {
    let part = &mut sources[from..to];
    let mut min = part[0].point;
    let mut max = part[0].point;
    let mut smallest = f64::INFINITY;
    for source in part.iter() {
        min = min.inf(&source.point);
        max = max.sup(&source.point);
        smallest = smallest.min(source.size);
    }
    let index = nodes.len();
    nodes.push(Node { min, max, smallest, from: index_u32(from), to: index_u32(to), right: 0 });
    if part.len() <= LEAF {
        return;
    }
    let axis = usize::from(max.y - min.y > max.x - min.x);
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.point[axis].total_cmp(&b.point[axis]));
    split(sources, from, from + middle, nodes);
    nodes[index].right = index_u32(nodes.len());
    split(sources, from + middle, to, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_envelope_is_that_of_the_plain_loop() {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let sources: Vec<_> = (0..500)
            .map(|_| SizeSource {
                point: Point::<2>::new(random(), random()),
                size: 0.01 + 0.1 * random(),
            })
            .collect();
        let tree = SizeTree::new(sources.clone());
        for _ in 0..500 {
            let x = Point::<2>::new(3.0 * random() - 1.0, 3.0 * random() - 1.0);
            let plain =
                sources.iter().map(|s| s.size + 0.3 * (x - s.point).norm()).fold(0.4, f64::min);
            assert!((tree.envelope(x, 0.3, 0.4, 0.0) - plain).abs() < 1e-15);
            let near = tree.envelope(x, 0.3, 0.4, 0.01);
            assert!(near >= plain - 1e-15 && near <= plain / 0.99 + 1e-15);
        }
    }
}
