//! Sessions: what strokes do is asked for while a run goes on.

mod commands;
mod eel;
mod replay;

use alewife_core::case::{Case, Model};
use alewife_core::run::{Dimension, Session, Solve};
use tests::cases::case;

/// Three links with two pivots whose angles are asked for, in a small tank.
pub fn chain(settings: &str) -> Model {
    case(&text(settings))
}

/// The same with keys set as on the command line.
pub fn chain_with(settings: &[String]) -> Model {
    Case::parse("chain.toml", &text(""), settings).expect("the case is right").model
}

fn text(settings: &str) -> String {
    format!(
        r#"
        title = "three links on command"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.2 }}
        domain.box = {{ min = [-2.5, -1.5], max = [2.5, 1.5] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.8, surface = 0.3, growth = 0.8, gap_layers = 1 }}
        time.unsteady = {{ step = 0.05, end = 0.6{settings} }}
        [[swimmer]]
        name = "eel"
        [swimmer.kind.chain]
        links = [[0.4, 0.12], [0.4, 0.12], [0.4, 0.1]]
        gap = 0.2
        joints = [
            {{ bent.angle.command = {{ start = 0.1, limits = [-0.6, 0.6], rate = 3.0, filter = 0.05 }} }},
            {{ bent.angle.command = {{ limits = [-0.6, 0.6], filter = 0.06 }} }},
        ]
        "#
    )
}

/// What a controller asks for at a time.
pub fn targets(time: f64) -> [f64; 2] {
    [0.5 * (9.0 * time).sin(), 0.6 * (9.0 * time - 1.0).cos()]
}

/// Makes a session up to a time, with targets at pauses of a size (s).
pub fn act<const D: usize>(session: &mut Session<D>, until: f64, pause: f64)
where
    Dimension<D>: Solve<D>,
{
    while session.time() < until - 1e-9 {
        let time = session.time();
        let names = session.commands();
        for (name, target) in names.iter().zip(targets(time)) {
            session.command(name, target).expect("it is a command");
        }
        session.advance_to((time + pause).min(until)).expect("it goes on");
    }
}
