//! `NamedFacets`: the facets of a file by their vertices, with the physical names of their entities.

use std::collections::BTreeMap;

use super::error::MshError;
use super::file::MshFile;
use crate::{Boundary, BoundaryId, BoundaryKind};

/// What is asked of the boundary.
pub const NAMES: &str = "give each curve (in the plane) or surface (in space) of the boundary one \
                         physical name in Gmsh: Physical Curve(\"inlet\") or Physical Surface(\"inlet\")";

/// Facets with names, by the tags of their vertices in ascending order.
#[derive(Debug)]
pub struct NamedFacets<const D: usize> {
    /// The boundary of each.
    pub of: BTreeMap<[u64; D], BoundaryId>,
    /// All names, by their tags.
    pub boundaries: Vec<Boundary>,
}

impl<const D: usize> NamedFacets<D> {
    /// Those of a file.
    ///
    /// # Errors
    /// When one has two names, or a number instead of a name.
    pub fn of(file: &MshFile) -> Result<Self, MshError> {
        let mut facets = Self { of: BTreeMap::new(), boundaries: Vec::new() };
        let mut numbers = BTreeMap::new();
        for (&(dimension, tag), name) in &file.names {
            if dimension == D - 1 {
                numbers.insert(tag, facets.boundary(name)?);
            }
        }
        for block in file.blocks.iter().filter(|block| block.kind.dimension == D - 1) {
            let groups = file.groups[D - 1].get(&block.entity).map_or(&[][..], Vec::as_slice);
            let entity = format!("{} {}", entity_name::<D>(), block.entity);
            let boundary = match groups {
                [] => continue,
                [one] => *numbers.get(one).ok_or_else(|| {
                    let found = format!("{entity} is in the physical group {one}, without a name");
                    MshError::of_mesh(found, NAMES)
                })?,
                several => {
                    let found = format!("{entity} is in {} physical groups", several.len());
                    return Err(MshError::of_mesh(found, NAMES));
                }
            };
            for (_, nodes) in block.elements() {
                let mut vertices: [u64; D] = std::array::from_fn(|local| nodes[local]);
                vertices.sort_unstable();
                let before = facets.of.insert(vertices, boundary);
                if let Some(before) = before.filter(|before| *before != boundary) {
                    let [one, other] = [before, boundary].map(|b| &facets.boundaries[b].name);
                    let found = format!("the same facet is in \"{one}\" and in \"{other}\"");
                    return Err(MshError::of_mesh(found, NAMES));
                }
            }
        }
        Ok(facets)
    }

    /// The boundary of a name, which several groups may have.
    fn boundary(&mut self, name: &str) -> Result<BoundaryId, MshError> {
        let known = self.boundaries.iter().position(|boundary| boundary.name == name);
        let index = known.unwrap_or_else(|| {
            self.boundaries.push(Boundary { name: name.to_owned(), kind: BoundaryKind::Side });
            self.boundaries.len() - 1
        });
        u16::try_from(index).map(BoundaryId::from).map_err(|_| {
            MshError::of_mesh(format!("{index} physical names"), "at most 65536 are read")
        })
    }

    /// Leaves out the names that no facet has.
    pub fn forget_unused(&mut self) {
        let mut is_used = vec![false; self.boundaries.len()];
        for boundary in self.of.values() {
            is_used[*boundary] = true;
        }
        let mut n_before = 0;
        let numbers: Vec<BoundaryId> = is_used
            .iter()
            .map(|is_used| {
                let number = BoundaryId::new(n_before);
                n_before += usize::from(*is_used);
                number
            })
            .collect();
        for boundary in self.of.values_mut() {
            *boundary = numbers[*boundary];
        }
        let mut is_used = is_used.into_iter();
        self.boundaries.retain(|_| is_used.next().unwrap_or(false));
    }
}

/// What Gmsh calls the entities that facets are on.
pub fn entity_name<const D: usize>() -> &'static str {
    if D == 2 { "curve" } else { "surface" }
}
