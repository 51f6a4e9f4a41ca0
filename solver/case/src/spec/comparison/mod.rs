//! What a run is compared with: references, the statistics they are values of, and how certain they are.

pub(crate) mod data;
pub(crate) mod reference;
pub(crate) mod statistic;
pub(crate) mod uncertainty;
