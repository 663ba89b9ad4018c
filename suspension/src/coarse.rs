//! The second level of the preconditioner: rigid motions.
//!
//! What a held body does to the others far away is the flow of the force and torque that it takes
//! to hold it, and no body can know that by itself. So the rigid motions $c$ of all held bodies are
//! solved for together: a boundary velocity $f_i$ stands for the rigid motion $\Psi_i f_i$ that
//! takes the same force and torque, and motion $c_j$ of body $j$ alone makes body $i$ feel $\Psi_i
//! u_j$. With
//!
//! $$ G = 1 + (\Psi_i u_j)_{i \ne j}, \qquad f \mapsto f + E\\,(G^{-1} - 1)\\,\Psi f, $$
//!
//! where $E$ takes motions to boundary velocities, that part of the interactions is done with. By
//! the reciprocal theorem $\Psi_i f = R_i^{-1} \int \tau_k \cdot f\\, d\Gamma$, with the tractions
//! $\tau_k$ of the six rigid motions and the resistance $R_i$, and the same tractions are the
//! single layers that make $u_j$: so $G = 1 + R^{-1} K$ with a symmetric $K$, which a few points on
//! each body give well enough.

use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

use faer::MatMut;
use nalgebra::{Matrix6, Vector3, Vector6};
use panel_quadrature::{GaussLegendre, QuadratureError};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::constraint::{Constraint, elementary, six_of_wrench};
use super::layout::Layout;
use super::tables::Member;
use f64_lanes::{Lanes, padded};
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::discretization::{Discretization, Node};
use stokes_body::factors::{Permutation, factor_in_place, solve_transpose};
use stokes_body::progress::Silent;
use stokes_body::surface::SurfaceModes;

/// Nodes on the whole curve, and azimuths of each.
const NODES: usize = 10;
const AZIMUTHS: usize = 6;

/// The six rigid motions of a shape, in its frame. Angular velocities are in units of 1/size, so
/// that all six are velocities: with others $G$ would have entries too different to be factored.
#[derive(Debug)]
pub(crate) struct RigidTractions {
    /// Angular velocities are so many times those of the six motions.
    per_size: f64,
    /// Points on the surface and, motion by motion, the force of the traction on the point's share
    /// of it.
    points: Vec<Vector3<f64>>,
    forces: Vec<SixForces>,
    /// $R^{-1}$.
    mobility: Matrix6<f64>,
    /// $E$ and, with the same numbers, the functionals $\int \tau_k \cdot f$: scaled modes 0 and 1,
    /// motion by motion.
    motions: Vec<Vec<f64>>,
    functionals: Vec<Vec<f64>>,
}

/// At one point, the forces of the six motions.
type SixForces = [Vector3<f64>; 6];

impl RigidTractions {
    /// The tractions of a shape.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(discretization: &Discretization) -> Result<Self, QuadratureError> {
        let solver =
            DirichletSolver::new(discretization.clone(), Formulation::SingleLayer, 1, &Silent)?;
        let per_size = 1.0 / discretization.size();
        let units = units(per_size);
        let motions: Vec<SurfaceModes> = (0..6)
            .map(|k| SurfaceModes::of_motion(discretization, &elementary(k)).scaled(units[k]))
            .collect();
        let tractions: Vec<SurfaceModes> = motions.iter().map(|on| solver.solve(on)).collect();
        let columns: Vec<Vector6<f64>> = tractions
            .iter()
            .map(|traction| six_of_wrench(solver.wrench(traction)).component_mul(&units))
            .collect();
        let resistance = Matrix6::from_columns(&columns);
        let mobility = resistance.try_inverse().unwrap_or_else(Matrix6::zeros);
        let scaled = |field: &SurfaceModes| field.scaled_by_roots(discretization);
        let functionals = tractions.iter().map(|traction| {
            let mut functional = scaled(traction);
            let of_mode = functional.len() / traction.modes();
            for (place, value) in functional.iter_mut().enumerate() {
                // The integral of the square of what a component comes with.
                *value *= if place < of_mode { 2.0 * PI } else { PI };
            }
            functional
        });
        let (points, forces) = coarse_points(discretization, &tractions)?;
        Ok(Self {
            per_size,
            points,
            forces,
            mobility,
            functionals: functionals.collect(),
            motions: motions.iter().map(scaled).collect(),
        })
    }

    /// The rigid motion that a boundary velocity stands for.
    fn motion_of(&self, field: &[f64]) -> Vector6<f64> {
        let products = self.functionals.iter().map(|functional| {
            let both = functional.iter().zip(field);
            both.map(|(a, b)| a * b).sum::<f64>()
        });
        self.mobility * Vector6::from_iterator(products)
    }

    /// Adds a rigid motion to a boundary velocity.
    fn add(&self, motion: &[f64], field: &mut [f64]) {
        for (on, by) in self.motions.iter().zip(motion) {
            for (to, from) in field.iter_mut().zip(on) {
                *to += by * from;
            }
        }
    }
}

