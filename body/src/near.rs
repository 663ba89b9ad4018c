//! Which quadrature resolves what a panel does to a target, on the curve or off it.
//!
//! The modal kernels are singular at the target and at its mirror image $(-r, z)$ across the axis:
//! as functions of the source's parameter they are analytic only inside an ellipse that keeps clear
//! of both (Bernstein). A Gauss rule of `p` nodes is good to $\varrho^{-2p}$, where
//! $\varrho + 1/\varrho$ is the sum of the singularity's distances from the panel's ends, in half
//! panel lengths. So a panel is taken
//!
//! - as it is, where $\varrho$ is large enough;
//! - with a Kolm–Rokhlin rule, if it is the target's own or one as long next to it on the same
//!   smooth piece of the curve, the mirror image is not close, and the highest mode does not decay
//!   too fast;
//! - otherwise cut towards the singularity, each part nearly four times as long as the one before,
//!   until every part is resolved by a Gauss rule. Parts that end at the target have a rule for a
//!   logarithm at that end instead. Off the curve at a distance `d` the number of parts grows with
//!   $\log(1/d)$.

use panel_quadrature::kolm_rokhlin::{KolmRokhlin, Side};
use panel_quadrature::{GaussLegendre, LogEndpoint, PanelBasis, QuadratureError};

use super::discretization::{Discretization, Node};
use bodies_of_revolution::{Meridian, Topology};

/// Significant digits that a panel's quadrature is chosen for.
const DIGITS: f64 = 15.5;

/// The ellipse parameter with which `2 p` powers make up the digits.
fn far_enough(p: usize) -> f64 {
    10f64.powf(DIGITS / (2 * p) as f64)
}

/// Nodes of the rule on parts that do not touch the target.
const GAUSS: usize = 16;
/// Nodes of the rule on parts that end at the target.
const LOG_ENDPOINT: usize = 24;
/// Longest part at a target, in decay lengths $r/n$ of the highest mode, that [`LOG_ENDPOINT`]
/// nodes resolve.
const DECAY_LENGTHS: f64 = 24.0;
/// Longest panel for a Kolm–Rokhlin rule, in the same lengths and per node of the panel: longer
/// ones are cut near the target.
const DECAY_LENGTHS_PER_NODE: f64 = 2.5;
/// Where a part is cut whose end is its point nearest to the singularity, as a fraction of the part
/// from that end: the rest has $\varrho + 1/\varrho = 3.5$.
const CUT: f64 = 0.27;
/// Next to a point that is very close, on a stretch as long as this fraction of half a panel, the
/// panel's polynomials are first interpolated from so many nodes. With 8 nodes the error is 4e-13
/// of the coefficient of degree 8, and 1e-7 of the one of degree 15, which is as small as the
/// panel's own error.
const INNER_REACH: f64 = 1.0 / 32.0;
const INNER: usize = 8;
/// Cuts after which a part is taken as it is: it is then of the size of rounding errors.
const DEEPEST: usize = 52;

/// A point seen from a point of the curve close to it.
///
/// Where sources are close, their differences from the point come from the gap and the chord, never
/// from coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Parameter of the curve point.
    pub s: f64,
    /// The curve point, its radius with full relative precision next to the axis.
    pub foot: Meridian,
    /// From the curve point to the point; zero on the curve.
    pub gap: Meridian,
}

impl Sight {
    /// A node sees itself.
    pub fn on(node: &Node) -> Self {
        Self {
            s: node.s,
            foot: Meridian {
                r: node.r,
                z: node.z,
            },
            gap: Meridian { r: 0.0, z: 0.0 },
        }
    }

    /// The point.
    pub fn point(&self) -> Meridian {
        Meridian {
            r: self.foot.r + self.gap.r,
            z: self.foot.z + self.gap.z,
        }
    }
}

