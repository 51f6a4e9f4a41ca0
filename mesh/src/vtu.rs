//! VTU writer: a mesh with named node and cell arrays, compressed, readable by ParaView and VTK.
//!
//! UnstructuredGrid of quadratic cells (type 22 or 24), arrays appended raw after the XML header,
//! each cut in blocks of 32 KiB that are compressed by zlib and preceded by UInt64 counts:
//! blocks, block size, size of a last partial block, compressed sizes.

use std::io::{self, Write};

use flate2::{Compression, write::ZlibEncoder};
use rayon::prelude::*;

use crate::{Mesh, Simplex};

/// Bytes of a block before compression.
const BLOCK: usize = 32 * 1024;

/// The beginning of a file.
const HEADER: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
                      byte_order=\"LittleEndian\" header_type=\"UInt64\" \
                      compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";

/// A point as a cell.
const VERTEX: u8 = 1;

/// A named array of values at the nodes or in the cells.
#[derive(Debug, Clone, Copy)]
pub struct Array<'a> {
    /// Its name.
    pub name: &'a str,
    /// Components per node or cell.
    pub components: usize,
    /// Values, one node or cell after the other.
    pub values: &'a [f64],
}

impl<'a> Array<'a> {
    /// An array of values with this many components for each node or cell.
    #[must_use]
    pub fn new(name: &'a str, components: usize, values: &'a [f64]) -> Self {
        Self { name, components, values }
    }
}

/// How floating-point arrays are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Four bytes: half the size, seven digits. Positions keep eight bytes.
    F32,
    /// Eight bytes: exact.
    #[default]
    F64,
}

