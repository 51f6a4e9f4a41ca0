//! `MshFile`: the sections of a file that matter, as they are written.

use std::collections::BTreeMap;

use super::error::MshError;
use super::input::Input;
use super::kind::Kind;
use crate::Point;

/// What is read of a file.
#[derive(Debug, Default)]
pub struct MshFile {
    /// Names of physical groups, by dimension and tag.
    pub names: BTreeMap<(usize, i32), String>,
    /// Physical groups of the entities of each dimension, by the tag of the entity.
    pub groups: [BTreeMap<i32, Vec<i32>>; 4],
    /// Positions of the nodes by their tags.
    pub nodes: BTreeMap<u64, Point<3>>,
    /// Elements of one kind on one entity each.
    pub blocks: Vec<Block>,
}

/// Elements of one kind on one entity.
#[derive(Debug)]
pub struct Block {
    /// What they are.
    pub kind: Kind,
    /// Tag of the entity they are on.
    pub entity: i32,
    /// Their tags.
    pub tags: Vec<u64>,
    /// Tags of their nodes, one element after the other.
    pub nodes: Vec<u64>,
}

impl Block {
    /// Tag and tags of the nodes of each element.
    pub fn elements(&self) -> impl Iterator<Item = (u64, &[u64])> {
        self.tags.iter().copied().zip(self.nodes.chunks_exact(self.kind.n_nodes))
    }
}

/// What is asked of a version.
const VERSION: &str =
    "MSH 2.2, 4.0 and 4.1 are read: Mesh.MshFileVersion = 4.1 in Gmsh, `gmsh -format msh41`";

/// What is asked of elements.
pub(super) const ELEMENTS: &str = "triangles and tetrahedra of order 1 to 3 are read, with their edges and points: \
                                   mesh without Recombine (Mesh.RecombineAll = 0), or divide quadrangles by \
                                   `alewife-post convert IN.msh OUT.msh`";

/// Versions of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    /// 2.2: elements with their groups, no entities.
    V2,
    /// 4.0.
    V40,
    /// 4.1.
    V41,
}

impl MshFile {
    /// Reads a file.
    ///
    /// # Errors
    /// When it is of another version than 2.2, 4.0 and 4.1, is damaged, or has elements that are no simplices.
    pub fn read(bytes: &[u8]) -> Result<Self, MshError> {
        let mut input = Input::new(bytes);
        let mut file = Self::default();
        let version = read_version(&mut input)?;
        let mut seen = Vec::new();
        while !input.is_at_end() {
            let start = input.at();
            let section = input.section()?;
            if ["Entities", "Nodes", "Elements"].contains(&section) && seen.contains(&section) {
                let found = format!("a second section ${section}");
                return Err(input.refuse_at(start, found, "one of each is read"));
            }
            seen.push(section);
            match section {
                "PhysicalNames" => input.as_text(|input| file.read_names(input))?,
                "Entities" => file.read_entities(&mut input, version)?,
                "Nodes" => match version {
                    Version::V2 => file.read_listed_nodes(&mut input)?,
                    Version::V40 => file.read_nodes_with_tags(&mut input)?,
                    Version::V41 => file.read_nodes(&mut input)?,
                },
                "Elements" if version == Version::V2 => file.read_listed_elements(&mut input)?,
                "Elements" => file.read_elements(&mut input, version)?,
                "PartitionedEntities" => {
                    let whole = "save the mesh in one part: Mesh.SaveAll = 0, no partitions";
                    return Err(input.refuse_at(start, "a mesh in partitions", whole));
                }
                other => {
                    input.skip(other)?;
                    continue;
                }
            }
            input.end_of(section)?;
        }
        for needed in ["Nodes", "Elements"] {
            if !seen.contains(&needed) {
                return Err(input.refuse(
                    format!("no section ${needed}"),
                    "generate the mesh in Gmsh before it is saved",
                ));
            }
        }
        Ok(file)
    }

    fn read_names(&mut self, input: &mut Input<'_>) -> Result<(), MshError> {
        let n = input.count("physical names", 6)?;
        for _ in 0..n {
            let dimension = dimension(input)?;
            let tag = input.integer()?;
            let start = input.at();
            let line = input.line()?;
            let name = line.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
            let Some(name) = name.filter(|name| !name.is_empty() && !name.contains('"')) else {
                let found = "a physical name that is not in quotes";
                return Err(input.refuse_at(start, found, "write \"inlet\", for example"));
            };
            self.names.insert((dimension, tag), name.to_owned());
        }
        Ok(())
    }

