//! Crossings of polygons.

use super::Meridian;

/// Twice the signed area of the triangle a, b, c.
fn orientation(a: Meridian, b: Meridian, c: Meridian) -> f64 {
    (b.r - a.r) * (c.z - a.z) - (b.z - a.z) * (c.r - a.r)
}

/// A rectangle around a part of a polygon.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    fn around(a: Meridian, b: Meridian) -> Self {
        Self {
            low: [a.r.min(b.r), a.z.min(b.z)],
            high: [a.r.max(b.r), a.z.max(b.z)],
        }
    }

    fn joined(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [
                self.high[0].max(other.high[0]),
                self.high[1].max(other.high[1]),
            ],
        }
    }

    fn meets(self, other: Self) -> bool {
        (0..2).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// A place where the polygon through `points` meets itself other than where two successive sides
/// join, or turns straight back; `closed` says that the last point repeats the first.
///
/// Pairs of sides are searched through a binary tree of rectangles along the polygon: about N log N
/// steps for N points of a reasonable curve.
pub(super) fn first_crossing(points: &[Meridian], closed: bool) -> Option<Meridian> {
    let sides = points.len().saturating_sub(1);
    if sides < 2 {
        return None;
    }
    let leaves: Vec<Rectangle> = points
        .windows(2)
        .map(|p| Rectangle::around(p[0], p[1]))
        .collect();
    let mut levels = vec![leaves];
    while let Some(level) = levels.last().filter(|level| level.len() > 1) {
        let next = level
            .chunks(2)
            .map(|c| c[0].joined(c[c.len() - 1]))
            .collect();
        levels.push(next);
    }
    let mut pairs = vec![(levels.len() - 1, 0, 0)];
    while let Some((level, i, j)) = pairs.pop() {
        if !levels[level][i].meets(levels[level][j]) {
            continue;
        }
        if level > 0 {
            let below = levels[level - 1].len();
            for child in 2 * i..(2 * i + 2).min(below) {
                let first = if i == j { child } else { 2 * j };
                pairs
                    .extend((first..(2 * j + 2).min(below)).map(|other| (level - 1, child, other)));
            }
        } else if i != j {
            let (a, b, c, d) = (points[i], points[i + 1], points[j], points[j + 1]);
            let crosses = if j == i + 1 {
                turns_back(a, b, d)
            } else if closed && i == 0 && j == sides - 1 {
                turns_back(c, a, b)
            } else {
                orientation(a, b, c) * orientation(a, b, d) <= 0.0
                    && orientation(c, d, a) * orientation(c, d, b) <= 0.0
            };
            if crosses {
                return Some(c);
            }
        }
    }
    None
}

/// Whether the path a, b, c returns onto itself.
fn turns_back(a: Meridian, b: Meridian, c: Meridian) -> bool {
    let along = (b.r - a.r) * (c.r - b.r) + (b.z - a.z) * (c.z - b.z);
    along < 0.0 && orientation(a, b, c) == 0.0
}

/// Volume over pi of the body whose meridian is the polygon; positive if the normal points outward.
pub(super) fn signed_volume(points: &[Meridian]) -> f64 {
    points
        .windows(2)
        .map(|p| (p[0].z - p[1].z) * (p[0].r * p[0].r + p[0].r * p[1].r + p[1].r * p[1].r) / 3.0)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<Meridian> {
        points.iter().map(|&(r, z)| Meridian { r, z }).collect()
    }

    #[test]
    fn crossings_are_found() {
        let bow = polygon(&[(1.0, 1.0), (2.0, 0.0), (2.0, 1.0), (1.0, 0.0), (1.0, 1.0)]);
        assert!(first_crossing(&bow, true).is_some());
        let square = polygon(&[(1.0, 1.0), (2.0, 1.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        assert!(first_crossing(&square, true).is_none());
        let spike = polygon(&[(0.0, 1.0), (2.0, 0.0), (1.0, 0.5), (0.0, -1.0)]);
        assert!(first_crossing(&spike, false).is_some());
        assert!((signed_volume(&square) - 3.0).abs() < 1e-15);
    }

    #[test]
    fn many_sides_take_little_time() {
        // A comb of 25000 teeth that does not cross itself.
        let points: Vec<Meridian> = (0..100_000)
            .map(|k| Meridian {
                r: f64::from(k),
                z: f64::from(k % 4 / 2),
            })
            .collect();
        assert!(first_crossing(&points, false).is_none());
    }
}
