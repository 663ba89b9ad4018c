use std::f64::consts::PI;

use nalgebra::{Point3, Unit, Vector3};

use super::*;
use crate::curve::{Biconcave, Capsule, GeneratingCurve, Spheroid, Torus};
use crate::frame::Frame;

pub(super) fn at<'a>(
    curve: &'a dyn GeneratingCurve,
    center: [f64; 3],
    axis: [f64; 3],
) -> Placed<'a> {
    Placed {
        curve,
        frame: Frame::along(center.into(), Unit::new_normalize(axis.into())),
        reach: 10.0,
    }
}

pub(super) fn scaled<'a>(scale: f64, placed: Placed<'a>) -> Placed<'a> {
    Placed {
        frame: placed.frame.scaled(scale),
        ..placed
    }
}

pub(super) const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// The gap of two bodies; it must be the same the other way round, and its points so far apart.
pub(super) fn gap_of(a: Placed<'_>, b: Placed<'_>) -> Gap {
    let found = gaps(&[a, b]).unwrap();
    assert_eq!(found.len(), 1);
    let back = gaps(&[b, a]).unwrap()[0];
    assert!(
        found[0].distance == back.distance
            || found[0].relation != Relation::Apart
            || (found[0].distance - back.distance).abs() < 1e-13
    );
    let apart = (found[0].points[0] - found[0].points[1]).norm();
    assert!((apart - found[0].distance.abs()).abs() < 5e-14);
    assert_eq!(
        found[0].depth.is_some(),
        found[0].check(0.0).is_err() && found[0].relation != Relation::Touching
    );
    found[0]
}

fn distance_of(a: Placed<'_>, b: Placed<'_>) -> f64 {
    let gap = gap_of(a, b);
    assert_eq!(gap.relation, Relation::Apart);
    gap.distance
}

pub(super) fn direction(chance: &mut fastrand::Rng) -> [f64; 3] {
    loop {
        let x = Vector3::from_fn(|_, _| 2.0 * chance.f64() - 1.0);
        if x.norm() > 0.1 && x.norm() < 1.0 {
            return x.normalize().into();
        }
    }
}

