//! A panel: an interval of the parameter that quadrature works on.

/// An interval of a curve's parameter, within one smooth piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Parameter of its first end.
    pub start: f64,
    /// Parameter of its last end, larger than `start`.
    pub end: f64,
    /// The smooth piece it belongs to, from 0.
    pub piece: usize,
}

impl Panel {
    /// Its length in the parameter.
    pub fn length(&self) -> f64 {
        self.end - self.start
    }

    /// The parameter at `t` of the reference interval [-1, 1].
    pub fn at(&self, t: f64) -> f64 {
        // From the nearer end, so that t = -1 and t = 1 give the ends themselves.
        let half = 0.5 * self.length();
        if t < 0.0 {
            self.start + half * (1.0 + t)
        } else {
            self.end - half * (1.0 - t)
        }
    }

    /// Its two halves.
    pub(super) fn halves(&self) -> [Self; 2] {
        let middle = self.start + 0.5 * self.length();
        [
            Self {
                end: middle,
                ..*self
            },
            Self {
                start: middle,
                ..*self
            },
        ]
    }
}
