//! Stokes flow in a box of tetrahedra by iterations: unknowns, iterations, seconds and memory.
//!
//! `cargo bench -p benches --bench spatial [-- CUBES ...]`, on one thread; `--bodies` leaves a body
//! free in the middle, `--rate R` adds the factor R (1/s) of the new velocity in its rate,
//! `--threads N` takes N threads; `--spheres` takes chains of free spheres in place of boxes;
//! `--write FOLDER` writes the systems of boxes without a body for `compare/petsc.py`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use alewife_core::body::{MeshPoses, Pose, Wrench};
use alewife_core::coupling::{FluidSystem, Problem, RigidBody, Side, Solution};
use alewife_core::space::Metric;
use alewife_core::timing::{Stage, Timing, cpu_seconds};
use alewife_mesh::{BoundaryId, Mesh, Point};
use benches::{write_integers, write_matrix, write_reals};
use nalgebra::Vector3;
use tests::{BoxOfTetrahedra, ChainOfSpheres, fluid_only, one_system_from_rest};

/// Cubes along the edges of the boxes: 5, 12, 41, 86 and 270 thousand unknowns.
const CUBES: [usize; 5] = [6, 9, 15, 18, 27];

/// Numbers of spheres in a chain, and their gaps in radii.
const CHAINS: [(usize, f64); 8] =
    [(1, 0.1), (2, 0.1), (2, 0.02), (2, 0.01), (10, 0.1), (30, 0.1), (10, 0.02), (10, 0.01)];

struct Options {
    cubes: Vec<usize>,
    has_spheres: bool,
    folder: Option<PathBuf>,
    has_body: bool,
    rate: f64,
    threads: usize,
}

impl Options {
    fn read() -> Self {
        let mut options = Self {
            cubes: Vec::new(),
            has_spheres: false,
            folder: None,
            has_body: false,
            rate: 0.0,
            threads: 1,
        };
        let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
        while let Some(word) = words.next() {
            match word.as_str() {
                "--spheres" => options.has_spheres = true,
                "--write" => options.folder = words.next().map(PathBuf::from),
                "--bodies" => options.has_body = true,
                "--rate" => options.rate = following(words.next()),
                "--threads" => options.threads = following(words.next()),
                _ => options.cubes.push(following(Some(word))),
            }
        }
        if options.cubes.is_empty() {
            options.cubes.extend(CUBES);
        }
        options
    }
}

/// A number on the command line.
fn following<T: std::str::FromStr>(word: Option<String>) -> T {
    word.and_then(|word| word.parse().ok()).expect("a number")
}

fn main() {
    let options = Options::read();
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global()
        .expect("no pool is there yet");
    // On a thread of the pool, as runs are
    rayon::scope(|_| measure_all(&options));
}

fn measure_all(options: &Options) {
    println!(
        "unknowns  iterations  residual  analysis s  assembly s  set-up s  solve s  wall s  \
         preconditioner MB  peak MB"
    );
    if options.has_spheres {
        for (n, gap) in CHAINS {
            let chain = ChainOfSpheres { n, gap, surface: 0.35 };
            let mesh = chain.mesh();
            print!("{n:3} spheres, gap {gap:4}: ");
            let _system = measure(&mesh, &chain.problem(&mesh), 0.0);
        }
        return;
    }
    for &cubes in &options.cubes {
        let mesh = BoxOfTetrahedra { cubes, has_body: options.has_body }.mesh();
        let problem = problem(&mesh, f64::from(options.rate > 0.0));
        let Measured { system, flow } = measure(&mesh, &problem, options.rate);
        if let Some(folder) = &options.folder {
            write(&folder.join(system.n_unknowns.to_string()), &mesh, &system, &flow)
                .expect("the folder can be written");
        }
    }
}

