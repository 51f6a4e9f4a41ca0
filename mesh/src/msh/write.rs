//! Writer of MSH 4.1: quadratic cells, facets by their boundaries, names as physical groups.

use std::io::{self, Write};

use super::kind::{Kind, node_order};
use crate::{Bounds, Facet, Mesh, NodeId, Point, Simplex};

/// How the numbers of a file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Encoding {
    /// As text, with as many digits as it takes to read the same numbers back.
    Text,
    /// In binary, least significant bytes first.
    #[default]
    Binary,
}

/// The name of the physical group of all cells.
const FLUID: &str = "fluid";

/// Writes a mesh as MSH 4.1, quadratic, with a physical group for each boundary that has facets and
/// one named `fluid` for the cells.
///
/// Pairs of periodic nodes are not written.
///
/// # Errors
/// What `out` reports.
pub fn write_msh<const D: usize>(
    out: impl Write,
    mesh: &Mesh<D>,
    encoding: Encoding,
) -> io::Result<()> {
    let mut out = Output { out, encoding };
    let is_binary = encoding == Encoding::Binary;
    out.text(&format!("$MeshFormat\n4.1 {} 8\n", i32::from(is_binary)))?;
    if is_binary {
        out.out.write_all(&1_i32.to_le_bytes())?;
        out.text("\n")?;
    }
    out.text("$EndMeshFormat\n")?;
    let entities = Entities::of(mesh);
    write_names(&mut out, mesh, &entities)?;
    write_entities(&mut out, mesh, &entities)?;
    write_nodes(&mut out, mesh, &entities)?;
    write_elements(&mut out, mesh, &entities)?;
    out.out.flush()
}

/// The entities of a mesh: its boundaries with their facets, then all cells.
struct Entities<'a> {
    /// Facets of each boundary.
    facets: Vec<Vec<&'a Facet>>,
    /// Nodes on each boundary and on none before, then those inside.
    nodes: Vec<Vec<NodeId>>,
}

impl<'a> Entities<'a> {
    fn of<const D: usize>(mesh: &'a Mesh<D>) -> Self {
        let n = mesh.boundaries.len();
        let mut facets = vec![Vec::new(); n];
        let mut owner = vec![n; mesh.n_nodes()];
        for facet in &mesh.facets {
            facets[facet.boundary].push(facet);
            for node in mesh.facet_nodes(facet) {
                owner[node] = owner[node].min(facet.boundary.index());
            }
        }
        let mut nodes = vec![Vec::new(); n + 1];
        for node in mesh.node_ids() {
            nodes[owner[node]].push(node);
        }
        Self { facets, nodes }
    }

    /// Boundaries that have facets.
    fn used(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.facets.len()).filter(|boundary| !self.facets[*boundary].is_empty())
    }
}

/// Number of an entity or of a physical group: that of its boundary, from 1.
fn tag(boundary: usize) -> i32 {
    i32::try_from(boundary + 1).unwrap_or(i32::MAX)
}

/// Writes numbers in an encoding.
struct Output<W: Write> {
    out: W,
    encoding: Encoding,
}

impl<W: Write> Output<W> {
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.out.write_all(text.as_bytes())
    }

    fn integer(&mut self, value: i32) -> io::Result<()> {
        match self.encoding {
            Encoding::Text => write!(self.out, "{value} "),
            Encoding::Binary => self.out.write_all(&value.to_le_bytes()),
        }
    }

    fn number(&mut self, value: usize) -> io::Result<()> {
        match self.encoding {
            Encoding::Text => write!(self.out, "{value} "),
            Encoding::Binary => self.out.write_all(&(value as u64).to_le_bytes()),
        }
    }

    /// The three coordinates of a point.
    fn point<const D: usize>(&mut self, point: &Point<D>) -> io::Result<()> {
        for axis in 0..3 {
            let value = point.as_slice().get(axis).copied().unwrap_or_default();
            match self.encoding {
                // The shortest digits that stand for this number alone
                Encoding::Text => write!(self.out, "{value:?} ")?,
                Encoding::Binary => self.out.write_all(&value.to_le_bytes())?,
            }
        }
        Ok(())
    }

    /// The end of a line of text.
    fn end_line(&mut self) -> io::Result<()> {
        if self.encoding == Encoding::Text { self.text("\n") } else { Ok(()) }
    }

    /// The end of a section with numbers.
    fn end(&mut self, section: &str) -> io::Result<()> {
        if self.encoding == Encoding::Binary {
            self.text("\n")?;
        }
        self.text(&format!("$End{section}\n"))
    }
}

