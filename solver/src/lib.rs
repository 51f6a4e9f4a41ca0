//! Swimmers in a viscous fluid: bodies move, the mesh follows, one system gives fluid and bodies
//! together, observers look on.

pub mod algebra;
pub mod body;
pub mod case;
pub mod cli;
pub mod contact;
pub mod coupling;
pub mod flow;
pub mod gait;
pub mod motion;
pub mod multifrontal;
pub mod observer;
pub mod simulation;
pub mod space;
pub mod time;
pub mod timing;
pub mod validation;
