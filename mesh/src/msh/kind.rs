//! `Kind`: the kinds of elements a file may have, by Gmsh's numbers.

/// What an element is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// Its dimension, 0 to 3.
    pub dimension: usize,
    /// Order of its map, 1 to 3.
    pub order: usize,
    /// Number of nodes.
    pub n_nodes: usize,
}

impl Kind {
    /// The kind of a number, or what else such elements are.
    ///
    /// # Errors
    /// The name of elements that have no place in a mesh of triangles or tetrahedra.
    pub fn of(number: i32) -> Result<Self, String> {
        let kind = |dimension, order, n_nodes| Ok(Self { dimension, order, n_nodes });
        match number {
            15 => kind(0, 1, 1),
            1 => kind(1, 1, 2),
            8 => kind(1, 2, 3),
            2 => kind(2, 1, 3),
            9 => kind(2, 2, 6),
            4 => kind(3, 1, 4),
            11 => kind(3, 2, 10),
            26 => kind(1, 3, 4),
            21 => kind(2, 3, 10),
            29 => kind(3, 3, 20),
            3 | 10 | 16 => Err("quadrangles".to_owned()),
            5 | 12 | 17 => Err("hexahedra".to_owned()),
            6 | 13 | 18 => Err("prisms".to_owned()),
            7 | 14 | 19 => Err("pyramids".to_owned()),
            20 | 22..=25 => Err("triangles of an order above 3".to_owned()),
            27 | 28 => Err("edges of an order above 3".to_owned()),
            30 | 31 => Err("tetrahedra of an order above 3".to_owned()),
            _ => Err("an unknown kind".to_owned()),
        }
    }

    /// Gmsh's number of simplices of order 2.
    #[must_use]
    pub fn number_of_quadratic(dimension: usize) -> i32 {
        match dimension {
            1 => 8,
            2 => 9,
            _ => 11,
        }
    }
}

/// Local nodes of Gmsh's quadratic simplex of dimension D in the order of [`Simplex`](crate::Simplex):
/// of a tetrahedron the last two are the other way round.
#[must_use]
pub fn node_order<const D: usize>() -> &'static [usize] {
    if D == 3 { &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8] } else { &[0, 1, 2, 3, 4, 5] }
}
