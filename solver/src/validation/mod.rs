//! A run against the references of its case.

mod comparison;
mod evidence;
mod morison;
mod page;
mod report;
mod section;
mod statistic;
mod uncertainty;

pub use comparison::{Comparison, Verdict, compare, compare_series, not_computed};
pub use evidence::Evidence;
pub use page::ReportPage;
pub use report::{comparison_table, comparisons_to_json, count_table, summary};
pub use section::{CaseReport, Companion, Links, MemberReport};
pub use statistic::{StatisticError, measured_in_whole, measured_value};
pub use uncertainty::{
    MeshSize, Refinement, RunSize, coarser_settings, no_companion, raise_coincidences,
    set_uncertainties,
};
