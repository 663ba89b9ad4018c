//! Case files: every valid one is read, and every wrong one refused in a clear line.

mod errors;
mod files;
mod width;