    fn read_entities(&mut self, input: &mut Input<'_>, version: Version) -> Result<(), MshError> {
        let of_point = if version == Version::V41 { 3 } else { 6 };
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = input.count("entities", 8)?;
        }
        for (dimension, n) in counts.into_iter().enumerate() {
            for _ in 0..n {
                let tag = input.integer()?;
                // A point, or the corners of a box around the entity
                for _ in 0..if dimension == 0 { of_point } else { 6 } {
                    input.float()?;
                }
                let n_groups = input.count("physical groups", 2)?;
                let mut groups = Vec::new();
                for _ in 0..n_groups {
                    groups.push(input.integer()?.saturating_abs());
                }
                self.groups[dimension].insert(tag, groups);
                if dimension > 0 {
                    for _ in 0..input.count("bounding entities", 2)? {
                        input.integer()?;
                    }
                }
            }
        }
        Ok(())
    }

    fn read_nodes(&mut self, input: &mut Input<'_>) -> Result<(), MshError> {
        let n_blocks = n_blocks(input, "nodes", 8)?;
        for _ in 0..n_blocks {
            let dimension = dimension(input)?;
            input.integer()?;
            let is_parametric = input.integer()? != 0;
            let n = input.count("nodes", 8)?;
            let mut tags = Vec::new();
            for _ in 0..n {
                tags.push(input.number()?);
            }
            for tag in tags {
                let point = Point::<3>::new(input.float()?, input.float()?, input.float()?);
                for _ in 0..if is_parametric { dimension } else { 0 } {
                    input.float()?;
                }
                self.add_node(input, tag, point)?;
            }
        }
        Ok(())
    }

    fn read_elements(&mut self, input: &mut Input<'_>, version: Version) -> Result<(), MshError> {
        let is_old = version == Version::V40;
        let n_blocks = if is_old {
            n_blocks_and_things(input, "elements", 4)?
        } else {
            n_blocks(input, "elements", 4)?
        };
        for _ in 0..n_blocks {
            let entity = if is_old {
                let entity = input.integer()?;
                dimension(input)?;
                entity
            } else {
                dimension(input)?;
                input.integer()?
            };
            let kind = kind_of(input)?;
            let n = input.count("elements", 4)?;
            let (mut tags, mut nodes) = (Vec::new(), Vec::new());
            for _ in 0..n {
                tags.push(if is_old { input.tag()? } else { input.number()? });
                for _ in 0..kind.n_nodes {
                    nodes.push(self.read_node_of_element(input, is_old)?);
                }
            }
            self.blocks.push(Block { kind, entity, tags, nodes });
        }
        Ok(())
    }

    /// A node of an element, which the file has.
    pub(super) fn read_node_of_element(
        &self,
        input: &mut Input<'_>,
        is_old: bool,
    ) -> Result<u64, MshError> {
        let start = input.at();
        let node = if is_old { input.tag()? } else { input.number()? };
        if self.nodes.contains_key(&node) {
            return Ok(node);
        }
        let found = format!("node {node}, which is not in $Nodes");
        Err(input.refuse_at(start, found, "elements have nodes of the file"))
    }

    /// Keeps a node.
    pub(super) fn add_node(
        &mut self,
        input: &Input<'_>,
        tag: u64,
        point: Point<3>,
    ) -> Result<(), MshError> {
        if self.nodes.insert(tag, point).is_some() {
            return Err(input.refuse(format!("a second node {tag}"), "tags are unique"));
        }
        Ok(())
    }
}

/// The kind of elements whose number is next.
pub(super) fn kind_of(input: &mut Input<'_>) -> Result<Kind, MshError> {
    let start = input.at();
    let number = input.integer()?;
    Kind::of(number).map_err(|name| {
        input.refuse_at(start, format!("elements of type {number}: {name}"), ELEMENTS)
    })
}

/// Reads the section that every file begins with.
fn read_version(input: &mut Input<'_>) -> Result<Version, MshError> {
    let start = input.at();
    if input.is_at_end() || input.line().ok() != Some("$MeshFormat") {
        let found = "a file that does not begin with $MeshFormat";
        return Err(input.refuse_at(start, found, VERSION));
    }
    let start = input.at();
    let line = input.line()?;
    let words: Vec<&str> = line.split_whitespace().collect();
    let &[version, kind, size] = words.as_slice() else {
        return Err(input.refuse_at(start, "no version", VERSION));
    };
    let version = match version {
        "2.2" | "2" => Version::V2,
        "4" | "4.0" => Version::V40,
        "4.1" => Version::V41,
        other => {
            let version: String = other.chars().take(20).collect();
            return Err(input.refuse_at(start, format!("version {version}"), VERSION));
        }
    };
    if size != "8" {
        let found = "numbers that have not 8 bytes";
        return Err(input.refuse_at(start, found, "files with a data size of 8 are read"));
    }
    match kind {
        "0" => {}
        "1" => input.set_binary()?,
        _ => {
            let found = "a file type that is neither text nor binary";
            return Err(input.refuse_at(start, found, "0 is text, 1 is binary"));
        }
    }
    input.end_of("MeshFormat")?;
    Ok(version)
}

/// The same of version 4.0, which has no tags there.
pub(super) fn n_blocks_and_things(
    input: &mut Input<'_>,
    what: &str,
    least_bytes: usize,
) -> Result<usize, MshError> {
    let n_blocks = input.count(&format!("blocks of {what}"), 8)?;
    input.count(what, least_bytes)?;
    Ok(n_blocks)
}

/// The number of blocks at the start of a section, whose things take some bytes in the file at least.
fn n_blocks(input: &mut Input<'_>, what: &str, least_bytes: usize) -> Result<usize, MshError> {
    let n_blocks = input.count(&format!("blocks of {what}"), 8)?;
    input.count(what, least_bytes)?;
    // Least and greatest tag
    input.number()?;
    input.number()?;
    Ok(n_blocks)
}

/// The dimension of an entity.
pub(super) fn dimension(input: &mut Input<'_>) -> Result<usize, MshError> {
    let start = input.at();
    let found = input.integer()?;
    match usize::try_from(found) {
        Ok(dimension) if dimension <= 3 => Ok(dimension),
        _ => Err(input.refuse_at(start, format!("the dimension {found}"), "0, 1, 2 or 3")),
    }
}
