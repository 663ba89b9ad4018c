use super::*;

struct Roots<'a>(&'a [f64]);

impl WithRoots for Roots<'_> {
    type Output = Vec<f64>;
    const EACH_PRECISION: bool = true;

    #[inline(always)]
    fn with_roots<S: Isa, const TERMS: usize>(self, simd: S) -> Vec<f64> {
        let mut roots = vec![0.0; self.0.len()];
        for index in 0..self.0.len() / Lanes::<S>::COUNT {
            let x = Lanes::load(simd, self.0, index);
            let root = x.rsqrt_above::<TERMS>(Lanes::splat(simd, 0.0));
            root.store(&mut roots, index);
        }
        roots
    }
}

#[test]
fn reciprocal_roots_reach_their_precision() {
    let x: Vec<f64> = (0..8 * 400)
        .map(|i| 1.7f64.powi(i % 400 - 200) * (1.0 + f64::from(i) / 4000.0))
        .collect();
    for (precision, bound) in [
        (Precision::Seed, 1e-4),
        (Precision::Single, 1e-8),
        (Precision::Close, 1e-12),
        (Precision::Full, 1e-15),
    ] {
        for (x, root) in x.iter().zip(dispatch_roots(precision, Roots(&x))) {
            let error = (root * root * x - 1.0).abs() / 2.0;
            assert!(error < bound, "{precision:?} of {x}: {error:e}");
        }
    }
}

#[test]
fn no_root_of_zero() {
    for precision in [
        Precision::Seed,
        Precision::Single,
        Precision::Close,
        Precision::Full,
    ] {
        assert_eq!(dispatch_roots(precision, Roots(&[0.0; 8])), [0.0; 8]);
    }
}
