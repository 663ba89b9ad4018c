//! Makes the data files of the crate anew: `cargo run --release -p panel-quadrature --example generate_tables`.

use std::path::Path;

use panel_quadrature::log_endpoint;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    std::fs::write(
        data.join("log_endpoint.txt"),
        log_endpoint::generate_table()?,
    )?;
    println!("wrote {}", data.join("log_endpoint.txt").display());
    Ok(())
}
