//! Searches for the parameters that make an objective with a gradient small, whatever it is an objective of.

mod bounded;
mod certainty;
mod error;
mod external;
mod journal;
mod methods;
mod minimise;
mod progress;
mod proposals;
mod report;
mod sought;
mod whole_file;

pub use bounded::Bounded;
pub use certainty::{Certainty, certainties};
pub use error::SearchError;
pub use external::External;
pub use journal::{Journal, Journalled, Opened};
pub use methods::{Ask, Method, propose};
pub use minimise::{Ended, Evaluated, Found, Search, minimise};
pub use progress::{Progress, search};
pub use proposals::{Effort, HALVINGS, Halt, Objective, Proposal, Proposals};
pub use report::{Certainties, Slope, number_lines, numbers_to_json, slopes};
pub use sought::Sought;
pub use whole_file::write_whole;
