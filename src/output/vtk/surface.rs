//! The surfaces of the bodies.

use std::f64::consts::PI;

use nalgebra::{Point3, Vector3};
use panel_quadrature::QuadratureError;
use vtkio::model::{
    Attributes, CellType, Cells, DataSet, Piece, UnstructuredGridPiece, VertexNumbers,
};

use super::field::Field;
use super::file::{VtkError, bytes, flat, scalars, vectors};
use bodies_of_revolution::{Frame, Topology};
use stokes_body::discretization::Discretization;
use stokes_body::flow::AXIAL;
use stokes_body::flow::SurfaceStress;
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;
use stokes_suspension::{Answer, BodyAnswer, BodyFlow, SuspensionError};

/// The surfaces of bodies as closed meshes with what acts on them, in the laboratory.
///
/// The sum of weights times a field over a body's points is its integral over the surface, as good
/// as the answer: of 1 the area, of the traction minus the force that the body exerts on the fluid.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The vertices, body after body: the nodes of the generating curve, each turned to the
    /// azimuths in equal steps; then the poles, upper and lower.
    pub points: Vec<Point3<f64>>,
    /// Outward unit normals of the surface itself.
    pub normals: Vec<Vector3<f64>>,
    /// Every point's share of the area; the poles have none.
    pub weights: Vec<f64>,
    /// Velocities of the surface, and of the fluid there.
    pub velocity: Vec<Vector3<f64>>,
    /// Force per area that the fluid exerts on the body, of the whole flow.
    pub traction: Vec<Vector3<f64>>,
    /// Pressure of the fluid.
    pub pressure: Vec<f64>,
    /// The number of each vertex's body, from 1, in the order of the case.
    pub body: Vec<u32>,
    /// Vertices of each cell, four or three, counterclockwise seen from outside.
    pub cells: Vec<Vec<u64>>,
    /// What is known of whole bodies, and of all together.
    fields: Vec<Field>,
}

impl Mesh {
    /// The surfaces of all bodies of an answer, with as many azimuths as show their modes.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn of_answer(answer: &Answer) -> Result<Self, SuspensionError> {
        Self::of(answer, Self::azimuths, &Silent)
    }

    /// Azimuths that show the modes of a body: 64 to 512.
    pub fn azimuths(body: &BodyFlow) -> usize {
        (4 * body.disturbance.modes()).clamp(64, 512)
    }

    /// The surfaces of all bodies of an answer, each with so many azimuths. Integrals by weights
    /// need more than twice as many as the body has modes.
    ///
    /// # Errors
    /// If a quadrature rule is missing, or the caller cancels.
    pub fn of(
        answer: &Answer,
        azimuths: impl Fn(&BodyFlow) -> usize,
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        let flow = &answer.flow;
        let all: Vec<usize> = (0..flow.bodies().len()).collect();
        let stresses = flow.surface_stresses(&all, progress)?;
        let mut mesh = Self {
            fields: fields(answer),
            ..Self::default()
        };
        for (number, (body, stress)) in (1..).zip(flow.bodies().iter().zip(stresses)) {
            mesh.add(body, number, stress, azimuths(body))?;
        }
        Ok(mesh)
    }

    fn add(
        &mut self,
        body: &BodyFlow,
        number: u32,
        stress: &SurfaceStress,
        azimuths: usize,
    ) -> Result<(), QuadratureError> {
        let (nodes, frame) = (body.disturbance.discretization(), &body.frame);
        let velocity = body.surface_velocity();
        let (traction, pressure) = (&stress.traction, &stress.pressure_along_axis);
        let first = self.points.len();
        let share = 2.0 * PI / azimuths as f64 * frame.scale().powi(2);
        // All four in the body's frame.
        let mut add = |at: [Vector3<f64>; 4], pressure: f64, weight: f64| {
            let [point, normal, velocity, traction] = at;
            self.points.push(frame.point_to_lab(point.into()));
            self.normals.push(frame.vector_to_lab(normal));
            self.velocity.push(frame.vector_to_lab(velocity));
            self.traction.push(frame.vector_to_lab(traction));
            self.pressure.push(pressure);
            self.weights.push(weight);
            self.body.push(number);
        };
        for (k, node) in nodes.nodes().iter().enumerate() {
            for l in 0..azimuths {
                let theta = 2.0 * PI * l as f64 / azimuths as f64;
                let (sin, cos) = theta.sin_cos();
                let turned =
                    |[r, t, z]: [f64; 3]| Vector3::new(r * cos - t * sin, r * sin + t * cos, z);
                add(
                    [
                        turned([node.r, 0.0, node.z]),
                        turned([node.normal[0], 0.0, node.normal[1]]),
                        turned(velocity.at(k, theta)),
                        turned(traction.at(k, theta)),
                    ],
                    pressure.at(k, theta)[AXIAL],
                    share * node.weight,
                );
            }
        }
        let poles = nodes.curve().topology() == Topology::PoleToPole;
        if poles {
            for pole in [Pole::Upper, Pole::Lower] {
                add(
                    [
                        pole.point(nodes),
                        pole.normal(),
                        pole.value(nodes, &velocity)?,
                        pole.value(nodes, traction)?,
                    ],
                    pole.value(nodes, pressure)?.z,
                    0.0,
                );
            }
        }
        let mut cells = cells(nodes.nodes().len(), azimuths, poles);
        for vertex in cells.iter_mut().flatten() {
            *vertex += first as u64;
        }
        self.cells.append(&mut cells);
        Ok(())
    }

    /// The `.vtu` file.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn file(&self) -> Result<Vec<u8>, VtkError> {
        let sizes = self.cells.iter().map(Vec::len);
        let offsets = sizes.scan(0, |end, size| {
            *end += size as u64;
            Some(*end)
        });
        let kind = |cell: &Vec<u64>| match cell.len() {
            3 => CellType::Triangle,
            _ => CellType::Quad,
        };
        let points: Vec<Vector3<f64>> = self.points.iter().map(|x| x.coords).collect();
        let piece = UnstructuredGridPiece {
            points: flat(&points).into(),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: self.cells.concat(),
                    offsets: offsets.collect(),
                },
                types: self.cells.iter().map(kind).collect(),
            },
            data: Attributes {
                point: vec![
                    vectors("traction", &self.traction),
                    vectors("velocity", &self.velocity),
                    vectors("normal", &self.normals),
                    scalars("pressure", self.pressure.clone()),
                    scalars("weight", self.weights.clone()),
                    scalars("body", self.body.clone()),
                ],
                cell: Vec::new(),
            },
        };
        let data = DataSet::UnstructuredGrid {
            meta: None,
            pieces: vec![Piece::Inline(Box::new(piece))],
        };
        bytes("surfaces of the bodies", data, &self.fields)
    }
}

