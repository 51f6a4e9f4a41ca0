//! Many runs of one case: their directory, their processes, one table of all of them.
//!
//! A sweep has one directory:
//!
//! | File | What it holds |
//! |---|---|
//! | `sweep.json` | What the sweep is: the case, and what each point sets |
//! | `points/0001`, ... | Ordinary run directories, counted from 1 |
//! | `failed/0001.json`, ... | Why a point failed, and with which exit code |
//! | `sweep.csv` | One row a point: what it sets, and what came out |

mod case_hash;
mod children;
mod collect;
mod directory;
mod failure;
mod misplaced;
mod plan;
mod point_state;
mod script;

pub use children::{Ended, Ending, Launch, run_children};
pub use collect::{collect, unknown_quantity};
pub use directory::{PLAN_FILE, SweepDirectory, SweepDirectoryError, TABLE_FILE};
pub use failure::PointFailure;
pub use plan::Plan;
pub use point_state::{PointState, Stand, stand, stand_of_own};
pub use script::{ArrayScript, MOST_TASKS};
