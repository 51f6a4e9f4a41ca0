//! Identifies a soft starfish from its recorded motion, as @du2021 did.
//!
//! ```sh
//! cargo run --release -p alewife-reduced --example starfish -- RECORD.csv MESH.msh [substeps] [frames] [E] [nu] [equal]
//! ```
//!
//! The records are `python/example/soft_starfish_3d/data_*.csv` of github.com/mit-gfx/diff_pd_public, the surface to
//! be meshed with tetrahedra (Gmsh's MSH 4.1, in metres) is `asset/mesh/starfish_half_simplified.obj` there. With
//! the word `equal` all cells count with their mean volume and all nodes with the mass of one cell, as there.

use std::error::Error;
use std::time::Instant;

use alewife_reduced::search::{Bounded, Evaluated, Search, minimise};
use alewife_reduced::soft::{Curve, FacetLaw, Gaps, Markers, Plan, Record, SoftBody, SoftError};
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Fibres, Frame, Order, Solid, SolidMesh, SolidSpec};
use nalgebra::Vector3;

/// Length (m) of a tendon at rest.
const TENDON: f64 = 0.065;

/// Places (m) of the marks along the limbs.
const MARKS: [f64; 4] = [-0.070, -0.040, 0.0362, 0.0632];

const WEIGHTS: [f64; 4] = [10.0, 1.0, 1.0, 10.0];

/// The body: flat below, fibres in its lowest cells along the two limbs that pull, on a rail along x.
fn starfish(mesh: SolidMesh<3>, young: f64, poisson: f64) -> Result<SoftBody<3>, Box<dyn Error>> {
    let rail = mesh.nodes_where(|x| x[1].abs() < 0.018 && x[2].abs() < 0.018);
    let mut cells = Vec::new();
    for (number, cell) in mesh.cells.chunks_exact(4).enumerate() {
        let places = || cell.iter().map(|node| mesh.nodes[*node]);
        let centre = places().fold(Vector3::zeros(), |sum, x| sum + x) / 4.0;
        let is_flat = places().any(|x| x[0].abs() <= 1e-3);
        let is_limb = !(centre[1].abs() > 0.0075 && centre[2].abs() > 0.0075);
        if is_flat && is_limb && centre[2].abs() > 0.018 {
            cells.push(number);
        }
    }
    let spec = SolidSpec {
        frame: Frame::Space,
        materials: vec![Material {
            law: Law::CorotatedVolume,
            young,
            poisson,
            density: 400.0,
            viscosity: 0.0,
        }],
        material_of: Vec::new(),
        fibres: vec![Fibres { directions: vec![Vector3::z(); cells.len()], cells, stiffness: 2e6 }],
        rigid: Vec::new(),
        held: rail.iter().flat_map(|node| [3 * node + 1, 3 * node + 2]).collect(),
        mesh,
    };
    let law = FacetLaw {
        density: 1e3,
        drag: Curve::bezier(&[0.05, 0.05, 1.85, 2.05])?,
        thrust: Curve::bezier(&[-0.8, -0.5, 0.1, 2.5])?,
    };
    Ok(SoftBody { solid: Solid::new(spec)?, law: Some(law) })
}

