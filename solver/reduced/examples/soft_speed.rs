//! Time of the motion of a soft case in space and of its gradient, for one evaluation of its optimisation.
//!
//! ```sh
//! cargo run --release -p alewife-reduced --example soft_speed -- [CASE] [KEY=VALUE ...]
//! ```

use std::error::Error;
use std::time::Instant;

use alewife_case::soft::SoftFile;
use alewife_reduced::search::Sought as _;
use alewife_reduced::tier::{Bodies, Kind, Model, Seeker, SolidOf, Sought};

/// The shipped starfish in space.
const CASE: &str = "starfish-twin";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let case = arguments.first().map_or(CASE, String::as_str);
    let file = SoftFile::read(case, arguments.get(1..).unwrap_or_default())
        .map_err(|error| format!("{error:?}"))?;
    let own = file.case.optimisation.as_ref().ok_or("the case has no [optimisation]")?;
    let model = Model::<3>::new(&file)?;
    let solid = &model.body.solid;
    println!(
        "{} nodes, {} unknowns, {} steps",
        solid.n_places() / 3,
        solid.n_unknowns(),
        model.plan.n_steps()
    );
    let clock = Instant::now();
    let motion = Bodies::simulate(&model.body, &model.plan)?;
    println!(
        "motion {:.2} s, {} iterations, {} factorisations",
        clock.elapsed().as_secs_f64(),
        motion.n_iterations,
        motion.n_factors
    );
    let sought = Sought::new(&file.case, &own.parameter);
    let values: Vec<f64> = sought.bounded.iter().map(|one| one.start).collect();
    let kind = Kind::Optimisation(own.objective.clone());
    let mut seeker = Seeker { model, sought, kind };
    let clock = Instant::now();
    let found = seeker.evaluate(&values)?;
    println!(
        "motion and gradient {:.2} s: objective {:?}, slopes {:?}",
        clock.elapsed().as_secs_f64(),
        -found.objective,
        found.slopes
    );
    Ok(())
}
