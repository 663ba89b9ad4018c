//! Suspensions: the table 3.1 of the thesis, and figures of the multibody solver.
//!
//! Each is asked for by `cargo bench --bench suspension --` and a word:
//!
//! - `table [MOST [FEWEST]]`: the thesis's table, its figures beside ours
//! - `chosen BODIES TOLERANCE`: its test with points chosen for a tolerance
//! - `iterations [bodies on a side ...]`
//! - `product [BODIES] [TOLERANCE]`: products at one tolerance beside their sums over points
//! - `solve BODIES TOLERANCE [PANELS ORDER MODES]`: one suspension of free bodies, time and memory;
//!   with 0 panels the solver chooses
//! - `error BODIES TOLERANCE`: by how much the motions found with 2550 points each are off
//! - `walk BODIES STEPS TOLERANCE`: a random walk with one solver, beside fresh ones
//!
//! Spheroids on a cubic grid of spacing 2.4, axes at random; the thesis's have 5 panels of 10 nodes
//! and 25 modes, 2550 points each.

use std::error::Error;
use std::sync::Arc;

use axistokes::body::Stokeslet;
use axistokes::nalgebra::{Point3, Unit, Vector3};
use axistokes::suspension::{Levels, SolveError};
use axistokes::{
    Accuracy, Answer, Body, Frame, GeneratingCurve, Motion, Options, Panels, Resolution,
    RigidMotion, Slip, Solver, Spheroid, Suspension, SuspensionError, Wrench,
};

const SPACING: f64 = 2.4;
/// Panels, nodes on each, and modes: 2550 points.
const THESIS_POINTS: [usize; 3] = [5, 10, 25];
/// Shapes in the table: every body its own up to the thesis's 256. Of a thousand shapes the
/// matrices would fill the memory.
const SHAPES: usize = 256;
/// Most bodies for which the preconditioner without its second level is tried: it takes many
/// iterations.
const ONE_LEVEL: usize = 100;

type ThesisRow = (usize, usize, f64, f64, Option<(usize, f64)>, f64, f64);
type Question = (Vec<Body>, Vec<Arc<Resolution>>);

/// The thesis's rows: threads, bodies, T_ker, T_inv, n_op, T_near, T_fmm, absolute error; none
/// where it did not converge.
const THESIS: [ThesisRow; 18] = [
    (1, 2, 3.8, 0.1, Some((14, 4.4471e-7)), 1.1, 2.0),
    (1, 4, 4.2, 1.3, Some((22, 1.0709e-6)), 2.5, 4.5),
    (1, 8, 6.6, 3.1, Some((27, 8.4709e-7)), 5.1, 16.5),
    (1, 16, 13.5, 6.1, Some((29, 7.1951e-7)), 10.1, 37.9),
    (1, 32, 24.5, 12.1, Some((54, 7.1479e-7)), 21.0, 85.7),
    (1, 64, 49.5, 26.8, Some((177, 4.4704e-6)), 43.0, 196.1),
    (2, 4, 3.5, 0.9, Some((23, 7.6096e-7)), 1.8, 2.7),
    (2, 8, 4.1, 1.6, Some((22, 2.5302e-6)), 3.7, 9.1),
    (2, 16, 7.0, 3.2, Some((46, 1.3312e-6)), 7.8, 21.0),
    (2, 32, 14.2, 6.9, Some((56, 7.3557e-7)), 15.7, 47.6),
    (2, 64, 26.9, 14.7, Some((123, 7.9819e-7)), 27.6, 100.5),
    (2, 128, 52.6, 26.1, None, 56.6, 214.0),
    (4, 8, 3.7, 1.2, Some((27, 1.1476e-6)), 3.4, 6.3),
    (4, 16, 4.5, 2.1, Some((62, 3.9708e-7)), 7.0, 17.9),
    (4, 32, 7.3, 5.8, Some((36, 8.5426e-7)), 14.1, 28.3),
    (4, 64, 13.7, 10.4, Some((179, 2.1424e-6)), 28.5, 63.0),
    (4, 128, 28.5, 21.2, None, 58.3, 145.6),
    (4, 256, 50.5, 46.2, None, 117.4, 280.5),
];