/// The six motions in units of 1 and 1/length.
fn units(per_size: f64) -> Vector6<f64> {
    Vector6::new(1.0, 1.0, 1.0, per_size, per_size, per_size)
}

/// A few points on the whole curve with the forces of the tractions.
fn coarse_points(
    discretization: &Discretization,
    tractions: &[SurfaceModes],
) -> Result<(Vec<Vector3<f64>>, Vec<SixForces>), QuadratureError> {
    let curve = discretization.curve();
    let panels = discretization.panels().as_slice();
    let (order, basis) = (discretization.order(), discretization.basis());
    let breakpoints = curve.breakpoints();
    let per_piece = (NODES / (breakpoints.len() - 1)).max(4);
    let rule = GaussLegendre::new(per_piece)?;
    let (mut points, mut forces) = (Vec::new(), Vec::new());
    let mut row = vec![0.0; order];
    for piece in breakpoints.windows(2) {
        let half = 0.5 * (piece[1] - piece[0]);
        for (x, w) in rule.iter() {
            let s = piece[0] + half * (1.0 + x);
            let node = Node::new(&**curve, s, half * w);
            let panel = panels.partition_point(|p| p.end < s).min(panels.len() - 1);
            let on = &panels[panel];
            basis.interpolation_row((s - on.start) / (0.5 * on.length()) - 1.0, &mut row)?;
            let at = |traction: &SurfaceModes, theta: f64| -> Vector3<f64> {
                let mut sum = Vector3::zeros();
                for (i, l) in row.iter().enumerate() {
                    sum += *l * Vector3::from(traction.at(panel * order + i, theta));
                }
                sum
            };
            for l in 0..AZIMUTHS {
                let theta = 2.0 * PI * l as f64 / AZIMUTHS as f64;
                let (sin, cos) = theta.sin_cos();
                let share = node.weight * 2.0 * PI / AZIMUTHS as f64;
                points.push(Vector3::new(node.r * cos, node.r * sin, node.z));
                let of: Vec<Vector3<f64>> = tractions
                    .iter()
                    .map(|traction| {
                        let v = at(traction, theta);
                        share * Vector3::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos, v.z)
                    })
                    .collect();
                forces.push(std::array::from_fn(|k| of[k]));
            }
        }
    }
    Ok((points, forces))
}

/// The rigid motions of all held bodies.
pub(crate) struct Coarse {
    /// The held bodies, with their tractions.
    bodies: Vec<(usize, Arc<RigidTractions>)>,
    /// Factors of $G$ transposed, in its place.
    rows: Vec<f64>,
    permutation: Permutation,
}

/// Points and forces of a body in the laboratory: coordinates, then the components of each motion's
/// forces; padded by points without force.
struct InLab {
    position: [Vec<f64>; 3],
    forces: Vec<[Vec<f64>; 3]>,
    /// The force of body `j` on the fluid is its shape's times this.
    scale: f64,
}

impl InLab {
    fn new(member: &Member, tractions: &RigidTractions) -> Self {
        let (frame, count) = (&member.frame, tractions.points.len());
        let last = count - 1;
        let place = |i: usize| tractions.points[i.min(last)];
        let all = 0..padded(count);
        let position = [0, 1, 2].map(|k| {
            let at = |i: usize| frame.point_to_lab(place(i).into())[k];
            all.clone().map(at).collect()
        });
        let force = |motion: usize, k: usize, i: usize| {
            if i < count {
                frame.vector_to_lab(tractions.forces[i][motion])[k]
            } else {
                0.0
            }
        };
        let forces = (0..6)
            .map(|motion| [0, 1, 2].map(|k| all.clone().map(|i| force(motion, k, i)).collect()));
        Self {
            position,
            forces: forces.collect(),
            scale: frame.scale(),
        }
    }
}

