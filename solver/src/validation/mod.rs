//! A run against the references of its case.

mod comparison;
mod morison;
mod report;
mod statistic;

pub use comparison::{Comparison, Verdict, compare, not_computed};
pub use report::{comparison_page, comparison_table, comparisons_to_json, count_table, summary};
pub use statistic::{StatisticError, measured_value};
