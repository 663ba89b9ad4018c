//! Speed, memory and error of one sum, as one line of JSON:
//! `cargo run --release -p stokes-fmm --example throughput -- --help`.

mod common;

use clap::Parser;

/// Times a sum of singularities of Stokes flow and measures its error.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    case: common::Case,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { case } = Arguments::parse();
    if case.n >= 1_000_000 {
        eprintln!("{} points: this may take minutes", case.n);
    }
    println!("{}", serde_json::to_string(&case.measure()?)?);
    Ok(())
}
