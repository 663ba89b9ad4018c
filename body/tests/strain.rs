//! Functions of strain against closed forms, the reciprocal theorem, and shifts of the origin.

use std::f64::consts::PI;
use std::sync::Arc;

use bodies_of_revolution::{
    GeneratingCurve, Meridian, Panels, Polar, RigidMotion, Spheroid, Topology, Wrench,
};
use nalgebra::{Matrix3, Vector3};
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::discretization::Discretization;
use stokes_body::layers::Layers;
use stokes_body::linear_flow::LinearFlow;
use stokes_body::mobility::MobilitySolver;
use stokes_body::progress::Silent;
use stokes_body::resistance::RigidBodyMatrices;
use stokes_body::strain::{FreeBodyFunctions, StrainFunctions};
use stokes_body::stresslet::stresslet;
use stokes_body::surface::SurfaceModes;

fn matrices(curve: Arc<dyn GeneratingCurve>) -> RigidBodyMatrices {
    RigidBodyMatrices::to_tolerance(curve, 1e-12, &Silent).expect("matrices")
}

fn pear() -> Polar {
    Polar::new(&[1.0, 0.3, 0.1, 0.15]).expect("a pear")
}

/// The largest error of six functions in units of length³, or made so by `size`.
fn difference(a: [f64; 6], b: [f64; 6], size: f64) -> f64 {
    let scales = [size, size, 1.0, 1.0, 1.0, 1.0];
    let errors = a
        .iter()
        .zip(b)
        .zip(scales)
        .map(|((a, b), s)| s * (a - b).abs());
    errors.fold(0.0, f64::max) / size.powi(3)
}

/// Errors as they are printed.
fn digits(errors: &[f64]) -> String {
    let digits: Vec<String> = errors.iter().map(|x| format!("{x:.0e}")).collect();
    digits.join(" ")
}

fn of_held(f: &StrainFunctions) -> [f64; 6] {
    [f.xg, f.yg, f.yh, f.xm, f.ym, f.zm]
}

#[test]
fn of_a_sphere_are_exact() {
    let radius = 2.0;
    let found = matrices(Arc::new(Spheroid::sphere(radius).expect("a sphere")));
    let m = 20.0 / 3.0 * PI * radius.powi(3);
    let held = difference(of_held(&found.strain), [0.0, 0.0, 0.0, m, m, m], radius);
    let free = &found.free;
    let of_free = [free.xm, free.ym, free.zm].map(|x| (x / m - 1.0).abs());
    let of_free = of_free.into_iter().fold(0.0, f64::max);
    let coupling = [free.xg, free.yg, free.yh].map(f64::abs);
    let viscosities = [
        free.intrinsic_viscosity(found.volume),
        free.brownian_intrinsic_viscosity(found.volume, &found.mobility.scalar_functions()),
    ];
    println!(
        "sphere: held {held:.1e}, free {of_free:.1e}, {}, {viscosities:?}",
        digits(&coupling)
    );
    assert!(held <= 1e-13 && of_free <= 1e-14);
    assert!(coupling.into_iter().all(|x| x <= 1e-14));
    assert!(viscosities.into_iter().all(|x| (x - 2.5).abs() <= 1e-13));
}

