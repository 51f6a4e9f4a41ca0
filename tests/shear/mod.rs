//! Fluids whose viscosity depends on the rate of shear: exact flows, orders in space and time, loads, swimmers.

mod bodies;
mod parallel;
mod time;

/// The Carreau law of the tests, thinned tenfold.
const CARREAU: &str = "{ carreau = { zero = 1.0, infinite = 0.1, time = 1.0, index = 0.25 } }";

/// All laws, and the Newtonian fluid.
const LAWS: [&str; 5] = [
    "0.7",
    CARREAU,
    "{ cross = { zero = 1.0, infinite = 0.1, time = 1.0, index = 0.25 } }",
    "{ power-law = { consistency = 1.0, index = 0.4, regularised = 1e-2 } }",
    "{ herschel-bulkley = { yield_stress = 0.5, consistency = 1.0, index = 0.6, regularised = 1e-2 } }",
];
