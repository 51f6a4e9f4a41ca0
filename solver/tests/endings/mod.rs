//! How commands end: by signals, by expressions without a value, and what they say of runs in which little happens.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

mod expressions;
mod rest;
#[cfg(unix)]
mod signals;

use std::path::Path;
use std::process::{Command, Output};

/// A disc between two plates, with an inflow.
const PLANE: &str = "
title = 'a disc between plates'
geometry = 'planar'
fluid = { model = 'navier-stokes', viscosity = 0.1, density = 1.0 }
domain.box = { min = [-2.0, -2.0], max = [2.0, 2.0] }
boundary = { left.velocity.value = ['1-(y/2)^2', 0], right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 1.0, surface = 0.35, growth = 0.5 }
time.unsteady = { step = 0.05, end = 0.4 }
[[body]]
name = 'b'
shape.disc.radius = 0.5
center = [0.0, 0.0]
density = 1.0
motion = 'held'
";

/// A sphere on the axis of a closed tube.
const AXIS: &str = "
title = 'a sphere on the axis'
geometry = 'axisymmetric'
fluid = { model = 'navier-stokes', viscosity = 0.1, density = 1.0 }
domain.cylinder = { x = [-2.0, 2.0], radius = 2.0 }
boundary = { left = 'no-slip', right = 'no-slip', wall = 'no-slip' }
mesh = { size = 1.0, surface = 0.3, growth = 0.5 }
time.unsteady = { step = 0.05, end = 0.4 }
[[body]]
name = 'b'
shape.sphere.radius = 0.5
center = [0.0, 0.0]
density = 1.0
motion = 'held'
";

/// The same in space, in a sphere.
const SPACE: &str = "
title = 'a sphere in a sphere'
geometry = 'spatial'
fluid = { model = 'navier-stokes', viscosity = 0.1, density = 1.0 }
domain.sphere = { center = [0.0, 0.0, 0.0], radius = 2.0 }
boundary.wall = 'no-slip'
mesh = { size = 2.0, surface = 0.6, growth = 1.0, gap_layers = 1 }
time.unsteady = { step = 0.05, end = 0.2 }
[[body]]
name = 'b'
shape.sphere.radius = 0.5
center = [0.0, 0.0, 0.0]
density = 1.0
motion = 'held'
";

fn run(directory: &Path, case: &str, settings: &[&str]) -> Output {
    std::fs::write(directory.join("case.toml"), case).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_alewife"));
    command.args(["run", "case.toml", "--out", "r", "--overwrite", "--quiet", "--threads", "1"]);
    settings.iter().for_each(|setting| {
        command.args(["--set", setting]);
    });
    command.current_dir(directory).output().unwrap()
}

/// The key and its value that make the steps of a run adaptive.
const ADAPTIVE: &str = "time={ unsteady = { end = 0.4 } }";

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