type Shared = Arc<dyn GeneratingCurve>;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let number = |index: usize, default: f64| {
        let given = arguments.get(index).and_then(|a| a.parse().ok());
        given.unwrap_or(default)
    };
    match arguments.first().map(String::as_str) {
        Some("table") => table(number(2, 0.0) as usize, number(1, 1000.0) as usize),
        Some("iterations") => {
            let sides: Vec<usize> = arguments[1..]
                .iter()
                .filter_map(|a| a.parse().ok())
                .collect();
            iterations(if sides.is_empty() { &[2, 4] } else { &sides })
        }
        Some("chosen") => chosen(number(1, 64.0) as usize, number(2, 1e-9)),
        Some("product") => product(number(1, 64.0) as usize, number(2, 1e-6)),
        Some("solve") => {
            let [panels, order, modes] =
                [0, 1, 2].map(|k| number(3 + k, THESIS_POINTS[k] as f64) as usize);
            solve(
                number(1, 125.0) as usize,
                number(2, 1e-6),
                [panels, order, modes],
            )
        }
        Some("error") => error(number(1, 125.0) as usize, number(2, 1e-7)),
        Some("walk") => walk(
            number(1, 27.0) as usize,
            number(2, 20.0) as usize,
            number(3, 1e-4),
        ),
        _ => {
            println!("nothing asked for: table, chosen, iterations, product, solve, error or walk");
            Ok(())
        }
    }
}

/// The answer, also if it misses its tolerance.
fn answer(suspension: &Suspension, options: Options) -> Result<Answer, SuspensionError> {
    Solver::new(options)
        .solve(suspension)
        .or_else(SolveError::answer)
}

/// Options for given resolutions.
fn given(resolutions: &[Arc<Resolution>], tolerance: f64) -> Options {
    Options::new(Accuracy::Resolutions {
        of_bodies: resolutions.to_vec(),
        tolerance,
    })
}

fn random(chance: &mut fastrand::Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| chance.f64() - 0.5)
}

/// Where bodies are: on the smallest cube that has room for them, layer by layer.
fn frames(count: usize, chance: &mut fastrand::Rng) -> Vec<Frame> {
    let side = (1..).find(|side: &usize| side.pow(3) >= count).unwrap_or(1);
    let frame = |i: usize, chance: &mut fastrand::Rng| {
        let place = [i % side, i / side % side, i / side / side];
        let center = Point3::from(place.map(|k| SPACING * k as f64));
        let axis = loop {
            let v = random(chance);
            if v.norm() > 0.1 && v.norm() < 0.5 {
                break Unit::new_normalize(v);
            }
        };
        Frame::along(center, axis)
    };
    (0..count).map(|i| frame(i, chance)).collect()
}

fn by_hand(
    curve: &Shared,
    [panels, order, modes]: [usize; 3],
) -> Result<Arc<Resolution>, Box<dyn Error>> {
    Ok(Arc::new(Resolution {
        panels: Panels::equal_arcs(&**curve, panels)?,
        order,
        modes,
    }))
}

/// Stokeslets at the centres of spheroids of random aspect ratio, as the thesis has them.
fn table(fewest: usize, most: usize) -> Result<(), Box<dyn Error>> {
    println!(
        "Thesis, table 3.1 (single layer, BiCGStab), and this solver (combined field, GMRES): 2550 points per body"
    );
    println!(
        "threads bodies |      T_ker T_inv n_op T_near T_fmm eps_abs (thesis) |  T_ker  T_inv  n_op T_near  T_fmm  eps_abs  estimate iterations"
    );
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        for bodies in [2, 4, 8, 16, 32, 64, 128, 256, 512, 1000] {
            let asked = (fewest..=most).contains(&bodies);
            if !asked || threads == 1 && bodies > 64 || threads == 2 && bodies < 4 {
                continue;
            }
            let known = THESIS
                .iter()
                .find(|row| (row.0, row.1) == (threads, bodies));
            // Its rows of 256 bodies are for four threads only.
            let known = known.or(THESIS.iter().find(|row| row.1 == bodies && bodies == 256));
            let thesis = match known {
                Some((of, _, ker, inv, Some((ops, error)), near, fmm)) => {
                    format!(
                        "({of}) {ker:7.1} {inv:5.1} {ops:4} {near:6.1} {fmm:5.1} {error:7.1e}         "
                    )
                }
                Some((of, _, ker, inv, None, near, fmm)) => {
                    format!("({of}) {ker:7.1} {inv:5.1}    - {near:6.1} {fmm:5.1}       -         ")
                }
                None => " ".repeat(52),
            };
            let (answer, error) = pool
                .install(|| known_flow(bodies, None))
                .map_err(|e| e.to_string())?;
            let t = answer.statistics.timings;
            println!(
                "{threads:7} {bodies:6} | {thesis} | {:6.2} {:6.2} {:5} {:6.2} {:6.2} {error:8.1e}  {:8.1e} {:5}",
                t.assemble,
                t.factor,
                answer.statistics.iteration.products,
                t.near + t.iterate - t.sum,
                t.sum,
                answer.error_estimate,
                answer.statistics.iteration.iterations,
            );
        }
    }
    Ok(())
}

