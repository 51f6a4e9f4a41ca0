//! Soft bodies inside of closed surfaces of triangles: volume, stiffness and frequencies, and what is refused.

use std::fmt::Write as _;
use std::fs;

use alewife_case::soft::SoftFile;
use alewife_mesh::Point;
use alewife_mesh::spatial::TriangleMesh;
use alewife_reduced::tier::{Model, TierError, write_case};
use alewife_solid::solid::{Minimiser, Potential, Solid};
use tempfile::TempDir;

use crate::given;

/// A box of 1 by 2 by 1 with a corner at 0, in mm.
fn block() -> TriangleMesh {
    let corners =
        [[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0], [0, 0, 1], [1, 0, 1], [1, 2, 1], [0, 2, 1]];
    let sides =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]];
    let point = |at: [i32; 3]| Point::from(at.map(f64::from)) * 1e3;
    TriangleMesh {
        vertices: corners.map(point).to_vec(),
        triangles: sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

/// A sphere of radius one: an octahedron whose triangles are divided so many times.
fn sphere(times: usize) -> TriangleMesh {
    let mut vertices: Vec<Point<3>> = [0, 1, 2]
        .into_iter()
        .flat_map(|axis| {
            [1.0, -1.0].map(|sign| Point::from_fn(|i, _| if i == axis { sign } else { 0.0 }))
        })
        .collect();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for x in [0, 1] {
        for y in [2, 3] {
            for z in [4, 5] {
                let is_even = (x + y + z) % 2 == 0;
                triangles.push(if is_even { [x, y, z] } else { [x, z, y] });
            }
        }
    }
    for _ in 0..times {
        let mut middles = std::collections::BTreeMap::new();
        let mut next = Vec::new();
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                    let sum = vertices[from as usize] + vertices[to as usize];
                    vertices.push(sum.normalize());
                    u32::try_from(vertices.len() - 1).expect("there are few")
                })
            });
            next.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = next;
    }
    TriangleMesh { vertices, triangles }
}

fn case(keys: &str) -> String {
    format!(
        r#"
title = "a solid in a surface"
geometry = "spatial"

[[solid]]
name = "b"
{keys}
material = {{ young = 4e4, poisson = 0.3, density = 1000.0 }}

[soft]
frame = 0.01
frames = 1
"#
    )
}

fn model(bytes: &[u8], keys: &str) -> Result<Model<3>, String> {
    let folder = TempDir::new().expect("there is room");
    fs::write(folder.path().join("b.stl"), bytes).expect("it is written");
    let file = given::read_in(&folder, &case(keys)).map_err(|error| error.to_string())?;
    let made = Model::<3>::new(&file).map_err(|error| match error {
        TierError::Case(all) => all.iter().fold(String::new(), |mut text, one| {
            let _ = write!(text, "{} | {one}", one.key);
            text
        }),
        other => other.to_string(),
    })?;
    // What is written stands for itself
    let out = TempDir::new().expect("there is room");
    write_case(out.path(), &file, &file.case).expect("it is written");
    let again = SoftFile::read(&out.path().join("case.toml").display().to_string(), &[]);
    assert_eq!(again.expect("it is a case").case, file.case);
    Ok(made)
}

#[test]
fn a_box_has_its_volume_and_is_stretched_as_by_hooke() {
    for order in ["quadratic", "linear"] {
        let keys = format!(
            "shape.surface = {{ file = 'b.stl', scale = 1e-3, center = [0, 0, 0] }}\nsize = 0.5\norder = '{order}'"
        );
        let made = model(&block().to_stl(), &keys).expect("it is a body");
        let mut spec = made.body.solid.spec().clone();
        assert!((made.body.solid.volume() - 2.0).abs() < 1e-6, "{}", made.body.solid.volume());
        // The surface is seen from outside
        let mut flux = 0.0;
        for facet in &spec.mesh.facets {
            let [a, b, c] = [0, 1, 2].map(|k| spec.mesh.nodes[facet.nodes[k]]);
            flux += (b - a).cross(&(c - a)).dot(&a) / 6.0;
        }
        assert!((flux - 2.0).abs() < 1e-6, "{flux}");
        // On rails at x, y, z = 0, and pulled at y = 2
        let near = |x: f64, at: f64| (x - at).abs() < 1e-6;
        let mut ends = Vec::new();
        for (node, x) in spec.mesh.nodes.iter().enumerate() {
            spec.held.extend((0..3).filter(|i| near(x[*i], 0.0)).map(|i| 3 * node + i));
            if near(x[1], 2.0) {
                spec.held.push(3 * node + 1);
                ends.push(3 * node + 1);
            }
        }
        let solid = Solid::new(spec).expect("it is a solid");
        let mut start = solid.at_rest();
        let small = 1e-6;
        ends.iter().for_each(|c| start[*c] += 2.0 * small);
        let loads = vec![0.0; start.len()];
        let potential = Potential::at_rest(&solid, &[], &loads);
        let found =
            Minimiser::with_tolerance(1e-12).minimise(&potential, &start).expect("it stretches");
        let force: f64 = ends.iter().map(|c| found.slope[*c]).sum();
        println!("{order}: {} cells, E = {:.6e}", solid.spec().mesh.n_cells(), force / small);
        assert!((force / (small * 4e4) - 1.0).abs() < 1e-5, "{force}");
    }
}

