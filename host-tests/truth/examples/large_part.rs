//! A body of many patches as a model file, to see what becomes of a large part ([`palpate_truth::dunes`]):
//!
//! ```sh
//! cargo run --release -p palpate-truth --example large_part > large.toml && cargo palpate parts large.toml
//! ```
//!
//! 15 patches along each side are 510; a number on the command line is in their place.

fn main() {
    let across = std::env::args().nth(1).map_or(15, |number| number.parse().expect("a number of patches"));
    print!("{}", palpate_truth::dunes::dunes(across));
}
