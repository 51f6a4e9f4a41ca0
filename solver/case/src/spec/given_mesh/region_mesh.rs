//! `RegionMesh`: the mesh inside a surface, which is made once it is asked for.

use std::sync::OnceLock;

use alewife_mesh::spatial::{Purpose, Region, estimate_cells_inside, generate_inside};
use alewife_mesh::{MeshError, Sizing};

use super::contents::Contents;

/// Most cells of the inside.
const MOST_CELLS: f64 = 5e6;

/// Length of a region over the size of its cells from which on its unit of length is asked for: it would have more
/// cells than any other one.
const MUCH_LARGER: f64 = 1000.0;

/// What else may be wrong with a region that is far larger than the size of its cells (m), called `name`: lengths of its
/// file were multiplied by `scale`.
#[must_use]
pub fn unit_hint(region: &Region, name: &str, size: f64, scale: f64) -> String {
    let length = region.triangles().extent();
    if length < MUCH_LARGER * size {
        return String::new();
    }
    format!(
        "; the surface is about {length:.3e} long and {name} {size:.3e}: where lengths of its file are in another unit \
         than the case, such as mm, write scale = {:?}",
        scale * 1e-3
    )
}

/// Why there is no mesh inside a surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegionFault {
    /// The key of the case that is to be changed.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What may be done about it.
    pub help: String,
    /// Whether meshing was asked to end, which says nothing of the region.
    was_ended: bool,
}

impl RegionFault {
    pub(crate) fn new(key: &str, message: String, help: String) -> Self {
        Self { key: key.to_owned(), message, help, was_ended: false }
    }
}

/// The inside of a surface and the sizes of its cells, which is meshed once its mesh is asked for: a case that is
/// listed or written needs none.
#[derive(Debug)]
pub(crate) struct RegionMesh {
    region: Region,
    sizing: Sizing<3>,
    /// Factor by which lengths of the file were multiplied.
    scale: f64,
    made: OnceLock<Result<Contents, RegionFault>>,
}

impl RegionMesh {
    /// A region whose lengths were those of a file times a factor, with the sizes of its cells (m).
    pub(crate) fn new(region: Region, sizing: Sizing<3>, scale: f64) -> Self {
        Self { region, sizing, scale, made: OnceLock::new() }
    }

    /// Names of its sides.
    pub(crate) fn sides(&self) -> &[String] {
        self.region.sides()
    }

    /// What is made of it, the same at each time.
    pub(crate) fn contents(&self) -> Result<&Contents, RegionFault> {
        let kept = match self.made.get() {
            Some(kept) => kept,
            None => {
                // Outside the lock: threads that mesh may be lent to another task that asks for the same
                let made = self.make();
                if let Err(fault) = &made
                    && fault.was_ended
                {
                    return Err(fault.clone());
                }
                self.made.get_or_init(|| made)
            }
        };
        kept.as_ref().map_err(Clone::clone)
    }

    fn make(&self) -> Result<Contents, RegionFault> {
        let failed = |error: MeshError| {
            let key = match error {
                MeshError::UnknownSide { .. } => "mesh.sides",
                _ => "domain.surface",
            };
            let help = "take a smaller mesh.size, or a smaller edge length in mesh.sides where it is, or round edges \
                        that are too sharp";
            let message = format!("the inside of the surface cannot be meshed: {error}");
            let was_ended = error == MeshError::Stopped;
            RegionFault { was_ended, ..RegionFault::new(key, message, help.to_owned()) }
        };
        let (region, sizing) = (&self.region, &self.sizing);
        let n_cells = estimate_cells_inside(region, sizing, MOST_CELLS).map_err(failed)?;
        if n_cells > MOST_CELLS {
            return Err(self.too_many_cells());
        }
        Ok(Contents::of_region(generate_inside(region, sizing, Purpose::Flow).map_err(failed)?))
    }

    fn too_many_cells(&self) -> RegionFault {
        let unit = unit_hint(&self.region, "mesh.size", self.sizing.size, self.scale);
        let message = format!(
            "the inside of the surface would have more than {MOST_CELLS:e} cells, by sizes and by how its wall bends \
             and narrows"
        );
        let help = "write a larger size, fewer gap_layers, or a larger mesh.scale".to_owned();
        RegionFault::new("mesh.size", message, help + &unit)
    }
}
