//! Swimmers in viscous fluid.
