//! What a run looks out for: a flow that has blown up, steps too long for it, contact too weak, bodies that leave.

mod blow_up;
mod cell_bound;
mod drives;
mod force_agreement;
mod given_loads;
mod given_values;
mod leaving;
mod not_finite;
mod pace;
mod resolution;
mod self_contact;
mod sound_state;
mod soundness;

pub(super) use cell_bound::nearest_gap;
pub use cell_bound::{Allowed, AllowedBy, AtHand, CellBound};
pub(super) use force_agreement::ForceAgreement;
pub use given_values::{Places, by_key};
pub use not_finite::NotFinite;
pub(super) use pace::Pace;
pub(super) use sound_state::SoundState;