/// Quadrature nodes on one panel for one target.
#[derive(Debug, Default)]
pub struct NearNodes {
    /// Their geometry; the weights include the rule's.
    pub nodes: Vec<Node>,
    /// Target minus node: $(r - r', z - z')$, to full relative precision.
    pub separation: Vec<[f64; 2]>,
    /// Node after node, the weights with which the panel's own nodes interpolate there.
    pub interpolation: Vec<f64>,
    parts: Vec<Part>,
}

/// A part of a panel, from one offset from the foot (in the curve's parameter) to another.
#[derive(Clone, Copy, Debug)]
struct Part {
    start: f64,
    end: f64,
    depth: usize,
}

/// A stretch of a panel, by offsets from the foot in the curve's parameter.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'b> {
    /// Where it is.
    pub range: [f64; 2],
    /// Where the nodes are that densities are interpolated from: the whole panel, or the stretch
    /// itself.
    pub domain: [f64; 2],
    /// Those nodes.
    pub basis: &'b PanelBasis,
}

/// A place on a panel: in its reference interval, and as an offset from the foot in the curve's
/// parameter.
#[derive(Clone, Copy, Debug)]
struct Place {
    t: f64,
    ds: f64,
}

/// The rules and their thresholds.
#[derive(Debug)]
pub struct NearRules {
    gauss: GaussLegendre,
    /// Nodes of the stretch next to a point that is very close.
    inner: PanelBasis,
    log_endpoint: LogEndpoint,
    far: f64,
    /// What the rule of [`GAUSS`] nodes resolves, and the one of [`LOG_ENDPOINT`] nodes (whose
    /// degree is half a Gauss rule's).
    gauss_far: f64,
    log_far: f64,
    /// Longest part at a target, relative to the target's radius.
    longest: f64,
    /// Longest panel with a Kolm–Rokhlin rule, relative to the target's radius; none where there
    /// are no such rules.
    longest_kolm_rokhlin: f64,
}

/// By how much a bend lowers the logarithm of the ellipse's parameter, for each radian by which the
/// tangent turns: on a circular arc the preimage of a point on the inner side lies on an ellipse
/// whose logarithm is smaller by 1 / (1 + 0.36 angle) at the worst.
const BEND: f64 = 0.36;

/// The parameter of the Bernstein ellipse around a panel that passes through the preimage of a
/// point, or somewhat less.
pub fn bernstein(discretization: &Discretization, point: [f64; 2], panel: usize) -> f64 {
    let distance = |from: [f64; 2]| (point[0] - from[0]).hypot(point[1] - from[1]);
    ellipse(
        discretization.ends(panel).map(distance),
        discretization.arc_length(panel),
        discretization.turning(panel),
    )
}

/// The same from the distances of the point from the two ends of a part of a curve, its length, and
/// by how much its tangent turns.
fn ellipse(distances: [f64; 2], length: f64, turning: f64) -> f64 {
    let sum = (distances[0] + distances[1]) / (0.5 * length);
    // rho + 1/rho = sum; on the part itself the sum is 2, less where it bends.
    let half = (0.5 * sum).max(1.0);
    (half + (half * half - 1.0).sqrt()).powf(1.0 / (1.0 + BEND * turning))
}

/// Which root a panel's bend takes of the parameter at the worst.
pub fn bend(discretization: &Discretization, panel: usize) -> f64 {
    1.0 + BEND * discretization.turning(panel)
}

impl NearRules {
    /// Rules for panels of `order` nodes and modes up to `n_max`.
    pub fn new(order: usize, n_max: usize) -> Result<Self, QuadratureError> {
        Ok(Self {
            longest: DECAY_LENGTHS / n_max.max(1) as f64,
            gauss: GaussLegendre::new(GAUSS)?,
            inner: PanelBasis::new(INNER)?,
            log_endpoint: LogEndpoint::new(LOG_ENDPOINT)?,
            far: far_enough(order),
            gauss_far: far_enough(GAUSS),
            log_far: 10f64.powf(DIGITS / LOG_ENDPOINT as f64),
            longest_kolm_rokhlin: if KolmRokhlin::own(order, 0).is_ok() {
                DECAY_LENGTHS_PER_NODE * order as f64 / n_max.max(1) as f64
            } else {
                0.0
            },
        })
    }

