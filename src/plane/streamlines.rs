//! Evenly spaced streamlines.
//!
//! After Jobard and Lefer, *Creating evenly-spaced streamlines of arbitrary density*, Visualization
//! in Scientific Computing '97: a streamline is followed both ways until it comes too near to
//! another one, or to itself; new ones start at a given distance beside those there are.

use std::collections::VecDeque;
use std::f64::consts::PI;

/// Steps per distance of neighbouring streamlines, where the line is straight.
const STEPS: f64 = 8.0;
/// How near a streamline may come to others, as a part of the distance at which they start.
const NEAREST: f64 = 0.5;
/// The same for its own earlier turns: in a spiral, and in a hairpin.
const OWN_NEAREST: f64 = 0.25;
/// How far beside its start a line may come back to be closed, as a part of the same distance.
const CLOSED: f64 = 0.01;
/// Shortest streamlines that are kept, in distances of neighbouring ones: long ones first, for
/// short ones would be in their way.
const SHORTEST: [f64; 3] = [12.0, 5.0, 2.0];
/// How far the direction may turn within a step: this is its cosine.
const LEAST_COSINE: f64 = 0.97;
/// How often a step is halved where the direction turns faster; a line that needs more ends, at a
/// stagnation point.
const HALVINGS: usize = 3;
/// Most steps of a streamline in either direction.
const MOST_STEPS: usize = 4000;

/// A line along the flow, its points in the direction of the flow and closer where it bends.
#[derive(Clone, Debug, PartialEq)]
pub struct Streamline {
    /// Coordinates in the plane.
    pub points: Vec<[f64; 2]>,
    /// Whether it returns to where it began.
    pub closed: bool,
}

impl Streamline {
    /// The length from its beginning to every point.
    pub fn lengths(&self) -> Vec<f64> {
        let mut length = 0.0;
        let pairs = self.points.windows(2);
        let steps = pairs.map(|pair| {
            length += distance(pair[0], pair[1]);
            length
        });
        std::iter::once(0.0).chain(steps).collect()
    }
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
        shortest: 0.0,
        near: Neighbourhood::new(size, separation),
        own: Neighbourhood::new(size, separation),
        lines: Vec::new(),
    };
    let [columns, rows] = size.map(|length| (length / separation).ceil().max(1.0) as usize);
    for shortest in SHORTEST {
        drawing.shortest = shortest * separation;
        // Beside the lines there are as long as there is room; then wherever no line has come.
        drawing.fill(0);
        for k in 0..rows * columns {
            let cell = |i: usize, count: usize, length: f64| {
                ((i as f64 + 0.5) / count as f64 - 0.5) * length
            };
            let start = [
                cell(k % columns, columns, size[0]),
                cell(k / columns, rows, size[1]),
            ];
            if drawing.start(start) {
                drawing.fill(drawing.lines.len() - 1);
            }
        }
    }
    drawing.lines
}

struct Drawing<F> {
    direction: F,
    size: [f64; 2],
    separation: f64,
    /// The shortest line that is drawn.
    shortest: f64,
    /// Points of all lines.
    near: Neighbourhood,
    /// Points of the line that is being drawn, each with the length from its start.
    own: Neighbourhood,
    lines: Vec<Streamline>,
}

impl<F: Fn([f64; 2]) -> Option<[f64; 2]>> Drawing<F> {
    /// Draws the streamline through a point, if it is far enough from the others and gets long
    /// enough.
    fn start(&mut self, start: [f64; 2]) -> bool {
        if !self.contains(start)
            || self
                .near
                .any_within(start, 0.99 * self.separation, |_| true)
        {
            return false;
        }
        let Some(line) = self.line(start) else {
            return false;
        };
        for &point in &line.points {
            self.near.add(point, 0.0);
        }
        self.lines.push(line);
        true
    }

