//! Which quadrature resolves what a panel does to a target on the curve.
//!
//! The modal kernels are singular at the target and at its mirror image $(-r, z)$ across the axis: as functions of the source's
//! parameter they are analytic only inside an ellipse that keeps clear of both (Bernstein). A Gauss rule of `p` nodes is
//! good to $\varrho^{-2p}$, where $\varrho + 1/\varrho$ is the sum of the singularity's distances from the panel's ends, in half panel
//! lengths. So a panel is taken
//!
//! - as it is, where $\varrho$ is large enough;
//! - with a Kolm–Rokhlin rule, if it is the target's own or one as long next to it on the same smooth piece of the curve, and the
//!   mirror image is out of the way and the highest mode does not decay too fast;
//! - otherwise bisected until every part is resolved by a Gauss rule, but for the parts that end at the target, which have a rule for a
//!   logarithm at that end.

use panel_quadrature::kolm_rokhlin::{KolmRokhlin, Side};
use panel_quadrature::{GaussLegendre, LogEndpoint, QuadratureError};

use super::discretization::{Discretization, Node};
use crate::curve::Topology;

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
/// Longest part at a target, in decay lengths $r/n$ of the highest mode, that [`LOG_ENDPOINT`] nodes resolve.
const DECAY_LENGTHS: f64 = 24.0;
/// Longest panel for a Kolm–Rokhlin rule, in the same lengths and per node of the panel: longer ones are cut near the target.
const DECAY_LENGTHS_PER_NODE: f64 = 2.5;
/// Bisections after which a part is taken as it is: it is then of the size of rounding errors.
const DEEPEST: usize = 52;

/// Quadrature nodes on one panel for one target.
#[derive(Debug, Default)]
pub(crate) struct NearNodes {
    /// Their geometry; the weights include the rule's.
    pub nodes: Vec<Node>,
    /// Target minus node: $(r - r', z - z')$, to full relative precision.
    pub separation: Vec<[f64; 2]>,
    /// Node after node, the weights with which the panel's own nodes interpolate there.
    pub interpolation: Vec<f64>,
    parts: Vec<Part>,
}

/// A part of a panel, in the panel's reference interval.
#[derive(Clone, Copy, Debug)]
struct Part {
    start: f64,
    end: f64,
    depth: usize,
    at_target: bool,
}

/// Where on a panel the target is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Position {
    /// It is this node of the panel.
    On(usize),
    /// It is off the panel.
    Off,
}

/// The rules and their thresholds.
#[derive(Debug)]
pub(crate) struct NearRules {
    gauss: GaussLegendre,
    log_endpoint: LogEndpoint,
    far: f64,
    /// What the rule of [`GAUSS`] nodes resolves, and the one of [`LOG_ENDPOINT`] nodes (whose degree is half a Gauss rule's).
    gauss_far: f64,
    log_far: f64,
    /// Longest part at a target, relative to the target's radius.
    longest: f64,
    /// Longest panel with a Kolm–Rokhlin rule, relative to the target's radius; none where there are no such rules.
    longest_kolm_rokhlin: f64,
}

/// The parameter of the Bernstein ellipse around a part of a curve, from its ends and arc length, that passes through a point.
pub(crate) fn bernstein(point: [f64; 2], [start, end]: [[f64; 2]; 2], length: f64) -> f64 {
    let distance = |from: [f64; 2]| (point[0] - from[0]).hypot(point[1] - from[1]);
    let sum = (distance(start) + distance(end)) / (0.5 * length);
    // rho + 1/rho = sum; on the part itself the sum is 2, less where it bends.
    let half = (0.5 * sum).max(1.0);
    half + (half * half - 1.0).sqrt()
}

