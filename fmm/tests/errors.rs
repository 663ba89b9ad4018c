//! What is refused, and how; and what is nothing, but fine.

use stokes_fmm::{
    Flow, FmmError, LaplaceSum, Output, Points, Singularities, StokesSum, Strengths, Stresslets,
    direct,
};

const PLACES: [[f64; 3]; 3] = [[0.0, 0.5, 1.0], [1.0, 0.0, 0.25], [0.5, 0.5, 0.5]];
const KINDS: [Singularities; 4] = [
    Singularities::Stokeslets,
    Singularities::Stresslets,
    Singularities::Both,
    Singularities::All,
];

fn plan(points: Points<'_>, tolerance: f64) -> Result<StokesSum, FmmError> {
    StokesSum::new(points, Singularities::All, Output::Gradient, tolerance)
}

fn valid(kinds: Singularities) -> StokesSum {
    StokesSum::new(Points::same(&PLACES), kinds, Output::Velocity, 1e-3).expect("valid points")
}

#[test]
fn positions_must_be_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut places = PLACES;
        places[1][2] = bad;
        for (points, expected) in [
            (Points::same(&places), "source position"),
            (Points::apart(&places, &PLACES), "source position"),
            (Points::apart(&PLACES, &places), "target position"),
        ] {
            let refusals = [
                plan(points, 1e-3).err(),
                valid(Singularities::All).moved(points).err(),
                LaplaceSum::new(points, true, 1e-3).err(),
            ];
            for refusal in refusals {
                let Some(FmmError::NotFinite { what, index, value }) = refusal else {
                    panic!("{refusal:?}");
                };
                assert_eq!((what, index), (expected, 1));
                assert!(!value.is_finite());
            }
        }
    }
}

#[test]
fn positions_must_not_be_too_far() {
    let places = [[0.0; 3], [0.0, -2e100, 0.0]];
    for points in [Points::same(&places), Points::apart(&PLACES, &places)] {
        assert_eq!(plan(points, 1e-3).err(), Some(FmmError::TooFar(2e100)));
        let laplace = LaplaceSum::new(points, false, 1e-3);
        assert_eq!(laplace.err(), Some(FmmError::TooFar(2e100)));
    }
    let refused = direct::laplace(&places, &[1.0; 2], &PLACES, false, None);
    assert_eq!(refused.err(), Some(FmmError::TooFar(2e100)));
}

#[test]
fn tolerances_have_a_range() {
    let points = Points::same(&PLACES);
    for tolerance in [0.0, -1e-3, 0.99e-12, 0.11, f64::INFINITY] {
        let expected = Some(FmmError::Tolerance(tolerance));
        assert_eq!(plan(points, tolerance).err(), expected);
        assert_eq!(LaplaceSum::new(points, true, tolerance).err(), expected);
    }
    assert!(matches!(
        plan(points, f64::NAN),
        Err(FmmError::Tolerance(tolerance)) if tolerance.is_nan()
    ));
    for tolerance in [1e-12, 1e-1] {
        assert!(plan(points, tolerance).is_ok());
    }
}

#[test]
fn strengths_must_be_one_for_each_source() {
    let (short, long) = ([[1.0; 3]; 2], [[1.0; 3]; 4]);
    let right = [[1.0; 3]; 3];
    let layer = |densities, normals| Strengths {
        stresslets: Some(Stresslets { densities, normals }),
        ..Default::default()
    };
    let cases = [
        (
            Strengths {
                stokeslets: Some(&short),
                ..Default::default()
            },
            2,
        ),
        (layer(&long, &right), 4),
        (layer(&right, &short), 2),
        (
            Strengths {
                rotlets: Some(&long),
                ..Default::default()
            },
            4,
        ),
        (
            Strengths {
                fluxes: Some(&[1.0; 5]),
                ..Default::default()
            },
            5,
        ),
    ];
    let sum = valid(Singularities::All);
    for (strengths, count) in cases {
        let refusal = sum.apply(&strengths).err();
        let Some(FmmError::Length {
            found, expected, ..
        }) = refusal
        else {
            panic!("{refusal:?}");
        };
        assert_eq!((found, expected), (count, 3));
    }
    let laplace = LaplaceSum::new(Points::same(&PLACES), false, 1e-3).expect("valid points");
    assert!(matches!(
        laplace.apply(&[1.0; 4]),
        Err(FmmError::Length {
            found: 4,
            expected: 3,
            ..
        })
    ));
}

