//! `NamedFacets`: the facets of a file by their vertices, with the physical names of their entities.

use std::collections::{BTreeMap, BTreeSet};

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
    /// Facets that are in several groups, and what to say of those on the boundary.
    pub several: Vec<([u64; D], MshError)>,
}

impl<const D: usize> NamedFacets<D> {
    /// Those of a file; of the groups that `sides` names, if it names any. A group without a name is known by its tag.
    ///
    /// # Errors
    /// When one is in two groups, or `sides` names one that is not there.
    pub fn of(file: &MshFile, sides: &[String]) -> Result<Self, MshError> {
        let mut facets = Self { of: BTreeMap::new(), boundaries: Vec::new(), several: Vec::new() };
        let mut numbers = BTreeMap::new();
        let named = file.names.keys().filter(|(dimension, _)| *dimension == D - 1);
        let tags = named.map(|(_, tag)| *tag).chain(file.groups[D - 1].values().flatten().copied());
        let mut known = BTreeSet::new();
        for tag in tags.collect::<BTreeSet<i32>>() {
            let name = file.names.get(&(D - 1, tag)).cloned().unwrap_or_else(|| tag.to_string());
            if sides.is_empty() || sides.contains(&name) {
                numbers.insert(tag, facets.boundary(&name)?);
            }
            known.insert(name);
        }
        if let Some(unknown) = sides.iter().find(|side| !known.contains(*side)) {
            let all: Vec<String> = known.into_iter().collect();
            let found = format!("no physical group \"{unknown}\", which domain.mesh.sides names");
            return Err(MshError::of_mesh(found, &format!("groups: {}", all.join(", "))));
        }
        for block in file.blocks.iter().filter(|block| block.kind.dimension == D - 1) {
            let groups = file.groups[D - 1].get(&block.entity).map_or(&[][..], Vec::as_slice);
            let mut own: Vec<BoundaryId> =
                groups.iter().filter_map(|tag| numbers.get(tag).copied()).collect();
            own.sort_unstable();
            own.dedup();
            let Some(&boundary) = own.first() else { continue };
            let error = (own.len() > 1).then(|| {
                let entity = format!("{} {}", entity_name::<D>(), block.entity);
                facets.in_several(&format!("{entity} is in {} physical groups", own.len()), &own)
            });
            for (_, nodes) in block.elements() {
                let mut vertices: [u64; D] = std::array::from_fn(|local| nodes[local]);
                vertices.sort_unstable();
                let before = facets.of.insert(vertices, boundary);
                if let Some(before) = before.filter(|before| *before != boundary) {
                    let found = "a facet is in 2 physical groups";
                    let error = facets.in_several(found, &[before, boundary]);
                    facets.several.push((vertices, error));
                }
                facets.several.extend(error.clone().map(|error| (vertices, error)));
            }
        }
        Ok(facets)
    }

    /// That something is in several groups, and how to choose one.
    fn in_several(&self, found: &str, groups: &[BoundaryId]) -> MshError {
        let names = |ids: &[BoundaryId]| {
            let quoted = ids.iter().map(|id| format!("\"{}\"", self.boundaries[*id].name));
            quoted.collect::<Vec<_>>().join(", ")
        };
        let accepted = format!(
            "name the groups that are sides, one for each part of the boundary: domain.mesh.sides = [...], of {}",
            names(&(0..self.boundaries.len()).map(BoundaryId::new).collect::<Vec<_>>())
        );
        MshError::of_mesh(format!("{found}: {}", names(groups)), &accepted)
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
