//! Evenly spaced streamlines.
//!
//! After Jobard and Lefer, *Creating evenly-spaced streamlines of arbitrary density*, Visualization
//! in Scientific Computing '97: a streamline is followed both ways until it comes too near to
//! another one; new ones start at a given distance beside those there are.

use std::collections::VecDeque;

/// Steps per distance of neighbouring streamlines.
const STEPS: f64 = 8.0;
/// How near a streamline may come to others, as a part of the distance at which they start.
const NEAREST: f64 = 0.5;
/// Shortest streamline that is kept, in distances of neighbouring ones.
const SHORTEST: f64 = 2.0;
/// How far the direction may turn within a step: this is its cosine.
const LEAST_COSINE: f64 = 0.9;
/// How often a step is halved where the direction turns faster; a line that needs more ends, at a
/// stagnation point.
const HALVINGS: usize = 5;
/// Most steps of a streamline in either direction.
const MOST_STEPS: usize = 4000;

/// A line along the flow, its points in the direction of the flow at equal steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Streamline {
    /// Coordinates in the plane.
    pub points: Vec<[f64; 2]>,
    /// Whether it returns to where it began.
    pub closed: bool,
}

/// Streamlines of a flow in the rectangle of a size around the origin, about `separation` apart.
///
/// `direction` is the direction of the flow, a unit vector, and `None` where there is no flow:
/// streamlines end there, and at the edges.
pub fn evenly_spaced(
    direction: impl Fn([f64; 2]) -> Option<[f64; 2]>,
    size: [f64; 2],
    separation: f64,
) -> Vec<Streamline> {
    let mut drawing = Drawing {
        direction,
        size,
        separation,
        near: Neighbourhood::new(size, separation),
        lines: Vec::new(),
    };
    let [columns, rows] = size.map(|length| (length / separation).ceil().max(1.0) as usize);
    // Beside the lines there are as long as there is room; then wherever no line has come.
    for k in 0..rows * columns {
        let cell =
            |i: usize, count: usize, length: f64| ((i as f64 + 0.5) / count as f64 - 0.5) * length;
        let start = [
            cell(k % columns, columns, size[0]),
            cell(k / columns, rows, size[1]),
        ];
        if drawing.start(start) {
            drawing.fill();
        }
    }
    drawing.lines
}

struct Drawing<F> {
    direction: F,
    size: [f64; 2],
    separation: f64,
    near: Neighbourhood,
    lines: Vec<Streamline>,
}

impl<F: Fn([f64; 2]) -> Option<[f64; 2]>> Drawing<F> {
    /// Draws the streamline through a point, if it is far enough from the others and gets long
    /// enough.
    fn start(&mut self, start: [f64; 2]) -> bool {
        if !self.contains(start) || self.near.any_within(start, 0.99 * self.separation) {
            return false;
        }
        let Some(line) = self.line(start) else {
            return false;
        };
        for &point in &line.points {
            self.near.add(point);
        }
        self.lines.push(line);
        true
    }

    /// Draws streamlines beside the last one, beside those, and so on.
    fn fill(&mut self) {
        let mut queue = VecDeque::from([self.lines.len() - 1]);
        while let Some(index) = queue.pop_front() {
            let line = self.lines[index].points.clone();
            for &[x, y] in line.iter().step_by(STEPS as usize / 2) {
                let Some([u, v]) = (self.direction)([x, y]) else {
                    continue;
                };
                for side in [self.separation, -self.separation] {
                    if self.start([x - side * v, y + side * u]) {
                        queue.push_back(self.lines.len() - 1);
                    }
                }
            }
        }
    }

    fn line(&self, start: [f64; 2]) -> Option<Streamline> {
        let (mut points, closed) = self.follow(start, 1.0);
        if !closed {
            let (mut before, _) = self.follow(start, -1.0);
            before.reverse();
            before.pop();
            before.append(&mut points);
            points = before;
        }
        let long = points.len() as f64 > SHORTEST * STEPS;
        long.then_some(Streamline { points, closed })
    }

    /// The points from `start` on, with or against the flow, and whether they lead back there.
    fn follow(&self, start: [f64; 2], sign: f64) -> (Vec<[f64; 2]>, bool) {
        let step = self.separation / STEPS;
        let nearest = NEAREST * self.separation;
        let mut own = Neighbourhood::new(self.size, self.separation);
        let mut points = vec![start];
        // The line's own points count once it has left them behind.
        let behind = (3.0 * STEPS) as usize;
        while points.len() < MOST_STEPS {
            let last = points[points.len() - 1];
            let Some(next) = self.step(last, sign * step, HALVINGS) else {
                break;
            };
            if !self.contains(next) || self.near.any_within(next, nearest) {
                break;
            }
            if points.len() > behind {
                if distance(next, start) <= step {
                    points.push(start);
                    return (points, true);
                }
                if own.any_within(next, 0.5 * nearest) && distance(next, start) > 2.0 * step {
                    break;
                }
                own.add(points[points.len() - behind]);
            }
            points.push(next);
        }
        (points, false)
    }

