//! Panels and quadrature nodes on a generating curve.

use std::f64::consts::PI;
use std::sync::Arc;

use panel_quadrature::{PanelBasis, QuadratureError};

use bodies_of_revolution::{GeneratingCurve, Panel, Panels};

/// Gauss–Legendre nodes of the panels of a generating curve, node after node along the curve.
#[derive(Clone, Debug)]
pub struct Discretization {
    curve: Arc<dyn GeneratingCurve>,
    panels: Panels,
    basis: Arc<PanelBasis>,
    nodes: Vec<Node>,
    arc_lengths: Vec<f64>,
    ends: Vec<[[f64; 2]; 2]>,
    turnings: Vec<f64>,
}

/// A point of a generating curve with its geometry.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Curve parameter.
    pub s: f64,
    /// Distance from the axis.
    pub r: f64,
    /// Height along the axis.
    pub z: f64,
    /// Outward unit normal, radial and axial component.
    pub normal: [f64; 2],
    /// Quadrature weight per unit azimuth, $w\\, r\\, \lvert d\gamma/ds\rvert$: the surface element
    /// is this times $d\theta$.
    pub weight: f64,
}

impl Node {
    /// The node at parameter `s` with quadrature weight `ds`.
    pub fn new(curve: &dyn GeneratingCurve, s: f64, ds: f64) -> Self {
        Self::on_ring(curve, s, curve.point(s).r, ds)
    }

    /// The same with a radius that is known better than from the parameter.
    pub fn on_ring(curve: &dyn GeneratingCurve, s: f64, r: f64, ds: f64) -> Self {
        let tangent = curve.tangent(s);
        let speed = tangent.r.hypot(tangent.z);
        Self {
            s,
            r,
            z: curve.point(s).z,
            normal: [-tangent.z / speed, tangent.r / speed],
            weight: ds * speed * r,
        }
    }
}

impl From<&Discretization> for Arc<Discretization> {
    fn from(of: &Discretization) -> Self {
        Self::new(of.clone())
    }
}

impl Discretization {
    /// `order` nodes on each of the panels.
    ///
    /// # Errors
    /// If there is no Gauss–Legendre rule of that order.
    pub fn new(
        curve: Arc<dyn GeneratingCurve>,
        panels: Panels,
        order: usize,
    ) -> Result<Self, QuadratureError> {
        let basis = Arc::new(PanelBasis::new(order)?);
        let mut nodes = Vec::with_capacity(panels.len() * order);
        let mut arc_lengths = Vec::with_capacity(panels.len());
        for panel in panels.iter() {
            let half = 0.5 * panel.length();
            let on_panel = basis.nodes().iter().zip(basis.weights());
            nodes.extend(on_panel.map(|(&t, w)| Node::new(&*curve, panel.at(t), half * w)));
            let last = &nodes[nodes.len() - order..];
            arc_lengths.push(last.iter().map(|node| node.weight / node.r).sum());
        }
        let end = |s: f64| {
            let point = curve.point(s);
            [point.r, point.z]
        };
        let ends = panels.iter().map(|p| [p.start, p.end].map(end)).collect();
        let turning = |panel: &[Node]| -> f64 {
            let angle = |pair: &[Node]| {
                let ([a, b], [c, d]) = (pair[0].normal, pair[1].normal);
                (a * d - b * c).atan2(a * c + b * d).abs()
            };
            panel.windows(2).map(angle).sum()
        };
        let turnings = nodes.chunks(order).map(turning).collect();
        Ok(Self {
            curve,
            panels,
            basis,
            nodes,
            arc_lengths,
            ends,
            turnings,
        })
    }

    /// The generating curve.
    pub fn curve(&self) -> &Arc<dyn GeneratingCurve> {
        &self.curve
    }

    /// The panels, in order along the curve.
    pub fn panels(&self) -> &Panels {
        &self.panels
    }

    /// Nodes per panel.
    pub fn order(&self) -> usize {
        self.basis.order()
    }

    /// Interpolation on a panel's nodes.
    pub fn basis(&self) -> &PanelBasis {
        &self.basis
    }

    /// All nodes, panel after panel.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The nodes of one panel.
    pub fn nodes_of(&self, panel: usize) -> &[Node] {
        &self.nodes[panel * self.order()..][..self.order()]
    }

    pub(crate) fn panel(&self, panel: usize) -> &Panel {
        &self.panels.as_slice()[panel]
    }

    /// Arc length of a panel.
    pub fn arc_length(&self, panel: usize) -> f64 {
        self.arc_lengths[panel]
    }

    /// Radius and height of a panel's ends.
    pub fn ends(&self, panel: usize) -> [[f64; 2]; 2] {
        self.ends[panel]
    }

    /// By how much the normal turns from a panel's first node to its last, in radians, all bends
    /// counting.
    pub fn turning(&self, panel: usize) -> f64 {
        self.turnings[panel]
    }

    /// Area of the surface.
    pub fn area(&self) -> f64 {
        2.0 * PI * self.nodes.iter().map(|node| node.weight).sum::<f64>()
    }

    /// Half the largest extent of the body: the length that errors are measured in.
    pub fn size(&self) -> f64 {
        let far = |node: &Node| node.r.hypot(node.z);
        self.nodes.iter().map(far).fold(0.0, f64::max)
    }

    /// The same panels with another number of nodes on each.
    ///
    /// # Errors
    /// If there is no Gauss–Legendre rule of that order.
    pub fn with_order(&self, order: usize) -> Result<Self, QuadratureError> {
        Self::new(self.curve.clone(), self.panels.clone(), order)
    }
}
