//! The zeroth prolate spheroidal wave function.

use panel_quadrature::legendre;

/// The prolate function $\psi = \psi_0^c$: of all functions on $[-1, 1]$ the one whose Fourier
/// transform is most concentrated in $[-c, c]$.
///
/// It is normalised by $\psi(0) = 1$. Its transform is the function itself:
/// $\int_0^1 \psi(x) \cos(kx)\,dx = C_0\,\psi(k/c)$ for $|k| \le c$, with $C_0 = \int_0^1 \psi$
/// (Slepian & Pollak 1961; Osipov, Rokhlin & Xiao, *Prolate Spheroidal Wave Functions of Order
/// Zero*, 2013).
#[derive(Clone, Debug)]
pub(crate) struct Prolate {
    bandwidth: f64,
    /// Legendre coefficients of $\psi$.
    value: Vec<f64>,
    /// Legendre coefficients of $\int_0^x \psi$.
    integral: Vec<f64>,
    /// $C_0$.
    half_integral: f64,
}

impl Prolate {
    /// The function of bandwidth $c > 0$.
    pub fn new(bandwidth: f64) -> Self {
        let value = legendre_coefficients(bandwidth);
        let integral = antiderivative(&value);
        Self {
            bandwidth,
            half_integral: legendre::series(&integral, 1.0),
            value,
            integral,
        }
    }

    /// $c$.
    pub fn bandwidth(&self) -> f64 {
        self.bandwidth
    }

    /// $\psi(x)$ for $|x| \le 1$; 0 beyond.
    pub fn value(&self, x: f64) -> f64 {
        if x.abs() > 1.0 {
            return 0.0;
        }
        legendre::series(&self.value, x)
    }

    /// $\psi'(x)$ for $|x| \le 1$; 0 beyond.
    pub fn derivative(&self, x: f64) -> f64 {
        if x.abs() > 1.0 {
            return 0.0;
        }
        legendre::series_with_derivative(&self.value, x).1
    }

    /// $C_0 = \int_0^1 \psi$.
    pub fn half_integral(&self) -> f64 {
        self.half_integral
    }

    /// $\int_0^x \psi$; $\pm C_0$ for $|x| \ge 1$.
    pub fn integral(&self, x: f64) -> f64 {
        legendre::series(&self.integral, x.clamp(-1.0, 1.0))
    }
}

/// Legendre coefficients of $\psi_0^c$: with $\bar P_k$ normalised, the vector of the smallest
/// eigenvalue of
///
/// $$ T_{kk} = k(k+1) + \frac{2k(k+1) - 1}{(2k+3)(2k-1)}\,c^2, \qquad
///    T_{k,k+2} = \frac{(k+1)(k+2)}{(2k+3)\sqrt{(2k+1)(2k+5)}}\,c^2, \qquad k \text{ even} $$
///
/// (Xiao, Rokhlin & Yarvin 2001, eq. 2.19). The second eigenvalue is at least five times the first,
/// so inverse iteration at zero converges by that factor a step; the matrix is positive definite
/// and needs no pivots.
fn legendre_coefficients(bandwidth: f64) -> Vec<f64> {
    const STEPS: usize = 30;
    let c2 = bandwidth * bandwidth;
    let count = bandwidth as usize + 30;
    let degree = |i: usize| 2.0 * i as f64;

    let mut pivots = vec![0.0; count];
    let mut below = vec![0.0; count];
    for i in 0..count {
        let k = degree(i);
        let diagonal =
            k * (k + 1.0) + c2 * (2.0 * k * (k + 1.0) - 1.0) / ((2.0 * k + 3.0) * (2.0 * k - 1.0));
        pivots[i] = diagonal;
        if i > 0 {
            let k = degree(i - 1);
            let off = c2 * (k + 1.0) * (k + 2.0)
                / ((2.0 * k + 3.0) * ((2.0 * k + 1.0) * (2.0 * k + 5.0)).sqrt());
            below[i] = off / pivots[i - 1];
            pivots[i] -= off * below[i];
        }
    }

    let mut vector = vec![0.0; count];
    vector[0] = 1.0;
    for _ in 0..STEPS {
        for i in 1..count {
            vector[i] -= below[i] * vector[i - 1];
        }
        for i in 0..count {
            vector[i] /= pivots[i];
        }
        for i in (1..count).rev() {
            vector[i - 1] -= below[i] * vector[i];
        }
        let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|x| *x /= norm);
    }

    let mut coefficients = vec![0.0; 2 * count - 1];
    for (i, x) in vector.iter().enumerate() {
        coefficients[2 * i] = x * (degree(i) + 0.5).sqrt();
    }
    let at_zero = legendre::series(&coefficients, 0.0);
    coefficients.iter_mut().for_each(|x| *x /= at_zero);
    coefficients
}

