//! The solid of a soft case: materials, fibres and what is held, on its mesh.

use crate::soft::{Curve, FacetLaw, SoftBody, SoftError};
use alewife_mesh::Point;
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Fibres, Frame, RigidPart, Solid, SolidError, SolidMesh, SolidSpec};
use nalgebra::Vector3;

use alewife_case::soft::SoftFile;
use alewife_case::soft::solid::{LawName, MaterialSpec, SoftSolid};
use alewife_case::soft::spec::{LoadCurve, Loads};
use alewife_case::{Diagnostic, Geometry};

/// The material of a case.
pub(super) fn material(spec: &MaterialSpec) -> Material {
    let law = match spec.law {
        LawName::NeoHookean => Law::NeoHookean,
        LawName::SaintVenantKirchhoff => Law::SaintVenantKirchhoff,
        LawName::Corotated => Law::Corotated,
        LawName::CorotatedVolume => Law::CorotatedVolume,
    };
    let MaterialSpec { young, poisson, density, viscosity, .. } = *spec;
    Material { law, young, poisson, density, viscosity }
}

/// The law of the loads of a case.
pub(super) fn loads(spec: &Loads) -> Result<FacetLaw, SoftError> {
    let curve = |curve: &LoadCurve| match curve {
        LoadCurve::Bezier(points) => Curve::bezier(points),
        LoadCurve::Table(values) => Curve::table(values),
    };
    Ok(FacetLaw { density: spec.density, drag: curve(&spec.drag)?, thrust: curve(&spec.thrust)? })
}

/// Materials in the order of their numbers: that of the body, then those of its parts.
pub(super) fn materials(solid: &SoftSolid) -> Vec<Material> {
    let parts = solid.part.iter().map(|part| &part.material);
    [&solid.material].into_iter().chain(parts).map(material).collect()
}

/// Centres of all cells.
fn centres<const D: usize>(mesh: &SolidMesh<D>) -> Vec<Point<D>> {
    let cells = mesh.cells.chunks_exact(mesh.n_local());
    let centre = |cell: &[usize]| -> Point<D> {
        cell[..=D].iter().map(|node| mesh.nodes[*node]).sum::<Point<D>>() / (D + 1) as f64
    };
    cells.map(centre).collect()
}

/// A body with its loads.
pub(super) fn body<const D: usize>(
    file: &SoftFile,
    solid: &SoftSolid,
    mesh: SolidMesh<D>,
) -> Result<SoftBody<D>, Diagnostic> {
    let centres = centres(&mesh);
    let inside = |region: &alewife_case::soft::solid::Region| -> Vec<usize> {
        let all = centres.iter().enumerate().filter(|(_, x)| region.holds(x.as_slice()));
        all.map(|(cell, _)| cell).collect()
    };
    let mut material_of = vec![0; if solid.part.is_empty() { 0 } else { centres.len() }];
    for (part, spec) in solid.part.iter().enumerate() {
        let cells = inside(&spec.region);
        if cells.is_empty() {
            return Err(empty(file, &format!("solid.0.part.{part}.region"), "no centre of a cell"));
        }
        cells.into_iter().for_each(|cell| material_of[cell] = part + 1);
    }
    let mut rigid = Vec::new();
    for (part, spec) in solid.rigid.iter().enumerate() {
        let cells = inside(&spec.region);
        if cells.is_empty() {
            let key = format!("solid.0.rigid.{part}.region");
            return Err(empty(file, &key, "no centre of a cell"));
        }
        rigid.push(RigidPart { cells, density: spec.density });
    }
    let mut fibres = Vec::new();
    for (n, spec) in solid.fibre.iter().enumerate() {
        let cells = inside(&spec.region);
        if cells.is_empty() {
            return Err(empty(file, &format!("solid.0.fibre.{n}.region"), "no centre of a cell"));
        }
        let along = |axis: usize| spec.direction.get(axis).copied().unwrap_or(0.0);
        let direction = Vector3::new(along(0), along(1), along(2));
        let directions = vec![direction; cells.len()];
        fibres.push(Fibres { cells, directions, stiffness: spec.stiffness });
    }
    let mut held = Vec::new();
    for (n, spec) in solid.hold.iter().enumerate() {
        let nodes = mesh.nodes_where(|x| spec.region.holds(x.as_slice()));
        if nodes.is_empty() {
            return Err(empty(file, &format!("solid.0.hold.{n}.region"), "no node"));
        }
        let all: Vec<usize> = (0..D).collect();
        let named = |axes: &Vec<_>| {
            axes.iter().map(|axis: &alewife_case::soft::solid::AxisName| axis.index()).collect()
        };
        let axes = spec.axes.as_ref().map_or(all, named);
        held.extend(nodes.iter().flat_map(|node| axes.iter().map(move |axis| D * node + axis)));
    }
    let frame = match file.case.geometry {
        Geometry::Planar => Frame::Plane,
        Geometry::Axisymmetric => Frame::Axis,
        Geometry::Spatial => Frame::Space,
    };
    held.sort_unstable();
    held.dedup();
    let spec =
        SolidSpec { mesh, frame, materials: materials(solid), material_of, fibres, rigid, held };
    Ok(SoftBody {
        solid: Solid::new(spec).map_err(|error| refused(file, &error))?,
        law: file
            .case
            .loads
            .as_ref()
            .map(loads)
            .transpose()
            .map_err(|error| file.error("loads", error.to_string(), "write finite numbers"))?,
    })
}

/// Why a body is none.
fn refused(file: &SoftFile, error: &SolidError) -> Diagnostic {
    let [key, help] = match error {
        SolidError::RigidTouch([_, part]) => [
            format!("solid.0.rigid.{part}.region"),
            "make the two one part, or leave cells between them".to_owned(),
        ],
        SolidError::RigidHeld(part) => [
            format!("solid.0.rigid.{part}.region"),
            "hold cells beside it, or leave it elastic".to_owned(),
        ],
        _ => ["solid.0".to_owned(), "change the body or its mesh".to_owned()],
    };
    file.error(&key, error.to_string(), &help)
}

/// A region that holds nothing.
fn empty(file: &SoftFile, key: &str, what: &str) -> Diagnostic {
    let message = format!("{what} lies in this region");
    file.error(key, message, "widen the region, or make the cells smaller")
}
