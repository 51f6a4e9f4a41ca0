//! Where the contributions of fronts are kept until their parents take them.

use std::ops::Range;

use super::super::front::{Front, Subtree};

/// Plans the stack of the fronts of a subtree, or of those above: sets where the contribution of each
/// is kept, and returns how large the stack gets.
///
/// A front writes its contribution to one end of the stack while it takes those of its children from
/// the other.
pub(super) fn plan_stack(fronts: &mut [Front], children: &[u32], range: Range<usize>) -> Subtree {
    let is_inside = |front: usize| range.contains(&front);
    for index in range.clone().rev() {
        // Parents come after their children.
        let parent = fronts[index].parent.filter(|&parent| is_inside(parent));
        fronts[index].grows_down = parent.is_some_and(|parent| !fronts[parent].grows_down);
    }
    // Sizes in use at the lower and at the upper end, and the largest sum of both.
    let (mut low, mut high, mut largest) = (0usize, 0usize, 0usize);
    for index in range.clone() {
        let front = &fronts[index];
        // What leaves the subtree is kept outside the stack.
        let stays = front.parent.is_some_and(is_inside);
        let size = if stays { front.r * front.r } else { 0 };
        let taken: usize = children[front.children.clone()]
            .iter()
            .filter(|&&child| is_inside(child as usize))
            .map(|&child| fronts[child as usize].r.pow(2))
            .sum();
        let front = &mut fronts[index];
        if front.grows_down {
            high += size;
            largest = largest.max(low + high);
            low -= taken;
            front.contribution = high;
        } else {
            front.contribution = low;
            low += size;
            largest = largest.max(low + high);
            high -= taken;
        }
    }
    for front in fronts[range.clone()].iter_mut().filter(|front| front.grows_down) {
        front.contribution = largest - front.contribution;
    }
    Subtree { fronts: range, stack_size: largest }
}