    /// Draws streamlines beside the lines from the `first` on, beside those, and so on.
    fn fill(&mut self, first: usize) {
        let mut queue: VecDeque<usize> = (first..self.lines.len()).collect();
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

    fn line(&mut self, start: [f64; 2]) -> Option<Streamline> {
        self.own.clear();
        self.own.add(start, 0.0);
        let (mut points, closed) = self.follow(start, 1.0);
        if !closed {
            let (mut before, _) = self.follow(start, -1.0);
            before.reverse();
            before.pop();
            before.append(&mut points);
            points = before;
        }
        let line = Streamline { points, closed };
        let length = line.lengths().last().copied().unwrap_or_default();
        (length > self.shortest).then_some(line)
    }

    /// The points from `start` on, with or against the flow, and whether they lead back there.
    fn follow(&mut self, start: [f64; 2], sign: f64) -> (Vec<[f64; 2]>, bool) {
        let reach = OWN_NEAREST * self.separation;
        // Own points count from half a circle on that is as wide as the reach.
        let behind = 0.55 * PI * reach;
        let mut points = vec![start];
        let (mut last, mut length) = (start, 0.0);
        // Those beyond are in the line if it closes only.
        let mut sure = 1;
        let mut some = Vec::new();
        'line: while points.len() < MOST_STEPS {
            some.clear();
            let step = sign * self.separation / STEPS;
            let Some(end) = self.step(last, step, HALVINGS, &mut some) else {
                break;
            };
            for &next in &some {
                let others = NEAREST * self.separation;
                if !self.contains(next) || self.near.any_within(next, others, |_| true) {
                    break 'line;
                }
                length += sign * distance(next, points[points.len() - 1]);
                let back = match length > behind {
                    true => self.comes_back(start, next),
                    false => Back::No,
                };
                let earlier = |at: f64| (length - at).abs() > behind;
                match back {
                    Back::Before => {}
                    Back::There => {
                        // A short last piece would point aside.
                        let far = |point: &[f64; 2]| distance(*point, start) >= step.abs();
                        points.truncate(points.iter().rposition(far).map_or(0, |k| k + 1));
                        points.push(start);
                        return (points, true);
                    }
                    Back::No if self.own.any_within(next, reach, earlier) => break 'line,
                    Back::No => sure = points.len() + 1,
                }
                self.own.add(next, length);
                points.push(next);
            }
            last = end;
        }
        points.truncate(sure);
        (points, false)
    }

    /// Where a point of a line that has left its start is, seen from there.
    fn comes_back(&self, start: [f64; 2], [x, y]: [f64; 2]) -> Back {
        let near = distance(start, [x, y]) < OWN_NEAREST * self.separation;
        let Some([u, v]) = (self.direction)(start).filter(|_| near) else {
            return Back::No;
        };
        let [x, y] = [x - start[0], y - start[1]];
        let (beyond, aside) = (x * u + y * v, (x * v - y * u).abs());
        if beyond < 0.0 {
            Back::Before
        } else if beyond <= self.separation / STEPS && aside <= CLOSED * self.separation {
            Back::There
        } else {
            Back::No
        }
    }

    /// Adds the points of one step of the classical Runge–Kutta method along the unit directions,
    /// in halves where they turn fast, and returns the last; `None` if it leads to where there is
    /// no flow.
    fn step(
        &self,
        [x, y]: [f64; 2],
        h: f64,
        halvings: usize,
        points: &mut Vec<[f64; 2]>,
    ) -> Option<[f64; 2]> {
        let at = |t: f64, [u, v]: [f64; 2]| (self.direction)([x + t * u, y + t * v]);
        let a = (self.direction)([x, y])?;
        let b = at(0.5 * h, a)?;
        let c = at(0.5 * h, b)?;
        let d = at(h, c)?;
        let turn = [b, c, d].map(|e| a[0] * e[0] + a[1] * e[1]);
        if turn.iter().any(|&cos| cos < LEAST_COSINE) {
            let halvings = halvings.checked_sub(1)?;
            let middle = self.step([x, y], 0.5 * h, halvings, points)?;
            return self.step(middle, 0.5 * h, halvings, points);
        }
        let mean = |j: usize| (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]) / 6.0;
        let end = [x + h * mean(0), y + h * mean(1)];
        points.push(end);
        Some(end)
    }

    fn contains(&self, point: [f64; 2]) -> bool {
        [0, 1].iter().all(|&j| point[j].abs() <= 0.5 * self.size[j])
    }
}

/// Whether a line that has left its start comes back there.
enum Back {
    /// It is elsewhere, or passes beside it.
    No,
    /// It is near its start, but not there yet.
    Before,
    /// It is there, a step beyond at most.
    There,
}