#[test]
fn spheres() {
    let sphere = Spheroid::sphere(1.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(1);
    for gap in [1e-11, 1e-7, 1e-3, 0.1, 3.0] {
        for radius in [0.01, 0.5, 1.0, 40.0] {
            let (n, c) = (
                Vector3::from(direction(&mut chance)),
                direction(&mut chance),
            );
            let second = scaled(
                radius,
                at(
                    &sphere,
                    (Vector3::from(c) + n * (1.0 + radius + gap)).into(),
                    direction(&mut chance),
                ),
            );
            let first = at(&sphere, c, direction(&mut chance));
            let found = gap_of(first, second);
            let error = (found.distance - gap).abs();
            assert!(
                error < 2e-15 * (1.0 + radius + gap) + 1e-15,
                "{gap} {radius} {error}"
            );
            let touch = Vector3::from(c) + n;
            assert!(
                (found.points[0].coords - touch).norm() < 1e-8 * (1.0 + gap),
                "{gap} {radius}"
            );
        }
    }
}

#[test]
fn spheres_that_touch_and_that_nearly_do() {
    let sphere = Spheroid::sphere(1.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(2);
    for k in 0..30 {
        let n = if k == 0 {
            [1.0, 0.0, 0.0]
        } else {
            direction(&mut chance)
        };
        let (first, axis) = (
            at(&sphere, [0.0; 3], direction(&mut chance)),
            direction(&mut chance),
        );
        let place = |distance: f64| at(&sphere, n.map(|x| x * distance), axis);
        assert_eq!(gap_of(first, place(2.0)).relation, Relation::Touching);
        assert_eq!(
            gap_of(first, place(2.0 - 1e-13)).relation,
            Relation::Touching
        );
        let gap = gap_of(first, place(2.0000001));
        assert_eq!(gap.relation, Relation::Apart);
        assert!((gap.distance - 1e-7).abs() < 2e-15);
        assert!(gap.check(0.9e-7).is_ok());
        let error = gap.check(0.01).unwrap_err().to_string();
        assert_eq!(
            error,
            "bodies[0] and bodies[1] are 1.000e-7 apart, but must be 1.000e-2"
        );
        let gap = gap_of(first, place(2.0 - 1e-9));
        assert_eq!(gap.relation, Relation::Overlapping);
        assert!((gap.distance + 1e-9).abs() < 4e-15);
        assert!(matches!(
            gap.check(0.0),
            Err(ContactError::Overlap {
                first: 0,
                second: 1,
                ..
            })
        ));
        assert_eq!(gap_of(first, place(1.0)).relation, Relation::Overlapping);
    }
}

#[test]
fn spheroids_whose_gap_is_known() {
    for (polar, equatorial) in [(3.0, 1.0), (1.0, 3.0), (0.05, 1.0), (1.0, 0.05)] {
        let body = Spheroid::new(polar, equatorial).unwrap();
        let first = at(&body, [0.0; 3], Z);
        for gap in [1e-9, 1e-3, 0.5] {
            for second in [
                at(&body, [0.0, 2.0 * equatorial + gap, 0.0], Z),
                at(&body, [0.0, 0.0, -2.0 * polar - gap], Z),
                at(&body, [polar + equatorial + gap, 0.0, 0.0], [1.0, 0.0, 0.0]),
                at(&body, [2.0 * equatorial + gap, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ] {
                let found = distance_of(first, second);
                assert!(
                    (found - gap).abs() < 3e-15,
                    "{polar} {equatorial} {gap} {}",
                    found - gap
                );
            }
        }
    }
}

/// Distance of two ellipsoids by a grid on each and shrinking steps from the best pairs, a method
/// that shares nothing with the module.
fn by_search(a: [f64; 2], to_lab_a: &Frame, b: [f64; 2], to_lab_b: &Frame) -> f64 {
    let point = |[polar, equatorial]: [f64; 2], frame: &Frame, s: f64, phi: f64| {
        frame.point_to_lab(Point3::new(
            equatorial * s.sin() * phi.cos(),
            equatorial * s.sin() * phi.sin(),
            polar * s.cos(),
        ))
    };
    let far =
        |x: [f64; 4]| (point(a, to_lab_a, x[0], x[1]) - point(b, to_lab_b, x[2], x[3])).norm();
    let n = 24;
    let parameters: Vec<[f64; 2]> = (0..n * 2 * n)
        .map(|k| {
            [
                PI * ((k % n) as f64 + 0.5) / n as f64,
                PI * (k / n) as f64 / n as f64,
            ]
        })
        .collect();
    let mut grid: Vec<([f64; 4], f64)> = Vec::new();
    let on_b: Vec<_> = parameters
        .iter()
        .map(|p| point(b, to_lab_b, p[0], p[1]))
        .collect();
    for p in &parameters {
        let x = point(a, to_lab_a, p[0], p[1]);
        let (k, d) = on_b
            .iter()
            .map(|y| (x - y).norm())
            .enumerate()
            .min_by(|x, y| x.1.total_cmp(&y.1))
            .unwrap();
        grid.push(([p[0], p[1], parameters[k][0], parameters[k][1]], d));
    }
    grid.sort_by(|x, y| x.1.total_cmp(&y.1));
    let mut least = f64::INFINITY;
    for (mut x, mut d) in grid.into_iter().take(5) {
        let mut chance = fastrand::Rng::with_seed(3);
        let mut step = 0.1;
        while step > 1e-8 {
            let mut better = false;
            for _ in 0..60 {
                let mut y = x;
                y.iter_mut()
                    .for_each(|y| *y += step * (2.0 * chance.f64() - 1.0));
                let there = far(y);
                if there < d {
                    (x, d, better) = (y, there, true);
                }
            }
            if !better {
                step *= 0.6;
            }
        }
        least = least.min(d);
    }
    least
}

#[test]
fn spheroids_of_chance_agree_with_a_search() {
    let mut chance = fastrand::Rng::with_seed(11);
    let mut apart = 0;
    for case in 0..30 {
        let mut semiaxes = || [0.2 + chance.f64(), 0.2 + chance.f64()];
        let (a, b) = (semiaxes(), semiaxes());
        let (first, second) = (
            Spheroid::new(a[0], a[1]).unwrap(),
            Spheroid::new(b[0], b[1]).unwrap(),
        );
        let place = direction(&mut chance).map(|x| x * (1.0 + chance.f64()));
        let first = at(&first, [0.0; 3], direction(&mut chance));
        let second = at(&second, place, direction(&mut chance));
        let gap = gap_of(first, second);
        let search = by_search(a, &first.frame, b, &second.frame);
        if gap.relation == Relation::Apart {
            apart += 1;
            assert!(
                (search - gap.distance).abs() < 2e-14,
                "{case} {search} {}",
                gap.distance
            );
        } else {
            assert!(search < 1e-2, "{case} {search} {gap:?}");
        }
    }
    assert!((10..=28).contains(&apart), "{apart}");
}

/// A rim of small radius. The gap is at most that of a disc of no thickness, and it is smaller by
/// no more than the thickness.
#[test]
fn rims_of_thin_discs() {
    let mut chance = fastrand::Rng::with_seed(12);
    let sphere = Spheroid::sphere(0.5).unwrap();
    for thickness in [0.1, 0.01, 0.001] {
        let disc = Spheroid::new(thickness, 1.0).unwrap();
        for case in 0..10 {
            let n = Vector3::from(direction(&mut chance));
            let center = n * (1.6 + chance.f64());
            let axis = direction(&mut chance);
            let first = at(&disc, [0.0; 3], axis);
            // The distance of a point from a disc of no thickness.
            let height = center.dot(&Vector3::from(axis));
            let beside = (center - Vector3::from(axis) * height).norm();
            let flat = (beside - 1.0).max(0.0).hypot(height) - 0.5;
            let found = distance_of(first, at(&sphere, center.into(), Z));
            assert!(found <= flat + 1e-14, "{thickness} {case} {found} {flat}");
            assert!(
                found >= flat - thickness - 1e-14,
                "{thickness} {case} {found} {flat}"
            );
        }
    }
    // A rim above a face.
    let disc = Spheroid::new(0.001, 1.0).unwrap();
    let tilt = 0.1f64.atan();
    let first = at(&disc, [0.0; 3], Z);
    let found = distance_of(
        first,
        at(&disc, [1.5, 1.5, 0.0], [1.0, 1.0, 0.1 * 2f64.sqrt()]),
    );
    let flat = (1.5 * 2f64.sqrt() - 1.0) * tilt.cos();
    assert!(found <= flat && found >= flat - 0.002, "{found} {flat}");
}

#[test]
fn tori_around_things() {
    let torus = Torus::new(2.0, 0.5).unwrap();
    let sphere = Spheroid::sphere(1.0).unwrap();
    let around = at(&torus, [0.0; 3], Z);
    for offset in [0.0, 0.1, 0.4999] {
        let found = distance_of(
            around,
            at(
                &sphere,
                [0.0, offset, 0.0],
                direction(&mut fastrand::Rng::with_seed(1)),
            ),
        );
        assert!((found - (0.5 - offset)).abs() < 3e-15, "{offset}");
    }
    assert_eq!(
        gap_of(around, at(&sphere, [0.0, 0.5, 0.0], Z)).relation,
        Relation::Touching
    );
    assert_eq!(
        gap_of(around, at(&sphere, [0.0, 0.6, 0.0], Z)).relation,
        Relation::Overlapping
    );
    let rod = Capsule::new(0.3, 8.0).unwrap();
    for offset in [0.0, 0.7, 1.199] {
        let found = distance_of(around, at(&rod, [offset, 0.0, 1.0], Z));
        assert!((found - (1.2 - offset)).abs() < 1e-15, "{offset}");
    }
    assert_eq!(
        gap_of(around, at(&rod, [1.3, 0.0, 0.0], Z)).relation,
        Relation::Overlapping
    );
    // The circles of two linked rings of radius 2 are 2 apart all around. With one ring moved by a
    // half they are 1.5 apart, in two places.
    let thin = Torus::new(2.0, 0.3).unwrap();
    let ring = at(&thin, [0.0; 3], Z);
    let links = distance_of(ring, at(&thin, [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert!((links - 1.4).abs() < 1e-15, "{links}");
    let links = distance_of(ring, at(&thin, [1.5, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert!((links - 0.9).abs() < 1e-15, "{links}");
    // Side by side in a plane, one in the other, one above the other.
    let found = distance_of(ring, at(&thin, [4.7, 0.0, 0.0], Z));
    assert!((found - 0.1).abs() < 5e-15);
    let small = scaled(0.5, at(&thin, [0.1, 0.0, 0.0], Z));
    assert!((distance_of(ring, small) - 0.45).abs() < 1e-15);
    let found = distance_of(ring, at(&thin, [0.0, 0.0, 0.7], Z));
    assert!((found - 0.1).abs() < 1e-15);
}

/// The gap of a sphere is the distance of its centre from the body, less its radius.
#[test]
fn a_sphere_in_the_dent_of_a_red_cell() {
    let cell = Biconcave::new(1.0).unwrap();
    let half = |r: f64| {
        0.5 * (1.0 - r * r).max(0.0).sqrt() * (0.207161 + r * r * (2.002558 - 1.122762 * r * r))
    };
    let mut chance = fastrand::Rng::with_seed(5);
    for (radius, x, height) in [
        (0.3, 0.0, 0.45),
        (0.3, 0.0, 0.404),
        (0.3, 0.1, 0.45),
        (0.7, 0.0, 1.0),
        (2.0, 0.3, 2.4),
        (0.1, 0.05, 0.21),
        (0.2, 1.25, 0.1),
    ] {
        // Evans and Fung's curve, sampled by the sine of an angle.
        let far = |s: f64| {
            (s.sin() - x).hypot(s.cos().abs() / s.cos().abs().max(1e-300) * half(s.sin()) - height)
        };
        let mut best = (0..200_001)
            .map(|k| 0.5 * PI * f64::from(k) / 2e5 - 0.25 * PI)
            .map(|s| s * 2.0)
            .min_by(|&a, &b| far(a).total_cmp(&far(b)))
            .unwrap();
        let mut step = 1e-5;
        while step > 1e-12 {
            let next = [best - step, best + step]
                .into_iter()
                .find(|&s| far(s) < far(best));
            match next {
                Some(s) => best = s,
                None => step *= 0.5,
            }
        }
        let sphere = Spheroid::sphere(radius).unwrap();
        let found = distance_of(
            at(&cell, [0.0; 3], Z),
            at(&sphere, [0.0, x, height], direction(&mut chance)),
        );
        assert!(
            (found - (far(best) - radius)).abs() < 4e-15,
            "{radius} {x} {} {found}",
            far(best) - radius
        );
    }
    let sphere = Spheroid::sphere(0.3).unwrap();
    let on = at(&sphere, [0.0, 0.0, 0.4035], Z);
    assert_eq!(
        gap_of(at(&cell, [0.0; 3], Z), on).relation,
        Relation::Overlapping
    );
}

#[test]
fn bodies_inside_others() {
    let (sphere, torus) = (
        Spheroid::sphere(1.0).unwrap(),
        Torus::new(2.0, 0.5).unwrap(),
    );
    let capsule = Capsule::new(1.0, 4.0).unwrap();
    let mut chance = fastrand::Rng::with_seed(8);
    for (outer, at_inner, scale) in [
        (&sphere as &dyn GeneratingCurve, [0.0, 0.3, 0.2], 0.5),
        (&sphere, [0.0; 3], 0.99),
        (&sphere, [0.0; 3], 1e-3),
        (&torus, [2.0, 0.1, 0.1], 0.3),
        (&capsule, [0.0, 0.0, 1.7], 0.9),
    ] {
        let inner = scaled(scale, at(&sphere, at_inner, direction(&mut chance)));
        let outer = at(outer, [0.0; 3], Z);
        for reach in [0.0, 1.0] {
            let (inner, outer) = (Placed { reach, ..inner }, Placed { reach, ..outer });
            let gap = gaps(&[inner, outer]).unwrap()[0];
            assert_eq!(gap.relation, Relation::Inside(0));
            assert_eq!(
                gap.check(0.0),
                Err(ContactError::Inside { inner: 0, outer: 1 })
            );
            let gap = gaps(&[outer, inner]).unwrap()[0];
            assert_eq!(gap.relation, Relation::Inside(1));
            assert!(gap.distance < 0.0);
        }
    }
    // In the hole, not in the body.
    let inner = Placed {
        reach: 0.0,
        ..at(&sphere, [0.0; 3], Z)
    };
    let outer = Placed {
        reach: 0.0,
        ..at(&torus, [0.0; 3], Z)
    };
    assert!(gaps(&[inner, outer]).unwrap().is_empty());
    // The same body twice.
    assert_ne!(gaps(&[outer, outer]).unwrap()[0].relation, Relation::Apart);
}

#[test]
fn pairs_are_all_that_are_within_reach_in_order() {
    let sphere = Spheroid::sphere(0.1).unwrap();
    let mut chance = fastrand::Rng::with_seed(4);
    let centers: Vec<[f64; 3]> = (0..300)
        .map(|_| [0; 3].map(|_| 2.0 * chance.f64()))
        .collect();
    let reach = |i: usize| if i.is_multiple_of(7) { 0.2 } else { 0.02 };
    let bodies: Vec<_> = (0..300)
        .map(|i| Placed {
            reach: reach(i),
            ..at(&sphere, centers[i], Z)
        })
        .collect();
    let found = gaps(&bodies).unwrap();
    let mut expected = Vec::new();
    for i in 0..300 {
        for j in i + 1..300 {
            let gap = (Vector3::from(centers[i]) - Vector3::from(centers[j])).norm() - 0.2;
            if gap <= reach(i).max(reach(j)) {
                expected.push(([i, j], gap));
            }
        }
    }
    assert!(expected.len() > 100);
    assert_eq!(found.len(), expected.len());
    for (found, (pair, gap)) in found.iter().zip(&expected) {
        assert_eq!(found.bodies, *pair);
        if *gap > 0.0 {
            assert!((found.distance - gap).abs() < 1.9e-15);
        } else {
            assert_eq!(found.relation, Relation::Overlapping);
        }
    }
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert_eq!(one.install(|| gaps(&bodies).unwrap()), found);
}

#[test]
fn bad_places_are_refused() {
    let sphere = Spheroid::sphere(1.0).unwrap();
    let good = at(&sphere, [0.0; 3], Z);
    let told = |bad: Placed<'_>| gaps(&[good, bad]).unwrap_err().to_string();
    assert_eq!(
        told(scaled(0.0, good)),
        "bodies[1]: the scale must be a positive number, got 0"
    );
    assert_eq!(
        told(Placed {
            reach: f64::NAN,
            ..good
        }),
        "bodies[1]: the reach must be zero or a positive length, got NaN"
    );
    assert_eq!(
        told(at(&sphere, [0.0, f64::INFINITY, 0.0], Z)),
        "bodies[1]: every coordinate of the frame must be finite, got inf"
    );
    assert_eq!(gaps(&[]), Ok(Vec::new()));
}
