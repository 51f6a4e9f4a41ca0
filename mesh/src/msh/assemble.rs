//! From a file to a mesh: cells made positive, sides by their names, edges with their inner nodes.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::divide::divide;
use super::error::MshError;
use super::facets::{NAMES, NamedFacets, entity_name};
use super::file::MshFile;
use super::kind::node_order;
use super::options::{MshOptions, ReadMsh};
use super::parts::{Middle, Parts, edges_of, facet_of};
use super::pieces::{check_connected, join_pieces};
use super::plane::Plane;
use crate::check::check_mesh;
use crate::mesh::jacobian_coefficients;
use crate::{Boundary, BoundaryId, CellId, Facet, Mesh, NodeId, Point, Simplex, Topology};

/// Inner nodes this near to the middle of their edge are on it, in lengths of the edge.
const IN_MIDDLE: f64 = 1e-12;

/// The same on the boundary, below which a side is straight.
const FLAT: f64 = 1e-9;

/// A cell that is flatter than this has no volume: D! times its measure over its longest edge to
/// the power D.
const NO_VOLUME: f64 = 1e-14;

/// Reads a mesh of triangles (D = 2) or tetrahedra (D = 3), its lengths multiplied by a factor.
///
/// Cells that are negative are turned, nodes without cells left out, edges inside made straight;
/// cells with two sides on the boundary are divided at their centroids. Elements that are no cells
/// matter only where they are facets with a physical name. The boundaries are in the order of the
/// tags of their physical groups.
///
/// # Errors
/// [`MshError`] with the place and what would be accepted.
pub fn read_msh<const D: usize>(bytes: &[u8], scale: f64) -> Result<Mesh<D>, MshError> {
    read_msh_with(bytes, &MshOptions::scaled(scale)).map(|read| read.mesh)
}

/// The same with more options, and with what was made of the file: facets inside are no sides, pieces that touch are
/// joined, and a mesh in the plane may be at any z.
///
/// # Errors
/// [`MshError`] with the place and what would be accepted.
pub fn read_msh_with<const D: usize>(
    bytes: &[u8],
    options: &MshOptions,
) -> Result<ReadMsh<D>, MshError> {
    let mut read = Read::<D>::of(bytes, options)?;
    divide(&mut read.parts);
    let notes = std::mem::take(&mut read.parts.notes);
    Ok(ReadMsh { mesh: read.mesh()?, notes })
}

/// Reads a mesh as [`read_msh`], with all cells as they are: for elastic bodies, which have no pressure that
/// needs a node inside.
///
/// # Errors
/// [`MshError`] with the place and what would be accepted.
pub fn read_undivided_msh<const D: usize>(bytes: &[u8], scale: f64) -> Result<Mesh<D>, MshError> {
    let read = Read::<D>::of(bytes, &MshOptions::scaled(scale))?;
    let mut divided = read.clone();
    divide(&mut divided.parts);
    // It conforms where the divided one does, which is what can be checked
    divided.mesh()?;
    mesh_of(read.parts, read.boundaries)
}

/// What a file has.
#[derive(Clone)]
struct Read<const D: usize> {
    parts: Parts<D>,
    boundaries: Vec<Boundary>,
}

impl<const D: usize> Read<D> {
    fn of(bytes: &[u8], options: &MshOptions) -> Result<Self, MshError> {
        let mut file = MshFile::read(bytes)?;
        let n_joined = join_pieces(&mut file, D);
        let mut facets = NamedFacets::<D>::of(&file, &options.sides)?;
        let mut parts = parts_of(&file, &mut facets, options.scale)?;
        if n_joined > 0 {
            let note = format!("pieces that touch are joined at {n_joined} nodes that coincide");
            parts.notes.push(note);
        }
        Ok(Self { parts, boundaries: facets.boundaries })
    }

    fn mesh(self) -> Result<Mesh<D>, MshError> {
        let mesh = mesh_of(self.parts, self.boundaries)?;
        check_mesh(&mesh).map_err(|error| {
            MshError::of_mesh(
                format!("no conforming mesh: {error}"),
                "mesh the model again in Gmsh",
            )
        })?;
        Ok(mesh)
    }
}

