//! The built-in passes, one file each.