fn chosen(count: usize, tolerance: f64) -> Result<(), Box<dyn Error>> {
    let (answer, error) = known_flow(count, Some(tolerance))?;
    println!(
        "{count} bodies to {tolerance:.0e}: {} points, absolute error {error:.1e}, estimated {:.1e} of the largest speed {:.3}; {:?}",
        answer.statistics.points,
        answer.error_estimate,
        answer.largest_speed,
        answer.statistics.timings
    );
    Ok(())
}

/// The absolute error of the velocity at points outside; the thesis's points, or those that the
/// solver chooses for a tolerance.
fn known_flow(count: usize, tolerance: Option<f64>) -> Result<(Answer, f64), String> {
    let mut chance = fastrand::Rng::with_seed(31);
    let frames = frames(count, &mut chance);
    let stokeslets: Vec<Stokeslet> = frames
        .iter()
        .map(|frame| Stokeslet {
            at: frame.center().coords,
            force: 2.0 * random(&mut chance),
        })
        .collect();
    let exact =
        |x: Vector3<f64>| -> Vector3<f64> { stokeslets.iter().map(|s| s.velocity(x)).sum() };
    let slips = frames.iter().map(|&frame| {
        let stokeslets = stokeslets.clone();
        Slip::new(move |x| {
            let x = frame.point_to_lab(x.into()).coords;
            frame.vector_to_body(stokeslets.iter().map(|s| s.velocity(x)).sum())
        })
    });
    let mut bodies = Vec::new();
    let (mut shapes, mut resolutions) = (Vec::new(), Vec::new());
    for (frame, slip) in frames.iter().zip(slips) {
        if bodies.len() < SHAPES {
            let other = 0.5 + 0.5 * chance.f64();
            let axes = if chance.bool() {
                [1.0, other]
            } else {
                [other, 1.0]
            };
            let shape = Spheroid::new(axes[0], axes[1]).map_err(|e| e.to_string())?;
            let curve: Shared = Arc::new(shape);
            resolutions.push(by_hand(&curve, THESIS_POINTS).map_err(|e| e.to_string())?);
            shapes.push(curve);
        } else {
            resolutions.push(resolutions[bodies.len() % SHAPES].clone());
        }
        bodies.push(Body {
            slip: Some(slip),
            ..Body::new(shapes[bodies.len() % SHAPES].clone(), *frame)
        });
    }
    let side = SPACING * (count as f64).cbrt();
    let outside = |point: &Point3<f64>| {
        frames
            .iter()
            .all(|frame| (frame.center() - point).norm() > 1.01)
    };
    let targets: Vec<Point3<f64>> = std::iter::repeat_with(|| {
        Point3::from((random(&mut chance) + Vector3::repeat(0.5)) * side)
    })
    .filter(outside)
    .take(200)
    .collect();
    let suspension = Suspension::new(bodies).with_probes(targets.clone());
    let options = match tolerance {
        None => given(&resolutions, 1e-8),
        Some(tolerance) => Options::tolerance(tolerance),
    };
    let answer = answer(&suspension, options).map_err(|error| error.to_string())?;
    let errors = targets.iter().zip(&answer.probes);
    let error = errors
        .map(|(x, at)| (at.velocity - exact(x.coords)).amax())
        .fold(0.0, f64::max);
    Ok((answer, error))
}

