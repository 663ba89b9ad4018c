//! The fast sums as users see them.

use std::sync::Arc;

use crate::dispatch::Kernel;
use crate::error::FmmError;
use crate::flow::{Flow, Output, Singularities, Strengths, check, check_positions};
use crate::kernel::MOST;
use crate::operators::Operators;
use crate::plan::{Planned, Scaled, plan};

/// Where the sources are, and where their sum is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// Places of the sources.
    pub sources: &'a [[f64; 3]],
    /// Places of the targets; `None` if they are the sources. A source has no effect on a target in
    /// the same place.
    pub targets: Option<&'a [[f64; 3]]>,
}

impl<'a> Points<'a> {
    /// Sources that are the targets too.
    pub fn same(points: &'a [[f64; 3]]) -> Self {
        Self {
            sources: points,
            targets: None,
        }
    }

    /// Sources and targets apart.
    pub fn apart(sources: &'a [[f64; 3]], targets: &'a [[f64; 3]]) -> Self {
        Self {
            sources,
            targets: Some(targets),
        }
    }

    /// The power of two that scales the extent of all points to between 1 and 2, or an error if the
    /// points allow no sum.
    fn scale(&self) -> Result<f64, FmmError> {
        let most = self.sources.len().max(self.targets.map_or(0, <[_]>::len));
        if most >= u32::MAX as usize {
            return Err(FmmError::TooMany(most));
        }
        check_positions("source position", self.sources)?;
        check_positions("target position", self.targets.unwrap_or(&[]))?;
        let mut range = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for point in self.sources.iter().chain(self.targets.unwrap_or(&[])) {
            for axis in 0..3 {
                range[0][axis] = range[0][axis].min(point[axis]);
                range[1][axis] = range[1][axis].max(point[axis]);
            }
        }
        let extent = (0..3)
            .map(|axis| range[1][axis] - range[0][axis])
            .fold(0.0, f64::max);
        // Beyond 1e-300 the inverse power would overflow.
        Ok(if extent > 1e-300 {
            (-extent.log2().floor()).exp2()
        } else {
            1.0
        })
    }

    fn scaled(&self, scale: f64) -> Scaled {
        let scaled = |points: &[[f64; 3]]| points.iter().map(|x| x.map(|x| x * scale)).collect();
        Scaled {
            sources: scaled(self.sources),
            targets: self.targets.map(scaled),
        }
    }
}

/// Sums of Stokeslets, stresslets, rotlets and sources over one set of points, planned once and
/// applied to any number of strengths.
///
/// The time and memory of a sum grow with the number of points, not with its square. If
/// there are so few points that it takes less time, all pairs are summed directly. Results are the
/// same bits on any number of threads.
pub struct StokesSum {
    planned: Box<dyn Planned>,
    operators: Arc<Operators>,
    singularities: Singularities,
    output: Output,
    tolerance: f64,
    sources: usize,
    /// The plan's lengths per user's length.
    scale: f64,
}

impl StokesSum {
    /// Plans sums of `singularities` to the `tolerance`.
    ///
    /// The tolerance is relative, in the Euclidean norm over all targets, for each output
    /// separately, for strengths that behave like random ones. Where the terms of an output cancel,
    /// its error is relative to what they would add up to without cancellation. This is so for
    /// gradients of forces that are all alike, and for flows of stresslets, or of forces whose sum
    /// is zero, seen from far away. Ask for more digits there.
    ///
    /// Points nearer than about 1e-40 of the extent of all points are taken for one. Points in one
    /// place cost all their pairs.
    ///
    /// # Errors
    ///
    /// Coordinates that are not finite or beyond 1e100, 2^32 - 1 points or more, and tolerances
    /// outside of 1e-12 to 1e-1.
    pub fn new(
        points: Points<'_>,
        singularities: Singularities,
        output: Output,
        tolerance: f64,
    ) -> Result<Self, FmmError> {
        let kernel = Kernel::stokes(singularities, output);
        let operators = Arc::new(Operators::new(kernel, tolerance)?);
        Self::with_operators(points, singularities, output, tolerance, operators)
    }

