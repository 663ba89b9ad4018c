//! How finely each body is cut, before and after what is known of its error.
//!
//! Two bodies that face each other over a gap $d$ see each other's images gather at a distance of
//! $\delta = d/2 + \sqrt{d a + d^2/4}$ from the surface, for a radius $a$ (the poles of bispherical
//! coordinates): what panels and modes have to resolve there. Bodies farther away are sources at
//! their centres. Modes and panels are chosen from a short list, so that alike bodies stay alike
//! and share their factors.

use std::sync::Arc;

use nalgebra::Matrix3;

use super::arrangement::are_coaxial;
use super::check::Miss;
use super::class::Kind;
use super::error::SuspensionError;
use super::slip::Slip;
use super::suspension::{Body, Suspension};
use bodies_of_revolution::Gap;
use bodies_of_revolution::Meridian;
use bodies_of_revolution::{GeneratingCurve, Panel, Panels, Shape};
use stokes_body::discretization::Discretization;
use stokes_body::linear_flow;
use stokes_body::refinement::first_panels;
use stokes_body::resolution::Resolution;
use stokes_body::surface::SurfaceModes;

/// Modes of bodies among others, for each digit of the tolerance, and how many are enough where no
/// gap asks for more.
const MODES_PER_DIGIT: f64 = 2.0;
const MODES_FAR_APART: usize = 8;
/// Others whose modes are looked at where they are far away.
const NEAREST: usize = 16;
/// By how much, as a logarithm, what others do to a body is larger than the velocity that it is
/// compared with: densities are, and they change faster.
const LARGER: f64 = 2.0;
/// Bisections of one panel at first.
const DEEPEST: usize = 12;
/// Most modes.
const MOST_MODES: usize = 400;

/// The first resolutions for a tolerance.
pub(crate) fn first(
    suspension: &Suspension,
    gaps: &[Gap],
    tolerance: f64,
) -> Result<Vec<Arc<Resolution>>, SuspensionError> {
    let coaxial = are_coaxial(&suspension.bodies);
    let mut known: Vec<(Shape, Arc<Resolution>)> = Vec::new();
    let mut resolutions = Vec::with_capacity(suspension.bodies.len());
    for (index, body) in suspension.bodies.iter().enumerate() {
        let at_body = |error| SuspensionError::Curve { body: index, error };
        let (panels, order) = first_panels(&*body.shape, tolerance).map_err(at_body)?;
        let gradient = suspension.background.gradient != Matrix3::zeros();
        let last_exact = if gradient { linear_flow::LAST_MODE } else { 1 };
        let of_data = match &body.slip {
            None => last_exact,
            Some(slip) => {
                let sampled = Discretization::new(body.shape.clone(), panels.clone(), order)?;
                let modes = modes_of_slip(slip, &sampled, tolerance);
                modes
                    .ok_or(SuspensionError::Velocity { body: index })?
                    .max(last_exact)
            }
        };
        let facing: Vec<Facing> = gaps
            .iter()
            .filter_map(|gap| Facing::of(gap, index, body))
            .collect();
        let modes = if coaxial {
            of_data
        } else {
            let rings = rings(&*body.shape, &panels);
            let of_gaps = facing.iter().map(|facing| facing.modes(&rings, tolerance));
            let of_nearest = nearest(&suspension.bodies, index)
                .into_iter()
                .map(|other| modes_of_distant(&rings, body, other, tolerance));
            let least = (-MODES_PER_DIGIT * tolerance.log10()) as usize;
            let far_apart = of_data.max(least.min(MODES_FAR_APART));
            listed(of_gaps.chain(of_nearest).fold(far_apart, usize::max))
        };
        let resolution = Resolution {
            panels: graded(&*body.shape, panels, order, &facing, tolerance),
            order,
            modes,
        };
        let same = known
            .iter()
            .find(|(curve, other)| Arc::ptr_eq(curve, &body.shape) && **other == resolution);
        let shared = match same {
            Some((_, shared)) => shared.clone(),
            None => {
                let shared = Arc::new(resolution);
                known.push((body.shape.clone(), shared.clone()));
                shared
            }
        };
        resolutions.push(shared);
    }
    Ok(resolutions)
}