impl NearRules {
    /// Rules for panels of `order` nodes and modes up to `n_max`.
    pub fn new(order: usize, n_max: usize) -> Result<Self, QuadratureError> {
        Ok(Self {
            longest: DECAY_LENGTHS / n_max.max(1) as f64,
            gauss: GaussLegendre::new(GAUSS)?,
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

    /// Whether the panel's own nodes resolve its action on a target off it.
    pub fn is_far(&self, discretization: &Discretization, target: &Node, panel: usize) -> bool {
        let ends = panel_ends(discretization, panel);
        let length = discretization.arc_length(panel);
        bernstein([target.r, target.z], ends, length) >= self.far
            && bernstein([-target.r, target.z], ends, length) >= self.far
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
        near.nodes.clear();
        near.separation.clear();
        near.interpolation.clear();
        let at = &discretization.nodes_of(home)[target];
        let length = discretization.arc_length(panel);
        let mirror = bernstein([-at.r, at.z], panel_ends(discretization, panel), length);
        if mirror >= self.far && length <= self.longest_kolm_rokhlin * at.r {
            let order = discretization.order();
            if panel == home {
                let rule = KolmRokhlin::own(order, target)?;
                for node in rule.iter() {
                    near.push_on(discretization, panel, target, node.offset, node.weight)?;
                }
                return Ok(());
            }
            if let Some(side) = next_door(discretization, home, panel) {
                let rule = KolmRokhlin::neighbour(order, target, side)?;
                let half = 0.5 * discretization.panel(panel).length();
                for node in rule.iter() {
                    let ds = half * node.offset;
                    near.push_off(discretization, at, panel, node.node, ds, node.weight)?;
                }
                return Ok(());
            }
        }
        self.bisect(
            discretization,
            at,
            panel,
            if panel == home {
                Position::On(target)
            } else {
                Position::Off
            },
            near,
        )
    }

    fn bisect(
        &self,
        discretization: &Discretization,
        target: &Node,
        panel: usize,
        position: Position,
        near: &mut NearNodes,
    ) -> Result<(), QuadratureError> {
        let curve = discretization.curve();
        let whole = discretization.panel(panel);
        let mut parts = std::mem::take(&mut near.parts);
        let part = |start: f64, end: f64, at_target| Part {
            start,
            end,
            depth: 0,
            at_target,
        };
        // Coordinates relative to the target where it is on the panel, so that parts next to it keep their digits.
        match position {
            Position::On(node) => {
                let t = discretization.basis().nodes()[node];
                parts.extend([part(0.0, 1.0 - t, true), part(-1.0 - t, 0.0, true)]);
            }
            Position::Off => parts.push(part(-1.0, 1.0, false)),
        }
        let half = 0.5 * whole.length();
        while let Some(Part {
            start,
            end,
            depth,
            at_target,
        }) = parts.pop()
        {
            let place = |t: f64| match position {
                Position::On(_) => {
                    let chord = curve.chord(target.s, half * t);
                    [target.r + chord.r, target.z + chord.z]
                }
                Position::Off => {
                    let point = curve.point(whole.at(t));
                    [point.r, point.z]
                }
            };
            let (a, m, b) = (place(start), place(0.5 * (start + end)), place(end));
            let step = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
            let length = step(a, m) + step(m, b);
            let mirror = bernstein([-target.r, target.z], [a, b], length);
            let resolved = if at_target {
                mirror >= self.log_far && length <= self.longest * target.r
            } else {
                mirror >= self.gauss_far
                    && bernstein([target.r, target.z], [a, b], length) >= self.gauss_far
            };
            if resolved || depth >= DEEPEST {
                let width = end - start;
                match position {
                    Position::On(node) if at_target => {
                        let sign = if start == 0.0 { 1.0 } else { -1.0 };
                        for (x, w) in self.log_endpoint.iter() {
                            near.push_on(discretization, panel, node, sign * width * x, width * w)?;
                        }
                    }
                    _ => {
                        for (x, w) in self.gauss.iter() {
                            // From the nearer end of the part, so that offsets from the target stay accurate.
                            let t = if x < 0.0 {
                                start + 0.5 * width * (1.0 + x)
                            } else {
                                end - 0.5 * width * (1.0 - x)
                            };
                            match position {
                                Position::On(node) => {
                                    near.push_on(discretization, panel, node, t, 0.5 * width * w)?
                                }
                                Position::Off => {
                                    let ds =
                                        parameter_difference(discretization, target, whole.at(t));
                                    near.push_off(
                                        discretization,
                                        target,
                                        panel,
                                        t,
                                        ds,
                                        0.5 * width * w,
                                    )?;
                                }
                            }
                        }
                    }
                }
            } else {
                let middle = 0.5 * (start + end);
                let half = |start, end| Part {
                    start,
                    end,
                    depth: depth + 1,
                    at_target: at_target && (start == 0.0 || end == 0.0),
                };
                parts.extend([half(start, middle), half(middle, end)]);
            }
        }
        near.parts = parts;
        Ok(())
    }
}

fn panel_ends(discretization: &Discretization, panel: usize) -> [[f64; 2]; 2] {
    let panel = discretization.panel(panel);
    [panel.start, panel.end].map(|s| {
        let point = discretization.curve().point(s);
        [point.r, point.z]
    })
}

/// On which side of the source panel the target's panel `home` lies, if it is as long and next to it on the same smooth piece.
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

/// The parameter difference from `target` to `s`, across the seam of a closed curve if that is shorter.
fn parameter_difference(discretization: &Discretization, target: &Node, s: f64) -> f64 {
    let difference = s - target.s;
    if discretization.panels().topology() == Topology::PoleToPole {
        return difference;
    }
    let panels = discretization.panels().as_slice();
    let period = panels[panels.len() - 1].end - panels[0].start;
    if difference > 0.5 * period {
        difference - period
    } else if difference < -0.5 * period {
        difference + period
    } else {
        difference
    }
}

impl NearNodes {
    /// A node at `offset` (in the reference interval) from the panel's node `target`.
    fn push_on(
        &mut self,
        discretization: &Discretization,
        panel: usize,
        target: usize,
        offset: f64,
        weight: f64,
    ) -> Result<(), QuadratureError> {
        let half = 0.5 * discretization.panel(panel).length();
        let at = &discretization.nodes_of(panel)[target];
        let ds = half * offset;
        let order = discretization.order();
        self.push(discretization, at, at.s + ds, ds, half * weight);
        let first = self.interpolation.len();
        self.interpolation.resize(first + order, 0.0);
        discretization.basis().interpolation_row_near(
            target,
            offset,
            &mut self.interpolation[first..],
        )
    }

    /// A node at `t` of a panel that the target is not on, `ds` from the target in the curve's parameter.
    fn push_off(
        &mut self,
        discretization: &Discretization,
        target: &Node,
        panel: usize,
        t: f64,
        ds: f64,
        weight: f64,
    ) -> Result<(), QuadratureError> {
        let source = discretization.panel(panel);
        self.push(
            discretization,
            target,
            source.at(t),
            ds,
            0.5 * source.length() * weight,
        );
        let first = self.interpolation.len();
        self.interpolation
            .resize(first + discretization.order(), 0.0);
        discretization
            .basis()
            .interpolation_row(t, &mut self.interpolation[first..])
    }

    fn push(
        &mut self,
        discretization: &Discretization,
        target: &Node,
        s: f64,
        ds: f64,
        weight: f64,
    ) {
        let curve = discretization.curve();
        let chord = curve.chord(target.s, ds);
        self.nodes.push(Node::new(&**curve, s, weight));
        self.separation.push([-chord.r, -chord.z]);
    }
}
