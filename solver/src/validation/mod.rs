//! Did the case reproduce what was published?

mod morison;
mod report;
mod statistic;

pub use report::{
    Comparison, Verdict, compare, comparison_page, comparison_table, comparisons_to_json,
    not_computed,
};
pub use statistic::{StatisticError, measured_value};
