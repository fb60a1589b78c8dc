//! The `stratavox` program.

fn main() {}
