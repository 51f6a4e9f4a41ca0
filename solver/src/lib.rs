//! Swimmers in a viscous fluid: bodies move, the mesh follows, one system gives fluid and bodies
//! together, observers look on.

pub mod body;
pub mod case;
pub mod observer;
pub mod simulation;
