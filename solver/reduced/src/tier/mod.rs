//! The soft tier as commands use it: from a soft case to its body, its motion, searches and their files.

mod compare;
mod evaluate;
mod fields;
mod job;
mod marked;
mod mesh;
mod model;
mod output;
mod parameters;
mod record;
mod rounds;
mod series;
mod solid;
mod surface;
mod written;

pub use compare::{Compared, compare};
pub use evaluate::{Kind, Seeker, WayAndWork};
pub use fields::{rest_mesh, write_fields};
pub use job::{Job, JobResult, Which};
pub use mesh::{Bodies, SolidOf};
pub use model::{Model, TierError};
pub use output::{checksum_of_case, fingerprint, write_case};
pub use parameters::Sought;
pub use rounds::{Perturbed, Robot, Round, Rounds, Seen, settings};
pub use series::{Series, series};
pub use written::Written;
