//! Smooth curves through points that lie close.

use svg::node::element::path::Data;

/// How far one piece of a curve may turn, in radians.
const TURN: f64 = 0.3;
/// How long it may be, in pixels.
const LENGTH: f64 = 40.0;

/// Adds a curve through points to a path: cubic pieces, each over many points where they lie on a
/// slight bend, with the points' own tangents at its ends.
pub fn curve(data: Data, points: &[[f64; 2]]) -> Data {
    let mut points = points.to_vec();
    points.dedup();
    let ends = ends(&points);
    let (Some(&first), true) = (points.first(), points.len() > 1) else {
        return data;
    };
    let data = data.move_to(rounded(first));
    ends.windows(2).fold(data, |data, pair| {
        let [from, to] = [pair[0], pair[1]];
        let (p, q) = (points[from], points[to]);
        let third = (q[0] - p[0]).hypot(q[1] - p[1]) / 3.0;
        let beside = |index: usize, [x, y]: [f64; 2], by: f64| {
            let [u, v] = tangent(&points, index);
            rounded([x + by * u, y + by * v])
        };
        data.cubic_curve_to((beside(from, p, third), beside(to, q, -third), rounded(q)))
    })
}

/// The points at which the pieces end.
fn ends(points: &[[f64; 2]]) -> Vec<usize> {
    let mut ends = vec![0];
    let (mut turned, mut length) = (0.0, 0.0);
    for k in 1..points.len() {
        let [a, b] = [points[k - 1], points[k]];
        length += (b[0] - a[0]).hypot(b[1] - a[1]);
        if let Some(&c) = points.get(k + 1) {
            let ([u, v], [s, t]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            turned += f64::atan2(u * t - v * s, u * s + v * t).abs();
        }
        if turned > TURN || length > LENGTH || k + 1 == points.len() {
            ends.push(k);
            (turned, length) = (0.0, 0.0);
        }
    }
    ends
}

/// The unit tangent at a point, of the parabola through it and its neighbours.
fn tangent(points: &[[f64; 2]], index: usize) -> [f64; 2] {
    let way = |from: usize, to: usize| {
        let (p, q) = (points[from], points[to]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        ([(q[0] - p[0]) / length, (q[1] - p[1]) / length], length)
    };
    let last = points.len() - 1;
    let middle = index.clamp(1, last.max(2) - 1);
    if last < 2 {
        return way(0, last).0;
    }
    let ((a, before), (b, after)) = (way(middle - 1, middle), way(middle, middle + 1));
    // Where the point is on the way from the one piece's middle to the other's.
    let t = match index {
        0 => -before,
        _ if index == last => before + 2.0 * after,
        _ => before,
    } / (before + after);
    let [u, v] = [0, 1].map(|j| a[j] + t * (b[j] - a[j]));
    let norm = u.hypot(v);
    [u / norm, v / norm]
}

/// Pixels to a hundredth: here roughness shows.
fn rounded([x, y]: [f64; 2]) -> (f32, f32) {
    let hundredths = |x: f64| ((100.0 * x).round() / 100.0) as f32;
    (hundredths(x), hundredths(y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_takes_few_pieces() {
        let angles: Vec<f64> = (0..=200).map(|k| 0.02 * f64::from(k)).collect();
        let points: Vec<[f64; 2]> = angles
            .iter()
            .map(|a| [100.0 * a.cos(), 100.0 * a.sin()])
            .collect();
        let ends = ends(&points);
        assert!((10..16).contains(&ends.len()), "{ends:?}");
        for (k, angle) in angles.iter().enumerate() {
            let [u, v] = tangent(&points, k);
            assert!((u + angle.sin()).hypot(v - angle.cos()) < 1e-3, "{k}");
        }
    }

    #[test]
    fn of_few_points() {
        let text = |points: &[[f64; 2]]| {
            let data = curve(Data::new(), points);
            svg::node::Value::from(data).to_string()
        };
        assert_eq!(text(&[]), "");
        assert_eq!(text(&[[1.0, 2.0], [1.0, 2.0]]), "");
        assert_eq!(text(&[[0.0, 0.0], [3.0, 0.0]]), "M0,0 C1,0,2,0,3,0");
    }
}