#[test]
fn of_spheroids_are_those_of_the_closed_forms() {
    let table = include_str!("../../tests/data/strain_spheroid.csv");
    for line in table
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
    {
        let row: Vec<f64> = line
            .split(',')
            .map(|x| x.parse().expect("a number"))
            .collect();
        let [polar, equatorial] = [row[0], row[1]];
        let found = matrices(Arc::new(
            Spheroid::new(polar, equatorial).expect("a spheroid"),
        ));
        let mobility = found.mobility.scalar_functions();
        let (held, free) = (&found.strain, &found.free);
        let values = [
            held.xm,
            held.ym,
            held.zm,
            held.yh,
            free.ym,
            free.bretherton_constant(),
            free.intrinsic_viscosity(found.volume),
            free.brownian_intrinsic_viscosity(found.volume, &mobility),
        ];
        let errors: Vec<f64> = values
            .iter()
            .zip(&row[2..])
            .map(|(x, exact)| (x / exact - 1.0).abs())
            .collect();
        let q2 = (polar / equatorial).powi(2);
        let jeffery = (q2 - 1.0) / (q2 + 1.0);
        let of_held = 2.0 * held.yh / found.resistance.scalar_functions().yc;
        let of_bretherton = [free.bretherton_constant(), of_held]
            .map(|b| (b / jeffery - 1.0).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let of_free = [free.xm / held.xm, free.zm / held.zm].map(|x| (x - 1.0).abs());
        println!(
            "{polar} : {equatorial}: {}, Bretherton {of_bretherton:.0e}, free {}, estimate {:.0e}",
            digits(&errors),
            digits(&of_free),
            found.error_estimate
        );
        assert!(errors.iter().all(|&error| error <= 2e-13));
        assert!(of_bretherton <= 1e-12 && of_free.into_iter().all(|x| x <= 1e-12));
        // The centre is a centre of symmetry.
        assert!(
            [held.xg, held.yg, free.xg, free.yg]
                .into_iter()
                .all(|x| x.abs() <= 1e-12)
        );
    }
}

/// The tensors of one body as Kim & Karrila write them, for a vector or a strain at a time.
struct Tensors([f64; 6]);

impl Tensors {
    fn held(f: &StrainFunctions) -> Self {
        Self(of_held(f))
    }

    fn free(f: &FreeBodyFunctions) -> Self {
        Self([f.xg, f.yg, f.yh, f.xm, f.ym, f.zm])
    }

    /// Component `ijk` of $G$.
    fn g(&self, [i, j, k]: [usize; 3]) -> f64 {
        let [xg, yg, ..] = self.0;
        let (d, delta): (Vector3<f64>, Matrix3<f64>) = (Vector3::z(), Matrix3::identity());
        xg * (d[i] * d[j] - delta[(i, j)] / 3.0) * d[k]
            + yg * (d[i] * delta[(j, k)] + d[j] * delta[(i, k)] - 2.0 * d[i] * d[j] * d[k])
    }

    /// Component `ijk` of $H$; $\epsilon_{ikl} d_l$ is component $k$ of $d \times e_i$.
    fn h(&self, [i, j, k]: [usize; 3]) -> f64 {
        let d = Vector3::<f64>::z();
        let turned = |i: usize| d.cross(&Vector3::ith(i, 1.0))[k];
        self.0[2] * (turned(i) * d[j] + turned(j) * d[i])
    }

    /// Component `ijkl` of $M$, by Kim & Karrila's $d^{(m)}_{ijkl}$.
    fn m(&self, [i, j, k, l]: [usize; 4]) -> f64 {
        let [.., xm, ym, zm] = self.0;
        let (d, one): (Vector3<f64>, Matrix3<f64>) = (Vector3::z(), Matrix3::identity());
        let delta = |i: usize, j: usize| one[(i, j)];
        let dyads = d[i] * d[k] * delta(j, l)
            + d[i] * d[l] * delta(j, k)
            + d[j] * d[k] * delta(i, l)
            + d[j] * d[l] * delta(i, k);
        let d4 = d[i] * d[j] * d[k] * d[l];
        let d0 = 1.5 * (d[i] * d[j] - delta(i, j) / 3.0) * (d[k] * d[l] - delta(k, l) / 3.0);
        let d1 = 0.5 * (dyads - 4.0 * d4);
        let d2 = 0.5
            * (delta(i, k) * delta(j, l) + delta(j, k) * delta(i, l) - delta(i, j) * delta(k, l)
                + d[i] * d[j] * delta(k, l)
                + delta(i, j) * d[k] * d[l]
                - dyads
                + d4);
        xm * d0 + ym * d1 + zm * d2
    }

    /// $G_{ijk} u_k + H_{ijk} \omega_k$.
    fn of_vectors(&self, u: Vector3<f64>, omega: Vector3<f64>) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| {
            let part = |k| self.g([i, j, k]) * u[k] + self.h([i, j, k]) * omega[k];
            (0..3).map(part).sum()
        })
    }

    /// $G_{jki} E_{jk}$ and $H_{jki} E_{jk}$.
    fn of_strain(&self, strain: &Matrix3<f64>) -> [Vector3<f64>; 2] {
        let sum = |f: &dyn Fn(usize, usize) -> f64| -> f64 {
            (0..9)
                .map(|n| f(n / 3, n % 3) * strain[(n / 3, n % 3)])
                .sum()
        };
        [
            Vector3::from_fn(|i, _| sum(&|j, k| self.g([j, k, i]))),
            Vector3::from_fn(|i, _| sum(&|j, k| self.h([j, k, i]))),
        ]
    }

    /// $M_{ijkl} E_{kl}$.
    fn stresslet(&self, strain: &Matrix3<f64>) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| {
            (0..9)
                .map(|n| self.m([i, j, n / 3, n % 3]) * strain[(n / 3, n % 3)])
                .sum()
        })
    }
}

