//! Timed cases that `throughput` and `table` share.

#[path = "../../tests/common/mod.rs"]
mod clouds;

use std::time::Instant;

use clap::ValueEnum;
use clouds::{Amounts, Cloud, ON_SPHEROID, errors, every, thinned};
use serde::Serialize;
use stokes_fmm::{
    Flow, FmmError, Output, Points, Singularities, StokesSum, Strengths, TreeCode, direct,
};

/// Targets that the error is measured at.
const CHECKED: usize = 500;
/// Times a sum is applied.
const APPLICATIONS: usize = 5;
/// Pairs of the direct sum that is timed.
const TIMED_PAIRS: usize = 500_000_000;
/// Targets that keep every lane of the direct sum busy.
const DIRECT_CHUNK: usize = 128;

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Kernel {
    Stokeslet,
    Stresslet,
    /// Both.
    Combined,
}

impl Kernel {
    fn singularities(self) -> Singularities {
        match self {
            Self::Stokeslet => Singularities::Stokeslets,
            Self::Stresslet => Singularities::Stresslets,
            Self::Combined => Singularities::Both,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Outputs {
    Velocity,
    /// Velocity and pressure.
    Pressure,
    /// Velocity, pressure and velocity gradient.
    Gradient,
}

impl Outputs {
    fn output(self) -> Output {
        match self {
            Self::Velocity => Output::Velocity,
            Self::Pressure => Output::Pressure,
            Self::Gradient => Output::Gradient,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Distribution {
    /// Uniform in the unit cube, normals at random.
    Cube,
    /// Surfaces of spheroids (2550 points each) with their normals.
    Spheroids,
}

impl Distribution {
    fn cloud(self, n: usize) -> Cloud {
        let mut random = fastrand::Rng::with_seed(1);
        match self {
            Self::Cube => Cloud::cube(n, &mut random),
            Self::Spheroids => {
                let spheroids = (n as f64 / ON_SPHEROID as f64).round().max(1.0);
                Cloud::spheroids(spheroids as usize, &mut random)
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Method {
    /// The fast sum.
    Fmm,
    /// The Barnes-Hut tree code.
    Tree,
    /// Pair by pair.
    Direct,
}

/// What is summed.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Case {
    #[arg(long, value_enum, default_value_t = Kernel::Stokeslet)]
    pub kernel: Kernel,
    #[arg(long, value_enum, default_value_t = Outputs::Velocity)]
    pub output: Outputs,
    #[arg(long, value_enum, default_value_t = Distribution::Cube)]
    pub distribution: Distribution,
    /// Sources, which are the targets too; rounded to whole spheroids.
    #[arg(long, default_value_t = 100_000, value_parser = at_least_one)]
    pub n: usize,
    /// Relative error asked for, from 1e-12 to 1e-1.
    #[arg(long, default_value_t = 1e-6, value_parser = tolerance)]
    pub tolerance: f64,
    #[arg(long, default_value_t = 1, value_parser = threads)]
    pub threads: usize,
    #[arg(long, value_enum, default_value_t = Method::Fmm)]
    pub method: Method,
}

/// As many threads as any machine of ours has.
fn threads(text: &str) -> Result<usize, String> {
    match at_least_one(text)? {
        count @ ..=1024 => Ok(count),
        _ => Err("expected at most 1024".into()),
    }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("expected at least 1".into()),
        Ok(count) => Ok(count),
        Err(error) => Err(format!("{error}")),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(tolerance) if (1e-12..=1e-1).contains(&tolerance) => Ok(tolerance),
        Ok(_) => Err("expected a number from 1e-12 to 1e-1".into()),
        Err(error) => Err(format!("{error}")),
    }
}

/// What it takes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measured {
    pub n: usize,
    pub tolerance: f64,
    /// The largest of the errors of velocity, pressure and gradient, of those that were asked for.
    /// Each is relative to the direct sum in the Euclidean norm over 500 of the targets.
    pub error: f64,
    /// What depends on kernel and tolerance alone.
    pub operators_seconds: f64,
    /// What depends on the points: tree and lists.
    pub plan_seconds: f64,
    /// One application, the median of five.
    pub apply_seconds: f64,
    pub points_per_second: f64,
    /// Of the direct sum to full precision, on one thread.
    pub direct_pairs_per_second: f64,
    /// Pairs of a direct sum in the same time on as many threads, per target.
    pub pairs_per_point: f64,
    /// Peak memory of the whole process since the case began, points and strengths included; 0
    /// where it is not known.
    pub peak_bytes: u64,
}

impl Case {
    /// Makes the points, sums, and compares.
    pub fn measure(&self) -> Result<Measured, Box<dyn std::error::Error>> {
        let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        reset_peak();
        let cloud = self.distribution.cloud(self.n);
        let amounts = Amounts::random(&cloud.normals, &mut fastrand::Rng::with_seed(2));
        let problem = Problem {
            case: self,
            points: &cloud.points,
            strengths: amounts.strengths(self.kernel.singularities()),
        };
        let threads = pool(self.threads)?;
        let timed = threads.install(|| problem.timed())?;
        let peak_bytes = peak_bytes();
        let error = threads.install(|| problem.error(&timed.flow))?;
        let direct_pairs_per_second = pool(1)?.install(|| problem.direct_rate())?;
        let n = cloud.len();
        Ok(Measured {
            n,
            tolerance: self.tolerance,
            error,
            operators_seconds: timed.operators,
            plan_seconds: timed.plan,
            apply_seconds: timed.apply,
            points_per_second: n as f64 / timed.apply,
            direct_pairs_per_second,
            pairs_per_point: timed.apply * direct_pairs_per_second * self.threads as f64 / n as f64,
            peak_bytes,
        })
    }
}

/// Seconds, and the flow at all points.
struct Timed {
    operators: f64,
    plan: f64,
    apply: f64,
    flow: Flow,
}

struct Problem<'a> {
    case: &'a Case,
    points: &'a [[f64; 3]],
    strengths: Strengths<'a>,
}

impl Problem<'_> {
    fn timed(&self) -> Result<Timed, FmmError> {
        match self.case.method {
            Method::Fmm => self.timed_fast(),
            Method::Tree => {
                let kinds = self.case.kernel.singularities();
                let output = self.case.output.output();
                let (points, tolerance) = (Points::same(self.points), self.case.tolerance);
                let (plan, sum) = seconds(|| TreeCode::new(points, kinds, output, tolerance))?;
                let (apply, flow) = median(APPLICATIONS, || sum.apply(&self.strengths))?;
                Ok(Timed {
                    operators: 0.0,
                    plan,
                    apply,
                    flow,
                })
            }
            Method::Direct => {
                let tolerance = Some(self.case.tolerance);
                let sum = || self.direct(self.points, tolerance);
                let (apply, flow) = median(APPLICATIONS, sum)?;
                Ok(Timed {
                    operators: 0.0,
                    plan: 0.0,
                    apply,
                    flow,
                })
            }
        }
    }

    fn timed_fast(&self) -> Result<Timed, FmmError> {
        let points = Points::same(self.points);
        let output = self.case.output.output();
        let kinds = self.case.kernel.singularities();
        let (first, sum) = seconds(|| StokesSum::new(points, kinds, output, self.case.tolerance))?;
        let (plan, sum) = seconds(|| sum.moved(points))?;
        let (apply, flow) = median(APPLICATIONS, || sum.apply(&self.strengths))?;
        Ok(Timed {
            operators: (first - plan).max(0.0),
            plan,
            apply,
            flow,
        })
    }

    fn direct(&self, targets: &[[f64; 3]], tolerance: Option<f64>) -> Result<Flow, FmmError> {
        let output = self.case.output.output();
        direct::sum(self.points, &self.strengths, targets, output, tolerance)
    }

    /// The worst of the outputs.
    fn error(&self, flow: &Flow) -> Result<f64, FmmError> {
        let stride = self.points.len().div_ceil(CHECKED);
        let expected = self.direct(&thinned(self.points, stride), None)?;
        let errors = errors(&every(flow, stride), &expected);
        Ok(errors.into_iter().fold(0.0, f64::max))
    }

    /// Pairs per second.
    fn direct_rate(&self) -> Result<f64, FmmError> {
        let wanted = (TIMED_PAIRS / self.points.len()).next_multiple_of(DIRECT_CHUNK);
        let targets = &self.points[..wanted.min(self.points.len())];
        let (seconds, _) = median(APPLICATIONS, || self.direct(targets, None))?;
        Ok(self.points.len() as f64 * targets.len() as f64 / seconds)
    }
}

fn seconds<T>(work: impl FnOnce() -> Result<T, FmmError>) -> Result<(f64, T), FmmError> {
    let start = Instant::now();
    let done = work()?;
    Ok((start.elapsed().as_secs_f64(), done))
}

/// Median of the seconds it takes, and what it gives.
fn median<T>(
    times: usize,
    mut work: impl FnMut() -> Result<T, FmmError>,
) -> Result<(f64, T), FmmError> {
    let (first, mut last) = seconds(&mut work)?;
    let mut all = vec![first];
    for _ in 1..times {
        let (again, done) = seconds(&mut work)?;
        all.push(again);
        last = done;
    }
    all.sort_by(f64::total_cmp);
    Ok((all[all.len() / 2], last))
}

/// The largest memory this process has had since [`reset_peak`].
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kilobytes = status.lines().find_map(|line| {
        let number = line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?;
        number.trim().parse::<u64>().ok()
    });
    1024 * kilobytes.unwrap_or(0)
}

/// Lets the peak begin anew, where the system can.
fn reset_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
