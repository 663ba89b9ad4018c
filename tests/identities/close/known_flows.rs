//! Flows of point forces on the other side, found again from their values on the surface.

use std::sync::Arc;

use axistokes::body::flow::Side;
use axistokes::body::{
    DirichletSolver, Discretization, FlowGradientAt, Formulation, Stokeslet, SurfaceModes,
};
use axistokes::case::{self, Case, Located};
use axistokes::*;
use nalgebra::Point3;

use super::bodies::bodies;
use super::exact::{Errors, Stokeslets};
use super::places::{Place, SIDES, places, targets};

const DISTANCES: [f64; 15] = [
    1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14, 1e-16, 0.0,
];

/// Velocity, pressure, gradient.
const BARS: [f64; 3] = [1e-11, 1e-9, 1e-8];

/// The point forces inside the thesis's spheroid.
fn thesis() -> Stokeslets {
    let text = include_str!("../../data/cases/thesis-single-body.toml");
    let case = Case::parse(text, "thesis-single-body.toml").expect("a valid case");
    let test = case.test.expect("a test flow");
    let stokeslet = |s: &Located<case::Stokeslet>| Stokeslet {
        at: s.value.at.into(),
        force: s.value.force.into(),
    };
    Stokeslets(test.stokeslets.iter().map(stokeslet).collect())
}

/// A Dirichlet problem whose solution is known.
struct Known {
    solver: DirichletSolver,
    density: SurfaceModes,
    exact: Stokeslets,
    side: Side,
}

impl Known {
    fn new(nodes: Discretization, n_max: usize, exact: Stokeslets, side: Side) -> Self {
        let formulation = match side {
            Side::Exterior => Formulation::CombinedField,
            Side::Interior => Formulation::InteriorDoubleLayer,
        };
        let solver = DirichletSolver::new(nodes, formulation, n_max, &Silent).expect("a solver");
        let data = SurfaceModes::sample(solver.discretization(), n_max, |x| exact.velocity(x));
        let density = solver.solve(&data.modes);
        Self {
            solver,
            density,
            exact,
            side,
        }
    }

    /// Around the thesis's spheroid, or in it with point forces around it.
    fn thesis(panels: usize, order: usize, n_max: usize, side: Side) -> Self {
        let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
        let panels = Panels::equal_arcs(&*curve, panels).expect("panels");
        let nodes = Discretization::new(curve, panels, order).expect("nodes");
        let exact = match side {
            Side::Exterior => thesis(),
            Side::Interior => {
                Stokeslets::at(&[[0.9, 0.3, 0.2], [-0.4, 0.8, -0.9], [0.1, -0.3, 1.6]])
            }
        };
        Self::new(nodes, n_max, exact, side)
    }

    fn nodes(&self) -> &Discretization {
        self.solver.discretization()
    }

    /// The flow at points; the pressure inside, which the velocities determine up to a constant, is
    /// shifted to be exact at the centre.
    fn at(&self, targets: &[Point3<f64>]) -> Vec<FlowGradientAt> {
        let flow = self.solver.flow(&self.density);
        let mut found = flow.gradient_at(targets, 1e-15).expect("a flow");
        if self.side == Side::Interior {
            let centre = flow.at(&[Point3::origin()], 1e-15).expect("a flow")[0].pressure;
            let off = centre - self.exact.flow(Point3::origin().coords).pressure;
            found.iter_mut().for_each(|at| at.pressure -= off);
        }
        found
    }

    /// The errors at a distance from so many places.
    fn errors(&self, distance: f64, count: usize, seed: u64) -> Errors {
        let places = places(self.nodes(), count, seed);
        let targets = targets(self.nodes(), &places, self.side, distance);
        Errors::of(&targets, &self.at(&targets), |x| self.exact.flow(x))
    }
}

/// At every distance from places of every kind; and no distance is worse than another, on normals
/// from a pole, from a panel's end, from a node and from anywhere.
#[test]
fn thesis_spheroid_at_every_distance_from_both_sides() {
    const STEPS: usize = 200;
    for (side, panels, n_max) in [(Side::Exterior, 24, 60), (Side::Interior, 16, 40)] {
        let known = Known::thesis(panels, 16, n_max, side);
        for (k, distance) in DISTANCES.into_iter().enumerate() {
            let found = known.errors(distance, 14, k as u64);
            println!("{side:?} {distance:.0e}: {found}");
            assert!(found.are_below(BARS));
        }
        let normals = places(known.nodes(), 5, 11);
        let distance = |k: usize| 10f64.powf(-0.7 - 14.8 * k as f64 / (STEPS - 1) as f64);
        let sweep: Vec<Point3<f64>> = (0..STEPS)
            .flat_map(|k| targets(known.nodes(), &[normals[1 + k % 4]], side, distance(k)))
            .collect();
        assert_eq!(sweep.len(), STEPS);
        let found = Errors::of(&sweep, &known.at(&sweep), |x| known.exact.flow(x));
        println!("{side:?}, 0.2 to 1e-15.5: {found}");
        assert!(found.are_below(BARS));
    }
}