/// Coordinates for a message.
fn at<const D: usize>(point: &Point<D>) -> String {
    let coordinates: Vec<String> = point.iter().map(|x| format!("{x:.4}")).collect();
    format!("at ({})", coordinates.join(", "))
}

fn parts_of<const D: usize>(
    file: &MshFile,
    facets: &mut NamedFacets<D>,
    scale: f64,
) -> Result<Parts<D>, MshError> {
    let order = order_of_cells::<D>(file)?;
    let plane = Plane::of::<D>(file, scale);
    let cells = || {
        let blocks = file.blocks.iter().filter(|block| block.kind.dimension == D);
        blocks.flat_map(|block| block.elements())
    };
    // Vertices are numbered by their tags
    let mut numbers: BTreeMap<u64, usize> =
        cells().flat_map(|(_, nodes)| nodes[..=D].iter().map(|tag| (*tag, 0))).collect();
    let mut vertices = Vec::with_capacity(numbers.len());
    for (tag, number) in &mut numbers {
        *number = vertices.len();
        vertices.push(plane.position::<D>(file, *tag)?);
    }
    let mut parts = Parts {
        vertices,
        cells: Vec::new(),
        tags: Vec::new(),
        sides: BTreeMap::new(),
        middles: BTreeMap::new(),
        notes: plane.notes(),
    };
    let mut known_cells = BTreeSet::new();
    for (tag, nodes) in cells() {
        let mut own: Vec<usize> = nodes[..=D].iter().map(|node| numbers[node]).collect();
        let mut corners = own.clone();
        corners.sort_unstable();
        // A cell in two physical groups may be there twice
        if !known_cells.insert(corners) {
            continue;
        }
        if order > 1 {
            for (edge, [i, j]) in Simplex::<D>::EDGES.iter().enumerate() {
                let first = D + 1 + (order - 1) * (node_order::<D>()[D + 1 + edge] - D - 1);
                let inner = &nodes[first..first + order - 1];
                let ends = [own[*i], own[*j]].map(|vertex| parts.vertices[vertex]);
                let middle = plane.middle::<D>(file, inner, ends)?;
                if let Some(corner) = inner.iter().find(|node| numbers.contains_key(node)) {
                    let found = format!(
                        "node {corner} is a corner of one element, and inside an \
                                         edge of element {tag}"
                    );
                    return Err(MshError::of_mesh(found, "save the whole mesh with one order"));
                }
                let ends = [own[*i].min(own[*j]), own[*i].max(own[*j])];
                let known = parts.middles.insert(ends, middle);
                if known.is_some_and(|known| known.tag != middle.tag) {
                    let found = format!("two nodes in one edge of element {tag}");
                    return Err(MshError::of_mesh(found, "neighbours share nodes"));
                }
            }
        }
        turn(&parts.vertices, tag, &mut own)?;
        parts.cells.push(own);
        parts.tags.push(tag);
    }
    parts.sides = sides(&mut parts, facets, &numbers)?;
    check_connected(&parts)?;
    Ok(parts)
}

/// The order of all cells of a file.
fn order_of_cells<const D: usize>(file: &MshFile) -> Result<usize, MshError> {
    let [wanted, others] = if D == 2 {
        ["triangles in a plane of equal z, which a planar case needs", "tetrahedra"]
    } else {
        ["tetrahedra, which a case in space needs", "no tetrahedra"]
    };
    if D == 2 && file.blocks.iter().any(|block| block.kind.dimension == 3) {
        return Err(MshError::of_mesh(others.to_owned(), &format!("save {wanted}")));
    }
    let mut cells = file.blocks.iter().filter(|b| b.kind.dimension == D && !b.tags.is_empty());
    let Some(first) = cells.next() else {
        let found = if D == 2 { "no triangles" } else { others };
        let group = if D == 2 { "Surface" } else { "Volume" };
        let accepted = format!(
            "save {wanted}: with physical groups of sides Gmsh saves what is in a group only, so give the fluid \
             one, too, Physical {group}(\"fluid\") = {{...}}, or set Mesh.SaveAll = 1"
        );
        return Err(MshError::of_mesh(found.to_owned(), &accepted));
    };
    if cells.any(|block| block.kind.order != first.kind.order) {
        let found = "cells of several orders".to_owned();
        return Err(MshError::of_mesh(found, "save the whole mesh with one order"));
    }
    Ok(first.kind.order)
}

