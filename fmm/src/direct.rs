//! Direct sums, pair by pair: the fastest method for a few thousand points, and the reference for
//! all other methods.

pub(crate) mod chunks;

use f64_lanes::Precision;
use rayon::prelude::*;

use crate::FmmError;
use crate::dispatch::Kernel;
use crate::flow::{Flow, Output, Strengths, check, check_positions};
use crate::kernel::MOST;
use chunks::CHUNK;

/// The flow of `strengths` at `sources`, evaluated at `targets`, which may be the sources
/// themselves.
///
/// A pair at distance zero contributes nothing, and so does a pair nearer than 1e-40 of the largest
/// coordinate. Coordinates may be up to 1e100 in magnitude. Lengths are scaled to the largest
/// coordinate, so that nothing overflows or underflows on the way except for strengths or distances
/// beyond 1e±150 of that. Without a `tolerance` sums are exact to rounding; with one (1e-12 to
/// 1e-1) the error of each pair's contribution, relative to its size, is within it. The result does
/// not depend on the number of threads.
///
/// # Errors
///
/// Arrays of different lengths, numbers that are not finite, coordinates beyond 1e100, a tolerance
/// outside its range.
///
/// # Examples
///
/// ```
/// use stokes_fmm::{Output, Strengths, direct};
///
/// let strengths = Strengths { stokeslets: Some(&[[1.0, 0.0, 0.0]]), ..Default::default() };
/// let flow = direct::sum(&[[0.0; 3]], &strengths, &[[2.0, 0.0, 0.0]], Output::Velocity, None)?;
/// assert!((flow.velocity[0][0] * 8.0 * std::f64::consts::PI - 1.0).abs() < 1e-15);
/// # Ok::<(), stokes_fmm::FmmError>(())
/// ```
pub fn sum(
    sources: &[[f64; 3]],
    strengths: &Strengths,
    targets: &[[f64; 3]],
    output: Output,
    tolerance: Option<f64>,
) -> Result<Flow, FmmError> {
    let scale = common_scale(sources, targets)?;
    strengths.validate(sources.len())?;
    let precision = precision(tolerance)?;
    let singularities = strengths.singularities();
    let records = records(sources, scale, singularities.count(), |index| {
        let mut strength = strengths.of(index, singularities);
        singularities.weigh(&mut strength, scale);
        strength
    });
    let problem = Problem {
        records,
        targets: scaled(targets, scale),
        precision,
    };
    let columns = problem.sum(Kernel::stokes(singularities, output));
    Ok(Flow::assemble(
        output,
        targets.len(),
        scale,
        |target, output| columns.at(target, output),
    ))
}

/// The potential $\sum q / 4 \pi r$ of charges at `targets`, which may be the sources themselves,
/// and its gradient if `gradient` is true (otherwise it is empty). All else is as in [`sum`].
///
/// # Errors
///
/// Those of [`sum`].
pub fn laplace(
    sources: &[[f64; 3]],
    charges: &[f64],
    targets: &[[f64; 3]],
    gradient: bool,
    tolerance: Option<f64>,
) -> Result<(Vec<f64>, Vec<[f64; 3]>), FmmError> {
    let scale = common_scale(sources, targets)?;
    check("charges", charges.as_chunks::<1>().0, sources.len())?;
    let records = records(sources, scale, 1, |index| [charges[index]; MOST]);
    let problem = Problem {
        records,
        targets: scaled(targets, scale),
        precision: precision(tolerance)?,
    };
    let columns = problem.sum(Kernel::laplace(gradient));
    let potential = (0..targets.len()).map(|i| columns.at(i, 0) * scale);
    let slopes = (0..if gradient { targets.len() } else { 0 })
        .map(|i| [1, 2, 3].map(|k| columns.at(i, k) * scale * scale));
    Ok((potential.collect(), slopes.collect()))
}

/// How good the roots must be: $r^{-7}$ has seven times the error of $1/r$.
pub(crate) fn precision(tolerance: Option<f64>) -> Result<Precision, FmmError> {
    match tolerance {
        None => Ok(Precision::Full),
        Some(t) if !(1e-12..=1e-1).contains(&t) => Err(FmmError::Tolerance(t)),
        Some(t) if t >= 7e-4 => Ok(Precision::Seed),
        Some(t) if t >= 7e-8 => Ok(Precision::Single),
        Some(t) if t >= 7e-12 => Ok(Precision::Close),
        Some(_) => Ok(Precision::Full),
    }
}

/// The power of two that takes the largest coordinate to between 1 and 2.
fn common_scale(sources: &[[f64; 3]], targets: &[[f64; 3]]) -> Result<f64, FmmError> {
    let farthest = check_positions("source position", sources)?
        .max(check_positions("target position", targets)?);
    // Beyond 1e-300 the inverse power would overflow.
    Ok(if farthest < 1e-300 {
        1.0
    } else {
        (-farthest.log2().floor()).exp2()
    })
}

/// Positions in the scale where the largest coordinate is 1 to 2.
fn scaled(positions: &[[f64; 3]], scale: f64) -> Vec<[f64; 3]> {
    let scaled = positions.iter().map(|x| x.map(|x| x * scale));
    scaled.collect()
}

/// Position and strengths of each source, one source after the other.
pub(crate) fn records(
    sources: &[[f64; 3]],
    scale: f64,
    strengths: usize,
    strength: impl Fn(usize) -> [f64; MOST],
) -> Vec<f64> {
    let mut records = Vec::with_capacity((3 + strengths) * sources.len());
    for (index, position) in sources.iter().enumerate() {
        records.extend(position.map(|x| x * scale));
        records.extend_from_slice(&strength(index)[..strengths]);
    }
    records
}

/// Records of sources against targets.
pub(crate) struct Problem {
    /// Position and strengths of each source.
    pub records: Vec<f64>,
    pub targets: Vec<[f64; 3]>,
    pub precision: Precision,
}

/// Results, chunk by chunk of targets, in each chunk output by output.
pub(crate) struct Columns {
    outputs: usize,
    numbers: Vec<f64>,
}

impl Columns {
    pub fn at(&self, target: usize, output: usize) -> f64 {
        let (chunk, place) = (target / CHUNK, target % CHUNK);
        self.numbers[(chunk * self.outputs + output) * CHUNK + place]
    }
}

impl Problem {
    pub fn sum(mut self, kernel: &Kernel) -> Columns {
        let stride = 3 + kernel.numbers.strengths;
        for record in self.records.chunks_exact_mut(stride) {
            for (strength, factor) in record[3..].iter_mut().zip(kernel.numbers.factors) {
                *strength *= factor;
            }
        }
        let chunks = self.targets.len().div_ceil(CHUNK);
        let mut numbers = vec![0.0; chunks * kernel.numbers.outputs * CHUNK];
        numbers
            .par_chunks_mut(kernel.numbers.outputs * CHUNK)
            .zip(self.targets.par_chunks(CHUNK))
            .for_each(|(numbers, targets)| {
                (kernel.add_chunk)(self.precision, &self.records, targets, numbers);
            });
        Columns {
            outputs: kernel.numbers.outputs,
            numbers,
        }
    }
}

#[cfg(test)]
#[expect(
    clippy::needless_range_loop,
    reason = "indices of vectors and matrices are those of the formulas"
)]
mod tests;
