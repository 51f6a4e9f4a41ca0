//! Exact solutions and refinement studies shared by the tests of the whole project.
