//! Overlapping bodies: depths that are known, those of other methods, and bounds.

use nalgebra::{Matrix3, Point3, UnitQuaternion, Vector3};

use super::tests::{Z, at, direction, gap_of, scaled};
use super::*;
use crate::curve::{Biconcave, Capsule, GeneratingCurve, Spheroid, Torus};
use crate::frame::Frame;

/// The penetration depth that is exact, after what holds of every such gap has been checked.
fn depth_of(a: Placed<'_>, b: Placed<'_>) -> f64 {
    let gap = gap_of(a, b);
    let Some(Depth::Exact(depth)) = gap.depth else {
        panic!("{gap:?}");
    };
    assert_eq!(gap.distance, -depth);
    opposite(&gap);
    depth
}

/// Checks that the normals are opposite, and the segment between the points parallel to them.
fn opposite(gap: &Gap) {
    let [n, m] = gap.normals;
    assert!(
        (n.norm() - 1.0).abs() < 1e-14 && (n + m).norm() < 1e-9,
        "{gap:?}"
    );
    let between = gap.points[1] - gap.points[0];
    let off = (between - n * gap.distance).norm();
    assert!(off < 1e-9 * gap.distance.abs().max(1.0), "{gap:?}");
}

#[test]
fn spheres_in_each_other() {
    let sphere = Spheroid::sphere(1.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(21);
    let mut worst = 0.0_f64;
    for distance in [1.999, 1.5, 1.0, 0.3, 0.01, 0.0] {
        for radius in [0.01, 0.5, 1.0, 40.0] {
            let from: Vector3<f64> = direction(&mut chance).into();
            let n: Vector3<f64> = direction(&mut chance).into();
            let distance = 0.5 * distance * (1.0 + radius);
            let first = at(&sphere, from.into(), direction(&mut chance));
            let to = from + n * distance;
            let second = scaled(radius, at(&sphere, to.into(), direction(&mut chance)));
            let error = depth_of(first, second) - (1.0 + radius - distance);
            worst = worst.max(error.abs() / (1.0 + radius));
        }
    }
    assert!(worst < 4e-15, "{worst:e}");
}

/// A capsule is a segment with a ball around each of its points, so that the depth of two is that
/// of two segments' difference.
#[test]
fn capsules_in_others() {
    let sphere = Spheroid::sphere(0.7).unwrap();
    let rod = Capsule::new(0.5, 3.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(22);
    let mut worst = 0.0_f64;
    for _ in 0..40 {
        let far = [1.0, 0.0, 2.0].map(|x| x * (2.0 * chance.f64() - 1.0));
        let from_segment = far[0].hypot((far[2].abs() - 1.5).max(0.0));
        if from_segment > 1.19 {
            continue;
        }
        let found = depth_of(
            at(&rod, [0.0; 3], Z),
            at(&sphere, far, direction(&mut chance)),
        );
        worst = worst.max((found - (1.2 - from_segment)).abs());
    }
    assert!(worst < 4e-15, "{worst:e}");
    let upright = at(&rod, [0.0; 3], Z);
    for height in [0.0, 0.2, 0.99] {
        let crossing = depth_of(upright, at(&rod, [height, 0.3, 0.4], [0.0, 1.0, 0.2]));
        assert!(
            (crossing - (1.0 - height)).abs() < 1e-14,
            "{height} {crossing}"
        );
        let parallel = depth_of(upright, at(&rod, [height, 0.0, 0.4], Z));
        assert!(
            (parallel - (1.0 - height)).abs() < 1e-14,
            "{height} {parallel}"
        );
        let along = depth_of(upright, at(&rod, [0.0, 0.0, 3.0 + height], Z));
        assert!((along - (1.0 - height)).abs() < 1e-14, "{height} {along}");
    }
}

#[test]
fn spheroids_and_spheres_along_the_axes() {
    for (polar, equatorial) in [(3.0, 1.0), (1.0, 3.0), (0.05, 1.0), (1.0, 0.3)] {
        let body = Spheroid::new(polar, equatorial).unwrap();
        let sphere = Spheroid::sphere(0.5).unwrap();
        let first = at(&body, [0.0; 3], Z);
        // Discs of rims with a small radius of curvature slide off each other when deeper.
        for depth in [1e-6, 1e-4, 2e-3] {
            for (second, center) in [
                (&sphere, [0.0, 0.0, polar + 0.5 - depth]),
                (&sphere, [equatorial + 0.5 - depth, 0.0, 0.0]),
                (&body, [0.0, 0.0, depth - 2.0 * polar]),
                (&body, [0.0, 2.0 * equatorial - depth, 0.0]),
            ] {
                let found = depth_of(first, at(second, center, Z));
                assert!((found - depth).abs() < 1e-14, "{polar} {center:?} {found}");
            }
        }
    }
}

/// A spheroid for a method that has nothing in common with the module: its support function is
/// `c . n + sqrt(n^T A n)`.
struct Ellipsoid {
    center: Vector3<f64>,
    matrix: Matrix3<f64>,
}

impl Ellipsoid {
    fn new([polar, equatorial]: [f64; 2], frame: &Frame) -> Self {
        let axis = *frame.axis();
        let (across, along) = (equatorial * equatorial, polar * polar);
        Self {
            center: frame.center().coords,
            matrix: Matrix3::identity() * across + axis * axis.transpose() * (along - across),
        }
    }

    fn support(&self, n: Vector3<f64>) -> f64 {
        self.center.dot(&n) + n.dot(&(self.matrix * n)).sqrt()
    }
}

/// The largest distance, over the directions, of two ellipsoids: the best of many, and then random
/// steps from the best few.
fn signed_distance(a: &Ellipsoid, b: &Ellipsoid) -> f64 {
    let apart = |n: Vector3<f64>| -a.support(n) - b.support(-n);
    let many = 4000;
    let mut directions: Vec<(f64, Vector3<f64>)> = (0..many)
        .map(|k| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(many);
            let (sin, cos) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let n = Vector3::new(r * cos, r * sin, z);
            (apart(n), n)
        })
        .collect();
    directions.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut chance = fastrand::Rng::with_seed(3);
    let mut largest = f64::NEG_INFINITY;
    for k in [0, 1, 2, 5, 10, 20, 50] {
        let (mut value, mut n) = directions[k];
        let mut step = 0.05;
        while step > 1e-9 {
            let mut better = false;
            for _ in 0..30 {
                let off = Vector3::from_fn(|_, _| 2.0 * chance.f64() - 1.0);
                let there = (n + off * step).normalize();
                if apart(there) > value {
                    (value, n, better) = (apart(there), there, true);
                }
            }
            if !better {
                step *= 0.6;
            }
        }
        largest = largest.max(value);
    }
    largest
}

/// Pairs of spheroids by chance, most of them overlapping; each with the shapes' semi-axes.
fn by_chance(count: usize, each: impl Fn([Placed<'_>; 2], [[f64; 2]; 2])) {
    let mut chance = fastrand::Rng::with_seed(23);
    for _ in 0..count {
        let axes = [(); 2].map(|()| [(); 2].map(|()| 0.2 + 0.8 * chance.f64()));
        let [a, b] = axes.map(|[polar, equatorial]| Spheroid::new(polar, equatorial).unwrap());
        let place = direction(&mut chance).map(|x| x * 1.2 * chance.f64());
        let first = at(&a, [0.0; 3], direction(&mut chance));
        each([first, at(&b, place, direction(&mut chance))], axes);
    }
}

#[test]
fn spheroids_of_chance_agree_with_support_functions() {
    let worst = std::cell::Cell::new([0.0_f64; 2]);
    let overlapping = std::cell::Cell::new(0);
    by_chance(60, |[a, b], axes| {
        let gap = gap_of(a, b);
        opposite(&gap);
        let bodies = [
            Ellipsoid::new(axes[0], &a.frame),
            Ellipsoid::new(axes[1], &b.frame),
        ];
        let error = (gap.distance - signed_distance(&bodies[0], &bodies[1])).abs();
        let deep = usize::from(gap.relation != Relation::Apart);
        overlapping.set(overlapping.get() + deep);
        let mut errors = worst.get();
        errors[deep] = errors[deep].max(error);
        worst.set(errors);
    });
    let [apart, deep] = worst.get();
    assert!(
        overlapping.get() >= 30 && overlapping.get() < 60,
        "{}",
        overlapping.get()
    );
    assert!(apart < 2e-15 && deep < 4e-15, "{apart:e} {deep:e}");
}

#[test]
fn depths_do_not_depend_on_order_frame_and_scale() {
    by_chance(12, |[a, b], _| {
        let gap = gap_of(a, b);
        // `gap_of` looks at the other order.
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -1.2, 0.7));
        for scale in [1.0, 1e-3, 1e4] {
            let moved = [a, b].map(|placed| {
                let frame = placed.frame;
                let center = turn * frame.center() * scale + Vector3::new(0.3, 2.0, -1.0) * scale;
                Placed {
                    frame: Frame::new(center, turn * frame.orientation()).scaled(scale),
                    reach: 10.0 * scale,
                    ..placed
                }
            });
            let there = gaps(&moved).unwrap()[0];
            assert_eq!(there.relation, gap.relation);
            let error = (there.distance / scale - gap.distance).abs();
            assert!(error < 1e-14, "{scale} {error:e} {gap:?}");
        }
    });
}

/// Bodies that are pushed together: the distance falls by no more than the way, without a jump of
/// its slope.
#[test]
fn the_distance_passes_through_zero_smoothly() {
    let sphere = Spheroid::sphere(1.0).unwrap();
    let long = Spheroid::new(1.0, 0.6).unwrap();
    let flat = Spheroid::new(0.5, 1.0).unwrap();
    let rod = Capsule::new(0.6, 1.0).unwrap();
    let pairs: [[&dyn GeneratingCurve; 2]; 3] = [[&sphere; 2], [&long, &flat], [&long, &rod]];
    for [a, b] in pairs {
        let first = at(a, [0.0; 3], [0.2, -0.5, 1.0]);
        let toward = Vector3::new(0.6, 0.48, 0.64);
        let gap_at = |x: f64| gap_of(first, at(b, (toward * x).into(), [1.0, 0.3, 0.4]));
        // Where they touch.
        let mut contact = 4.0;
        for _ in 0..60 {
            contact -= gap_at(contact).distance;
        }
        let step = 1e-3;
        let found: Vec<Gap> = (-1..=200)
            .map(|k| gap_at(contact - step * f64::from(k)))
            .collect();
        assert_eq!(found[0].relation, Relation::Apart);
        assert!(found[0].distance > 0.0 && found[1].distance.abs() < 1e-12);
        for gap in &found {
            opposite(gap);
            assert!(gap.distance >= 0.0 || gap.relation != Relation::Apart);
        }
        for near in found.windows(3) {
            let [x, y, z] = [0, 1, 2].map(|k: usize| near[k].distance);
            assert!(x - y > 0.5 * step && x - y < step + 1e-12, "{x} {y}");
            assert!((x - 2.0 * y + z).abs() < 3.0 * step * step, "{x} {y} {z}");
        }
        // Close to contact on both sides.
        for small in [1e-11, 1e-9, 1e-6] {
            let [out, into] = [small, -small].map(|x| gap_at(contact + x).distance);
            assert!(out > 0.0 && into < 0.0 && (out + into).abs() < 4e-15 + 3.0 * small * small);
        }
    }
}

/// No translation shorter than the bound separates the bodies; where bodies only just overlap the
/// bound is the depth.
#[test]
fn depths_of_bodies_that_are_not_convex_are_bounds() {
    let (torus, sphere) = (
        Torus::new(2.0, 0.5).unwrap(),
        Spheroid::sphere(1.0).unwrap(),
    );
    let cell = Biconcave::new(1.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(25);
    for offset in [0.5 + 1e-9, 0.5001, 0.6, 0.8] {
        let gap = gap_of(at(&torus, [0.0; 3], Z), at(&sphere, [0.0, offset, 0.0], Z));
        let Some(Depth::AtLeast(depth)) = gap.depth else {
            panic!("{gap:?}");
        };
        assert!((depth - (offset - 0.5)).abs() < 1e-14, "{offset} {gap:?}");
    }
    for outer in [&torus as &dyn GeneratingCurve, &cell] {
        for _ in 0..10 {
            let center = direction(&mut chance).map(|x| 1.5 * x);
            let outer = at(outer, [0.0; 3], Z);
            let axis = direction(&mut chance);
            let gap = gap_of(outer, at(&sphere, center, axis));
            if let Some(depth) = gap.depth {
                assert_eq!(depth, Depth::AtLeast(-gap.distance));
                for _ in 0..10 {
                    let way = Vector3::from(direction(&mut chance)) * 0.999 * depth.lower_bound();
                    let there = (Vector3::from(center) + way).into();
                    let moved = gap_of(outer, at(&sphere, there, axis));
                    assert!(moved.depth.is_some(), "{gap:?} {moved:?}");
                }
            }
        }
    }
}

#[test]
fn errors_tell_depths_from_bounds() {
    let (torus, sphere) = (
        Torus::new(2.0, 0.5).unwrap(),
        Spheroid::sphere(1.0).unwrap(),
    );
    let ball = at(&sphere, [0.0, 0.75, 0.0], Z);
    let told = |other| gap_of(ball, other).check(0.0).unwrap_err().to_string();
    assert_eq!(
        told(at(&sphere, [0.0, 2.25, 0.0], Z)),
        "bodies[0] and bodies[1] overlap by 5.000e-1, but must be apart"
    );
    assert_eq!(
        told(at(&torus, [0.0; 3], Z)),
        "bodies[0] and bodies[1] overlap by 2.500e-1 or more, but must be apart"
    );
}

/// The smallest translation of a needle that pierces a wide disc is along the needle.
#[test]
fn a_needle_through_a_disc() {
    let needle = Spheroid::new(0.8, 0.05).unwrap();
    let disc = Spheroid::new(0.1, 2.0).unwrap();
    let gap = gap_of(at(&needle, [0.0; 3], Z), at(&disc, [0.0; 3], Z));
    assert_eq!(gap.relation, Relation::Overlapping);
    assert!((gap.distance + 0.9).abs() < 1e-14, "{gap:?}");
    let tips = gap.points.map(|point: Point3<f64>| point.z.abs());
    assert!(
        (tips[0] - 0.8).abs() < 1e-9 && (tips[1] - 0.1).abs() < 1e-9,
        "{gap:?}"
    );
}