/// The modes that a slip has, to a tenth of the tolerance; none if it is not finite everywhere.
fn modes_of_slip(slip: &Slip, discretization: &Discretization, tolerance: f64) -> Option<usize> {
    let mut modes = 32;
    loop {
        let sampled = SurfaceModes::sample(discretization, modes, |x| slip.at(x));
        if !sampled.largest.is_finite() {
            return None;
        }
        let small = 0.1 * tolerance * sampled.largest;
        let last = (0..=modes)
            .rev()
            .find(|&n| sampled.modes.amplitude(n) > small)
            .unwrap_or(0);
        if last < modes - modes / 8 || modes >= MOST_MODES {
            return Some(last);
        }
        modes = (2 * modes).min(MOST_MODES);
    }
}

/// The same resolution for all bodies, shared by those of one shape.
pub(crate) fn uniform(
    bodies: &[Body],
    [panels, order, modes]: [usize; 3],
) -> Result<Vec<Arc<Resolution>>, SuspensionError> {
    let mut known: Vec<(&Shape, Arc<Resolution>)> = Vec::new();
    let mut resolutions = Vec::with_capacity(bodies.len());
    for (index, body) in bodies.iter().enumerate() {
        let mut shared = known.iter();
        let shared = match shared.find(|(shape, _)| Arc::ptr_eq(shape, &body.shape)) {
            Some((_, shared)) => shared.clone(),
            None => {
                let panels = Panels::equal_arcs(&*body.shape, panels)
                    .map_err(|error| SuspensionError::Curve { body: index, error })?;
                let resolution = Resolution {
                    panels,
                    order,
                    modes,
                };
                known.push((&body.shape, Arc::new(resolution)));
                known[known.len() - 1].1.clone()
            }
        };
        resolutions.push(shared);
    }
    Ok(resolutions)
}

/// The least number of modes in the list that is enough: two for each doubling.
fn listed(modes: usize) -> usize {
    let list = (2..).flat_map(|k| [1 << k, 3 << (k - 1)]);
    list.into_iter().find(|&n| n >= modes).unwrap_or(modes)
}

/// Another body across a gap, in the frame of the one that looks.
struct Facing {
    /// The nearest point of the own surface, in the half plane.
    point: [f64; 2],
    /// $\delta$.
    depth: f64,
    /// Where the other body's images gather, at $\delta$ from there, in the half plane.
    images: Meridian,
    /// By how much, as a logarithm, they are weaker than the flow that they answer.
    weaker: f64,
}

impl Facing {
    fn of(gap: &Gap, index: usize, body: &Body) -> Option<Self> {
        let side = gap.bodies.iter().position(|&b| b == index)?;
        let scale = body.frame.scale();
        let place = body.frame.point_to_body(gap.points[side]);
        let outward = body.frame.vector_to_body(gap.normals[side]).normalize();
        let at = Meridian::of(&place);
        let d = gap.distance / scale;
        let radius = at.r.hypot(at.z);
        let depth = 0.5 * d + (d * radius + 0.25 * d * d).sqrt();
        Some(Self {
            point: [at.r, at.z],
            depth,
            images: Meridian::of(&(place + depth * outward)),
            weaker: (radius / depth).ln_1p(),
        })
    }

    /// Modes that resolve on all rings what the images do.
    fn modes(&self, rings: &[Meridian], tolerance: f64) -> usize {
        let slowest = slowest_decay(rings, self.images, self.depth);
        (((LARGER + self.digits(tolerance)) / slowest) as usize).min(MOST_MODES)
    }

    /// What is to be resolved of the images, as a logarithm.
    fn digits(&self, tolerance: f64) -> f64 {
        (-tolerance.ln() - self.weaker).max(0.0)
    }
}

/// The bodies whose centres are nearest to that of another one.
fn nearest(bodies: &[Body], index: usize) -> Vec<&Body> {
    let center = bodies[index].frame.center();
    let away = |body: &&Body| (body.frame.center() - center).norm_squared();
    let others = bodies.iter().enumerate().filter(|(i, _)| *i != index);
    let mut others: Vec<&Body> = others.map(|(_, body)| body).collect();
    if others.len() > NEAREST {
        others.select_nth_unstable_by(NEAREST, |a, b| away(a).total_cmp(&away(b)));
        others.truncate(NEAREST);
    }
    others
}