/// Writes a mesh and arrays with eight bytes per number; see [`write_vtu_as`].
///
/// # Errors
/// What `out` reports, and `InvalidInput` when an array has the wrong length.
pub fn write_vtu<const D: usize>(
    out: impl Write,
    mesh: &Mesh<D>,
    time: Option<f64>,
    point_arrays: &[Array<'_>],
    cell_arrays: &[Array<'_>],
) -> io::Result<()> {
    write_vtu_as(Precision::F64, out, mesh, time, point_arrays, cell_arrays)
}

/// Writes a mesh, its time (s) and arrays with one value per P2 node or per cell.
///
/// Positions and arrays of two components in 2D are written as they are, positions padded with
/// zeros to three.
///
/// # Errors
/// What `out` reports, and `InvalidInput` when an array has the wrong length.
pub fn write_vtu_as<const D: usize>(
    precision: Precision,
    mut out: impl Write,
    mesh: &Mesh<D>,
    time: Option<f64>,
    point_arrays: &[Array<'_>],
    cell_arrays: &[Array<'_>],
) -> io::Result<()> {
    let mut file = Appended::default();
    let mut xml = String::from(HEADER);
    if let Some(time) = time {
        xml += "<FieldData>\n";
        let attributes = "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"";
        file.declare(&mut xml, attributes, &time.to_le_bytes())?;
        xml += "</FieldData>\n";
    }
    xml += &format!(
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
        mesh.n_nodes(),
        mesh.n_cells()
    );
    for array in point_arrays {
        file.declare_floats(&mut xml, precision, array, mesh.n_nodes())?;
    }
    xml += "</PointData>\n<CellData>\n";
    for array in cell_arrays {
        file.declare_floats(&mut xml, precision, array, mesh.n_cells())?;
    }
    xml += "</CellData>\n<Points>\n";
    let positions: Vec<f64> = mesh
        .nodes
        .iter()
        .flat_map(|p| (0..3).map(move |i| if i < D { p[i] } else { 0.0 }))
        .collect();
    let positions = Array::new("Points", 3, &positions);
    file.declare_floats(&mut xml, Precision::F64, &positions, mesh.n_nodes())?;
    xml += "</Points>\n<Cells>\n";
    let per_cell = Simplex::<D>::N_NODES as u64;
    let integers = |name: &str| format!("type=\"Int64\" Name=\"{name}\"");
    let bytes: Vec<u8> = mesh.cells.iter().flat_map(|n| (n.index() as u64).to_le_bytes()).collect();
    file.declare(&mut xml, &integers("connectivity"), &bytes)?;
    let offsets = (1..=mesh.n_cells() as u64).flat_map(|i| (i * per_cell).to_le_bytes());
    file.declare(&mut xml, &integers("offsets"), &offsets.collect::<Vec<u8>>())?;
    let kind: u8 = if D == 2 { 22 } else { 24 };
    file.declare(&mut xml, "type=\"UInt8\" Name=\"types\"", &vec![kind; mesh.n_cells()])?;
    file.end(out.by_ref(), xml)
}

/// Writes points (m, three numbers each) as cells of their own, their time (s) and arrays with one value per point.
///
/// # Errors
/// What `out` reports, and `InvalidInput` when an array has the wrong length.
pub fn write_points_vtu(
    precision: Precision,
    mut out: impl Write,
    points: &[f64],
    time: f64,
    arrays: &[Array<'_>],
) -> io::Result<()> {
    let n = points.len() / 3;
    let mut file = Appended::default();
    let mut xml = String::from(HEADER);
    xml += "<FieldData>\n";
    let attributes = "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"";
    file.declare(&mut xml, attributes, &time.to_le_bytes())?;
    xml += "</FieldData>\n";
    xml += &format!("<Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">\n<PointData>\n");
    for array in arrays {
        file.declare_floats(&mut xml, precision, array, n)?;
    }
    xml += "</PointData>\n<Points>\n";
    file.declare_floats(&mut xml, Precision::F64, &Array::new("Points", 3, points), n)?;
    xml += "</Points>\n<Cells>\n";
    let integers = |name: &str| format!("type=\"Int64\" Name=\"{name}\"");
    let count = |from: u64| (from..from + n as u64).flat_map(u64::to_le_bytes).collect::<Vec<u8>>();
    file.declare(&mut xml, &integers("connectivity"), &count(0))?;
    file.declare(&mut xml, &integers("offsets"), &count(1))?;
    file.declare(&mut xml, "type=\"UInt8\" Name=\"types\"", &vec![VERTEX; n])?;
    file.end(out.by_ref(), xml)
}

/// The compressed arrays behind the header.
#[derive(Default)]
struct Appended {
    data: Vec<u8>,
}

impl Appended {
    /// Ends the header, and writes it with all arrays.
    fn end(&self, mut out: impl Write, mut xml: String) -> io::Result<()> {
        xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
        out.write_all(xml.as_bytes())?;
        out.write_all(&self.data)?;
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
        out.flush()
    }

    /// Declares an array in the header and appends its bytes.
    fn declare(&mut self, xml: &mut String, attributes: &str, bytes: &[u8]) -> io::Result<()> {
        let offset = self.data.len();
        *xml += &format!("<DataArray {attributes} format=\"appended\" offset=\"{offset}\"/>\n");
        let packed: Vec<Vec<u8>> = bytes.par_chunks(BLOCK).map(pack).collect::<Result<_, _>>()?;
        let counts = [packed.len(), BLOCK, bytes.len() % BLOCK];
        for count in counts.into_iter().chain(packed.iter().map(Vec::len)) {
            self.data.extend_from_slice(&(count as u64).to_le_bytes());
        }
        packed.iter().for_each(|block| self.data.extend_from_slice(block));
        Ok(())
    }

    fn declare_floats(
        &mut self,
        xml: &mut String,
        precision: Precision,
        array: &Array<'_>,
        n: usize,
    ) -> io::Result<()> {
        let Array { name, components, values } = *array;
        if values.len() != components * n {
            let message = format!(
                "array \"{name}\" has {} values, {components} components for {n} places need {}",
                values.len(),
                components * n
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let (kind, bytes): (_, Vec<u8>) = match precision {
            #[expect(clippy::cast_possible_truncation, reason = "single precision was asked for")]
            Precision::F32 => {
                ("Float32", values.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect())
            }
            Precision::F64 => ("Float64", values.iter().flat_map(|v| v.to_le_bytes()).collect()),
        };
        let attributes = format!(
            "type=\"{kind}\" Name=\"{}\" NumberOfComponents=\"{components}\"",
            escape(name)
        );
        self.declare(xml, &attributes, &bytes)
    }
}

/// A block of an array, compressed.
fn pack(block: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()
}

/// A name as an XML attribute.
fn escape(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Facet, NodeId, Point, Topology};

    fn triangle() -> Mesh<2> {
        let nodes = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        let topology = Topology {
            n_vertices: 3,
            cells: (0..6).map(NodeId::new).collect(),
            curved: vec![false],
            facets: Vec::<Facet>::new(),
            boundaries: Vec::new(),
            periodic: Vec::new(),
        };
        Mesh::new(nodes.into_iter().map(Point::<2>::from).collect(), topology)
    }

    #[test]
    fn the_header_lists_the_arrays_and_the_blocks_decompress_to_them() {
        let mut out = Vec::new();
        let pressure = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        write_vtu(&mut out, &triangle(), Some(0.25), &[Array::new("p & q", 1, &pressure)], &[])
            .unwrap();
        let start = out.windows(2).position(|w| w == b"\n_").unwrap() + 2;
        let header = String::from_utf8(out[..start].to_vec()).unwrap();
        assert!(header.contains("Name=\"p &amp; q\" NumberOfComponents=\"1\""));
        assert!(header.contains("NumberOfPoints=\"6\" NumberOfCells=\"1\""));
        // The time comes first: one block whose last, partial size is eight bytes
        let count = |i: usize| {
            let bytes = out[start + 8 * i..start + 8 * i + 8].try_into().unwrap();
            usize::try_from(u64::from_le_bytes(bytes)).unwrap()
        };
        assert_eq!([count(0), count(1), count(2)], [1, BLOCK, 8]);
        let mut time = Vec::new();
        let packed = &out[start + 32..start + 32 + count(3)];
        io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(packed), &mut time).unwrap();
        assert_eq!(time, 0.25_f64.to_le_bytes());
    }

    #[test]
    fn single_precision_is_for_arrays_only() {
        let mut out = Vec::new();
        let speed = [0.5; 12];
        let arrays = [Array::new("speed", 2, &speed)];
        write_vtu_as(Precision::F32, &mut out, &triangle(), None, &arrays, &[]).unwrap();
        let header = String::from_utf8_lossy(&out).into_owned();
        assert!(header.contains("type=\"Float32\" Name=\"speed\" NumberOfComponents=\"2\""));
        assert!(header.contains("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\""));
        assert!(!header.contains("TimeValue"));
    }

    #[test]
    fn an_array_of_the_wrong_length_is_refused() {
        let error = write_vtu(Vec::new(), &triangle(), None, &[Array::new("u", 2, &[0.0])], &[]);
        assert_eq!(error.unwrap_err().kind(), io::ErrorKind::InvalidInput);
    }
}
