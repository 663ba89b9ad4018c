//! Grand matrices of random clusters: symmetric, positive, and the same in any frame and units.

use axistokes::geometry::{Placed, gaps};
use axistokes::{Body, Frame, Options, Silent, Solver, Suspension};
use nalgebra::{DMatrix, Point3, Rotation3, Unit};

use super::common::{Curve, apart, asymmetry, direction, random, spheroid};

/// Three to five bodies of three shapes and different scales, at least `least` apart.
fn cluster(seed: u64, least: f64) -> Suspension {
    let mut rng = fastrand::Rng::with_seed(seed);
    let curves: [Curve; 3] = [spheroid(1.0, 1.0), spheroid(1.0, 0.5), spheroid(0.6, 1.0)];
    let count = if seed < 2 { 3 } else { rng.usize(3..=5) };
    let mut bodies: Vec<Body> = Vec::new();
    while bodies.len() < count {
        let center = Point3::from(4.0 * random(&mut rng));
        let frame = Frame::along(center, direction(&mut rng)).scaled(0.5 + rng.f64());
        bodies.push(Body::new(curves[rng.usize(0..3)].clone(), frame));
        let placed: Vec<Placed<'_>> = (bodies.iter())
            .map(|body| Placed {
                curve: &*body.shape,
                frame: body.frame,
                reach: least,
            })
            .collect();
        if !gaps(&placed)
            .expect("gaps")
            .iter()
            .all(|gap| gap.distance > least)
        {
            bodies.pop();
        }
    }
    Suspension::new(bodies)
}

/// The figures of one cluster.
fn check(seed: u64, least: f64, tolerance: f64) {
    let cluster = cluster(seed, least);
    let begin = std::time::Instant::now();
    let mut solver = Solver::new(Options::tolerance(tolerance));
    let found = solver.grand_mobility(&cluster, &Silent).expect("a matrix");
    let asymmetry = asymmetry(&found.matrix);
    let smallest = (0.5 * (&found.matrix + found.matrix.transpose()))
        .symmetric_eigenvalues()
        .min();
    println!(
        "cluster {seed}, {} bodies: asymmetry {asymmetry:.1e}, estimate {:.1e}, least eigenvalue {smallest:.2e} of {:.2e}, {:.1} s",
        cluster.bodies.len(),
        found.error_estimate,
        found.matrix.amax(),
        begin.elapsed().as_secs_f64()
    );
    assert!(found.error_estimate <= tolerance && asymmetry <= 0.1 * tolerance && smallest > 0.0);
}

#[test]
fn have_symmetric_positive_mobilities() {
    check(1, 0.5, 1e-7);
}

#[test]
#[ignore = "minutes"]
fn all_have_symmetric_positive_mobilities() {
    (0..20).for_each(|seed| check(seed, 0.5, 1e-9));
}

#[test]
fn look_the_same_from_any_side() {
    let mut rng = fastrand::Rng::with_seed(7);
    let mut cluster = cluster(0, 0.2);
    cluster.bodies.truncate(2);
    let rotation = Rotation3::from_axis_angle(&direction(&mut rng), 2.0);
    let shift = 10.0 * random(&mut rng);
    let moved = |place: &dyn Fn(&Frame) -> Frame| {
        let mut moved = cluster.clone();
        for body in &mut moved.bodies {
            body.frame = place(&body.frame);
        }
        moved
    };
    let turned = moved(&|frame| {
        let center = rotation * frame.center() + shift;
        let axis = Unit::new_normalize(rotation * frame.axis().into_inner());
        Frame::along(center, axis).scaled(frame.scale())
    });
    let enlarged = moved(&|frame| {
        Frame::along(3.0 * frame.center(), frame.axis()).scaled(3.0 * frame.scale())
    });
    let count = 6 * cluster.bodies.len();
    let turn = DMatrix::from_fn(count, count, |i, j| {
        if i / 3 == j / 3 {
            rotation[(i % 3, j % 3)]
        } else {
            0.0
        }
    });
    // Forces per velocity are a length, torques per velocity an area, torques per angular velocity
    // a volume.
    let power = |i: usize, j: usize| 1 + (i / 3 % 2) as i32 + (j / 3 % 2) as i32;
    let lengths = DMatrix::from_fn(count, count, |i, j| 3f64.powi(power(i, j)));
    let mobility = |s: &Suspension| {
        let mut solver = Solver::new(Options::tolerance(1e-4));
        solver.grand_mobility(s, &Silent).expect("a matrix").matrix
    };
    let [own, of_turned, of_enlarged] = [&cluster, &turned, &enlarged].map(mobility);
    let errors = [
        apart(&of_turned, &(&turn * &own * turn.transpose())),
        apart(&of_enlarged.component_mul(&lengths), &own),
    ];
    println!("turned {:.1e}, enlarged {:.1e}", errors[0], errors[1]);
    assert!(errors[0] <= 5e-6 && errors[1] <= 6e-8);
}