/// On the surface, at the order of the panels, and one less for what takes a derivative of the
/// density; down to a floor.
#[test]
fn errors_on_the_surface_fall_with_the_panels() {
    let [spheroid, ..] = bodies();
    for (order, panels) in [(10, [12, 24, 48]), (16, [6, 10, 24])] {
        for side in SIDES {
            let [coarse, fine, floor] = panels.map(|panels| {
                let panels = Panels::equal_arcs(&*spheroid.curve, panels).expect("panels");
                let exact = match side {
                    Side::Exterior => &spheroid.inside,
                    Side::Interior => &spheroid.outside,
                };
                let count = panels.len();
                let nodes = spheroid.nodes(panels, order);
                let known = Known::new(nodes, spheroid.n_max, exact.clone(), side);
                let found = known.errors(0.0, 24, 5);
                println!("{side:?} {count} x {order}: {found}");
                found
            });
            let refined = panels[1] as f64 / panels[0] as f64;
            let observed = |coarse: f64, fine: f64| (coarse / fine).ln() / refined.ln();
            let [velocity, pressure, gradient] = [
                observed(coarse.velocity, fine.velocity),
                observed(coarse.pressure, fine.pressure),
                observed(coarse.gradient, fine.gradient),
            ];
            println!("orders {velocity:.1}, {pressure:.1}, {gradient:.1}");
            // Sixteen nodes have not come to their order before rounding is left.
            let order = if order == 16 { 12.0 } else { 10.0 };
            assert!(velocity > order - 1.0 && pressure.min(gradient) > order - 3.0);
            assert!(floor.are_below([5e-14, 5e-10, 5e-10]));
        }
    }
}

/// With 16 nodes on a panel and, where that is quick, with 10.
#[test]
fn other_bodies_from_outside() {
    for body in bodies() {
        // Order and panels relative to the distance from the forces; levels of panels towards
        // joints.
        let (parts, joints, bars): (&[(usize, f64)], _, _) = match body.name {
            "spheroid 1 x 0.5" => (&[(16, 0.4), (10, 0.25)], 0, BARS),
            "torus 1 + 0.4" => (&[(16, 0.6)], 0, BARS),
            "torus 1 + 0.9" => (&[(16, 0.6), (10, 0.6)], 0, [1e-11, 1e-8, 1e-8]),
            "capsule 0.5, 1" => (&[(16, 0.6)], 6, [1e-11, 1e-5, 1e-5]),
            "disc 0.05 x 1" => (&[(16, 0.4)], 0, [1e-11, 1e-8, 1e-8]),
            _ => (&[(16, 0.4)], 0, BARS),
        };
        for &(order, part) in parts {
            let panels = body.panels_for(order, part).graded_to_breakpoints(joints);
            let count = panels.len();
            let nodes = body.nodes(panels, order);
            let known = Known::new(nodes, body.n_max, body.inside.clone(), Side::Exterior);
            for (k, distance) in [1e-3, 1e-6, 1e-10, 0.0].into_iter().enumerate() {
                let found = known.errors(distance, 12, k as u64);
                println!("{}, {count} x {order}, {distance:.0e}: {found}", body.name);
                assert!(found.are_below(bars));
            }
        }
    }
}

/// At a capsule's joint the density's second derivative is infinite: derivatives are as good as the
/// shortest panels there are short, velocities good all along; a hundredth away nothing is left of
/// it.
#[test]
fn next_to_a_joint_errors_fall_with_the_shortest_panels() {
    let [_, _, capsule, ..] = bodies();
    let joint = capsule.curve.breakpoints()[1];
    let errors = [3, 9].map(|levels| {
        let panels = capsule.panels_for(16, 0.6).graded_to_breakpoints(levels);
        let nodes = capsule.nodes(panels, 16);
        let known = Known::new(nodes, 6, capsule.inside.clone(), Side::Exterior);
        [1e-2, 1e-6, 0.0].map(|offset| {
            let azimuth = 0.3;
            let places = [-offset, offset].map(|ds| Place {
                s: joint + ds,
                azimuth,
            });
            let targets = targets(known.nodes(), &places, known.side, 1e-8);
            let found = Errors::of(&targets, &known.at(&targets), |x| known.exact.flow(x));
            println!("{levels} levels, {offset:.0e} from the joint: {found}");
            found
        })
    });
    let [[_, coarse, at_coarse], [away, fine, at_fine]] = errors;
    assert!(away.are_below(BARS));
    for (coarse, fine) in [(coarse, fine), (at_coarse, at_fine)] {
        assert!(fine.pressure < 0.1 * coarse.pressure && fine.gradient < 0.1 * coarse.gradient);
        assert!(fine.are_below([1e-10, 1e-5, 1e-5]));
    }
}