    /// Whether the panel's own nodes resolve its action on a point off it.
    pub fn is_far(&self, discretization: &Discretization, point: Meridian, panel: usize) -> bool {
        bernstein(discretization, [point.r, point.z], panel) >= self.far
            && bernstein(discretization, [-point.r, point.z], panel) >= self.far
    }

    /// Fills `near` with nodes on `panel` that resolve its action on node `target` of panel `home`.
    pub fn fill(
        &self,
        discretization: &Discretization,
        home: usize,
        target: usize,
        panel: usize,
        near: &mut NearNodes,
    ) -> Result<(), QuadratureError> {
        near.clear();
        let at = &discretization.nodes_of(home)[target];
        let sight = Sight::on(at);
        let length = discretization.arc_length(panel);
        let mirror = bernstein(discretization, [-at.r, at.z], panel);
        let half = 0.5 * discretization.panel(panel).length();
        if mirror >= self.far && length <= self.longest_kolm_rokhlin * at.r {
            let order = discretization.order();
            if panel == home {
                let t = discretization.basis().nodes()[target];
                for node in KolmRokhlin::own(order, target)?.iter() {
                    let place = Place {
                        t: t + node.offset,
                        ds: half * node.offset,
                    };
                    near.push(discretization, &sight, panel, place, half * node.weight);
                    near.interpolate_near(discretization, target, node.offset)?;
                }
                return Ok(());
            }
            if let Some(side) = next_door(discretization, home, panel) {
                for node in KolmRokhlin::neighbour(order, target, side)?.iter() {
                    let place = Place {
                        t: node.node,
                        ds: half * node.offset,
                    };
                    near.push(discretization, &sight, panel, place, half * node.weight);
                    near.interpolate(discretization.basis(), place.t)?;
                }
                return Ok(());
            }
        }
        let whole = offsets(discretization, &sight, panel);
        let stretch = Stretch {
            range: whole,
            domain: whole,
            basis: discretization.basis(),
        };
        self.cut(discretization, &sight, panel, &stretch, near)
    }

