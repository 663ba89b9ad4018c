//! Power laws $T \propto N^\alpha$.

/// $y = c\\, x^\alpha$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The exponent $\alpha$.
    pub exponent: f64,
    /// The factor $c$.
    pub factor: f64,
}

impl PowerLaw {
    /// The least-squares line through the logarithms of positive points; none through fewer than
    /// two places.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let count = points.len() as f64;
        let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / count;
        let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / count;
        let spread: f64 = logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
        let slope: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
        let exponent = slope / spread;
        let factor = (mean_y - exponent * mean_x).exp();
        (exponent.is_finite() && factor.is_finite()).then_some(Self { exponent, factor })
    }

    /// The law's value.
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_law_and_refuses_a_point() {
        let points: Vec<_> = (1..5)
            .map(|x| (f64::from(x), 3.0 * f64::from(x).powf(1.5)))
            .collect();
        let law = PowerLaw::fit(&points).unwrap();
        assert!((law.exponent - 1.5).abs() < 1e-14 && (law.factor - 3.0).abs() < 1e-13);
        assert!((law.at(4.0) - 24.0).abs() < 1e-12);
        assert_eq!(PowerLaw::fit(&points[..1]), None);
        assert_eq!(PowerLaw::fit(&[]), None);
    }
}