/// The control and the marks of a record (ms and mm), from where the tendon begins to pull.
fn marks(
    record: &Record,
    mesh: &SolidMesh<3>,
    substeps: usize,
    n_frames: usize,
) -> Result<(Plan, Markers), Box<dyn Error>> {
    let told: Vec<usize> =
        (0..record.rows.len()).filter(|k| !record.rows[*k][0].is_nan()).collect();
    let first = told.first().ok_or("the record has no control")?;
    let pull = |k: usize| record.rows[k][0];
    let begin = told.iter().position(|k| pull(*k) != pull(*first)).ok_or("nothing pulls")?;
    let rows = &told[begin..];
    if rows.len() <= n_frames {
        return Err(format!("the record has {} frames, not {}", rows.len(), n_frames + 1).into());
    }
    let last = rows[rows.len() - 1];
    let frame = 1e-3 * (record.times[last] - record.times[rows[0]]) / (rows.len() - 1) as f64;
    let targets = rows[..n_frames].iter().map(|k| vec![1.0 - 1e-3 * pull(*k) / TENDON]).collect();
    let at_start = &record.rows[rows[0]];
    let displacement = |row: usize, mark: usize| {
        let moved = |column: usize| 1e-3 * (record.rows[row][column] - at_start[column]);
        vec![moved(1 + 2 * mark), -moved(2 + 2 * mark)]
    };
    let node_of = |z: f64| {
        let near = mesh.nodes_where(|x| x[0].abs() <= 1e-3 && (x[2] - z).abs() < 0.004);
        near.into_iter().min_by(|a, b| mesh.nodes[*a][1].total_cmp(&mesh.nodes[*b][1]))
    };
    let nodes: Option<Vec<usize>> = MARKS.into_iter().map(node_of).collect();
    let markers = Markers {
        dimension: 3,
        nodes: nodes.ok_or("a mark has no node near it")?,
        weights: WEIGHTS.to_vec(),
        axes: vec![0, 2],
        substeps,
        displacements: rows[..=n_frames]
            .iter()
            .map(|row| (0..MARKS.len()).map(|mark| displacement(*row, mark)).collect())
            .collect(),
    };
    markers.check(n_frames)?;
    Ok((Plan { tolerance: 1e-6, ..Plan::new(frame, substeps, targets) }, markers))
}

fn parameter(name: &str, start: f64, lower: f64, upper: f64) -> Bounded {
    Bounded { name: name.to_owned(), start, lower, upper, scale: None }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, mesh, rest @ ..] = arguments.as_slice() else {
        return Err("starfish RECORD.csv MESH.msh [substeps] [frames] [E] [nu] [equal]".into());
    };
    let substeps = rest.first().map_or(Ok(5), |text| text.parse())?;
    let n_frames = rest.get(1).map_or(Ok(60), |text| text.parse())?;
    let record = Record::parse(file, &std::fs::read_to_string(file)?, Gaps::Kept)?;
    let mesh = alewife_mesh::read_undivided_msh::<3>(&std::fs::read(mesh)?, 1.0)?;
    let mesh = SolidMesh::of_mesh(&mesh, Order::Linear);
    let (plan, markers) = marks(&record, &mesh, substeps, n_frames)?;
    let young = rest.get(2).map_or(Ok(5.67e4), |text| text.parse())?;
    let poisson = rest.get(3).map_or(Ok(0.337), |text| text.parse())?;
    let mut body = starfish(mesh, young, poisson)?;
    if rest.get(4).is_some_and(|word| word == "equal") {
        body.solid = body.solid.with_equal_cells();
    }
    println!(
        "{} nodes, {} unknowns, {} fibres, step {:.5} s",
        body.solid.n_components() / 3,
        body.solid.n_unknowns(),
        body.solid.spec().fibres[0].cells.len(),
        plan.step()
    );
    let parameters = [parameter("E", young, 1e4, 5e6), parameter("nu", poisson, 0.2, 0.45)];
    let started = Instant::now();
    let mut moved = body.clone();
    let found = minimise(&parameters, &Search { decrease: 1e-4, ..Search::default() }, |values| {
        let clock = Instant::now();
        moved.solid.set_moduli(0, values[0], values[1])?;
        let found = moved.with_gradient(&plan, &markers, false)?;
        println!(
            "E {:.4e} nu {:.4} loss {:.5} slopes {:.3} {:.3} by log, {} iterations, {} factorisations, {:.2} s",
            values[0],
            values[1],
            found.value,
            found.gradient.young[0] * values[0],
            found.gradient.poisson[0] * values[1],
            found.trajectory.n_iterations,
            found.trajectory.n_factors,
            clock.elapsed().as_secs_f64()
        );
        Ok::<_, SoftError>(Evaluated {
            values: values.to_vec(),
            objective: found.value,
            slopes: vec![found.gradient.young[0], found.gradient.poisson[0]],
        })
    })?;
    println!(
        "{:?} after {} evaluations and {:.1} s",
        found.ended,
        found.all.len(),
        started.elapsed().as_secs_f64()
    );
    println!(
        "best: E {:.4e} nu {:.4} loss {:.5}",
        found.best.values[0], found.best.values[1], found.best.objective
    );
    Ok(())
}