impl Coarse {
    /// Factors $G$ for bodies with tractions; those without are free. A body that is free in some
    /// directions feels the others through its projection $\Pi$, which on motions is $1 - HR$.
    pub fn new(
        members: &[Member],
        tractions: Vec<Option<Arc<RigidTractions>>>,
        constraints: &[Option<Constraint>],
    ) -> Option<Self> {
        let bodies: Vec<(usize, Arc<RigidTractions>)> = tractions
            .into_iter()
            .enumerate()
            .filter_map(|(body, tractions)| Some((body, tractions?)))
            .collect();
        if bodies.len() < 2 {
            return None;
        }
        let in_lab: Vec<InLab> = bodies
            .iter()
            .map(|(body, tractions)| InLab::new(&members[*body], tractions))
            .collect();
        let count = bodies.len();
        // K is symmetric: of the bodies before each.
        let before: Vec<Vec<Matrix6<f64>>> = (0..count)
            .into_par_iter()
            .map(|i| {
                let of_pair = |other| energy(&in_lab[i], other);
                in_lab[..i].iter().map(of_pair).collect()
            })
            .collect();
        let size = 6 * count;
        // Row after row, which is the transposed matrix column after column.
        let mut rows = vec![0.0; size * size];
        for (i, (rows, (body, tractions))) in rows.chunks_mut(6 * size).zip(&bodies).enumerate() {
            let felt = match &constraints[*body] {
                Some(constraint) => {
                    let per_size = tractions.per_size;
                    let [to, from] = [1.0 / per_size, per_size].map(units);
                    let projected = constraint.on_motions() * Matrix6::from_diagonal(&from);
                    Matrix6::from_diagonal(&to) * projected * tractions.mobility
                }
                None => tractions.mobility,
            };
            for (j, other) in in_lab.iter().enumerate() {
                let block = match i.cmp(&j) {
                    Ordering::Less => other.scale * felt * before[j][i].transpose(),
                    Ordering::Equal => Matrix6::identity(),
                    Ordering::Greater => other.scale * felt * before[i][j],
                };
                for (k, row) in rows.chunks_mut(size).enumerate() {
                    for l in 0..6 {
                        row[6 * j + l] = block[(k, l)];
                    }
                }
            }
        }
        let permutation = factor_in_place(&mut rows, size);
        Some(Self {
            bodies,
            rows,
            permutation,
        })
    }

    /// Improves a boundary velocity, scaled modes of all bodies.
    pub fn apply(&self, layout: &Layout, field: &mut [f64]) {
        let of_all = self.bodies.par_iter().map(|(body, tractions)| {
            let motion = tractions.motion_of(&field[layout.of(*body)]);
            motion.iter().copied().collect::<Vec<f64>>()
        });
        let before: Vec<f64> = of_all.collect::<Vec<_>>().concat();
        let mut after = before.clone();
        let column = MatMut::from_column_major_slice_mut(&mut after, before.len(), 1);
        solve_transpose(&self.rows, &self.permutation, column);
        for (index, (body, tractions)) in self.bodies.iter().enumerate() {
            let change: [f64; 6] = std::array::from_fn(|k| {
                let place = 6 * index + k;
                after[place] - before[place]
            });
            tractions.add(&change, &mut field[layout.of(*body)]);
        }
    }
}

/// $\sum \tau_k(x) \cdot S(x - y)\\, \tau_l(y)$ over the points of two bodies.
fn energy(targets: &InLab, sources: &InLab) -> Matrix6<f64> {
    Arch::new().dispatch(Energy { targets, sources })
}

struct Energy<'a> {
    targets: &'a InLab,
    sources: &'a InLab,
}

impl WithSimd for Energy<'_> {
    type Output = Matrix6<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Matrix6<f64> {
        let Self { targets, sources } = self;
        let splat = |x| Lanes::splat(simd, x);
        let registers = sources.position[0].len() / S::F64_LANES;
        let mut sum = Matrix6::zeros();
        for m in 0..targets.position[0].len() {
            let x = [0, 1, 2].map(|k| splat(targets.position[k][m]));
            let mut velocity = [[splat(0.0); 3]; 6];
            for register in 0..registers {
                let d = [
                    x[0] - Lanes::load(simd, &sources.position[0], register),
                    x[1] - Lanes::load(simd, &sources.position[1], register),
                    x[2] - Lanes::load(simd, &sources.position[2], register),
                ];
                let square = d[0].mul_add(d[0], d[1].mul_add(d[1], d[2] * d[2]));
                let inv2 = 1.0 / square;
                let inv = inv2.sqrt();
                let cube = inv * inv2;
                for (velocity, force) in velocity.iter_mut().zip(&sources.forces) {
                    let f = [
                        Lanes::load(simd, &force[0], register),
                        Lanes::load(simd, &force[1], register),
                        Lanes::load(simd, &force[2], register),
                    ];
                    let along = cube * d[0].mul_add(f[0], d[1].mul_add(f[1], d[2] * f[2]));
                    for k in 0..3 {
                        velocity[k] += along.mul_add(d[k], inv * f[k]);
                    }
                }
            }
            for (l, velocity) in velocity.iter().enumerate() {
                let u = [velocity[0].sum(), velocity[1].sum(), velocity[2].sum()];
                for (k, force) in targets.forces.iter().enumerate() {
                    sum[(k, l)] += (0..3).map(|j| force[j][m] * u[j]).sum::<f64>();
                }
            }
        }
        sum / (8.0 * PI)
    }
}