fn problem(mesh: &Mesh<3>, density: f64) -> Problem<3> {
    let lid = |x: &Point<3>, _: f64| {
        let is_lid = x[2] > 1.0 - 1e-9;
        let bump = (1.0 - x[0] * x[0]) * (1.0 - x[1] * x[1]);
        Point::<3>::new(if is_lid { bump } else { 0.0 }, 0.0, 0.0)
    };
    let side = |_| Some(Side::Velocity { profile: Box::new(lid), is_wall: true });
    let sides = mesh.boundaries.iter().map(side).collect();
    let fluid = fluid_only(mesh, sides, density, 1.0, Metric::Cartesian);
    let free = |_: &RigidBody| RigidBody {
        load: Wrench { force: Vector3::new(1.0, 0.0, 0.0), torque: Vector3::new(0.0, 1.0, 0.0) },
        ..RigidBody::held("body", BoundaryId::new(0), Pose::planar(0.0, 0.0, 0.0)).free()
    };
    let bodies = fluid.bodies.iter().map(free).collect();
    Problem { bodies, has_convection: false, ..fluid }
}

/// A system that was solved.
struct Measured {
    system: FluidSystem<3>,
    flow: Solution<3>,
}

fn measure(mesh: &Mesh<3>, problem: &Problem<3>, rate: f64) -> Measured {
    let poses = MeshPoses::of(problem.bodies.iter().map(|body| body.pose));
    let (start_wall, start) = (Instant::now(), cpu_seconds());
    let mut system = FluidSystem::new(problem, mesh, &poses, false);
    let analysis = cpu_seconds() - start;
    let mut timing = Timing::default();
    let solved = one_system_from_rest(&mut system, problem, mesh, rate, &mut timing);
    let flow = solved.expect("the system is solved");
    let seconds = |stage: Stage| timing.cpu[stage as usize];
    println!(
        "{:8}  {:10}  {:8.1e}  {:10.2}  {:10.2}  {:8.2}  {:7.2}  {:6.2}  {:17.0}  {:7.0}",
        system.n_unknowns,
        system.accuracy().refinements,
        system.accuracy().residual,
        analysis,
        seconds(Stage::Assembly),
        seconds(Stage::Factorisation),
        seconds(Stage::Solve),
        start_wall.elapsed().as_secs_f64(),
        system.preconditioner_bytes() as f64 / 1e6,
        peak_megabytes(),
    );
    Measured { system, flow }
}

/// Writes the matrix, the right-hand side of the flow, the node of each unknown and whether it is a pressure,
/// and the vertices of the cells with their coordinates.
fn write(
    folder: &Path,
    mesh: &Mesh<3>,
    system: &FluidSystem<3>,
    flow: &Solution<3>,
) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let (matrix, unknowns) = (system.matrix(), system.unknowns());
    let mut x = vec![0.0; matrix.n()];
    // Unknowns of a node follow each other
    let (mut last, mut axis) = (u32::MAX, 0);
    for (unknown, value) in x.iter_mut().enumerate() {
        let node = unknowns.node[unknown];
        if unknowns.is_pressure[unknown] {
            *value = flow.pressure[node as usize];
            continue;
        }
        axis = if node == last { axis + 1 } else { 0 };
        last = node;
        *value = flow.velocity[node as usize][axis];
    }
    let mut rhs = vec![0.0; x.len()];
    matrix.multiply(&x, &mut rhs);
    write_matrix(folder, &matrix)?;
    write_reals(&folder.join("rhs.npy"), &rhs)?;
    let nodes: Vec<usize> = unknowns.node.iter().map(|node| *node as usize).collect();
    write_integers(&folder.join("nodes.npy"), &nodes)?;
    let is_pressure: Vec<usize> = unknowns.is_pressure.iter().map(|is| usize::from(*is)).collect();
    write_integers(&folder.join("is_pressure.npy"), &is_pressure)?;
    let cells = mesh.cell_ids().flat_map(|cell| mesh.cell_vertices(cell)).map(|node| node.index());
    write_integers(&folder.join("cells.npy"), &cells.collect::<Vec<_>>())?;
    let points: Vec<f64> = mesh.node_ids().flat_map(|node| mesh.nodes[node].data.0[0]).collect();
    write_reals(&folder.join("points.npy"), &points)
}

/// The most memory the process has taken so far (MB), zero where the system does not tell.
fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kilobytes.unwrap_or(0.0) / 1e3
}
