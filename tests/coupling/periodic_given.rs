//! Periodic sides of given meshes: flow past arrays as in our own periodic mesh, driven by mean gradients.

use alewife_core::case::{Case, CaseFile, Model, check};
use alewife_core::run::{build_mesh, simulate};
use alewife_mesh::{Boundary, BoundaryId, BoundaryKind, Mesh, Point};
use tests::BoxOfTetrahedra;
use tests::cases::{case, last, run};
use tests::figure;
use tests::given::in_mesh;

fn model(file: Result<CaseFile, String>) -> Model {
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    let errors: Vec<_> = check(&file)
        .into_iter()
        .filter(|found| found.severity == alewife_core::case::Severity::Error)
        .collect();
    assert!(errors.is_empty(), "{errors:?}");
    file.model
}

const ARRAY: &str = r#"
    title = "array"
    geometry = "planar"
    fluid = { model = "stokes", viscosity = 1.0 }
    flow.mean_velocity = [1.0, 0.0]
    mesh.size = 0.1
    time.steady = {}
    [boundary]
    left.periodic = "right"
    top.periodic = "bottom"
    "#;

/// Sangani and Acrivos 1982: 24.83 at an area fraction of 0.1.
#[test]
fn an_array_in_a_given_mesh_has_the_drag_of_our_own_and_of_the_literature() {
    let settings = ["mesh.size=0.08", "mesh.surface=0.03", "reference=[]"].map(str::to_owned);
    let own = Case::read("periodic-cylinders", &settings).expect("it is shipped").model;
    let mesh = build_mesh::<2>(&own).expect("it is meshed");
    let body = "[[body]]\nname = \"post\"\nshape.side = \"cylinder\"\nmotion = \"held\"\n";
    let body = run(&model(in_mesh("array-body", &mesh, &format!("{ARRAY}{body}"))));
    let own = last(&run(&own), "cylinder.force.x");
    let force = last(&body, "post.force.x");
    figure!(force, "drag");
    // Cells with two sides at the corners are divided when the file is read
    assert!((force / own - 1.0).abs() < 1e-5, "{force} {own}");
    assert!((force / 24.83 - 1.0).abs() < 1e-3, "{force}");
}

/// A mean gradient drives Poiseuille flow along a channel of a height of one: an eighth of it over the viscosity.
#[test]
fn a_mean_gradient_drives_a_channel_of_a_given_mesh() {
    let text = |domain: &str| {
        format!(
            r#"
            title = "channel"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 0.5 }}
            flow.pressure_gradient = [-3.0, 0.0]
            mesh.size = 0.3
            time.steady = {{}}
            probe = [{{ name = "p", point = [1.0, 0.5] }}]
            boundary = {{ left.periodic = "right", bottom = "no-slip", top = "no-slip" }}
            {domain}
            "#
        )
    };
    let own = case(&text("domain.channel = { length = 2.0, height = 1.0 }"));
    let mesh = build_mesh::<2>(&own).expect("it is meshed");
    let speed = last(&run(&model(in_mesh("channel", &mesh, &text("")))), "p.velocity.x");
    assert!((speed - 3.0 / (8.0 * 0.5)).abs() < 1e-9, "{speed}");
}

/// A box of tetrahedra from -1 to 1, its sides named as those of `domain.box`.
fn box_in_space() -> Mesh<3> {
    let mut mesh = BoxOfTetrahedra { cubes: 3, has_body: false }.mesh();
    let names = ["left", "right", "bottom", "top", "back", "front"];
    let sides: Vec<usize> = mesh
        .facets
        .iter()
        .map(|facet| {
            let middle: Point<3> =
                mesh.facet_vertices(facet).iter().map(|vertex| mesh.nodes[*vertex]).sum();
            2 * middle.iamax() + usize::from(middle[middle.iamax()] > 0.0)
        })
        .collect();
    let topology = mesh.topology_mut();
    let side = |name: &str| Boundary { name: name.to_owned(), kind: BoundaryKind::Side };
    topology.boundaries = names.map(side).to_vec();
    for (facet, side) in topology.facets.iter_mut().zip(sides) {
        facet.boundary = BoundaryId::new(side);
    }
    mesh
}

/// In space, along x and z; the walls hold the fluid across y: the square of half their distance over two viscosities.
#[test]
fn a_mean_gradient_drives_a_slit_of_a_given_mesh_in_space() {
    let text = r#"
        title = "slit"
        geometry = "spatial"
        fluid = { model = "stokes", viscosity = 0.5 }
        flow.pressure_gradient = [-3.0, 0.0, 0.0]
        mesh.size = 0.5
        time.steady = {}
        probe = [{ name = "p", point = [0.2, 0.0, 0.1] }]
        [boundary]
        left.periodic = "right"
        back.periodic = "front"
        bottom = "no-slip"
        top = "no-slip"
        "#;
    let given = model(in_mesh("slit", &box_in_space(), text));
    let outcome = simulate::<3>(&given, &mut []).expect("it is solved");
    let speed = last(&outcome, "p.velocity.x");
    assert!((speed - 3.0).abs() < 1e-6, "{speed}");
}

/// What is no pair is refused with the node, or the sides.
#[test]
fn sides_of_a_given_mesh_that_are_no_pairs_are_refused() {
    let own = case(&ARRAY.replace(
        "mesh.size",
        "domain.box = { min = [0.0, 0.0], max = [1.0, 1.0] }\n    mesh.size",
    ));
    let mesh = build_mesh::<2>(&own).expect("it is meshed");
    assert!(in_mesh("pairs", &mesh, ARRAY).is_ok());
    let told = |mesh: &Mesh<2>, text: &str, words: &[&str]| {
        let error = match in_mesh("no-pairs", mesh, text) {
            Err(error) => error,
            Ok(file) => format!("{:?}", check(&file)),
        };
        for word in words {
            assert!(error.contains(word), "{word}: {error}");
        }
    };
    let mut bent = mesh.clone();
    let moved = bent.nodes.iter_mut().find(|at| at[0] == 1.0 && at[1] > 0.3 && at[1] < 0.7);
    *moved.expect("there is one") += Point::<2>::new(0.0, 1e-3);
    told(&bent, ARRAY, &["the node of `", "has no partner at (", "Periodic Curve"]);
    let crossed = ARRAY.replace("\"right\"", "\"bottom\"").replace("top.periodic = \"bottom\"", "");
    let rest = format!("{crossed}right = \"no-slip\"\n    top = \"no-slip\"\n");
    told(&mesh, &rest, &["lie apart along x, y or z", "left", "bottom"]);
    told(&mesh, &ARRAY.replace("\"right\"", "\"rihgt\""), &["no such side", "right"]);
    told(
        &mesh,
        &format!("{ARRAY}right = \"no-slip\"\n"),
        &["`left` is periodic with `right`, which has another condition"],
    );
    let disc =
        "[[body]]\nname = \"b\"\nshape.disc.radius = 0.1\ncenter = [0.5, 0.5]\nmotion = \"free\"\n";
    told(&mesh, &format!("{ARRAY}{disc}"), &["is not held, or no hole"]);
}