/// Rods and discs in turn; free under random forces and torques, or held and moved at random.
fn rods_and_discs(
    count: usize,
    free: bool,
    points: [usize; 3],
) -> Result<Question, Box<dyn Error>> {
    let mut chance = fastrand::Rng::with_seed(1);
    let shapes: [Shared; 2] = [
        Arc::new(Spheroid::new(1.0, 0.5)?),
        Arc::new(Spheroid::new(0.5, 1.0)?),
    ];
    let by_hand = [by_hand(&shapes[0], points)?, by_hand(&shapes[1], points)?];
    let frames = frames(count, &mut chance);
    let which = |frame: &Frame| (frame.center().coords.sum() / SPACING).round() as usize % 2;
    let bodies = frames.iter().map(|frame| {
        let vectors = [random(&mut chance), random(&mut chance)];
        Body {
            motion: if free {
                Motion::Free(Wrench {
                    force: vectors[0],
                    torque: vectors[1],
                })
            } else {
                Motion::Given(RigidMotion {
                    velocity: vectors[0],
                    angular_velocity: vectors[1],
                })
            },
            ..Body::new(shapes[which(frame)].clone(), *frame)
        }
    });
    let bodies = bodies.collect();
    let resolutions = frames.iter().map(|frame| by_hand[which(frame)].clone());
    Ok((bodies, resolutions.collect()))
}

fn iterations(sides: &[usize]) -> Result<(), Box<dyn Error>> {
    println!(
        "GMRES to a relative residual of 1e-8; spheroids 1:2 and 2:1 in turn, spacing {SPACING}, 2550 points per body"
    );
    println!("bodies  mobility  resistance, two levels  one level");
    for &side in sides {
        let count = side.pow(3);
        let mut counts = Vec::new();
        for (free, two_level) in [(true, false), (false, true), (false, false)] {
            if !(free || two_level) && count > ONE_LEVEL {
                break;
            }
            let (bodies, resolutions) = rods_and_discs(count, free, THESIS_POINTS)?;
            let mut options = given(&resolutions, 1e-6);
            if !two_level {
                options.levels = Levels::One;
            }
            options.residual = Some(1e-8);
            let answer = answer(&Suspension::new(bodies), options)?;
            counts.push(answer.statistics.iteration.iterations);
        }
        println!(
            "{count:6}  {:8}  {:22}  {:>9}",
            counts[0],
            counts[1],
            counts.get(2).map_or("-".into(), usize::to_string)
        );
    }
    Ok(())
}

/// An iteration whose products are all made to one tolerance: all that it takes over its sums
/// alone, plans included in both.
fn product(count: usize, tolerance: f64) -> Result<(), Box<dyn Error>> {
    for free in [true, false] {
        let (bodies, resolutions) = rods_and_discs(count, free, THESIS_POINTS)?;
        let mut options = given(&resolutions, 25.0 * tolerance);
        options.loosest_product = 0.0;
        options.residual = Some(25.0 * tolerance);
        let answer = answer(&Suspension::new(bodies), options)?.statistics;
        let (t, products) = (answer.timings, answer.iteration.products as f64);
        println!(
            "{count} {} bodies, {} points, {products} products to {tolerance:.0e}: {:.3} s each, {:.3} times the sum's {:.3} s; {:.0} unknowns per second and iteration",
            if free { "free" } else { "held" },
            answer.points,
            t.iterate / products,
            t.iterate / t.sum,
            t.sum / products,
            answer.unknowns as f64 * products / t.iterate,
        );
    }
    Ok(())
}

fn solve(count: usize, tolerance: f64, points: [usize; 3]) -> Result<(), Box<dyn Error>> {
    let by_hand = if points[0] == 0 {
        THESIS_POINTS
    } else {
        points
    };
    let (bodies, resolutions) = rods_and_discs(count, true, by_hand)?;
    let suspension = Suspension::new(bodies);
    let start = std::time::Instant::now();
    let options = if points[0] == 0 {
        Options::tolerance(tolerance)
    } else {
        given(&resolutions, tolerance)
    };
    let answer = answer(&suspension, options)?;
    let seconds = start.elapsed().as_secs_f64();
    let peak = peak_memory().unwrap_or(f64::NAN);
    let statistics = &answer.statistics;
    let (iteration, timings) = (&statistics.iteration, &statistics.timings);
    println!(
        "{count} free bodies, {} points, {} unknowns: {seconds:.1} s, peak memory {peak:.2} GiB ({:.2} MiB per body)",
        statistics.points,
        statistics.unknowns,
        peak * 1024.0 / count as f64,
    );
    println!(
        "{} iterations, {} products, residual {:.1e}, estimated error {:.1e} of the largest speed {:.3}",
        iteration.iterations,
        iteration.products,
        iteration.residual,
        answer.error_estimate,
        answer.largest_speed
    );
    println!(
        "{} rounds, {timings:?}; near points and bytes {:?}; {} classes",
        statistics.rounds,
        (statistics.near_points, statistics.near_bytes),
        statistics.classes
    );
    Ok(())
}

