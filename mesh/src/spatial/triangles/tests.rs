//! Surfaces of triangles: files, faults with their places, repairs, moments.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;

/// A sphere of 20 * 4^n triangles, stretched.
pub(in crate::spatial) fn sphere(n: u32, semi_axes: [f64; 3]) -> TriangleMesh {
    let long = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices: Vec<Point<3>> = Vec::new();
    for (a, b) in [(-1.0, long), (1.0, long), (-1.0, -long), (1.0, -long)] {
        vertices.push(Point::<3>::new(a, b, 0.0).normalize());
    }
    for (a, b) in [(-1.0, long), (1.0, long), (-1.0, -long), (1.0, -long)] {
        vertices.push(Point::<3>::new(0.0, a, b).normalize());
    }
    for (a, b) in [(long, -1.0), (long, 1.0), (-long, -1.0), (-long, 1.0)] {
        vertices.push(Point::<3>::new(a, 0.0, b).normalize());
    }
    let mut triangles = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..n {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                u32::try_from(vertices.len() - 1).unwrap()
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [k, l, m] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, k, m], [k, b, l], [m, l, c], [k, l, m]]
            })
            .collect();
    }
    let stretch = Point::from(semi_axes);
    let vertices = vertices.iter().map(|vertex| vertex.component_mul(&stretch)).collect();
    TriangleMesh { vertices, triangles }
}

/// A cube from 0 to 1.
fn cube() -> TriangleMesh {
    let bit = |i: u8, axis: u8| f64::from(i >> axis & 1);
    let vertices = (0..8).map(|i| Point::<3>::new(bit(i, 0), bit(i, 1), bit(i, 2))).collect();
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh { vertices, triangles }
}