/// Points sorted into square cells, to find those near to another one; each with a number, the
/// length along its line where that matters.
struct Neighbourhood {
    cell: f64,
    corner: [f64; 2],
    columns: usize,
    cells: Vec<Vec<([f64; 2], f64)>>,
    /// The cells that have points.
    filled: Vec<usize>,
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
            filled: Vec::new(),
        }
    }

    fn place(&self, point: [f64; 2]) -> [usize; 2] {
        let rows = self.cells.len() / self.columns;
        [(0, self.columns), (1, rows)]
            .map(|(j, count)| (((point[j] - self.corner[j]) / self.cell) as usize).min(count - 1))
    }

    fn add(&mut self, point: [f64; 2], number: f64) {
        let [i, k] = self.place(point);
        let cell = k * self.columns + i;
        if self.cells[cell].is_empty() {
            self.filled.push(cell);
        }
        self.cells[cell].push((point, number));
    }

    /// Forgets all points.
    fn clear(&mut self) {
        for cell in self.filled.drain(..) {
            self.cells[cell].clear();
        }
    }

    /// Whether a point that counts is nearer than a distance, which must not exceed the cells'
    /// size.
    fn any_within(&self, point: [f64; 2], reach: f64, counts: impl Fn(f64) -> bool) -> bool {
        let [i, k] = self.place(point);
        let rows = self.cells.len() / self.columns;
        let within = |other: [f64; 2]| {
            (point[0] - other[0]).powi(2) + (point[1] - other[1]).powi(2) < reach * reach
        };
        (k.saturating_sub(1)..=(k + 1).min(rows - 1)).any(|k| {
            (i.saturating_sub(1)..=(i + 1).min(self.columns - 1)).any(|i| {
                let cell = &self.cells[k * self.columns + i];
                cell.iter()
                    .any(|&(other, number)| within(other) && counts(number))
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
                assert!(least >= 0.99 * NEAREST * separation, "{least}");
            }
            check_line(line, separation);
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

    /// No point nearer than allowed to one that is more than a half circle behind.
    fn check_line(line: &Streamline, separation: f64) {
        let lengths = line.lengths();
        let whole = lengths[lengths.len() - 1];
        let reach = OWN_NEAREST * separation;
        for (i, &p) in line.points.iter().enumerate() {
            for (j, &q) in line.points.iter().enumerate().skip(i) {
                let along = lengths[j] - lengths[i];
                let along = match line.closed {
                    true => along.min(whole - along),
                    false => along,
                };
                assert!(
                    along < 0.6 * PI * reach || distance(p, q) > 0.99 * reach,
                    "{p:?} {q:?}, {along} behind"
                );
            }
        }
    }

    /// Every piece of the lines is along the flow in its middle, and no bend is sharper than about
    /// what a step may turn.
    fn check_direction(
        lines: &[Streamline],
        direction: impl Fn([f64; 2]) -> Option<[f64; 2]>,
        separation: f64,
    ) {
        let mut pieces = 0;
        for line in lines {
            let ways = line.points.windows(2).filter_map(|pair| {
                let [a, b] = [pair[0], pair[1]];
                let length = distance(a, b);
                // What closes a line is as short as it comes.
                let way = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
                let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                (length > 1e-3 * separation).then_some((way, middle))
            });
            let ways: Vec<_> = ways.collect();
            for (way, middle) in &ways {
                let [u, v] = direction(*middle).expect("a flow");
                let cos = way[0] * u + way[1] * v;
                assert!(cos > 0.98, "{middle:?}: {cos}");
                pieces += 1;
            }
            for pair in ways.windows(2) {
                let ([a, b], [c, d]) = (pair[0].0, pair[1].0);
                assert!(a * c + b * d > 0.93, "a bend at {:?}", pair[1].1);
            }
        }
        assert!(pieces > 100);
    }

    #[test]
    fn spirals_end_before_their_turns_meet() {
        for inwards in [0.003, 0.03, 0.3, -0.1] {
            let field = |[x, y]: [f64; 2]| unit([-y - inwards * x, x - inwards * y]);
            let lines = evenly_spaced(field, [2.0, 2.0], 0.1);
            check_spacing(&lines, [2.0, 2.0], 0.1);
            check_direction(&lines, field, 0.1);
            let longest = lines
                .iter()
                .filter_map(|line| line.lengths().last().copied());
            assert!(longest.fold(0.0, f64::max) < 60.0);
        }
    }

    #[test]
    fn hairpins_are_smooth() {
        // A shear with a little across it turns around at x: y^2 = 2 a x + const.
        for across in [0.3, 0.03, 0.003] {
            let field = |[_, y]: [f64; 2]| unit([y, across]);
            let lines = evenly_spaced(field, [2.0, 2.0], 0.1);
            check_spacing(&lines, [2.0, 2.0], 0.1);
            check_direction(&lines, field, 0.1);
        }
    }

    #[test]
    fn lines_part_at_a_stagnation_point() {
        let field = |[x, y]: [f64; 2]| unit([x, -y]);
        let lines = evenly_spaced(field, [2.0, 2.0], 0.1);
        check_spacing(&lines, [2.0, 2.0], 0.1);
        check_direction(&lines, field, 0.1);
        for line in &lines {
            // x y is the same all along.
            let product = |[x, y]: [f64; 2]| x * y;
            let first = product(line.points[0]);
            assert!(
                line.points
                    .iter()
                    .all(|&p| (product(p) - first).abs() < 1e-3)
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