#[test]
fn a_sphere_in_a_rigid_shell_turns_to_and_fro_as_it_should() {
    // A field that turns about an axis by j_1(k r), with j_1(k) = 0 at the wall, three times
    let lame = 4e4 / 2.6;
    let exact = 4.493_409_457_909_064 * (lame / 1e3_f64).sqrt();
    let error = |times: usize, size: f64| {
        let keys = format!("shape.surface = {{ file = 'b.stl' }}\nsize = {size}");
        let made = model(&sphere(times).to_stl(), &keys).expect("it is a body");
        let mut spec = made.body.solid.spec().clone();
        let volume = made.body.solid.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0;
        for facet in &spec.mesh.facets {
            spec.held.extend(facet.nodes.iter().flat_map(|node| 3 * node..3 * node + 3));
        }
        let solid = Solid::new(spec).expect("it is a solid");
        let found = {
            let none = vec![0.0; solid.n_components()];
            solid.frequencies(&solid.at_rest(), &[], &none, 8).expect("it has modes")
        };
        let apart = |f: &f64| (f / exact - 1.0).abs();
        let mut near: Vec<f64> = found.iter().map(apart).collect();
        near.sort_by(f64::total_cmp);
        println!(
            "{} cells: volume {volume:+.1e}, frequency {:.1e}",
            solid.spec().mesh.n_cells(),
            near[2]
        );
        [volume.abs(), near[2]]
    };
    let (coarse, fine) = (error(3, 0.7), error(4, 0.4));
    println!("{coarse:?} {fine:?}");
    assert!(fine[0] < 1e-3 && fine[1] < 5e-3, "{fine:?}");
    assert!(fine[1] < 0.4 * coarse[1], "{coarse:?} {fine:?}");
}

#[test]
fn surfaces_that_enclose_nothing_are_refused_as_those_of_bodies_in_a_flow() {
    let mut open = block();
    open.triangles.pop();
    let mut flipped = block();
    flipped.triangles[0].swap(0, 1);
    let surface = "shape.surface = { file = 'b.stl', scale = 1e-3 }\n";
    let good = block().to_stl();
    for (bytes, keys, key, says) in [
        (
            open.to_stl(),
            format!("{surface}size = 0.5"),
            "solid.0.shape.surface.data",
            "alewife surface FILE --repair",
        ),
        (
            flipped.to_stl(),
            format!("{surface}size = 0.5"),
            "solid.0.shape.surface.data",
            "turns all triangles outwards",
        ),
        (good.clone(), surface.to_owned(), "solid.0.size", "add `size = ...` (m)"),
        (
            good.clone(),
            "shape.surface = { scale = 2.0 }\nsize = 0.5".to_owned(),
            "solid.0.shape.surface",
            "write file = \"body.stl\"",
        ),
        (
            good.clone(),
            format!("{}size = 0.5", surface.replace("1e-3", "-1")),
            "solid.0.shape.surface.scale",
            "write a number above 0",
        ),
        (
            good.clone(),
            "shape.surface = { file = 'b.stl' }\nsize = 0.5".to_owned(),
            "solid.0.size",
            "scale = 0.001",
        ),
        (
            good.clone(),
            "shape.surface = { file = 'c.stl' }\nsize = 0.5".to_owned(),
            "",
            "the path of an STL, OBJ or PLY file",
        ),
        (
            good,
            "shape.disc = { radius = 1.0 }\nsize = 0.5".to_owned(),
            "solid.0.shape",
            "surface of spatial ones",
        ),
    ] {
        let said = model(&bytes, &keys).err().unwrap_or_default();
        assert!(said.starts_with(key) && said.contains(says), "{key}, {says}: {said}");
        assert!(said.contains("case.toml:"), "{said}");
    }
}