    /// The stretches of a panel for a point off the curve, and whether each has its own few nodes:
    /// the one next to a point that is very close does.
    pub fn stretches<'b>(
        &'b self,
        discretization: &'b Discretization,
        sight: &Sight,
        panel: usize,
    ) -> impl Iterator<Item = (Stretch<'b>, bool)> + use<'b> {
        let domain = offsets(discretization, sight, panel);
        let [first, last] = domain;
        let reach = INNER_REACH * 0.5 * discretization.panel(panel).length();
        let [start, end] = [first.max(-reach), last.min(reach)];
        let close =
            sight.gap.r.hypot(sight.gap.z) <= 0.25 * INNER_REACH * discretization.arc_length(panel);
        let outer = |range: [f64; 2]| Stretch {
            range,
            domain,
            basis: discretization.basis(),
        };
        let inner = Stretch {
            range: [start, end],
            domain: [start, end],
            basis: &self.inner,
        };
        let stretches = if close && start < end {
            [
                Some((outer([first, start]), false)),
                Some((inner, true)),
                Some((outer([end, last]), false)),
            ]
        } else {
            [Some((outer(domain), false)), None, None]
        };
        let stretches = stretches.into_iter().flatten();
        stretches.filter(|(stretch, _)| stretch.range[0] < stretch.range[1])
    }

    /// Fills `near` with nodes on a stretch of `panel` that resolve its action on a point off the
    /// curve.
    pub fn fill_off_curve(
        &self,
        discretization: &Discretization,
        sight: &Sight,
        panel: usize,
        stretch: &Stretch<'_>,
        near: &mut NearNodes,
    ) -> Result<(), QuadratureError> {
        near.clear();
        self.cut(discretization, sight, panel, stretch, near)
    }

    /// The same for the whole panel, densities interpolated from all of its nodes.
    pub fn fill_panel_off_curve(
        &self,
        discretization: &Discretization,
        sight: &Sight,
        panel: usize,
        near: &mut NearNodes,
    ) -> Result<(), QuadratureError> {
        let domain = offsets(discretization, sight, panel);
        let whole = Stretch {
            range: domain,
            domain,
            basis: discretization.basis(),
        };
        self.fill_off_curve(discretization, sight, panel, &whole, near)
    }

    fn cut(
        &self,
        discretization: &Discretization,
        sight: &Sight,
        panel: usize,
        stretch: &Stretch<'_>,
        near: &mut NearNodes,
    ) -> Result<(), QuadratureError> {
        let curve = discretization.curve();
        let whole = offsets(discretization, sight, panel);
        let [first, last] = stretch.range;
        let on_curve = sight.gap.r == 0.0 && sight.gap.z == 0.0;
        let target = sight.point();
        let mut parts = std::mem::take(&mut near.parts);
        let part = |start: f64, end: f64| Part {
            start,
            end,
            depth: 0,
        };
        if on_curve && first < 0.0 && 0.0 < last {
            parts.extend([part(0.0, last), part(first, 0.0)]);
        } else {
            parts.push(part(first, last));
        }
        // Target minus curve point.
        let separation = |ds: f64| {
            let chord = curve.chord(sight.s, ds);
            [sight.gap.r - chord.r, sight.gap.z - chord.z]
        };
        while let Some(Part { start, end, depth }) = parts.pop() {
            let at_target = on_curve && (start == 0.0 || end == 0.0);
            let [a, m, b] = [start, 0.5 * (start + end), end].map(separation);
            let step = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
            let length = step(a, m) + step(m, b);
            let turning = turning([a, m, b]);
            let from_target = |p: [f64; 2]| p[0].hypot(p[1]);
            // The mirror image is 2 r further away in the radius.
            let mirrored = |p: [f64; 2]| [p[0] - 2.0 * target.r, p[1]];
            let mirror = ellipse([a, b].map(|p| from_target(mirrored(p))), length, turning);
            let direct = ellipse([a, b].map(from_target), length, turning);
            let resolved = if at_target {
                mirror >= self.log_far && length <= self.longest * target.r
            } else {
                mirror.min(direct) >= self.gauss_far
            };
            if resolved || depth >= DEEPEST {
                let width = end - start;
                let mut push = |ds: f64, weight: f64| {
                    let t = reference(ds, whole);
                    near.push(discretization, sight, panel, Place { t, ds }, weight);
                    near.interpolate(stretch.basis, reference(ds, stretch.domain))
                };
                if at_target {
                    let sign = if start == 0.0 { 1.0 } else { -1.0 };
                    for (x, w) in self.log_endpoint.iter() {
                        push(sign * width * x, width * w)?;
                    }
                } else {
                    for (x, w) in self.gauss.iter() {
                        // From the end nearer to the foot, so that offsets stay accurate.
                        let ds = if start.abs() < end.abs() {
                            start + 0.5 * width * (1.0 + x)
                        } else {
                            end - 0.5 * width * (1.0 - x)
                        };
                        push(ds, 0.5 * width * w)?;
                    }
                }
            } else {
                let fraction = if at_target || direct <= mirror {
                    projection(a, b)
                } else {
                    projection(mirrored(a), mirrored(b))
                };
                let middle = start + fraction.clamp(CUT, 1.0 - CUT) * (end - start);
                let depth = depth + 1;
                parts.extend([
                    Part {
                        start,
                        end: middle,
                        depth,
                    },
                    Part {
                        start: middle,
                        end,
                        depth,
                    },
                ]);
            }
        }
        near.parts = parts;
        Ok(())
    }
}

/// Where an offset lies in the reference interval of a domain, from the nearer end.
pub fn reference(ds: f64, [start, end]: [f64; 2]) -> f64 {
    let half = 0.5 * (end - start);
    if ds - start < end - ds {
        (ds - start) / half - 1.0
    } else {
        1.0 - (end - ds) / half
    }
}

