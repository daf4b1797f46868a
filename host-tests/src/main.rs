//! The host tool of palpate.

fn main() {}