#[test]
fn strengths_must_be_finite() {
    let mut bad = [[1.0; 3]; 3];
    bad[2][1] = f64::NAN;
    let good = [[1.0; 3]; 3];
    let sum = valid(Singularities::All);
    let layer = |densities, normals| Strengths {
        stresslets: Some(Stresslets { densities, normals }),
        ..Default::default()
    };
    let cases = [
        Strengths {
            stokeslets: Some(&bad),
            ..Default::default()
        },
        layer(&bad, &good),
        layer(&good, &bad),
        Strengths {
            rotlets: Some(&bad),
            ..Default::default()
        },
        Strengths {
            fluxes: Some(&[1.0, 1.0, f64::INFINITY]),
            ..Default::default()
        },
    ];
    for strengths in cases {
        let refusal = sum.apply(&strengths).err();
        assert!(
            matches!(refusal, Some(FmmError::NotFinite { index: 2, .. })),
            "{refusal:?}"
        );
    }
    let laplace = LaplaceSum::new(Points::same(&PLACES), false, 1e-3).expect("valid points");
    let refusal = laplace.apply(&[f64::NAN, 0.0, 0.0]).err();
    assert!(matches!(
        refusal,
        Some(FmmError::NotFinite { index: 0, .. })
    ));
}

#[test]
fn kinds_must_be_planned_for() {
    let vectors = [[1.0; 3]; 3];
    let given = [
        Strengths {
            stokeslets: Some(&vectors),
            ..Default::default()
        },
        Strengths {
            stresslets: Some(Stresslets {
                densities: &vectors,
                normals: &vectors,
            }),
            ..Default::default()
        },
        Strengths {
            rotlets: Some(&vectors),
            ..Default::default()
        },
        Strengths {
            fluxes: Some(&[1.0; 3]),
            ..Default::default()
        },
    ];
    let names = ["Stokeslets", "stresslets", "rotlets", "sources"];
    let planned = [
        [true, false, false, false],
        [false, true, false, false],
        [true, true, false, false],
        [true; 4],
    ];
    for (kinds, planned) in KINDS.into_iter().zip(planned) {
        let sum = valid(kinds);
        for kind in 0..4 {
            let expected = (!planned[kind]).then_some(FmmError::Unplanned(names[kind]));
            assert_eq!(sum.apply(&given[kind]).err(), expected);
        }
    }
}

#[test]
fn messages_name_what_is_wrong() {
    let places = [[0.0, f64::NAN, 0.0]];
    let refusal = plan(Points::same(&places), 1e-3)
        .err()
        .expect("not a number");
    assert_eq!(
        refusal.to_string(),
        "source position 0 is NaN, expected finite numbers"
    );
}

#[test]
fn no_points_make_no_flow() {
    let nothing: [[f64; 3]; 0] = [];
    let vectors = [[1.0; 3]; 3];
    for kinds in KINDS {
        for (points, forces, targets) in [
            (Points::same(&nothing), &nothing[..], 0),
            (Points::apart(&nothing, &PLACES), &nothing[..], 3),
            (Points::apart(&PLACES, &nothing), &vectors[..], 0),
        ] {
            let sum = StokesSum::new(points, kinds, Output::Gradient, 1e-6).expect("valid points");
            let strengths = match kinds {
                Singularities::Stresslets => Strengths::default(),
                _ => Strengths {
                    stokeslets: Some(forces),
                    ..Default::default()
                },
            };
            let flow = sum.apply(&strengths).expect("valid strengths");
            let still = Flow {
                velocity: vec![[0.0; 3]; targets],
                pressure: vec![0.0; targets],
                gradient: vec![[[0.0; 3]; 3]; targets],
            };
            assert_eq!(flow, still);
        }
    }
    let laplace = LaplaceSum::new(Points::same(&nothing), true, 1e-6).expect("valid points");
    let empty = laplace.apply(&[]).expect("valid charges");
    assert_eq!(empty, (vec![], vec![]));
}