/// A strain without any symmetry.
fn strain() -> Matrix3<f64> {
    Matrix3::new(0.3, -0.7, 0.4, -0.7, -1.1, 0.9, 0.4, 0.9, 0.8)
}

fn discretization(curve: impl GeneratingCurve + 'static) -> Discretization {
    let panels = Panels::resolving(&curve, 16, 1e-10).expect("panels");
    Discretization::new(Arc::new(curve), panels, 16).expect("nodes")
}

/// The velocity of a strain on the surface, times a factor.
fn strained(discretization: &Discretization, factor: f64) -> SurfaceModes {
    let flow = LinearFlow {
        velocity: Vector3::zeros(),
        gradient: strain(),
    };
    flow.on(discretization).modes.scaled(factor)
}

/// The reciprocal theorem: the stresslet of a moving pear has the functions of the force and torque
/// on a held one, and all have the form of the tensors.
#[test]
fn of_a_held_pear_are_reciprocal() {
    let found = matrices(Arc::new(pear()));
    let tensors = Tensors::held(&found.strain);
    let solver = DirichletSolver::new(
        discretization(pear()),
        Formulation::CombinedField,
        2,
        &Silent,
    )
    .expect("a solver");
    let nodes = solver.discretization();
    let stresslet_of =
        |density: &SurfaceModes| stresslet(nodes, &Layers::weighted(density, solver.weights()));

    let (velocity, angular_velocity) = (Vector3::new(0.3, -0.8, 0.6), Vector3::new(-0.5, 0.4, 0.7));
    let motion = RigidMotion {
        velocity,
        angular_velocity,
    };
    let moving = stresslet_of(&solver.solve(&SurfaceModes::of_motion(nodes, &motion)));
    let of_motion = (moving + tensors.of_vectors(velocity, angular_velocity)).amax();

    let density = solver.solve(&strained(nodes, -1.0));
    let Wrench { force, torque } = solver.wrench(&density);
    let [of_force, of_torque] = tensors.of_strain(&strain());
    let of_wrench = f64::max((force + of_force).amax(), (torque + of_torque).amax());
    let of_strain = (stresslet_of(&density) - tensors.stresslet(&strain())).amax();
    println!(
        "held pear: {:?}; moving {of_motion:.1e}, force {of_wrench:.1e}, stresslet {of_strain:.1e}",
        found.strain
    );
    assert!(of_motion <= 1e-11 && of_wrench <= 1e-11 && of_strain <= 1e-11);
    let StrainFunctions { xg, yg, yh, .. } = found.strain;
    assert!([xg, yg, yh].into_iter().all(|x| x.abs() > 0.1));
}

