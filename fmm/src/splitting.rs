//! The split of $B = r/8\pi$ at a length $L$ into a mollified part $B_L$, band-limited to
//! $kL \le c$, and a residual that vanishes beyond $r = L$, both up to [`Splitting::truncation`].
//!
//! $dB_L/dr = \Phi(r/L)/8\pi$ with $\Phi(\rho) = \frac1{C_0}\int_0^\rho \psi$, and the transform is
//! $-\gamma(kL)/k^4$ (af Klinteberg, Greengard, Jiang & Tornberg 2025).

use std::f64::consts::PI;

use panel_quadrature::GaussLegendre;

use crate::polynomial::{self, Sample};
use crate::prolate::Prolate;

/// Radius $R$ at which [`Splitting::free_space`] cuts off $B$, in sides of the root: the diagonal
/// of a cube plus the reach of the mollifier of $B_{L_0/2}$.
pub(crate) const ROOT_RADIUS: f64 = 1.7320508075688772 + 0.5;

/// Period of the waves of the root, in its sides. It is so large that images of the cut-off,
/// mollified $B$ do not touch the cube.
pub(crate) const ROOT_PERIOD: f64 = 1.0 + ROOT_RADIUS + 0.5;

/// What cutting off $B$ at $R$ (in sides of the root) adds to the Stokeslet, $-\mathsf I/4\pi R$.
/// It must be subtracted from the velocity for each force.
pub(crate) const ROOT_STOKESLET: f64 = -1.0 / (4.0 * PI * ROOT_RADIUS);

/// What cutting $B$ off at $R$ (sides of the root) adds to the potential of a charge, $-3/8\pi R$.
pub(crate) const ROOT_CHARGE: f64 = -3.0 / (8.0 * PI * ROOT_RADIUS);

/// The split for a number of waves.
#[derive(Clone, Debug)]
pub(crate) struct Splitting {
    psi: Prolate,
    /// Gauss-Legendre nodes on $[0, 1]$.
    rule: Vec<Node>,
}

/// A node of a quadrature, with what the integrals over it share.
#[derive(Clone, Copy, Debug)]
struct Node {
    x: f64,
    weight: f64,
    /// $\psi(x)$.
    psi: f64,
    /// $1 - \Phi(x)$.
    beyond: f64,
}

impl Splitting {
    /// The split whose difference kernel $B_{L/2} - B_L$ has the waves $k_j = 2\pi j/3L$,
    /// $|j| < J$, per axis. Then $c = \pi J/3$.
    pub fn new(waves: usize) -> Self {
        let bandwidth = waves as f64 * PI / 3.0;
        let rule = GaussLegendre::new(40 + waves).expect("an order within the limits");
        let psi = Prolate::new(bandwidth);
        let rule = rule.iter().map(|(node, weight)| {
            let x = 0.5 + 0.5 * node;
            Node {
                x,
                weight: 0.5 * weight,
                psi: psi.value(x),
                beyond: 1.0 - psi.integral(x) / psi.half_integral(),
            }
        });
        Self {
            rule: rule.collect(),
            psi,
        }
    }

    /// $c$: the mollified part has no waves beyond $c/L$.
    pub fn bandwidth(&self) -> f64 {
        self.psi.bandwidth()
    }

    /// $\gamma(kL) = \psi(x) - x\psi'(x)/2$ at $x = kL/c \le 1$, and 0 beyond. The transform of
    /// $B_L$ is $-\gamma(kL)/k^4$.
    pub fn gamma(&self, kl: f64) -> f64 {
        let x = kl / self.bandwidth();
        self.psi.value(x) - 0.5 * x * self.psi.derivative(x)
    }

    /// Transform of $B_{1/2} - B_1$, $[\gamma(k) - \gamma(k/2)]/k^4$, computed without the
    /// cancellation at small $k$ and with its limit at 0.
    ///
    /// Other lengths follow by scaling: the transform of $B_{L/2} - B_L$ is $L^4$ times the value
    /// at $kL$.
    pub fn difference(&self, k: f64) -> f64 {
        if k * k > self.bandwidth() {
            (self.gamma(k) - self.gamma(0.5 * k)) / k.powi(4)
        } else {
            self.residual_transform(k) - self.residual_transform(0.5 * k) / 16.0
        }
    }

