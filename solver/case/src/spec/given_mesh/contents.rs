//! `Contents`: a mesh that is given, and what is known of it as a whole.

use alewife_mesh::spatial::Imported;
use alewife_mesh::{Bounds, DomainMesh, Mesh, MshError, MshOptions, SideShape};

use crate::spec::extent::Extent;

/// What a file of a mesh holds, or what was made inside a surface.
#[derive(Debug)]
pub(crate) struct Contents {
    /// Content of the file; `None` of a mesh that was made.
    pub bytes: Option<Vec<u8>>,
    pub mesh: GivenMesh,
    pub sides: Vec<NamedSide>,
    pub extent: Extent,
    pub n_cells: usize,
    pub measure: f64,
    pub notes: Vec<String>,
    /// Along which coordinates sides are periodic.
    pub periodic: [bool; 3],
}

/// A mesh of the dimension of the case.
#[derive(Debug)]
pub(crate) enum GivenMesh {
    Planar(Mesh<2>),
    Spatial(Imported),
}

/// A side and what it looks like.
#[derive(Debug)]
pub(crate) struct NamedSide {
    pub name: String,
    pub shape: SideShape,
}

impl Contents {
    /// Reads the content of a file as a mesh of this many dimensions.
    pub(crate) fn read(
        bytes: Vec<u8>,
        options: &MshOptions,
        dimensions: usize,
    ) -> Result<Self, MshError> {
        if dimensions == 2 {
            let read = DomainMesh::<2>::read(&bytes, options)?;
            Ok(Self::of(Some(bytes), &read, GivenMesh::Planar(read.mesh.clone())))
        } else {
            let read = DomainMesh::<3>::read(&bytes, options)?;
            let imported = Imported::new(read.mesh.clone());
            Ok(Self::of(Some(bytes), &read, GivenMesh::Spatial(imported)))
        }
    }

    /// A mesh that was made inside a surface.
    pub(crate) fn of_region(mesh: Mesh<3>) -> Self {
        let imported = Imported::new(mesh.clone());
        Self::of(None, &DomainMesh::of(mesh), GivenMesh::Spatial(imported))
    }

    fn of<const D: usize>(bytes: Option<Vec<u8>>, from: &DomainMesh<D>, mesh: GivenMesh) -> Self {
        let sides = from.mesh.boundaries.iter().zip(&from.sides);
        let sides =
            sides.map(|(boundary, shape)| NamedSide { name: boundary.name.clone(), shape: *shape });
        let bounds = Bounds::around(&from.mesh.nodes);
        Self {
            bytes,
            sides: sides.collect(),
            extent: Extent::between(bounds.min.as_slice(), bounds.max.as_slice()),
            n_cells: from.mesh.n_cells(),
            measure: from.measure,
            notes: from.notes.clone(),
            periodic: [false; 3],
            mesh,
        }
    }
}
