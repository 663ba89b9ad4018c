//! Times that decide whether a grid pays.

/// What the pieces of a sum take, in nanoseconds on one thread.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    /// One pair of points within the reach of its residual.
    pub pair: f64,
    /// One gridded box: its transforms, its transfers from and to its parent, its translations.
    pub grid: f64,
    /// One point spread onto a grid and interpolated from it.
    pub point: f64,
}

impl Costs {
    /// Those of a sample, one of `stride` points, for which every point stands.
    pub(super) fn thinned(&self, stride: f64) -> Costs {
        Costs {
            pair: self.pair * stride * stride,
            grid: self.grid,
            point: self.point * stride,
        }
    }
}
