//! The `sunfleck` command.

fn main() {}
