//! The `axistokes` command line.

fn main() {}
