//! Bodies that travel: ALE invariants, orders in time, remeshing, contact, springs, in whole runs; a
//! side of the domain that waves.

mod ale;
mod ballast;
mod bodies;
mod contact;
mod driven;
mod grounded;
mod launched;
mod rebound;
mod remesh;
mod renumbered;
mod resume;
mod scalars;
mod sheet;
mod suspension;
mod tracers;

/// A box without flow; bodies are to follow.
fn tank(model: &str, time: &str, mesh: &str) -> String {
    format!(
        r#"
        title = "a tank"
        geometry = "planar"
        fluid = {{ model = "{model}", density = 1.0, viscosity = 0.1, gravity = [0.0, -10.0] }}
        domain.box = {{ min = [-1.0, -1.5], max = [1.0, 1.5] }}
        mesh = {{ {mesh} }}
        time.unsteady = {{ {time} }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        "#
    )
}
