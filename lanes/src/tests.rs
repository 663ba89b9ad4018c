use pulp::{Scalar, Simd};

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

struct Below<'a>(&'a [f64; 8], f64);

impl WithIsa for Below<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) -> usize {
        let mut bits = 0;
        for index in 0..8 / Lanes::<S>::COUNT {
            let x = Lanes::load(simd, self.0, index);
            bits |= x.less_bits(Lanes::splat(simd, self.1)) << (index * Lanes::<S>::COUNT);
        }
        bits
    }
}

#[test]
fn bits_tell_the_lanes_below() {
    let x = [3.0, 1.0, f64::INFINITY, 0.5, 2.0, -7.0, f64::NAN, 1.9];
    assert_eq!(dispatch(Below(&x, 2.0)), 0b1010_1010);
    let simd = Scalar::new();
    let below = x.map(|x| Lanes(simd, x).less_bits(Lanes(simd, 2.0)));
    assert_eq!(below, [0, 1, 0, 1, 0, 1, 0, 1]);
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        assert_eq!(
            pulp::Simd::vectorize(simd, OnV3(Below(&x, 2.0), simd)),
            0b1010_1010
        );
    }
}

#[cfg(target_arch = "x86_64")]
struct OnV3<W>(W, pulp::x86::V3);

#[cfg(target_arch = "x86_64")]
impl<W: WithIsa> pulp::WithSimd for OnV3<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.with_isa(self.1)
    }
}