fn text_of(mesh: &TriangleMesh) -> String {
    let mut text = "solid thing\n".to_owned();
    for triangle in 0..mesh.triangles.len() {
        text += "facet normal 0 0 0\n outer loop\n";
        for at in mesh.corners(triangle) {
            text += &format!("  vertex {} {} {}\n", at.x, at.y, at.z);
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid thing\n"
}

fn obj_of(mesh: &TriangleMesh) -> String {
    let vertices = mesh.vertices.iter().map(|at| format!("v {} {} {}\n", at.x, at.y, at.z));
    let faces = mesh.triangles.iter();
    let faces = faces.map(|[a, b, c]| format!("f {}/1 {}//2 {}\n", a + 1, b + 1, c + 1));
    vertices.chain(faces).collect()
}

fn ply_of(mesh: &TriangleMesh, format: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment made here\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nproperty uchar red\nelement face {}\nproperty list uchar int vertex_indices\n\
         end_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for at in &mesh.vertices {
        match format {
            "ascii" => bytes.extend(format!("{} {} {} 255\n", at.x, at.y, at.z).into_bytes()),
            "binary_big_endian" => bytes.extend(at.iter().flat_map(|x| x.to_be_bytes()).chain([7])),
            _ => bytes.extend(at.iter().flat_map(|x| x.to_le_bytes()).chain([7])),
        }
    }
    for [a, b, c] in &mesh.triangles {
        match format {
            "ascii" => bytes.extend(format!("3 {a} {b} {c}\n").into_bytes()),
            "binary_big_endian" => {
                bytes.extend([3].into_iter().chain([a, b, c].iter().flat_map(|n| n.to_be_bytes())));
            }
            _ => {
                bytes.extend([3].into_iter().chain([a, b, c].iter().flat_map(|n| n.to_le_bytes())))
            }
        }
    }
    bytes
}

fn all_files(mesh: &TriangleMesh) -> Vec<Vec<u8>> {
    let mut files = vec![mesh.to_stl(), text_of(mesh).into_bytes(), obj_of(mesh).into_bytes()];
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        files.push(ply_of(mesh, format));
    }
    files
}

#[test]
fn all_kinds_of_files_give_the_same_solid() {
    let mesh = sphere(1, [1.0, 0.5, 0.25]);
    for file in all_files(&mesh) {
        let read = TriangleMesh::read(&file).unwrap();
        assert_eq!([read.vertices.len(), read.triangles.len()], [42, 80]);
        read.check().unwrap();
        assert!((read.volume() / mesh.volume() - 1.0).abs() < 1e-6);
        assert_eq!(TriangleMesh::from_line(&read.to_line()).unwrap(), read);
    }
}

#[test]
fn moments_of_polyhedra_are_exact() {
    let moments = cube().scaled(2.0).moments();
    assert!((moments.volume - 8.0).abs() < 1e-13);
    assert!((moments.centroid - Point::<3>::repeat(1.0)).norm() < 1e-13);
    let expected = nalgebra::Matrix3::identity() * (8.0 * 4.0 / 6.0);
    assert!((moments.inertia - expected).amax() < 1e-12, "{}", moments.inertia);
    let measures = cube().measures();
    assert!((measures.area - 6.0).abs() < 1e-13);
    assert!((measures.edges[1] - 2.0_f64.sqrt()).abs() < 1e-14 && measures.edges[0] == 1.0);
    assert!((measures.sharpest.0 - PI / 2.0).abs() < 1e-12);
    assert_eq!([measures.n_open, measures.n_shells], [0, 1]);
}

#[test]
fn each_fault_is_named_with_its_place() {
    let whole = cube();
    whole.check().unwrap();
    let told = |mesh: &TriangleMesh| mesh.check().unwrap_err();
    let mut open = whole.clone();
    open.triangles.pop();
    assert!(matches!(told(&open), SurfaceFault::Open { n: 3, at } if at[0] == 1.0));
    let mut flipped = whole.clone();
    flipped.triangles[0].swap(0, 1);
    assert!(matches!(told(&flipped), SurfaceFault::Flipped { n: 3, at } if at[2] == 0.0));
    let mut inside_out = whole.clone();
    inside_out.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    assert!(
        matches!(told(&inside_out), SurfaceFault::InsideOut { volume } if (volume + 1.0).abs() < 1e-12
        )
    );
    let joined = |by: [f64; 3]| {
        let mut two = whole.clone();
        two.vertices.extend(whole.vertices.iter().map(|at| at + Point::from(by)));
        two.triangles.extend(whole.triangles.iter().map(|own| own.map(|vertex| vertex + 8)));
        two
    };
    assert!(matches!(told(&joined([3.0, 0.0, 0.0])), SurfaceFault::Shells { n: 2, .. }));
    // Edge to edge, and corner to corner
    let edge = TriangleMesh::read(&joined([1.0, 1.0, 0.0]).to_stl()).unwrap();
    assert!(matches!(told(&edge), SurfaceFault::Branched { n: 1, .. }));
    let corner = TriangleMesh::read(&joined([1.0; 3]).to_stl()).unwrap();
    assert!(matches!(told(&corner), SurfaceFault::Branched { n: 1, at } if at == [1.0; 3]));
    let mut flat = whole.clone();
    flat.vertices[7] = flat.vertices[6];
    assert!(matches!(told(&flat), SurfaceFault::Flat { .. }));
    // A corner pulled through the opposite side
    let mut through = whole.clone();
    through.vertices[7] = Point::<3>::new(-0.5, 0.4, 0.3);
    let fault = told(&through);
    assert!(matches!(fault, SurfaceFault::Crossing { .. }), "{fault}");
    assert!(matches!(
        crate::spatial::Triangulated::new(&whole, 45.0, None).unwrap_err(),
        SurfaceFault::Crease { n: 12, angle, .. } if (angle - 90.0).abs() < 1e-9
    ));
}

#[test]
fn small_faults_are_repaired() {
    let whole = sphere(1, [1.0, 1.0, 1.0]);
    // Each triangle by itself, off by a little, every third turned, one twice and one flat
    let mut loose = TriangleMesh::default();
    for (nth, _) in whole.triangles.iter().enumerate() {
        let first = u32::try_from(loose.vertices.len()).unwrap();
        let off = Point::<3>::new(2e-7, 0.0, -1e-7) * (nth % 2) as f64;
        loose.vertices.extend(whole.corners(nth).map(|corner| corner + off));
        let own = [first, first + 1, first + 2];
        loose.triangles.push(if nth % 3 == 1 { [own[1], own[0], own[2]] } else { own });
    }
    loose.triangles.push(loose.triangles[5]);
    loose.triangles.push([0, 0, 4]);
    let Repaired { mesh: mended, repairs } = loose.repaired();
    mended.check().unwrap();
    assert_eq!(repairs, Repairs { welded: 240 - 42, dropped: 2, turned: 27 });
    assert!((mended.volume() / whole.volume() - 1.0).abs() < 1e-6);
}

#[test]
fn quadratic_triangles_enclose_a_sphere_to_a_higher_order_than_straight_ones() {
    let exact = 4.0 / 3.0 * PI * 0.5;
    let error = |n: u32| {
        let mesh = sphere(n, [1.0, 1.0, 0.5]);
        let smooth = crate::spatial::Triangulated::new(&mesh, 60.0, None).unwrap();
        let inertia = smooth.moments().inertia[(2, 2)] / (exact * 2.0 / 5.0) - 1.0;
        let volumes = [mesh.volume(), smooth.moments().volume].map(|v| (v / exact - 1.0).abs());
        println!("{n}: {volumes:?} {inertia:e}");
        volumes
    };
    let ([straight, smooth], [finer, finest]) = (error(2), error(3));
    assert!((straight / finer).log2() > 1.9 && (smooth / finest).log2() > 2.5);
    assert!(finest < 0.05 * finer);
}

/// A ring of `n` by `m` points.
#[test]
fn a_torus_has_its_volume_and_inertia() {
    let (n, m, ring, tube) = (60, 30, 1.0, 0.4);
    let mut mesh = TriangleMesh::default();
    for i in 0..n {
        for j in 0..m {
            let (u, v) = (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(m));
            let far = ring + tube * v.cos();
            mesh.vertices.push(Point::<3>::new(far * u.cos(), far * u.sin(), tube * v.sin()));
            let at = |i: u32, j: u32| i % n * m + j % m;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let torus = crate::spatial::Triangulated::new(&mesh, 45.0, None).unwrap();
    let moments = torus.moments();
    let volume = 2.0 * PI * PI * ring * tube * tube;
    assert!((moments.volume / volume - 1.0).abs() < 1e-3, "{}", moments.volume / volume);
    let about = volume * (ring * ring + 0.75 * tube * tube);
    assert!((moments.inertia[(2, 2)] / about - 1.0).abs() < 1e-3);
    assert!((torus.area() / (4.0 * PI * PI * ring * tube) - 1.0).abs() < 1e-3);
    assert!((torus.inner_radius() / tube - 1.0).abs() < 0.05, "{}", torus.inner_radius());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    /// Whatever is done to a file, it is a surface or refused.
    #[test]
    fn mutated_files_are_read_or_refused(
        kind in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        end in any::<Option<prop::sample::Index>>(),
    ) {
        let mut file = all_files(&sphere(0, [1.0, 1.0, 1.0])).swap_remove(kind);
        for (at, byte) in changes {
            let at = at.index(file.len());
            file[at] = byte;
        }
        if let Some(end) = end {
            file.truncate(end.index(file.len()));
        }
        if let Ok(mesh) = TriangleMesh::read(&file) {
            let mended = mesh.repaired().mesh;
            prop_assert!(mended.measures().area >= 0.0);
            for mesh in [mesh, mended] {
                prop_assert!(mesh.measures().area >= 0.0);
                if let Ok(surface) = crate::spatial::Triangulated::new(&mesh, 180.0, None) {
                    prop_assert!(surface.moments().volume > 0.0);
                }
            }
        }
    }
}