/// Coefficients of the integral from 0 of an even series, by
/// $\int P_k = (P_{k+1} - P_{k-1})/(2k+1)$.
fn antiderivative(even: &[f64]) -> Vec<f64> {
    let mut integral = vec![0.0; even.len() + 1];
    for (k, c) in even.iter().enumerate() {
        let part = c / (2 * k + 1) as f64;
        integral[k + 1] += part;
        if k > 0 {
            integral[k - 1] -= part;
        }
    }
    integral
}

#[cfg(test)]
mod tests {
    use panel_quadrature::GaussLegendre;

    use super::*;

    /// Rows $c$, $x$, $\psi$, $\psi'$, $\int_0^x\psi$, from the same expansion in mpmath with 60
    /// digits, by a Rayleigh quotient iteration. The values agree with scipy.special.pro_ang1 to
    /// its accuracy (it loses digits above c = 50).
    #[expect(clippy::excessive_precision)]
    const REFERENCE: [[f64; 5]; 8] = [
        [
            5.0,
            0.3,
            0.824958782487743104,
            -1.07911037927059714,
            0.281956093138623744,
        ],
        [
            5.0,
            0.95,
            0.0793336116669238793,
            -0.642288828688066229,
            0.557103484184982291,
        ],
        [
            20.0,
            0.3,
            0.412504735279403539,
            -2.49193276800672406,
            0.23131895942469075,
        ],
        [
            20.0,
            0.7,
            0.00422025748747168279,
            -0.0785560304683975797,
            0.280050797792010119,
        ],
        [
            20.0,
            0.95,
            2.39331779445859584e-6,
            -0.000130548232503714876,
            0.28024952460330673,
        ],
        [
            60.0,
            0.3,
            0.0653323873267283949,
            -1.21666742534341944,
            0.158773879784136803,
        ],
        [
            60.0,
            0.7,
            4.55358646206120407e-8,
            -2.63352245613114443e-6,
            0.161802158627703985,
        ],
        [
            120.0,
            0.3,
            0.00411962709798750816,
            -0.154454735021164111,
            0.114310217494309534,
        ],
    ];

    #[test]
    fn values_agree_with_mpmath() {
        for [c, x, value, derivative, integral] in REFERENCE {
            let psi = Prolate::new(c);
            assert!((psi.value(x) - value).abs() < 1e-14, "psi({c}, {x})");
            assert!(
                (psi.derivative(x) - derivative).abs() < 2e-12,
                "psi'({c}, {x})"
            );
            assert!(
                (psi.integral(x) - integral).abs() < 1e-15,
                "int psi({c}, {x})"
            );
            assert_eq!(psi.value(-x), psi.value(x));
            assert_eq!(psi.integral(-x), -psi.integral(x));
        }
    }

    #[test]
    fn its_transform_is_itself() {
        let rule = GaussLegendre::new(120).unwrap();
        for c in [0.5, 5.0, 20.0, 60.0, 120.0] {
            let psi = Prolate::new(c);
            for x in [0.0, 0.1, 0.4, 0.9, 1.0] {
                let transform: f64 = rule
                    .iter()
                    .map(|(y, weight)| 0.5 * weight * psi.value(y) * (c * x * y).cos())
                    .sum();
                assert!(
                    (transform / psi.half_integral() - psi.value(x)).abs() < 1e-14,
                    "{c} {x}"
                );
            }
        }
    }

    #[test]
    fn nothing_beyond_its_interval() {
        let psi = Prolate::new(12.0);
        assert_eq!((psi.value(1.5), psi.derivative(-2.0)), (0.0, 0.0));
        assert_eq!(psi.integral(3.0), psi.half_integral());
        assert_eq!(psi.bandwidth(), 12.0);
    }
}