    /// One step of the classical Runge–Kutta method along the unit directions, in halves where
    /// they turn fast; `None` if it leads to where there is no flow.
    fn step(&self, [x, y]: [f64; 2], h: f64, halvings: usize) -> Option<[f64; 2]> {
        let at = |t: f64, [u, v]: [f64; 2]| (self.direction)([x + t * u, y + t * v]);
        let a = (self.direction)([x, y])?;
        let b = at(0.5 * h, a)?;
        let c = at(0.5 * h, b)?;
        let d = at(h, c)?;
        let turn = [b, c, d].map(|e| a[0] * e[0] + a[1] * e[1]);
        if turn.iter().any(|&cos| cos < LEAST_COSINE) {
            if halvings == 0 {
                return None;
            }
            let middle = self.step([x, y], 0.5 * h, halvings - 1)?;
            return self.step(middle, 0.5 * h, halvings - 1);
        }
        let mean = |j: usize| (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]) / 6.0;
        Some([x + h * mean(0), y + h * mean(1)])
    }

    fn contains(&self, point: [f64; 2]) -> bool {
        [0, 1].iter().all(|&j| point[j].abs() <= 0.5 * self.size[j])
    }
}

/// Points sorted into square cells, to find those near to another one.
struct Neighbourhood {
    cell: f64,
    corner: [f64; 2],
    columns: usize,
    cells: Vec<Vec<[f64; 2]>>,
}

impl Neighbourhood {
    /// For a rectangle of this size around the origin, and distances up to `cell`.
    fn new(size: [f64; 2], cell: f64) -> Self {
        let [columns, rows] = size.map(|length| (length / cell) as usize + 1);
        Self {
            cell,
            corner: size.map(|length| -0.5 * length),
            columns,
            cells: vec![Vec::new(); columns * rows],
        }
    }

    fn place(&self, point: [f64; 2]) -> [usize; 2] {
        let rows = self.cells.len() / self.columns;
        [(0, self.columns), (1, rows)]
            .map(|(j, count)| (((point[j] - self.corner[j]) / self.cell) as usize).min(count - 1))
    }

    fn add(&mut self, point: [f64; 2]) {
        let [i, k] = self.place(point);
        self.cells[k * self.columns + i].push(point);
    }

    /// Whether a point is nearer than a distance, which must not exceed the cells' size.
    fn any_within(&self, point: [f64; 2], reach: f64) -> bool {
        let [i, k] = self.place(point);
        let rows = self.cells.len() / self.columns;
        (k.saturating_sub(1)..=(k + 1).min(rows - 1)).any(|k| {
            (i.saturating_sub(1)..=(i + 1).min(self.columns - 1)).any(|i| {
                let cell = &self.cells[k * self.columns + i];
                cell.iter().any(|&other| distance(point, other) < reach)
            })
        })
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit([u, v]: [f64; 2]) -> Option<[f64; 2]> {
        let speed = u.hypot(v);
        (speed > 1e-9).then(|| [u / speed, v / speed])
    }

    /// No point nearer to another line than allowed, and no point of the rectangle far from all
    /// lines.
    fn check_spacing(lines: &[Streamline], size: [f64; 2], separation: f64) {
        for (k, line) in lines.iter().enumerate() {
            for other in lines[k + 1..].iter().flat_map(|line| &line.points) {
                let least = line.points.iter().map(|&p| distance(p, *other));
                let least = least.fold(f64::INFINITY, f64::min);
                assert!(least >= 0.49 * separation, "{least}");
            }
        }
        for k in 0..400 {
            let point = [
                size[0] * (0.05 * f64::from(k % 20) - 0.475),
                size[1] * (0.05 * f64::from(k / 20) - 0.475),
            ];
            let least = lines.iter().flat_map(|line| &line.points);
            let least = least
                .map(|&p| distance(p, point))
                .fold(f64::INFINITY, f64::min);
            assert!(
                least < 2.0 * separation,
                "{point:?} is {least} from all lines"
            );
        }
    }

    #[test]
    fn a_uniform_flow_has_parallel_lines() {
        let lines = evenly_spaced(|_| unit([3.0, 4.0]), [2.0, 1.0], 0.1);
        check_spacing(&lines, [2.0, 1.0], 0.1);
        for line in &lines {
            assert!(!line.closed);
            let [first, last] = [line.points[0], line.points[line.points.len() - 1]];
            let along = [last[0] - first[0], last[1] - first[1]];
            assert!(along[0] > 0.0 && (along[0] * 4.0 - along[1] * 3.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_rotation_has_closed_circles() {
        let lines = evenly_spaced(|[x, y]| unit([-y, x]), [2.0, 2.0], 0.1);
        check_spacing(&lines, [2.0, 2.0], 0.1);
        let mut whole = 0;
        for line in &lines {
            let radius = line.points[0][0].hypot(line.points[0][1]);
            // An arc whose radius is less than the step's is not resolved.
            for point in line.points.iter().filter(|_| radius > 0.05) {
                assert!((point[0].hypot(point[1]) - radius).abs() < 1e-4 * radius);
            }
            assert!(line.closed || radius > 0.9, "{radius}");
            whole += usize::from(line.closed);
        }
        assert!(whole >= 7, "{whole}");
    }

    #[test]
    fn no_flow_has_no_lines() {
        assert!(evenly_spaced(|_| None, [1.0, 1.0], 0.1).is_empty());
        let halves = evenly_spaced(|[x, _]| (x > 0.0).then_some([0.0, 1.0]), [1.0, 1.0], 0.1);
        assert!(!halves.is_empty());
        assert!(
            halves
                .iter()
                .flat_map(|line| &line.points)
                .all(|p| p[0] > 0.0)
        );
    }
}