    /// Transform of $B - B_1$ by its integral:
    /// $-\frac12\int_0^1 \rho^3\,\frac{j_1(k\rho)}{k\rho}\,[1 - \Phi(\rho)]\,d\rho$.
    fn residual_transform(&self, k: f64) -> f64 {
        self.rule
            .iter()
            .map(|node| {
                -0.5 * node.weight * node.x.powi(3) * scaled_bessel(1, k * node.x) * node.beyond
            })
            .sum()
    }

    /// $b_n(t)$, $t = (r/L)^2$, of the chain of the mollified part:
    /// $(\frac1r\frac d{dr})^n B_L = L^{1-2n}\,b_n(t)$.
    ///
    /// Since $\psi$ is its own transform,
    /// $b_1 = \Phi(\rho)/8\pi\rho = \frac1{8\pi C_0^2}\int_0^1\psi(x)\,j_0(c\rho x)\,dx$. The other
    /// orders follow from $\frac1z\frac d{dz}\frac{j_m(z)}{z^m} = -\frac{j_{m+1}(z)}{z^{m+1}}$. The
    /// error is a few rounding errors of $b_n(0)$.
    pub fn mollified(&self, order: usize, t: f64) -> f64 {
        let (c, c0) = (self.bandwidth(), self.psi.half_integral());
        let m = order - 1;
        let sum: f64 = self
            .rule
            .iter()
            .map(|node| {
                let cx = c * node.x;
                node.weight * node.psi * (-cx * cx).powi(m as i32) * scaled_bessel(m, cx * t.sqrt())
            })
            .sum();
        sum / (8.0 * PI * c0 * c0)
    }

    /// $b_n$ as a polynomial in $s = 2t - 1$, highest power first: the shortest one with an error
    /// of at most `accuracy`.
    ///
    /// The error is relative to what the polynomial is subtracted from,
    /// $|t^{1/2-n} b^{\text{full}}_n|$, and where that exceeds $|b_n(0)|$ relative to $|b_n(0)|$.
    pub fn polynomial(&self, order: usize, accuracy: f64) -> Vec<f64> {
        const SAMPLES: usize = 160;
        const LONGEST: usize = 60;
        let rounding = 4.0 * f64::EPSILON;
        let at_zero = self.mollified(order, 0.0).abs();
        let samples: Vec<Sample> = (0..SAMPLES)
            .map(|i| {
                let s = polynomial::node(i, SAMPLES);
                let t = 0.5 + 0.5 * s;
                let allowed = accuracy * singular(order, t).abs().min(at_zero);
                Sample {
                    s,
                    value: self.mollified(order, t),
                    allowed: allowed.max(rounding * at_zero),
                }
            })
            .collect();
        let mut polynomial = Vec::new();
        for degree in 1..=LONGEST {
            let error;
            (polynomial, error) = polynomial::fit(&samples, degree);
            if error <= 1.0 {
                break;
            }
        }
        polynomial
    }

    /// Transform of the mollified $B_{L_0/2}$ in free space, for sources and targets in a cube of
    /// side $L_0 = 1$. It is the transform of $\frac1{8\pi}(r - \frac{r^2}{2R} - \frac R2)$ cut off
    /// at $R$ = [`ROOT_RADIUS`], times $\gamma(k/2)$. Other sides follow by scaling with $L_0^4$,
    /// at $kL_0$.
    ///
    /// The quadratic and the constant term add [`ROOT_STOKESLET`] to the Stokeslet. They add
    /// nothing to its pressure and gradient, and nothing to any other flow.
    pub fn free_space(&self, k: f64) -> f64 {
        truncated_distance(k * ROOT_RADIUS) * ROOT_RADIUS.powi(4) * self.gamma(0.5 * k)
    }
}

