//! What a run looks out for: a flow that has blown up, steps too long for it, contact too weak, bodies that leave.

mod leaving;
mod pace;
mod soundness;

pub(super) use pace::Pace;
