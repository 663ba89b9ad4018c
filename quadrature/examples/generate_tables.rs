//! Writes the data files of the crate anew:
//!
//! ```text
//! cargo run --release -p panel-quadrature --example generate_tables
//! ```
//!
//! It takes two to four minutes. If names of files are given as arguments, only those are written.

use std::path::Path;

use panel_quadrature::kolm_rokhlin::{self, Family};
use panel_quadrature::{QuadratureError, log_endpoint};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let write = |name: &str, make: &dyn Fn() -> Result<String, QuadratureError>| {
        if wanted.is_empty() || wanted.iter().any(|w| w == name) {
            std::fs::write(data.join(name), make()?)?;
            println!("wrote {name}");
        }
        Ok::<(), Box<dyn std::error::Error>>(())
    };
    write("log_endpoint.txt", &log_endpoint::generate_table)?;
    for &order in kolm_rokhlin::ORDERS {
        write(&format!("neighbour_{order}.txt"), &|| {
            kolm_rokhlin::generate_table(Family::Neighbour, order)
        })?;
        write(&format!("own_{order}.txt"), &|| {
            kolm_rokhlin::generate_table(Family::Own, order)
        })?;
    }
    Ok(())
}
