//! The closed surface that a case names as its domain: read, its sides told apart.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use alewife_mesh::spatial::{NamedTriangles, Region, SurfaceFault, TriangleMesh};
use alewife_mesh::{Point, Sizing};

use super::surface_file::{NamedFile, read_named};
use crate::spec::given_mesh::region_mesh::RegionMesh;
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::{Case, DomainSpec, Geometry, MeshFile, NamedSolid, RegionFault, RegionSpec, SidePart};

/// Triangles are in a plane when they are nearer to it than this part of the surface.
const IN_PLANE: f64 = 1e-5;

/// The side of triangles that belong to none that is named.
const REST: &str = "wall";

/// Regions that are kept, with their meshes, for cases that are read again.
const MOST_KEPT: usize = 4;

/// The regions read last, by all they follow from: what is kept changes no result.
static KEPT: Mutex<Vec<(String, Arc<RegionMesh>)>> = Mutex::new(Vec::new());

/// Puts the triangles of a file in the place of its name, so that a case stands for itself.
///
/// # Errors
/// When the file cannot be read, or holds no triangles.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let domain = root.table_mut().and_then(|entries| entries.get_mut("domain"));
    let surface = domain.and_then(TomlNode::table_mut).and_then(|all| all.get_mut("surface"));
    let Some(entries) = surface.and_then(TomlNode::table_mut) else { return Ok(()) };
    let Some(NamedFile { file, content }) = read_named(entries, NamedTriangles::read)? else {
        return Ok(());
    };
    let NamedTriangles { mesh, groups } = content;
    let node = |value: TomlValue| TomlNode { value, ..file.clone() };
    let solid = |name: String, n: usize| {
        let n = i64::try_from(n).unwrap_or(i64::MAX);
        let entries = [("name", TomlValue::String(name)), ("triangles", TomlValue::Integer(n))];
        node(TomlValue::Table(entries.map(|(key, value)| (key.to_owned(), node(value))).into()))
    };
    let solids = groups.into_iter().map(|group| solid(group.name, group.n)).collect();
    entries.remove("file");
    entries.insert("data".to_owned(), node(TomlValue::String(mesh.to_line())));
    entries.insert("solids".to_owned(), node(TomlValue::Array(solids)));
    Ok(())
}

/// Reads the surface that is the domain of a case, if one is.
///
/// # Errors
/// When triangles enclose nothing, or a side has none.
pub fn read_into(case: &mut Case, root: &TomlNode) -> Result<(), TreeError> {
    let sizing = case.sizing::<3>();
    let DomainSpec::Surface(spec) = &mut case.domain else { return Ok(()) };
    let out_of_range = [("scale", spec.scale, f64::INFINITY), ("smooth", spec.smooth, 180.0)]
        .into_iter()
        .find(|(_, value, most)| !(value.is_finite() && *value > 0.0 && value <= most));
    if let Some((key, value, _)) = out_of_range {
        let key = format!("domain.surface.{key}");
        let origin = root.find(&key).node.origin.clone();
        let help = "write a number above 0, of degrees 180 at most".to_owned();
        return Err(TreeError { origin, message: format!("`{key}` is {value}"), help });
    }
    if case.geometry != Geometry::Spatial || !is_ready(spec, &sizing) {
        return Ok(());
    }
    let refused = |RegionFault { key, message, help, .. }: RegionFault| {
        let found = root.find(&key);
        let at_data = root.find("domain.surface.data");
        let node = if found.is_exact { found.node } else { at_data.node };
        TreeError { origin: node.origin.clone(), message, help }
    };
    let made_of = format!("{spec:?} {sizing:?}");
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let region = match kept.into_iter().find(|(known, _)| *known == made_of) {
        Some((_, region)) => region,
        None => {
            let region = Arc::new(region(spec, &sizing).map_err(refused)?);
            let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.len() >= MOST_KEPT {
                kept.remove(0);
            }
            kept.push((made_of, Arc::clone(&region)));
            region
        }
    };
    spec.filled = Some(MeshFile::inside(region));
    Ok(())
}

