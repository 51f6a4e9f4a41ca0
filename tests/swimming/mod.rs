//! Swimmers in whole runs: invariances, orders in time, articulated and deforming bodies with and
//! without inertia, copies and contact.

mod articulated;
mod cilia;
mod crowd;
mod cycle_error;
mod deforming;
mod invariance;
mod joints;
mod midline;
mod orders;
mod reciprocity;
mod rods;
mod rods_balance;
mod rods_of_cases;
mod rods_relax;
