//! `axistokes converge`.

use super::args::Converge;
use super::failure::Failure;
use super::folder::Folder;
use super::progress_bar::StderrBar;
use super::streams;
use axistokes::output::{plot, study};
use axistokes::study::errors::ErrorTable;
use axistokes::study::plan::Plan;
use axistokes::study::setup::{GRID, STOKESLETS, STOKESLETS_ON, Setup, TARGETS_ON};
use axistokes::study::timing::TimingTable;
use axistokes::study::{EQUATORIAL, POLAR};

/// Repeats the convergence study: tables on stdout, then plots and CSV in the folder.
pub fn run(arguments: &Converge) -> Result<(), Failure> {
    let folder = Folder::open(&arguments.output)
        .map_err(|why| Failure::Input(format!("--output {}: {why}", arguments.output.display())))?;
    let orders = arguments.order.map_or(vec![16, 10], |order| vec![order]);
    let plan = if arguments.tiny {
        Plan::tiny(orders)
    } else if arguments.quick {
        Plan::quick(orders)
    } else {
        Plan::full(orders)
    };
    let setup = Setup::random(arguments.seed);
    streams::print(&introduction(arguments.seed, &setup))?;

    let bar = StderrBar::new();
    let mut errors = Vec::new();
    for &order in &plan.orders {
        let table = ErrorTable::measure(&setup, order, &plan.panels, &plan.modes, &bar)?;
        streams::print(&format!("\n{}", study::errors_table(&table)))?;
        errors.push(table);
    }
    let mut times = Vec::new();
    for &order in &plan.orders {
        let table = TimingTable::measure(&setup, order, &plan.timing_panels, &bar)?;
        streams::print(&format!("\n{}", study::timing_table(&table)))?;
        times.push(table);
    }
    drop(bar);

    let files = [
        ("convergence.csv", study::errors_csv(&errors)),
        ("timing.csv", study::timing_csv(&times)),
        ("convergence.svg", plot::convergence(&errors)?),
        ("timing.svg", plot::timing(&times)?),
    ];
    let files = files.map(|(name, text)| (name.to_owned(), text.into_bytes()));
    folder.write(&files)?;
    let names = files.map(|(name, _)| name).join(", ");
    streams::print(&format!(
        "\nwritten to {}: {names}\n",
        folder.path().display()
    ))
}

/// What is studied.
fn introduction(seed: u64, setup: &Setup) -> String {
    let [stokeslets, targets] = [STOKESLETS_ON, TARGETS_ON].map(|[a, b]| format!("{a} x {b}"));
    let threads = match rayon::current_num_threads() {
        1 => "1 thread".to_owned(),
        n => format!("{n} threads"),
    };
    format!(
        "spheroid {EQUATORIAL} x {POLAR}, combined field, randomly rotated; seed {seed}, {threads}\n\
         {STOKESLETS} random Stokeslets on the spheroid {stokeslets}; \
         {} x {} targets on the spheroid {targets}, largest speed there {:.3}\n",
        GRID[0],
        GRID[1],
        setup.largest_speed()
    )
}