/// Whether its numbers are such that it can be meshed; what is wrong with them is told with the rest of the case.
fn is_ready(spec: &RegionSpec, sizing: &Sizing<3>) -> bool {
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    let mut sizes = sizing.sides.iter().map(|(_, size)| *size).chain([spec.scale]);
    let without_sides = Sizing { sides: Vec::new(), ..sizing.clone() };
    spec.data.is_some() && sizes.all(is_positive) && without_sides.check(&[]).is_ok()
}

/// The inside of a surface, its sides told apart.
fn region(spec: &RegionSpec, sizing: &Sizing<3>) -> Result<RegionMesh, RegionFault> {
    let of_surface = |fault: SurfaceFault| {
        let message = format!("the surface of the domain: {fault}");
        RegionFault::new("domain.surface.data", message, fault.remedy().to_owned())
    };
    let data = spec.data.as_deref().unwrap_or_default();
    let mesh = TriangleMesh::from_line(data).map_err(of_surface)?.scaled(spec.scale);
    let Sides { names, of } = sides(spec, &mesh)?;
    let region = Region::new(mesh, names, of, spec.smooth).map_err(of_surface)?;
    Ok(RegionMesh::new(region, sizing.clone(), spec.scale))
}

/// Names of sides, and that of each triangle.
struct Sides {
    names: Vec<String>,
    of: Vec<usize>,
}

/// The solid of each triangle.
fn solids_of(solids: &[NamedSolid], n: usize) -> Vec<&str> {
    let named = solids.iter().flat_map(|one| std::iter::repeat_n(one.name.as_str(), one.triangles));
    named.chain(std::iter::repeat("")).take(n).collect()
}

fn sides(spec: &RegionSpec, mesh: &TriangleMesh) -> Result<Sides, RegionFault> {
    let n = mesh.triangles.len();
    let solids = solids_of(&spec.solids, n);
    // A name that all have is that of the whole
    let has_several = solids.iter().any(|solid| *solid != solids[0]);
    let mut names: Vec<String> = Vec::new();
    let mut of: Vec<Option<usize>> = vec![None; n];
    for (side, part) in &spec.sides {
        let number = names.len();
        names.push(side.clone());
        let key = format!("domain.surface.sides.{side}");
        let own = triangles_of(part, mesh, &solids);
        if own.is_empty() {
            let message = format!("no triangle of the surface is on the side `{side}`");
            return Err(RegionFault::new(&key, message, parts_there_are(mesh, &solids)));
        }
        for triangle in own {
            if let Some(other) = of[triangle].replace(number) {
                let message = format!("the sides `{}` and `{side}` overlap", names[other]);
                let help = "give each triangle one side".to_owned();
                return Err(RegionFault::new(&key, message, help));
            }
        }
    }
    let mut rest: BTreeMap<&str, usize> = BTreeMap::new();
    for (solid, own) in solids.iter().zip(&mut of).filter(|(_, own)| own.is_none()) {
        let name = if has_several && !solid.is_empty() { *solid } else { REST };
        let known = names.iter().position(|side| side == name);
        let number = *rest.entry(name).or_insert_with(|| {
            known.unwrap_or_else(|| {
                names.push(name.to_owned());
                names.len() - 1
            })
        });
        *own = Some(number);
    }
    Ok(Sides { names, of: of.into_iter().map(Option::unwrap_or_default).collect() })
}

/// Triangles of a part.
fn triangles_of(part: &SidePart, mesh: &TriangleMesh, solids: &[&str]) -> Vec<usize> {
    match part {
        SidePart::Solid(name) => {
            (0..solids.len()).filter(|triangle| solids[*triangle] == name).collect()
        }
        SidePart::Plane { point, normal } => {
            let (point, normal) = (Point::from(*point), Point::<3>::from(*normal).normalize());
            let tolerance = IN_PLANE * mesh.extent();
            let is_on = |at: &Point<3>| normal.dot(&(at - point)).abs() <= tolerance;
            let all = 0..mesh.triangles.len();
            all.filter(|triangle| mesh.corners(*triangle).iter().all(is_on)).collect()
        }
    }
}