/// Makes a cell positive.
fn turn<const D: usize>(
    vertices: &[Point<D>],
    tag: u64,
    cell: &mut [usize],
) -> Result<(), MshError> {
    let corner = |local: usize| vertices[cell[local]];
    let columns: [Point<D>; D] = std::array::from_fn(|axis| corner(axis + 1) - corner(0));
    let longest = Simplex::<D>::EDGES.iter().map(|[i, j]| (corner(*i) - corner(*j)).norm());
    let longest = longest.fold(0.0, f64::max);
    // Of scaled columns, which cannot overflow
    let measure = crate::mesh::determinant(&columns.map(|column| column / longest));
    if measure.is_nan() || measure.abs() <= NO_VOLUME {
        let kind = if D == 2 { "no area" } else { "no volume" };
        let found = format!("element {tag} {} has {kind}", at(&corner(0)));
        return Err(MshError::of_mesh(found, "mesh the model again in Gmsh"));
    }
    if measure < 0.0 {
        cell.swap(D - 1, D);
    }
    Ok(())
}

/// The boundaries of all facets with one cell.
fn sides<const D: usize>(
    parts: &mut Parts<D>,
    facets: &mut NamedFacets<D>,
    numbers: &BTreeMap<u64, usize>,
) -> Result<BTreeMap<[usize; D], BoundaryId>, MshError> {
    let mut n_cells: HashMap<[usize; D], usize> = HashMap::new();
    for (cell, tag) in parts.cells.iter().zip(&parts.tags) {
        for side in 0..=D {
            let n = n_cells.entry(facet_of::<D>(cell, side)).or_default();
            *n += 1;
            if *n > 2 {
                let place = at(&parts.vertices[cell[0]]);
                let found =
                    format!("more than two elements share a facet of element {tag} {place}");
                return Err(MshError::of_mesh(
                    found,
                    "cells may not overlap: mesh the model again",
                ));
            }
        }
    }
    let n_cells_at = |tags: &[u64; D]| {
        let vertices = tags.map(|tag| numbers.get(&tag).copied().unwrap_or(usize::MAX));
        n_cells.get(&vertices).copied().unwrap_or(0)
    };
    parts.notes.extend(keep_outside(facets, n_cells_at)?);
    // Vertices are numbered in the order of their tags
    let vertices =
        |tags: &[u64; D]| tags.map(|tag| numbers.get(&tag).copied().unwrap_or(usize::MAX));
    let named: BTreeMap<[usize; D], BoundaryId> =
        facets.of.iter().map(|(tags, boundary)| (vertices(tags), *boundary)).collect();
    let all = parts.cells.iter().flat_map(|cell| (0..=D).map(|side| facet_of::<D>(cell, side)));
    let mut nameless = all.filter(|facet| n_cells[facet] == 1 && !named.contains_key(facet));
    if let Some(first) = nameless.next() {
        let center = first.iter().map(|v| parts.vertices[*v]).sum::<Point<D>>() / D as f64;
        let n = 1 + nameless.count();
        let facets = if n == 1 { "one facet".to_owned() } else { format!("{n} facets") };
        let found = format!("{facets} of the boundary without a name, the first {}", at(&center));
        return Err(MshError::of_mesh(found, NAMES));
    }
    Ok(named)
}

/// Leaves those facets that have fluid on one side; says which have it on both.
fn keep_outside<const D: usize>(
    facets: &mut NamedFacets<D>,
    n_cells_at: impl Fn(&[u64; D]) -> usize,
) -> Result<Vec<String>, MshError> {
    if let Some((_, error)) = facets.several.iter().find(|(tags, _)| n_cells_at(tags) == 1) {
        return Err(error.clone());
    }
    let mut inside: BTreeMap<BoundaryId, usize> = BTreeMap::new();
    for (tags, boundary) in &facets.of {
        match n_cells_at(tags) {
            0 => {
                let name = &facets.boundaries[*boundary].name;
                let found =
                    format!("an element of \"{name}\" with node {} is no facet of a cell", tags[0]);
                let accepted =
                    format!("only {}s of the fluid get physical names", entity_name::<D>());
                return Err(MshError::of_mesh(found, &accepted));
            }
            1 => {}
            _ => *inside.entry(*boundary).or_default() += 1,
        }
    }
    let note = |(boundary, n): (BoundaryId, usize)| {
        let name = &facets.boundaries[boundary].name;
        let plural = if n == 1 { "facet" } else { "facets" };
        format!("{n} {plural} of \"{name}\" with fluid on both sides: inside, and no side")
    };
    let notes = inside.into_iter().map(note).collect();
    facets.of.retain(|tags, _| n_cells_at(tags) == 1);
    facets.forget_unused();
    Ok(notes)
}

