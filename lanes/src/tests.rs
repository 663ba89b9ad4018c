use super::*;

struct Roots<'a>(&'a [f64], Precision);

impl WithIsa for Roots<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) -> Vec<f64> {
        let mut roots = vec![0.0; self.0.len()];
        for index in 0..self.0.len() / Lanes::<S>::COUNT {
            let root = Lanes::load(simd, self.0, index).rsqrt_or_zero(self.1);
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
        for (x, root) in x.iter().zip(dispatch(Roots(&x, precision))) {
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
        assert_eq!(dispatch(Roots(&[0.0; 8], precision)), [0.0; 8]);
    }
}