/// The same of a free pear: its stresslet under force and torque has the functions of its motion.
#[test]
fn of_a_free_pear_are_reciprocal() {
    let found = matrices(Arc::new(pear()));
    let tensors = Tensors::free(&found.free);
    let solver = MobilitySolver::new(discretization(pear()), 2, &Silent).expect("a solver");
    let nodes = solver.discretization();

    let (force, torque) = (Vector3::new(0.3, -0.8, 0.6), Vector3::new(-0.5, 0.4, 0.7));
    let at_rest = SurfaceModes::zero(0, nodes.nodes().len());
    let (_, layers) = solver.solve(Wrench { force, torque }, at_rest);
    let of_wrench = (stresslet(nodes, &layers) + tensors.of_vectors(force, torque)).amax();

    let free = Wrench {
        force: Vector3::zeros(),
        torque: Vector3::zeros(),
    };
    let (motion, layers) = solver.solve(free, strained(nodes, -1.0));
    let [velocity, angular_velocity] = tensors.of_strain(&strain());
    let of_motion = f64::max(
        (motion.velocity - velocity).amax(),
        (motion.angular_velocity - angular_velocity).amax(),
    );
    let of_strain = (stresslet(nodes, &layers) - tensors.stresslet(&strain())).amax();
    println!(
        "free pear: {:?}; forced {of_wrench:.1e}, motion {of_motion:.1e}, stresslet {of_strain:.1e}",
        found.free
    );
    assert!(of_wrench <= 1e-12 && of_motion <= 1e-12 && of_strain <= 1e-11);
}

/// A body moved along its axis.
#[derive(Debug)]
struct Raised<C>(C, f64);

impl<C: GeneratingCurve> GeneratingCurve for Raised<C> {
    fn breakpoints(&self) -> Vec<f64> {
        self.0.breakpoints()
    }

    fn topology(&self) -> Topology {
        self.0.topology()
    }

    fn point(&self, s: f64) -> Meridian {
        let Meridian { r, z } = self.0.point(s);
        Meridian { r, z: z + self.1 }
    }

    fn tangent(&self, s: f64) -> Meridian {
        self.0.tangent(s)
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        self.0.chord(s, ds)
    }
}

#[test]
fn of_a_raised_body_are_those_about_a_lower_point() {
    let height = 0.7;
    let curves: [(Arc<dyn GeneratingCurve>, Arc<dyn GeneratingCurve>); 2] = [
        (
            Arc::new(Spheroid::sphere(1.0).expect("a sphere")),
            Arc::new(Raised(Spheroid::sphere(1.0).expect("a sphere"), height)),
        ),
        (Arc::new(pear()), Arc::new(Raised(pear(), height))),
    ];
    for (curve, raised) in curves {
        let (found, raised) = (matrices(curve), matrices(raised));
        let held = found
            .strain
            .about(-height, &found.resistance.scalar_functions());
        let of_held = difference(of_held(&held), of_held(&raised.strain), 1.0);
        let free = found.free.about(-height);
        let values = |f: &FreeBodyFunctions| [f.xg, f.yg, f.yh, f.xm, f.ym, f.zm];
        let of_free = difference(values(&free), values(&raised.free), 1.0);
        println!("raised: held {of_held:.1e}, free {of_free:.1e}");
        assert!(of_held <= 1e-11 && of_free <= 1e-11);
    }
}

/// A sphere's functions about a point at height $h$ under its centre: force and stresslet of the
/// sphere in $E (x + h d)$, the stresslet about the lower point.
#[test]
fn of_a_sphere_about_a_lower_point_are_in_closed_form() {
    let h = 0.5;
    let found = matrices(Arc::new(Spheroid::sphere(1.0).expect("a sphere")));
    let below = found.strain.about(-h, &found.resistance.scalar_functions());
    let m = 20.0 / 3.0 * PI;
    let a = 6.0 * PI;
    let exact = [a * h, 0.5 * a * h, 0.5 * a * h * h];
    let moments = [m + a * h * h / 1.5, m + 0.5 * a * h * h, m];
    let exact = [
        exact[0], exact[1], exact[2], moments[0], moments[1], moments[2],
    ];
    assert!(difference(of_held(&below), exact, 1.0) <= 1e-12);
    // It is carried along with its centre, and the fluid's stresslet stays.
    let free = found.free.about(-h);
    assert!((free.xg - h).abs() <= 1e-14 && (free.yg - 0.5 * h).abs() <= 1e-14);
    let freed = below.freed(
        &found
            .resistance
            .about(Vector3::new(0.0, 0.0, -h))
            .scalar_functions(),
    );
    assert!((freed.xg - h).abs() <= 1e-14 && (freed.yg - 0.5 * h).abs() <= 1e-14);
    assert!((freed.xm / m - 1.0).abs() <= 1e-13 && (freed.ym / m - 1.0).abs() <= 1e-13);
    assert!(freed.yh.abs() <= 1e-14);
}
