//! Code that is compiled for each kernel, and the choice of the kernel at run time.

use crate::far::Far;
use crate::flow::{Output, Singularities};
use crate::kernel::Stokes;

/// Work that is compiled for each kernel.
pub(crate) trait WithKernel {
    /// What it returns.
    type Output;

    /// The work.
    fn run<K: Far>(self) -> Self::Output;
}

/// Does `work` with the kernel of Stokes flow that is asked for.
pub(crate) fn with_stokes<W: WithKernel>(
    singularities: Singularities,
    output: Output,
    work: W,
) -> W::Output {
    match (singularities, output) {
        (Singularities::Stokeslets, Output::Velocity) => work.run::<Stokes<3, 3>>(),
        (Singularities::Stokeslets, Output::Pressure) => work.run::<Stokes<3, 4>>(),
        (Singularities::Stokeslets, Output::Gradient) => work.run::<Stokes<3, 13>>(),
        (Singularities::Stresslets, Output::Velocity) => work.run::<Stokes<6, 3>>(),
        (Singularities::Stresslets, Output::Pressure) => work.run::<Stokes<6, 4>>(),
        (Singularities::Stresslets, Output::Gradient) => work.run::<Stokes<6, 13>>(),
        (Singularities::Both, Output::Velocity) => work.run::<Stokes<9, 3>>(),
        (Singularities::Both, Output::Pressure) => work.run::<Stokes<9, 4>>(),
        (Singularities::Both, Output::Gradient) => work.run::<Stokes<9, 13>>(),
        (Singularities::All, Output::Velocity) => work.run::<Stokes<13, 3>>(),
        (Singularities::All, Output::Pressure) => work.run::<Stokes<13, 4>>(),
        (Singularities::All, Output::Gradient) => work.run::<Stokes<13, 13>>(),
    }
}
