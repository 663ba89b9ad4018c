//! The cube around all points.

/// Sides tried: the extent of the points takes so many sixteenths of the root's.
const SIXTEENTHS: [f64; 8] = [16.0, 15.0, 14.0, 13.0, 12.0, 11.0, 10.0, 9.0];
/// Significant bits of the root's side: few, so that there are many levels with exact centres.
const SIDE_BITS: i32 = 12;

/// The root box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    /// Its lower corner.
    pub corner: [f64; 3],
    pub side: f64,
    /// Finest level whose centres are exact in floating point.
    pub finest: usize,
}

impl Root {
    /// Roots of several sides around the points. All have their lower corner at that of the points:
    /// points in a plane then lie within a layer of boxes, not on the faces between two layers.
    pub fn candidates(sources: &[[f64; 3]], targets: Option<&[[f64; 3]]>) -> Vec<Root> {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for points in [sources, targets.unwrap_or_default()] {
            for point in points {
                for axis in 0..3 {
                    low[axis] = low[axis].min(point[axis]);
                    high[axis] = high[axis].max(point[axis]);
                }
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        let largest = low
            .iter()
            .chain(&high)
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        let extent = (0..3).fold(0.0, |a: f64, axis| a.max(high[axis] - low[axis]));
        if extent == 0.0 {
            let side = if largest > 0.0 { largest } else { 1.0 };
            return vec![Root::around(low, largest, side)];
        }
        SIXTEENTHS
            .iter()
            .map(|part| Root::around(low, largest, extent * 16.0 / part))
            .collect()
    }

    /// A root slightly larger than `side`, for coordinates up to `largest` in magnitude.
    fn around(low: [f64; 3], largest: f64, side: f64) -> Root {
        let side = f64::max(side, largest * 2f64.powi(-38)).max(f64::MIN_POSITIVE / f64::EPSILON);
        let unit = 2f64.powi(exponent(side) + 1 - SIDE_BITS);
        // One unit more than needed, if need be: no point may lie on the upper face.
        let side = ((side / unit).floor() + 1.0) * unit;
        let magnitude = exponent(largest + side);
        let ulp = 2f64.powi(magnitude - 52);
        let corner = low.map(|x| (x / ulp).floor() * ulp);
        // Half a side of level l is a multiple of unit / 2^(l + 1), which must be one of the ulp.
        let finest = exponent(unit) - 1 - (magnitude - 52);
        Root {
            corner,
            side,
            finest: finest.max(0) as usize,
        }
    }

    /// Side of the boxes of a level.
    pub fn side(&self, level: usize) -> f64 {
        self.side * 2f64.powi(-(level as i32))
    }

    /// Centre of the box of a level at a place.
    pub fn center(&self, level: usize, place: [i64; 3]) -> [f64; 3] {
        let half = 0.5 * self.side(level);
        std::array::from_fn(|axis| self.corner[axis] + (2 * place[axis] + 1) as f64 * half)
    }
}

/// The power of two at or below a positive normal number.
fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023
}