    /// The same sums for points that have moved: what does not depend on the points is shared.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn moved(&self, points: Points<'_>) -> Result<Self, FmmError> {
        let operators = self.operators.clone();
        Self::with_operators(
            points,
            self.singularities,
            self.output,
            self.tolerance,
            operators,
        )
    }

    fn with_operators(
        points: Points<'_>,
        singularities: Singularities,
        output: Output,
        tolerance: f64,
        operators: Arc<Operators>,
    ) -> Result<Self, FmmError> {
        let scale = points.scale()?;
        let kernel = Kernel::stokes(singularities, output);
        let planned = plan(kernel, points.scaled(scale), operators.clone());
        let sources = points.sources.len();
        Ok(Self {
            planned,
            operators,
            singularities,
            output,
            tolerance,
            sources,
            scale,
        })
    }

    /// The accuracy of the sums, relative in the Euclidean norm over all targets, for each output
    /// separately.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The flow of sources of these strengths at the targets.
    ///
    /// # Errors
    ///
    /// Strengths that are not finite, whose number differs from that of the sources, or of a kind
    /// that was not planned for.
    pub fn apply(&self, strengths: &Strengths<'_>) -> Result<Flow, FmmError> {
        strengths.validate(self.sources)?;
        self.singularities.admits(strengths)?;
        let scale = self.scale;
        let strength = |index: usize| {
            let mut strength = strengths.of(index, self.singularities);
            self.singularities.weigh(&mut strength, scale);
            strength
        };
        let columns = self.planned.apply(&strength);
        Ok(Flow::assemble(
            self.output,
            columns[0].len(),
            scale,
            |target, output| columns[output][target],
        ))
    }
}

/// Sums of Laplace charges: potentials $\phi = \sum q / 4\pi r$, and their gradients. All else is
/// as for [`StokesSum`].
pub struct LaplaceSum {
    planned: Box<dyn Planned>,
    operators: Arc<Operators>,
    gradient: bool,
    sources: usize,
    scale: f64,
}

impl LaplaceSum {
    /// Plans potentials to the `tolerance`, with their gradients if `gradient`.
    ///
    /// # Errors
    ///
    /// As for [`StokesSum::new`].
    pub fn new(points: Points<'_>, gradient: bool, tolerance: f64) -> Result<Self, FmmError> {
        let operators = Operators::new(Kernel::laplace(gradient), tolerance)?;
        Self::with_operators(points, gradient, Arc::new(operators))
    }

    /// The same sums for points that have moved.
    ///
    /// # Errors
    ///
    /// As for [`StokesSum::new`].
    pub fn moved(&self, points: Points<'_>) -> Result<Self, FmmError> {
        Self::with_operators(points, self.gradient, self.operators.clone())
    }

    fn with_operators(
        points: Points<'_>,
        gradient: bool,
        operators: Arc<Operators>,
    ) -> Result<Self, FmmError> {
        let scale = points.scale()?;
        let kernel = Kernel::laplace(gradient);
        let planned = plan(kernel, points.scaled(scale), operators.clone());
        Ok(Self {
            planned,
            operators,
            gradient,
            sources: points.sources.len(),
            scale,
        })
    }

    /// Potentials of `charges` at the targets, and their gradients (empty if not planned for).
    ///
    /// # Errors
    ///
    /// Charges that are not finite or of another number than there are sources.
    pub fn apply(&self, charges: &[f64]) -> Result<(Vec<f64>, Vec<[f64; 3]>), FmmError> {
        check("charges", charges.as_chunks::<1>().0, self.sources)?;
        let columns = self.planned.apply(&|index| {
            let mut strength = [0.0; MOST];
            strength[0] = charges[index];
            strength
        });
        let scale = self.scale;
        let potential = columns[0].iter().map(|phi| phi * scale).collect();
        let count = if self.gradient { columns[0].len() } else { 0 };
        let slope =
            |target: usize| [1, 2, 3].map(|axis: usize| columns[axis][target] * scale * scale);
        Ok((potential, (0..count).map(slope).collect()))
    }
}
