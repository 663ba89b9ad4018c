//! Bodies of every kind.

use std::sync::Arc;

use axistokes::body::{Discretization, Stokeslet};
use axistokes::geometry::curve::arc_length;
use axistokes::{Biconcave, Capsule, GeneratingCurve, Panels, Spheroid, Torus};
use nalgebra::Vector3;

use super::exact::Stokeslets;

/// A body, with point forces on both sides of its surface, and the modes that their flows have on
/// it down to rounding.
pub struct Body {
    pub name: &'static str,
    pub curve: Arc<dyn GeneratingCurve>,
    pub inside: Stokeslets,
    pub outside: Stokeslets,
    pub n_max: usize,
}

impl Body {
    /// Panels of `order` nodes that resolve the curve.
    pub fn panels(&self, order: usize) -> Panels {
        Panels::resolving(&*self.curve, order, 1e-12).expect("panels")
    }

    /// The same, and none longer than `part` of its distance from any of the point forces.
    pub fn panels_for(&self, order: usize, part: f64) -> Panels {
        let mut panels = self.panels(order);
        loop {
            let long: Vec<bool> = (panels.iter())
                .map(|panel| {
                    let middle = self.curve.point(panel.at(0.0));
                    let distance =
                        |s: &Stokeslet| (s.at.x.hypot(s.at.y) - middle.r).hypot(s.at.z - middle.z);
                    let sources = self.inside.0.iter().chain(&self.outside.0);
                    let nearest = sources.map(distance).fold(f64::INFINITY, f64::min);
                    arc_length(&*self.curve, panel.start, panel.end) > part * nearest
                })
                .collect();
            if !long.contains(&true) {
                return panels.graded();
            }
            panels = panels.bisected(|panel| long[panel]);
        }
    }

    /// Nodes on panels.
    pub fn nodes(&self, panels: Panels, order: usize) -> Discretization {
        Discretization::new(self.curve.clone(), panels, order).expect("nodes")
    }
}

/// Spheroid, thin disc, capsule, torus, torus with a small hole, red cell.
pub fn bodies() -> [Body; 6] {
    let body = |name, curve: Arc<dyn GeneratingCurve>, [inside, outside]: [[f64; 3]; 2], n_max| {
        let two = |at: [f64; 3]| {
            let turned = Vector3::new(-at[1], at[0], -at[2]);
            Stokeslets::at(&[at, turned.into()])
        };
        Body {
            name,
            curve,
            inside: two(inside),
            outside: two(outside),
            n_max,
        }
    };
    [
        body(
            "spheroid 1 x 0.5",
            Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid")),
            [[0.01, 0.005, 0.3], [0.02, 0.01, 1.6]],
            12,
        ),
        body(
            "disc 0.05 x 1",
            Arc::new(Spheroid::new(0.05, 1.0).expect("a disc")),
            [[0.002, 0.001, 0.01], [0.02, 0.01, 0.6]],
            12,
        ),
        body(
            "capsule 0.5, 1",
            Arc::new(Capsule::new(0.5, 1.0).expect("a capsule")),
            [[0.01, 0.005, 0.3], [0.02, 0.01, 1.6]],
            12,
        ),
        body(
            "torus 1 + 0.4",
            Arc::new(Torus::new(1.0, 0.4).expect("a torus")),
            [[0.6, 0.8, 0.05], [0.05, 0.1, 0.8]],
            80,
        ),
        body(
            "torus 1 + 0.9",
            Arc::new(Torus::new(1.0, 0.9).expect("a torus")),
            [[0.6, 0.8, 0.05], [0.03, 0.05, 1.3]],
            60,
        ),
        body(
            "red cell",
            Arc::new(Biconcave::new(1.0).expect("a red cell")),
            [[0.004, 0.002, 0.02], [0.02, 0.01, 0.7]],
            12,
        ),
    ]
}
