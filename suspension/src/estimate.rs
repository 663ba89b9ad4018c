//! The estimated error of a solution.
//!
//! Two means: by how much the solution [misses](super::check) the boundary velocity on finer
//! surfaces, and by how much it differs from a second solution on those surfaces. For many bodies
//! the first is cheap and tells all but where gaps are narrow. For a body alone the second costs as
//! much as a check would, and tells more.

use std::f64::consts::PI;

use bodies_of_revolution::{RigidMotion, Wrench};
use stokes_body::kernel::FlowAt;
use stokes_body::refinement;

use super::solution::Solution;
use super::suspension::Suspension;

/// How far the estimate stays above what the boundary velocity is off by.
const SAFETY: f64 = 2.0;
/// What is left to rounding.
const ROUNDING: f64 = 1e-14;
/// Forces below this part of what the largest speed would make them, and motions below this part of
/// the largest speed, count as if they were that large.
const SMALL: f64 = 1e-2;
/// How far the estimate stays above the difference of two solutions for many bodies: the finer one
/// has an error too.
pub(crate) const COMPARED: f64 = 3.0;

/// The largest speed on the surfaces, of what is imposed and of motions that were found.
pub(crate) fn largest_speed(suspension: &Suspension, solution: &Solution) -> f64 {
    let speeds = suspension.bodies.iter().enumerate().map(|(i, body)| {
        if !body.motion.is_found() {
            return 0.0;
        }
        speed_of(&solution.motions[i], size_of_shape(solution, i))
    });
    speeds.fold(solution.largest_imposed, f64::max)
}

fn speed_of(motion: &RigidMotion, size: f64) -> f64 {
    larger(
        motion.velocity.norm(),
        size * motion.angular_velocity.norm(),
    )
}

/// The larger of two errors; infinite if one is not a number, which `max` would pass over.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}

/// Half the largest extent of a body's shape.
fn size_of_shape(solution: &Solution, body: usize) -> f64 {
    solution.classes.of(body).tables.discretization.size()
}

/// The estimate from the largest speed that each body's boundary velocity is off by.
pub(crate) fn from_misses(
    suspension: &Suspension,
    solution: &Solution,
    misses: &[f64],
    speed: f64,
) -> f64 {
    let worst = misses.iter().copied().fold(0.0, larger);
    if worst == 0.0 {
        return 0.0;
    }
    let velocities = worst / speed;
    // A boundary velocity takes 6 pi size times itself to hold back, more or less; free bodies have
    // no such force.
    let mut force = 0.0f64;
    for (i, body) in suspension.bodies.iter().enumerate() {
        if body.motion.is_held() {
            let size = body.frame.scale() * size_of_shape(solution, i);
            force = force.max(6.0 * PI * size * misses[i]);
        }
    }
    let forces = relative(force, force_scale(suspension, solution, speed));
    SAFETY * velocities.max(forces) + ROUNDING
}

/// The estimate from the difference of two solutions, the second on finer surfaces, and of their
/// velocities at the probes.
pub(crate) fn from_comparison(
    suspension: &Suspension,
    [solution, finer]: [&Solution; 2],
    [probes, finer_probes]: [&[FlowAt]; 2],
    speed: f64,
) -> f64 {
    let both = probes.iter().zip(finer_probes);
    let in_flow = both.map(|(a, b)| (a.velocity - b.velocity).norm());
    let in_flow = relative(in_flow.fold(0.0, larger), speed);
    let (mut motions, mut found, mut forces) = (0.0f64, SMALL * speed, 0.0f64);
    for (i, body) in suspension.bodies.iter().enumerate() {
        let size = size_of_shape(solution, i);
        let difference = solution.motions[i] - finer.motions[i];
        motions = larger(motions, speed_of(&difference, size));
        if body.motion.is_found() {
            found = found.max(speed_of(&finer.motions[i], size));
        }
        if body.motion.is_held() {
            let Wrench { force, torque } = solution.wrenches[i] - finer.wrenches[i];
            let difference = larger(force.norm(), torque.norm() / size);
            forces = larger(forces, body.frame.scale() * difference);
        }
    }
    let forces = relative(forces, force_scale(suspension, finer, speed));
    let difference = in_flow.max(relative(motions, found)).max(forces);
    match &suspension.bodies[..] {
        [_] => {
            let on = &solution.classes.of(0).tables.discretization;
            refinement::error_estimate(on, difference)
        }
        _ => COMPARED * difference,
    }
}

/// A difference over a scale, where there is a difference.
fn relative(difference: f64, scale: f64) -> f64 {
    if difference == 0.0 {
        0.0
    } else {
        difference / scale
    }
}

/// The largest force or torque over size on a held body, or a part of what the largest speed would
/// make it.
fn force_scale(suspension: &Suspension, solution: &Solution, speed: f64) -> f64 {
    let mut scale = 0.0f64;
    for (i, body) in suspension.bodies.iter().enumerate() {
        if body.motion.is_held() {
            let size = body.frame.scale() * size_of_shape(solution, i);
            let wrench = body.frame.wrench_to_lab(solution.wrenches[i]);
            let found = wrench.force.norm().max(wrench.torque.norm() / size);
            scale = scale.max(found).max(SMALL * 6.0 * PI * size * speed);
        }
    }
    scale
}