/// Modes that resolve on all rings of a body what another one does from far away: it is a source
/// at its centre.
fn modes_of_distant(rings: &[Meridian], body: &Body, other: &Body, tolerance: f64) -> usize {
    let center = Meridian::of(&body.frame.point_to_body(other.frame.center()));
    let size = other.size() / body.frame.scale();
    let slowest = slowest_decay(rings, center, size);
    (((LARGER - tolerance.ln()) / slowest) as usize).min(MOST_MODES)
}

/// How fast the modes of what a source does on rings fall with their number, where that is slowest.
/// No ring counts as nearer than `least`: a body that is not convex may reach around the source.
///
/// On a ring of radius $r$ at $z$ the modes of a source at $(\rho, \zeta)$ fall as $e^{-n\eta}$
/// with $\cosh\eta = 1 + \frac{(r - \rho)^2 + (z - \zeta)^2}{2r\rho}$: this is the argument
/// of the toroidal functions that they are made of.
fn slowest_decay(rings: &[Meridian], source: Meridian, least: f64) -> f64 {
    let decay = |ring: &Meridian| {
        let square = (ring.r - source.r).powi(2) + (ring.z - source.z).powi(2);
        let square = square.max(least * least);
        (1.0 + square / (2.0 * ring.r * source.r)).acosh()
    };
    rings.iter().map(decay).fold(f64::INFINITY, f64::min)
}

/// Rings of a body, three on each panel.
fn rings(curve: &dyn GeneratingCurve, panels: &Panels) -> Vec<Meridian> {
    let on_panel = |panel: &Panel| [-0.5, 0.0, 0.5].map(|t| curve.point(panel.at(t)));
    panels.iter().flat_map(on_panel).collect()
}

/// Panels bisected until each is short beside what it faces.
fn graded(
    curve: &dyn GeneratingCurve,
    mut panels: Panels,
    order: usize,
    facing: &[Facing],
    tolerance: f64,
) -> Panels {
    for _ in 0..DEEPEST {
        let marked: Vec<bool> = panels
            .iter()
            .map(|panel| {
                let places = [-1.0, 0.0, 1.0].map(|t| curve.point(panel.at(t)));
                let length = (0..2)
                    .map(|k| (places[k + 1].r - places[k].r).hypot(places[k + 1].z - places[k].z))
                    .sum::<f64>();
                facing.iter().any(|facing| {
                    let away = places
                        .iter()
                        .map(|p| (p.r - facing.point[0]).hypot(p.z - facing.point[1]));
                    let away = away.fold(f64::INFINITY, f64::min);
                    // The Bernstein ellipse through a point at distance x from the middle of a
                    // panel of half length 1 has sinh(log rho) = x.
                    let needed = (facing.digits(tolerance) / order as f64).sinh();
                    0.5 * length * needed > facing.depth.hypot(away)
                })
            })
            .collect();
        if !marked.contains(&true) {
            break;
        }
        panels = panels.bisected(|panel| marked[panel]);
    }
    panels.graded_across_joints(curve)
}

/// Finer resolutions where a boundary velocity is off by more than is `allowed` on a body; bodies
/// that are alike in kind stay so if both are refined.
pub(crate) fn refined(
    kinds: &[Kind],
    misses: &[Miss],
    allowed: impl Fn(usize) -> f64,
) -> Vec<Kind> {
    let mut groups: Vec<(&Kind, Vec<bool>, bool)> = Vec::new();
    let mut group_of = vec![None; kinds.len()];
    for (body, (kind, miss)) in kinds.iter().zip(misses).enumerate() {
        let allowed = allowed(body);
        if miss.largest <= allowed {
            continue;
        }
        let (panels, modes) = wanted(kind, miss, allowed);
        let known = groups.iter().position(|(other, ..)| *other == kind);
        let group = known.unwrap_or_else(|| {
            groups.push((kind, vec![false; panels.len()], false));
            groups.len() - 1
        });
        for (all, panel) in groups[group].1.iter_mut().zip(panels) {
            *all |= panel;
        }
        groups[group].2 |= modes;
        group_of[body] = Some(group);
    }
    let finer: Vec<Arc<Resolution>> = groups
        .iter()
        .map(|(kind, marked, more_modes)| {
            let Resolution {
                panels,
                order,
                modes,
            } = &*kind.resolution;
            let bisected = panels.bisected(|panel| marked[panel]);
            Arc::new(Resolution {
                panels: bisected.graded_across_joints(&*kind.shape),
                order: *order,
                modes: if *more_modes {
                    listed(modes + modes / 4 + 1).min(MOST_MODES)
                } else {
                    *modes
                },
            })
        })
        .collect();
    let refined = kinds.iter().zip(group_of).map(|(kind, group)| match group {
        Some(group) => Kind {
            resolution: finer[group].clone(),
            ..kind.clone()
        },
        None => kind.clone(),
    });
    refined.collect()
}

