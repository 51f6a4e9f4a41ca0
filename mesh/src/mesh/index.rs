//! Typed indices: a node, a cell, a facet and a boundary cannot be taken for one another.
//!
//! `values[node]` works for any `Vec` or slice with one value a node, and likewise for the others.

use std::fmt;
use std::ops::{Index, IndexMut};

macro_rules! typed_index {
    ($(#[$doc:meta])* $name:ident, $number:ty) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        pub struct $name($number);

        impl $name {
            /// The index of this number, which must fit the type (checked in debug builds).
            #[must_use]
            #[expect(clippy::cast_possible_truncation, reason = "checked in debug builds")]
            pub const fn new(index: usize) -> Self {
                debug_assert!(index <= <$number>::MAX as usize);
                Self(index as $number)
            }

            /// The number as an array index.
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl From<$number> for $name {
            fn from(number: $number) -> Self {
                Self(number)
            }
        }

        impl From<$name> for $number {
            fn from(index: $name) -> Self {
                index.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }

        impl<T> Index<$name> for [T] {
            type Output = T;

            #[inline]
            fn index(&self, index: $name) -> &T {
                &self[index.0 as usize]
            }
        }

        impl<T> IndexMut<$name> for [T] {
            #[inline]
            fn index_mut(&mut self, index: $name) -> &mut T {
                &mut self[index.0 as usize]
            }
        }

        impl<T> Index<$name> for Vec<T> {
            type Output = T;

            #[inline]
            fn index(&self, index: $name) -> &T {
                &self.as_slice()[index.0 as usize]
            }
        }

        impl<T> IndexMut<$name> for Vec<T> {
            #[inline]
            fn index_mut(&mut self, index: $name) -> &mut T {
                &mut self.as_mut_slice()[index.0 as usize]
            }
        }
    };
}

typed_index! {
    /// A node of a mesh; the first ones are the vertices.
    NodeId, u32
}

typed_index! {
    /// A cell of a mesh.
    CellId, u32
}

typed_index! {
    /// A boundary facet of a mesh: an index into [`Topology::facets`](crate::Topology::facets).
    FacetId, u32
}

typed_index! {
    /// A boundary of a mesh: an index into [`Topology::boundaries`](crate::Topology::boundaries).
    BoundaryId, u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_slices_and_arrays_are_indexed() {
        let mut values = Vec::from([1.0, 2.0, 3.0]);
        values[NodeId::new(1)] += 0.5;
        assert_eq!(values[NodeId::new(1)], 2.5);
        assert_eq!(values[1..][CellId::new(1)], 3.0);
        assert_eq!([4, 5][BoundaryId::new(1)], 5);
        assert_eq!(u32::from(FacetId::from(7)), 7);
        assert_eq!(NodeId::new(3).index(), 3);
        assert_eq!(CellId::new(12).to_string(), "12");
    }
}
