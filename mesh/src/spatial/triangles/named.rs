//! `NamedTriangles`: the triangles of a file in the groups that it names: solids of STL, groups of OBJ.

use super::TriangleMesh;

/// Triangles of a file that follow each other and have one name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TriangleGroup {
    /// Name, empty where the file has none.
    pub name: String,
    /// Number of triangles.
    pub n: usize,
}

/// Triangles in groups.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NamedTriangles {
    /// All triangles.
    pub mesh: TriangleMesh,
    /// Their groups in order.
    pub groups: Vec<TriangleGroup>,
}

impl NamedTriangles {
    /// Begins a group, which the triangles that are added from now on belong to.
    pub(super) fn begin(&mut self, name: &str) {
        self.close();
        self.groups.push(TriangleGroup { name: name.trim().to_owned(), n: 0 });
    }

    /// Counts the triangles that were added since the last group began.
    pub(super) fn close(&mut self) {
        let known: usize = self.groups.iter().map(|group| group.n).sum();
        let added = self.mesh.triangles.len() - known;
        if added == 0 {
            return;
        }
        match self.groups.last_mut() {
            Some(last) => last.n += added,
            None => self.groups.push(TriangleGroup { name: String::new(), n: added }),
        }
    }
}

impl From<TriangleMesh> for NamedTriangles {
    fn from(mesh: TriangleMesh) -> Self {
        let groups = vec![TriangleGroup { name: String::new(), n: mesh.triangles.len() }];
        Self { mesh, groups }
    }
}