/// The kind with some of its panels bisected.
pub(crate) fn bisected(kind: &Kind, marked: &[bool]) -> Kind {
    let Resolution {
        panels,
        order,
        modes,
    } = &*kind.resolution;
    let panels = panels.bisected(|panel| marked[panel]);
    Kind {
        resolution: Arc::new(Resolution {
            panels: panels.graded_across_joints(&*kind.shape),
            order: *order,
            modes: *modes,
        }),
        ..kind.clone()
    }
}

/// Which panels a body wants bisected, and whether it wants more modes.
fn wanted(kind: &Kind, miss: &Miss, allowed: f64) -> (Vec<bool>, bool) {
    let n_max = kind.resolution.modes;
    let beyond = miss
        .modes
        .iter()
        .skip(n_max + 1)
        .fold(0.0, |a: f64, &b| a.max(b));
    let more_modes = beyond > 0.25 * allowed;
    let worst = miss.panels.iter().fold(0.0, |a: f64, &b| a.max(b));
    let threshold = allowed.max(0.02 * worst);
    let marked: Vec<bool> = (miss.panels.iter())
        .map(|&of_panel| of_panel > threshold)
        .collect();
    if more_modes || marked.contains(&true) {
        return (marked, more_modes);
    }
    // Nothing stands out: a little of everything.
    let marked = miss.panels.iter().map(|&p| p >= 0.5 * worst).collect();
    (marked, true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::Role;
    use bodies_of_revolution::Spheroid;
    use stokes_body::dirichlet::Formulation;

    fn kind(panels: usize, modes: usize) -> Kind {
        let curve: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::new(1.0, 0.6).unwrap());
        Kind {
            resolution: Arc::new(Resolution {
                panels: Panels::equal_arcs(&*curve, panels).unwrap(),
                order: 16,
                modes,
            }),
            shape: curve,
            role: Role::Held(Formulation::CombinedField),
        }
    }

    /// What is refined of four panels and eight modes.
    fn refined_of(panels: [f64; 4], beyond: f64, allowed: f64) -> (usize, usize) {
        let mut modes = vec![1e-3; 9];
        modes.extend([beyond; 3]);
        let largest = panels.iter().fold(beyond, |most, &p| most.max(p));
        let miss = Miss {
            largest,
            panels: panels.to_vec(),
            modes,
        };
        let finer = &refined(&[kind(4, 8)], &[miss], |_| allowed)[0].resolution;
        (finer.panels.len(), finer.modes)
    }

    #[test]
    fn what_is_missing_is_refined() {
        // A panel that stands out; modes that are missing, which all panels feel; both; nothing but
        // a little of that; nothing.
        assert_eq!(refined_of([1e-3, 1e-6, 1e-6, 1e-6], 1e-9, 1e-5), (5, 8));
        assert_eq!(refined_of([1e-6; 4], 1e-3, 1e-5), (4, 12));
        assert_eq!(refined_of([3e-2, 2e-6, 3e-6, 1e-6], 1e-3, 1e-5), (5, 12));
        assert_eq!(refined_of([1.8e-6; 4], 2e-6, 1.9e-6), (4, 12));
        assert_eq!(refined_of([2e-6; 4], 2e-6, 2.1e-6), (4, 8));
    }
}
