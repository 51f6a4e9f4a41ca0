//! Sees everything, changes nothing: files, progress, log.