/// Names of solids and the largest flat parts of a surface, as a remedy.
fn parts_there_are(mesh: &TriangleMesh, solids: &[&str]) -> String {
    let mut names: Vec<&str> = solids.iter().copied().filter(|name| !name.is_empty()).collect();
    names.dedup();
    let named = if names.is_empty() {
        "the file names no solids".to_owned()
    } else {
        format!("its solids are `{}`", names.join("`, `"))
    };
    let largest = (0..mesh.triangles.len())
        .max_by(|a, b| mesh.area_vector(*a).norm().total_cmp(&mesh.area_vector(*b).norm()));
    let place = largest.map(|triangle| {
        let [x, y, z]: [f64; 3] = mesh.corners(triangle)[0].into();
        let [u, v, w]: [f64; 3] = mesh.area_vector(triangle).normalize().into();
        format!(
            "; its largest triangle is in {{ plane = {{ point = [{x:.5}, {y:.5}, {z:.5}], normal = [{u:.4}, {v:.4}, \
             {w:.4}] }} }}"
        )
    });
    format!("{named}{}; lengths are those of the case, after `scale`", place.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use crate::{Case, CaseFile, Severity, check};

    /// A box of 3 by 1 by 1 with the groups `in` and `out` at its ends.
    const BOX: &str = "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 0 1 0\nv 0 0 1\nv 3 0 1\nv 3 1 1\nv 0 1 1\n\
                       g in\nf 1 5 8 4\ng out\nf 2 3 7 6\n\
                       g sheath\nf 1 2 6 5\nf 4 8 7 3\nf 1 4 3 2\nf 5 6 7 8\n";

    fn read(obj: &str, keys: &str, boundary: &str, size: &str) -> Result<CaseFile, String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("box.obj"), obj).unwrap();
        let case = format!(
            "
title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
mesh = {{ size = {size} }}
time = {{ steady = {{}} }}
boundary = {{ {boundary} }}
[domain.surface]
{keys}
"
        );
        let path = directory.path().join("t.toml");
        std::fs::write(&path, case).unwrap();
        Case::read(&path.display().to_string(), &[]).map_err(|error| error.to_string())
    }

    fn errors(file: &CaseFile) -> Vec<String> {
        let all = check(file).into_iter().filter(|one| one.severity == Severity::Error);
        all.map(|one| one.message).collect()
    }

    const GROUPS: &str =
        "in = { developed = { flux = 1.0 } }, out = 'do-nothing', sheath = 'no-slip'";

    #[test]
    fn groups_of_the_file_are_sides_and_the_case_stands_for_itself() {
        let file = read(BOX, "file = 'box.obj'", GROUPS, "0.5").unwrap();
        assert_eq!(errors(&file), Vec::<String>::new());
        assert_eq!(file.case().sides(), ["in", "out", "sheath"]);
        let mesh = file.case().given_mesh().unwrap();
        assert!((mesh.measure() - 3.0).abs() < 1e-9, "{}", mesh.measure());
        let again = Case::parse("t.toml", &file.case().to_toml().unwrap(), &[]).unwrap();
        assert_eq!(again.case(), file.case());
        assert_eq!(again.case().given_mesh().unwrap().n_cells(), mesh.n_cells());
    }

    #[test]
    fn a_surface_in_another_unit_of_length_is_asked_about() {
        let file = read(BOX, "file = 'box.obj'\nscale = 1e3", GROUPS, "0.5").unwrap();
        let refused = check(&file).into_iter().find(|one| one.key == "mesh.size").unwrap();
        assert!(refused.message.contains("more than 5e6 cells"), "{refused:?}");
        assert!(refused.help.contains("another unit") && refused.help.contains("scale = 1.0"));
        // One that is far too small is meshed, and asked about
        for (scale, is_asked) in [("1e-3", true), ("1.0", false)] {
            let keys = format!("file = 'box.obj'\nscale = {scale}");
            let Ok(file) = read(BOX, &keys, GROUPS, "0.5") else { panic!("can be meshed") };
            let asked = check(&file).into_iter().find(|one| one.key == "domain.surface");
            assert_eq!(
                asked.as_ref().is_some_and(|one| one.help.contains("scale = 1.0")),
                is_asked
            );
        }
    }

    #[test]
    fn planes_are_sides_and_the_rest_is_the_wall() {
        let keys = "file = 'box.obj'\nscale = 2.0\n\
                    sides.inlet.plane = { point = [0.0, 0.3, 0.0], normal = [2.0, 0.0, 0.0] }\n\
                    sides.outlet.solid = 'out'";
        let sides =
            "inlet = { parabolic = { peak = 1.0 } }, outlet = 'do-nothing', sheath = 'no-slip'";
        let file = read(BOX, keys, sides, "1.0").unwrap();
        assert_eq!(errors(&file), Vec::<String>::new());
        let shape = file.case().given_mesh().unwrap().side_shape("inlet").unwrap();
        assert!(shape.is_flat && (shape.area.x + 4.0).abs() < 1e-9, "{shape:?}");
        let bare = BOX.lines().filter(|line| !line.starts_with('g')).collect::<Vec<_>>().join("\n");
        let keys = keys.replace("sides.outlet.solid = 'out'", "");
        let sides = "inlet = { parabolic = { peak = 1.0 } }, wall = 'no-slip'";
        assert_eq!(read(&bare, &keys, sides, "1.0").unwrap().case().sides(), ["inlet", "wall"]);
    }

    #[test]
    fn what_is_no_region_is_told_with_its_place_and_a_remedy() {
        let plane = |x: f64| format!("plane = {{ point = [{x}, 0, 0], normal = [1, 0, 0] }}");
        let file = "file = 'box.obj'";
        for (obj, keys, told) in [
            (BOX, format!("{file}\nsides.inlet.{}", plane(1.0)), "`inlet`"),
            (
                BOX,
                format!("{file}\nsides.inlet.{}", plane(1.0)),
                "its solids are `in`, `out`, `sheath`",
            ),
            (
                BOX,
                format!("{file}\nsides.a.{}\nsides.b.solid = 'in'", plane(0.0)),
                "`a` and `b` overlap",
            ),
            (BOX, format!("{file}\nsides.a.solid = 'inn'"), "no triangle"),
            (BOX, "file = 'bax.obj'".to_owned(), "bax.obj"),
            (BOX, format!("{file}\nsides.a.sphere = 1"), "sphere"),
            (&BOX[..BOX.len() - 10], file.to_owned(), "edges are open"),
            ("hello", file.to_owned(), "no STL, OBJ or PLY"),
        ] {
            let error = read(obj, &keys, GROUPS, "0.5").unwrap_err();
            assert!(error.contains(told), "{told}: {error}");
        }
        let fine = read(BOX, file, GROUPS, "1e-4").unwrap();
        assert!(errors(&fine).iter().any(|one| one.contains("more than 5e6 cells")));
        let wrong = read(BOX, file, GROUPS, "-1.0").unwrap();
        assert!(errors(&wrong).iter().any(|one| one.contains("mesh.size")));
        for (key, value) in
            [("scale", "0.0"), ("scale", "-1.0"), ("smooth", "0.0"), ("smooth", "200.0")]
        {
            let keys = format!("{file}\n{key} = {value}");
            let error = read(BOX, &keys, GROUPS, "0.5").unwrap_err();
            assert!(error.contains(&format!("`domain.surface.{key}` is")), "{error}");
        }
        let none = read(BOX, "smooth = 20.0", GROUPS, "0.5").unwrap();
        assert!(errors(&none).iter().any(|one| one.contains("no triangles")));
    }
}