/// Numbers of every body, in the laboratory and about its centre, and of all together.
fn fields(answer: &Answer) -> Vec<Field> {
    let of_all = |name, value: f64| Field::new(name, [[value]]);
    let of_frames = |name, value: fn(&Frame) -> Vector3<f64>| {
        let bodies = answer.flow.bodies().iter();
        Field::new(name, bodies.map(|body| value(&body.frame).into()))
    };
    let of_bodies = |name, value: fn(&BodyAnswer) -> Vector3<f64>| {
        Field::new(name, answer.bodies.iter().map(|body| value(body).into()))
    };
    let orientations = answer.flow.bodies().iter().map(|body| {
        let q = body.frame.orientation();
        [q.w, q.i, q.j, q.k]
    });
    vec![
        of_all("viscosity", answer.flow.viscosity()),
        of_all("estimated_error", answer.error_estimate),
        of_frames("center", |frame| frame.center().coords),
        of_frames("axis", |frame| *frame.axis()),
        Field::new("orientation_wxyz", orientations),
        of_bodies("body_velocity", |body| body.motion.velocity),
        of_bodies("body_angular_velocity", |body| body.motion.angular_velocity),
        of_bodies("force_on_fluid", |body| body.wrench.force),
        of_bodies("torque_on_fluid", |body| body.wrench.torque),
    ]
}

/// Quadrilaterals between neighbouring rings of vertices, and either triangles around the two poles
/// or rings that close.
fn cells(rings: usize, azimuths: usize, poles: bool) -> Vec<Vec<u64>> {
    let vertex = |ring: usize, l: usize| (ring % rings * azimuths + l % azimuths) as u64;
    let [upper, lower] = [0, 1].map(|pole| (rings * azimuths + pole) as u64);
    let last = if poles { rings - 1 } else { rings };
    let around = |l: usize, ring: usize| {
        vec![
            vertex(ring, l),
            vertex(ring + 1, l),
            vertex(ring + 1, l + 1),
            vertex(ring, l + 1),
        ]
    };
    let mut cells: Vec<Vec<u64>> = Vec::new();
    if poles {
        cells.extend((0..azimuths).map(|l| vec![upper, vertex(0, l), vertex(0, l + 1)]));
        cells.extend((0..azimuths).map(|l| vec![vertex(last, l), lower, vertex(last, l + 1)]));
    }
    cells.extend((0..last).flat_map(|ring| (0..azimuths).map(move |l| around(l, ring))));
    cells
}

/// An end of a generating curve on the axis.
#[derive(Clone, Copy)]
enum Pole {
    /// Where the curve begins.
    Upper,
    /// Where it ends.
    Lower,
}

impl Pole {
    fn point(self, nodes: &Discretization) -> Vector3<f64> {
        let panels = nodes.panels().as_slice();
        let s = match self {
            Self::Upper => panels[0].start,
            Self::Lower => panels[panels.len() - 1].end,
        };
        Vector3::new(0.0, 0.0, nodes.curve().point(s).z)
    }

    fn normal(self) -> Vector3<f64> {
        match self {
            Self::Upper => Vector3::z(),
            Self::Lower => -Vector3::z(),
        }
    }

    /// A field there, interpolated from the panel: only modes 0 and 1 do not vanish on the axis.
    fn value(
        self,
        nodes: &Discretization,
        field: &SurfaceModes,
    ) -> Result<Vector3<f64>, QuadratureError> {
        let order = nodes.order();
        let (first, t) = match self {
            Self::Upper => (0, -1.0),
            Self::Lower => (nodes.nodes().len() - order, 1.0),
        };
        let mut row = vec![0.0; order];
        nodes.basis().interpolation_row(t, &mut row)?;
        let at = |n: usize, family: usize, j: usize| -> f64 {
            if n >= field.modes() {
                return 0.0;
            }
            let values = &field.component(n, family, j)[first..][..order];
            values.iter().zip(&row).map(|(x, l)| x * l).sum()
        };
        Ok(Vector3::new(at(1, 0, 0), at(1, 1, 0), at(0, 0, 2)))
    }
}
