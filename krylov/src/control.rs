//! Which method iterates, and how exact its products are.

use super::error::KrylovError;

/// How to iterate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// GMRES (Y. Saad and M. H. Schultz, 1986): the iterate of least residual in the Krylov space.
    /// It makes one product per iteration and keeps up to `restart + 1` vectors.
    Gmres {
        /// After how many iterations the basis is thrown away; at least 1.
        restart: usize,
    },
    /// BiCGStab, stabilised biconjugate gradients (H. A. van der Vorst, 1992): two products per
    /// iteration, eight vectors in all.
    BiCgStab,
}

/// When to end, and how exact the products are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Norm of the residual, over that of the right-hand side, to reach; between 0 and 1.
    pub tolerance: f64,
    /// Iterations after which the method gives up.
    pub max_iterations: usize,
    /// Share of the tolerance that one product's error may take; between 0 and 1.
    pub safety: f64,
    /// Largest tolerance that is asked of a product. With 0 all products are made at full
    /// tolerance, which is `safety` times `tolerance`.
    pub loosest: f64,
}

impl Control {
    /// A thousand iterations, all products at a tenth of the tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            max_iterations: 1000,
            safety: 0.1,
            loosest: 0.0,
        }
    }

    pub(crate) fn validate<E>(&self, method: Method) -> Result<(), KrylovError<E>> {
        let bad = |quantity, value, expected| KrylovError::Control {
            quantity,
            value,
            expected,
        };
        let open = "a number above 0 and below 1";
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(bad("tolerance", self.tolerance, open));
        }
        if !(self.safety > 0.0 && self.safety < 1.0) {
            return Err(bad("safety", self.safety, open));
        }
        if !(self.loosest >= 0.0 && self.loosest < 1.0) {
            return Err(bad(
                "loosest",
                self.loosest,
                "a number from 0 to less than 1",
            ));
        }
        if method == (Method::Gmres { restart: 0 }) {
            return Err(bad("restart", 0.0, "at least 1"));
        }
        Ok(())
    }
}