/// The motions with the thesis's points, beside those to a tolerance.
fn error(count: usize, tolerance: f64) -> Result<(), Box<dyn Error>> {
    let (bodies, resolutions) = rods_and_discs(count, true, THESIS_POINTS)?;
    let suspension = Suspension::new(bodies);
    let by_hand = answer(&suspension, given(&resolutions, 1e-6))?;
    let better = answer(&suspension, Options::tolerance(tolerance))?;
    let apart = by_hand.bodies.iter().zip(&better.bodies).map(|(a, b)| {
        let turning = a.motion.angular_velocity - b.motion.angular_velocity;
        (a.motion.velocity - b.motion.velocity)
            .norm()
            .max(turning.norm())
    });
    println!(
        "{count} free bodies: motions off by {:.1e} of the largest speed, estimate {:.1e}; compared with an answer whose estimate is {:.1e}",
        apart.fold(0.0, f64::max) / better.largest_speed,
        by_hand.error_estimate,
        better.error_estimate
    );
    Ok(())
}

/// A random walk in steps of 0.02 radii: one solver that starts each answer from the one before,
/// and fresh solvers.
fn walk(count: usize, steps: usize, tolerance: f64) -> Result<(), Box<dyn Error>> {
    for free in [false, true] {
        let (bodies, _) = rods_and_discs(count, free, THESIS_POINTS)?;
        let mut suspension = Suspension::new(bodies);
        let mut chance = fastrand::Rng::with_seed(7);
        let mut solver = Solver::new(Options::tolerance(tolerance));
        let setup = |answer: &Answer| {
            let t = answer.statistics.timings;
            [t.assemble + t.factor, t.near]
        };
        let mut before = solver.solve(&suspension).or_else(SolveError::answer)?;
        let first = setup(&before);
        println!(
            "{count} {} bodies to {tolerance:.0e}; first: {} rounds, assemble and factor {:.3} s, near rows {:.3} s, {:?}",
            if free { "free" } else { "held" },
            before.statistics.rounds,
            first[0],
            first[1],
            before.statistics.timings,
        );
        let mut sums = [0.0f64; 6];
        let mut apart = 0.0f64;
        for _ in 0..steps {
            for body in &mut suspension.bodies {
                let step = 0.02 * random(&mut chance).normalize();
                body.frame = body
                    .frame
                    .moved(step, 0.02 * random(&mut chance).normalize());
            }
            let start = std::time::Instant::now();
            let kept = solver.solve_from(&suspension, &before);
            let kept = kept.or_else(SolveError::answer)?;
            sums[0] += start.elapsed().as_secs_f64();
            let start = std::time::Instant::now();
            let fresh = answer(&suspension, Options::tolerance(tolerance))?;
            sums[1] += start.elapsed().as_secs_f64();
            for (sum, part) in sums[2..].iter_mut().zip(setup(&kept)) {
                *sum += part;
            }
            sums[4] += kept.statistics.iterations as f64;
            sums[5] += fresh.statistics.iterations as f64;
            let off = kept.bodies.iter().zip(&fresh.bodies).map(|(a, b)| {
                let motion = (a.motion - b.motion).velocity.norm() / fresh.largest_speed;
                let largest = fresh.bodies.iter().map(|b| b.wrench.force.norm());
                let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
                motion.max((a.wrench - b.wrench).force.norm() / largest)
            });
            let allowed = kept.error_estimate + fresh.error_estimate;
            apart = apart.max(off.fold(0.0, f64::max) / allowed);
            before = kept;
        }
        let n = steps as f64;
        println!(
            "later, mean of {steps}: {:.3} s each (fresh {:.3} s), assemble and factor {:.3} s, near rows {:.3} s: set-up {:.1} % of the first's; {:.1} iterations from a start, {:.1} fresh ({:.0} %); answers apart by at most {:.2} of both estimates",
            sums[0] / n,
            sums[1] / n,
            sums[2] / n,
            sums[3] / n,
            100.0 * (sums[2] + sums[3]) / n / (first[0] + first[1]),
            sums[4] / n,
            sums[5] / n,
            100.0 * sums[4] / sums[5],
            apart,
        );
    }
    Ok(())
}

/// The largest memory of the process so far, in GiB, where the system tells.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / f64::from(1 << 20))
}