/// By how much the tangent of an arc turns: twice the angle between the chords of its halves.
fn turning([a, m, b]: [[f64; 2]; 3]) -> f64 {
    let (u, v) = ([m[0] - a[0], m[1] - a[1]], [b[0] - m[0], b[1] - m[1]]);
    2.0 * (u[0] * v[1] - u[1] * v[0])
        .atan2(u[0] * v[0] + u[1] * v[1])
        .abs()
}

/// Where on the way from `a` to `b` the origin is nearest, as a fraction.
fn projection(a: [f64; 2], b: [f64; 2]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    -(a[0] * d[0] + a[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])
}

/// On which side of the source panel the target's panel `home` lies, if it is as long and next to
/// it on the same smooth piece.
fn next_door(discretization: &Discretization, home: usize, panel: usize) -> Option<Side> {
    let (mine, other) = (discretization.panel(home), discretization.panel(panel));
    let smooth = mine.piece == other.piece
        && (mine.length() - other.length()).abs() <= 1e-12 * mine.length();
    if smooth && mine.end == other.start {
        return Some(Side::Left);
    }
    if smooth && mine.start == other.end {
        return Some(Side::Right);
    }
    None
}

/// The offsets of a panel's ends from the foot in the curve's parameter, across the seam of a
/// closed curve if that is shorter.
pub fn offsets(discretization: &Discretization, sight: &Sight, panel: usize) -> [f64; 2] {
    let panel = discretization.panel(panel);
    let panels = discretization.panels().as_slice();
    let period = panels[panels.len() - 1].end - panels[0].start;
    let middle = 0.5 * (panel.start + panel.end) - sight.s;
    let shift = if discretization.panels().topology() == Topology::PoleToPole {
        0.0
    } else if middle > 0.5 * period {
        -period
    } else if middle < -0.5 * period {
        period
    } else {
        0.0
    };
    [panel.start, panel.end].map(|s| (s + shift) - sight.s)
}

impl NearNodes {
    /// The panel's own nodes, for a point that they resolve it for.
    pub fn take_own_nodes(&mut self, discretization: &Discretization, sight: &Sight, panel: usize) {
        self.clear();
        let point = sight.point();
        let order = discretization.order();
        self.nodes.extend(discretization.nodes_of(panel));
        self.separation
            .extend((self.nodes.iter()).map(|node| [point.r - node.r, point.z - node.z]));
        for k in 0..order {
            self.next_row(order)[k] = 1.0;
        }
    }

    fn clear(&mut self) {
        self.nodes.clear();
        self.separation.clear();
        self.interpolation.clear();
    }

    /// A node of the panel.
    fn push(
        &mut self,
        discretization: &Discretization,
        sight: &Sight,
        panel: usize,
        place: Place,
        weight: f64,
    ) {
        let curve = discretization.curve();
        let chord = curve.chord(sight.s, place.ds);
        let s = discretization.panel(panel).at(place.t);
        let node = Node::on_ring(&**curve, s, sight.foot.r + chord.r, weight);
        self.nodes.push(node);
        self.separation
            .push([sight.gap.r - chord.r, sight.gap.z - chord.z]);
    }

    /// The interpolation to `t` of the reference interval.
    fn interpolate(&mut self, basis: &PanelBasis, t: f64) -> Result<(), QuadratureError> {
        let row = self.next_row(basis.order());
        basis.interpolation_row(t, row)
    }

    /// The panel's interpolation to `offset` from its node `target`.
    fn interpolate_near(
        &mut self,
        discretization: &Discretization,
        target: usize,
        offset: f64,
    ) -> Result<(), QuadratureError> {
        let row = self.next_row(discretization.order());
        discretization
            .basis()
            .interpolation_row_near(target, offset, row)
    }

    fn next_row(&mut self, order: usize) -> &mut [f64] {
        let first = self.interpolation.len();
        self.interpolation.resize(first + order, 0.0);
        &mut self.interpolation[first..]
    }
}