fn write_names<const D: usize>(
    out: &mut Output<impl Write>,
    mesh: &Mesh<D>,
    entities: &Entities<'_>,
) -> io::Result<()> {
    out.text(&format!("$PhysicalNames\n{}\n", entities.used().count() + 1))?;
    for boundary in entities.used() {
        let name: String = mesh.boundaries[boundary].name.replace(['"', '\n', '\r'], "_");
        out.text(&format!("{} {} \"{name}\"\n", D - 1, tag(boundary)))?;
    }
    out.text(&format!("{D} {} \"{FLUID}\"\n$EndPhysicalNames\n", tag(mesh.boundaries.len())))
}

fn write_entities<const D: usize>(
    out: &mut Output<impl Write>,
    mesh: &Mesh<D>,
    entities: &Entities<'_>,
) -> io::Result<()> {
    out.text("$Entities\n")?;
    for dimension in 0..4 {
        out.number(match dimension {
            _ if dimension + 1 == D => entities.used().count(),
            _ => usize::from(dimension == D),
        })?;
    }
    out.end_line()?;
    for boundary in entities.used() {
        out.integer(tag(boundary))?;
        let nodes = entities.facets[boundary].iter().flat_map(|facet| mesh.facet_nodes(facet));
        write_box(out, mesh, nodes)?;
        out.number(1)?;
        out.integer(tag(boundary))?;
        out.number(0)?;
        out.end_line()?;
    }
    out.integer(1)?;
    write_box(out, mesh, mesh.node_ids())?;
    out.number(1)?;
    out.integer(tag(mesh.boundaries.len()))?;
    out.number(entities.used().count())?;
    for boundary in entities.used() {
        out.integer(tag(boundary))?;
    }
    out.end_line()?;
    out.end("Entities")
}

/// The corners of a box around nodes.
fn write_box<const D: usize>(
    out: &mut Output<impl Write>,
    mesh: &Mesh<D>,
    nodes: impl Iterator<Item = NodeId>,
) -> io::Result<()> {
    let points: Vec<Point<D>> = nodes.map(|node| mesh.nodes[node]).collect();
    let bounds = Bounds::around(&points);
    out.point(&bounds.min)?;
    out.point(&bounds.max)
}

/// Dimension and tag of the entity of a block of nodes or elements.
fn write_entity<const D: usize>(
    out: &mut Output<impl Write>,
    boundary: usize,
    n_boundaries: usize,
) -> io::Result<()> {
    let is_fluid = boundary == n_boundaries;
    let dimension = if is_fluid { D } else { D - 1 };
    out.integer(i32::try_from(dimension).unwrap_or(3))?;
    out.integer(if is_fluid { 1 } else { tag(boundary) })
}

fn write_nodes<const D: usize>(
    out: &mut Output<impl Write>,
    mesh: &Mesh<D>,
    entities: &Entities<'_>,
) -> io::Result<()> {
    out.text("$Nodes\n")?;
    let blocks = || entities.nodes.iter().enumerate().filter(|(_, nodes)| !nodes.is_empty());
    for number in [blocks().count(), mesh.n_nodes(), 1, mesh.n_nodes()] {
        out.number(number)?;
    }
    out.end_line()?;
    for (boundary, nodes) in blocks() {
        write_entity::<D>(out, boundary, mesh.boundaries.len())?;
        out.integer(0)?;
        out.number(nodes.len())?;
        out.end_line()?;
        for node in nodes {
            out.number(node.index() + 1)?;
            out.end_line()?;
        }
        for node in nodes {
            out.point(&mesh.nodes[*node])?;
            out.end_line()?;
        }
    }
    out.end("Nodes")
}

fn write_elements<const D: usize>(
    out: &mut Output<impl Write>,
    mesh: &Mesh<D>,
    entities: &Entities<'_>,
) -> io::Result<()> {
    out.text("$Elements\n")?;
    let n_elements = mesh.facets.len() + mesh.n_cells();
    for number in [entities.used().count() + 1, n_elements, 1, n_elements] {
        out.number(number)?;
    }
    out.end_line()?;
    let mut element = 0;
    let mut write_element = |out: &mut Output<_>, nodes: &mut dyn Iterator<Item = NodeId>| {
        element += 1;
        out.number(element)?;
        for node in nodes {
            out.number(node.index() + 1)?;
        }
        out.end_line()
    };
    for boundary in entities.used() {
        write_entity::<D>(out, boundary, mesh.boundaries.len())?;
        out.integer(Kind::number_of_quadratic(D - 1))?;
        out.number(entities.facets[boundary].len())?;
        out.end_line()?;
        for facet in &entities.facets[boundary] {
            write_element(out, &mut mesh.facet_nodes(facet))?;
        }
    }
    write_entity::<D>(out, mesh.boundaries.len(), mesh.boundaries.len())?;
    out.integer(Kind::number_of_quadratic(D))?;
    out.number(mesh.n_cells())?;
    out.end_line()?;
    for nodes in mesh.cells() {
        debug_assert_eq!(nodes.len(), Simplex::<D>::N_NODES);
        write_element(out, &mut node_order::<D>().iter().map(|local| nodes[*local]))?;
    }
    out.end("Elements")
}