/// The mesh, with quadratic nodes and boundary facets.
fn mesh_of<const D: usize>(
    parts: Parts<D>,
    boundaries: Vec<Boundary>,
) -> Result<Mesh<D>, MshError> {
    let Parts { vertices, cells, tags, sides, middles, .. } = parts;
    let n_vertices = vertices.len();
    let on_boundary = edges_of(&sides);
    let mut nodes = vertices;
    // Nodes of the file in the order of their tags, then those of other edges
    let mut given: Vec<([usize; 2], Middle<D>)> = middles.into_iter().collect();
    given.sort_by_key(|(_, middle)| middle.tag);
    let mut numbers: BTreeMap<[usize; 2], NodeId> = BTreeMap::new();
    let mut is_bent = BTreeSet::new();
    for ([a, b], middle) in given {
        let straight = (nodes[a] + nodes[b]) * 0.5;
        let off = (middle.point - straight).norm() / (nodes[a] - nodes[b]).norm();
        if off > FLAT && on_boundary.contains(&[a, b]) {
            is_bent.insert([a, b]);
        }
        numbers.insert([a, b], NodeId::new(nodes.len()));
        let is_kept = off <= IN_MIDDLE || on_boundary.contains(&[a, b]);
        nodes.push(if is_kept { middle.point } else { straight });
    }
    let mut topology = Topology {
        n_vertices,
        cells: Vec::with_capacity(Simplex::<D>::N_NODES * cells.len()),
        curved: Vec::with_capacity(cells.len()),
        facets: Vec::with_capacity(sides.len()),
        boundaries,
        periodic: Vec::new(),
    };
    for (index, cell) in cells.iter().enumerate() {
        topology.cells.extend(cell.iter().map(|vertex| NodeId::new(*vertex)));
        let mut is_curved = false;
        for ends in Simplex::<D>::EDGES {
            let [a, b] = ends.map(|local| cell[local]);
            let ends = [a.min(b), a.max(b)];
            is_curved |= is_bent.contains(&ends);
            topology.cells.push(*numbers.entry(ends).or_insert_with(|| {
                nodes.push((nodes[a] + nodes[b]) * 0.5);
                NodeId::new(nodes.len() - 1)
            }));
        }
        topology.curved.push(is_curved);
        for side in 0..=D {
            if let Some(boundary) = sides.get(&facet_of::<D>(cell, side)) {
                #[expect(clippy::cast_possible_truncation, reason = "a simplex has few facets")]
                let side = side as u8;
                topology.facets.push(Facet { cell: CellId::new(index), side, boundary: *boundary });
            }
        }
    }
    if u32::try_from(nodes.len()).is_err() {
        let found = format!("a mesh of {} nodes", nodes.len());
        return Err(MshError::of_mesh(found, "meshes up to 4 billion nodes are read"));
    }
    let mesh = Mesh::new(nodes, topology);
    check_folds(&mesh, &tags)?;
    Ok(mesh)
}

/// Whether curved cells are positive everywhere.
fn check_folds<const D: usize>(mesh: &Mesh<D>, tags: &[u64]) -> Result<(), MshError> {
    let is_folded = |cell: &CellId| {
        mesh.curved[*cell]
            && jacobian_coefficients(&mesh.cell_nodes(*cell)).iter().any(|c| *c <= 0.0)
    };
    match mesh.cell_ids().find(is_folded) {
        None => Ok(()),
        Some(cell) => {
            let (tag, place) = (tags[cell], at(&mesh.cell_center(cell)));
            let found = format!("element {tag} {place} is folded by its curved side");
            let accepted = "use smaller elements there, or save the mesh with order 1";
            Err(MshError::of_mesh(found, accepted))
        }
    }
}