/// $b^{\text{full}}_n$: the chain of $B$ itself, $(-1)^{n-1}\,(2n-3)!!\; t^{1/2-n}/8\pi$.
fn singular(order: usize, t: f64) -> f64 {
    let factor: f64 = (1..order).map(|i| 1.0 - 2.0 * i as f64).product();
    factor * t.powf(0.5 - order as f64) / (8.0 * PI)
}

/// $j_m(z)/z^m$ for $m \le 3$, with $j_m$ the spherical Bessel function.
fn scaled_bessel(m: usize, z: f64) -> f64 {
    const SMALL: f64 = 4.0;
    if z < SMALL {
        // Abramowitz & Stegun 10.1.2.
        let mut term = 1.0 / (0..m).map(|i| (2 * i + 3) as f64).product::<f64>();
        let mut sum = 0.0;
        for i in 0..30 {
            sum += term;
            term *= -0.5 * z * z / ((i + 1) * (2 * (m + i) + 3)) as f64;
        }
        return sum;
    }
    let (mut below, mut j) = (z.cos() / z, z.sin() / z);
    for i in 0..m {
        (below, j) = (j, (2 * i + 1) as f64 / z * j - below);
    }
    j / z.powi(m as i32)
}

/// Transform of the distance cut off at radius 1, at $x = kR$:
/// $-\left(1 + \tfrac12\cos x - \tfrac32\frac{\sin x}x\right)/x^4$.
fn truncated_distance(x: f64) -> f64 {
    if x.abs() > 1.0 {
        return -(1.0 + 0.5 * x.cos() - 1.5 * x.sin() / x) / x.powi(4);
    }
    // sum_m (-1)^(m+1) (m - 1) x^(2m-4) / (2m+1)!, m >= 2
    let mut power = -1.0 / 120.0;
    let mut sum = 0.0;
    for m in 2..12 {
        sum += (m - 1) as f64 * power;
        power *= -x * x / ((2 * m + 2) * (2 * m + 3)) as f64;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Orders of the radial chain.
    const ORDERS: usize = 4;

    #[expect(clippy::excessive_precision)]
    /// Waves, $t$, $b_1..b_4$, from closed forms in $\Phi$, $\psi$, $\psi'$, $\psi''$ by mpmath
    /// with 60 digits.
    const CHAIN: [(usize, f64, [f64; ORDERS]); 6] = [
        (
            17,
            0.01,
            [
                0.1302345948781652,
                -0.72514843765430474,
                6.9533938314748712,
                -75.258584789133112,
            ],
        ),
        (
            17,
            0.3,
            [
                0.071495739542042936,
                -0.21044977679305143,
                1.5409879916759861,
                -15.058517145394085,
            ],
        ),
        (
            17,
            0.9,
            [
                0.041940982173767668,
                -0.046599367362002748,
                0.15524541547902865,
                -0.85895820114190343,
            ],
        ),
        (
            32,
            0.01,
            [
                0.17420490515453389,
                -1.8253690331207742,
                34.276964283826731,
                -749.85939396141857,
            ],
        ),
        (
            32,
            0.3,
            [
                0.072576162324883735,
                -0.23898471124979426,
                2.275339758358289,
                -33.616049461716209,
            ],
        ),
        (
            32,
            0.9,
            [
                0.041941010086616879,
                -0.046601122267834496,
                0.15533706918247548,
                -0.86298326284413106,
            ],
        ),
    ];

    #[expect(clippy::excessive_precision)]
    /// Waves, $k$, transform of the difference (mpmath, 60 digits) and transform of the root's
    /// kernel (its integral by the quadrature of mpmath).
    const TRANSFORMS: [(usize, f64, f64, f64); 8] = [
        (17, 0.01, -0.00031968306535108771, -0.20683534503874992),
        (17, 0.4, -0.00031882748061423854, -0.1991179356026505),
        (17, 3.1, -0.00027221428765107878, -0.013762333476224545),
        (17, 20.5, -1.1335752620059162e-6, -9.8238919783199692e-7),
        (32, 0.01, -9.6718127953976853e-5, -0.20683534503878067),
        (32, 0.4, -9.6569668292316389e-5, -0.19911801131524379),
        (32, 3.1, -8.8208123505224848e-5, -0.013780420126714993),
        (32, 20.5, -3.0212855232567182e-6, -2.6646112852761178e-6),
    ];

    #[test]
    fn chain_agrees_with_its_closed_form() {
        for (waves, t, chain) in CHAIN {
            let splitting = Splitting::new(waves);
            for (order, expected) in (1..).zip(chain) {
                let error = splitting.mollified(order, t) - expected;
                assert!(
                    error.abs() < 5e-14 * splitting.mollified(order, 0.0).abs(),
                    "{waves} {t} {order}: {error:e}"
                );
            }
        }
    }

    #[test]
    fn transforms_agree_with_quadrature() {
        for (waves, k, difference, root) in TRANSFORMS {
            let splitting = Splitting::new(waves);
            assert!(
                (splitting.difference(k) - difference).abs() < 1e-13 * 1e-4,
                "{waves} {k}"
            );
            assert!(
                (splitting.free_space(k) - root).abs() < 1e-13 * root.abs(),
                "{waves} {k}"
            );
        }
    }

    #[test]
    fn transforms_have_no_seams() {
        let splitting = Splitting::new(24);
        let seam = splitting.bandwidth().sqrt();
        let jump =
            splitting.difference(seam * (1.0 + 1e-12)) / splitting.difference(seam * (1.0 - 1e-12));
        assert!((jump - 1.0).abs() < 1e-11, "{jump}");
        assert!(
            (truncated_distance(1.0 + 1e-13) / truncated_distance(1.0 - 1e-13) - 1.0).abs() < 1e-11
        );
        for m in 0..ORDERS {
            let jump = scaled_bessel(m, 4.0 + 1e-13) / scaled_bessel(m, 4.0 - 1e-13);
            assert!((jump - 1.0).abs() < 1e-11, "{m} {jump}");
        }
    }

    #[test]
    fn residual_ends_at_its_length() {
        for waves in [10, 17, 24, 32] {
            let splitting = Splitting::new(waves);
            for order in 1..=ORDERS {
                let left = splitting.mollified(order, 1.0) / singular(order, 1.0) - 1.0;
                // At its end the n-th derivative of psi is about (c^2/2)^n psi.
                let bound =
                    splitting.psi.value(1.0) * splitting.bandwidth().powi(2 * order as i32 - 2);
                assert!(left.abs() < bound + 1e-11, "{waves} {order}: {left:e}");
            }
        }
    }

    #[test]
    fn polynomials_are_as_accurate_as_asked() {
        for (waves, accuracy) in [(8, 1e-2), (10, 1e-3), (17, 1e-6), (24, 1e-9), (32, 1e-12)] {
            let splitting = Splitting::new(waves);
            for order in 1..=ORDERS {
                let polynomial = splitting.polynomial(order, accuracy);
                let at_zero = splitting.mollified(order, 0.0).abs();
                for i in 0..=300 {
                    let t = i as f64 / 300.0;
                    let s = 2.0 * t - 1.0;
                    let value = polynomial.iter().fold(0.0, |sum, c| sum * s + c);
                    let error = (value - splitting.mollified(order, t)).abs();
                    let allowed = accuracy * singular(order, t).abs().min(at_zero);
                    assert!(
                        error < 1.1 * allowed + 1e-14 * at_zero,
                        "{waves} {order} {t}: {error:e} {allowed:e}"
                    );
                }
                println!(
                    "J = {waves}, accuracy {accuracy:.0e}, order {order}: {} terms",
                    polynomial.len()
                );
            }
        }
    }

    #[test]
    fn polynomial_of_no_accuracy_is_still_one() {
        assert!(!Splitting::new(4).polynomial(1, 1.0).is_empty());
        assert!(Splitting::new(40).polynomial(4, 0.0).len() <= 61);
    }
}
