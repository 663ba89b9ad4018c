//! What is summed, and what comes out.

use crate::FmmError;
use crate::kernel::MOST;

/// The strengths of the sources, one entry per source in each array. All fields are optional:
/// `Strengths { stokeslets: Some(&forces), ..Default::default() }`. Viscosity is 1.
///
/// With $x$ from source to target and $r = |x|$ the flows are
///
/// * Stokeslet of force $f$: $u = (f/r + x (x \cdot f)/r^3)/8\pi$, $p = x \cdot f / 4\pi r^3$;
/// * stresslet of density $q$ and normal $n$: $u = -3\,x (x \cdot q)(x \cdot n)/4\pi r^5$,
///   $p = [q \cdot n/r^3 - 3 (x \cdot q)(x \cdot n)/r^5]/2\pi$;
/// * rotlet of torque $t$: $u = t \times x/8\pi r^3$, $p = 0$;
/// * source of flux $s$: $u = s\,x/4\pi r^3$, $p = 0$
///
/// (Pozrikidis, *Boundary Integral and Singularity Methods for Linearized Viscous Flow*, 1992,
/// chapters 2 and 7).
#[derive(Clone, Copy, Debug, Default)]
pub struct Strengths<'a> {
    /// Forces.
    pub stokeslets: Option<&'a [[f64; 3]]>,
    /// Densities and normals.
    pub stresslets: Option<Stresslets<'a>>,
    /// Torques.
    pub rotlets: Option<&'a [[f64; 3]]>,
    /// Fluxes.
    pub fluxes: Option<&'a [f64]>,
}

/// The two vectors of each stresslet. For a double-layer potential they are the density times the
/// quadrature weight, and the unit normal.
///
/// A constant $q$ on a closed surface with outward normals makes the flow $q$ inside and none
/// outside: the double layer jumps by $-q$ from inside to outside. $q$ is a velocity times an area,
/// so velocities do not depend on the viscosity; pressures must be multiplied by it.
#[derive(Clone, Copy, Debug)]
pub struct Stresslets<'a> {
    /// $q$.
    pub densities: &'a [[f64; 3]],
    /// $n$, of any length.
    pub normals: &'a [[f64; 3]],
}

/// How much of the flow is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Output {
    /// Velocity alone.
    #[default]
    Velocity,
    /// Velocity and pressure.
    Pressure,
    /// Velocity, pressure and velocity gradient.
    Gradient,
}

/// The flow at the targets. What was not asked for is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flow {
    /// $u_i$.
    pub velocity: Vec<[f64; 3]>,
    /// $p$.
    pub pressure: Vec<f64>,
    /// `gradient[target][i][j]` is $\partial u_i/\partial x_j$.
    pub gradient: Vec<[[f64; 3]; 3]>,
}

impl Flow {
    /// The flow whose numbers are `at(target, output)`, computed in lengths that are `scale` times
    /// the user's.
    pub(crate) fn assemble(
        output: Output,
        targets: usize,
        scale: f64,
        at: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let slope = |target, output| at(target, output) * scale * scale;
        let velocity = |target| [0, 1, 2].map(|k| at(target, k) * scale);
        let mut flow = Self {
            velocity: (0..targets).map(velocity).collect(),
            ..Self::default()
        };
        if output != Output::Velocity {
            flow.pressure = (0..targets).map(|target| slope(target, 3)).collect();
        }
        if output == Output::Gradient {
            let gradient = |target| [4, 7, 10].map(|row| [0, 1, 2].map(|k| slope(target, row + k)));
            flow.gradient = (0..targets).map(gradient).collect();
        }
        flow
    }

    /// $\sigma_{ij} = -p\,\delta_{ij} + \partial_j u_i + \partial_i u_j$ at each target; empty if
    /// the gradient was not asked for.
    pub fn stress(&self) -> Vec<[[f64; 3]; 3]> {
        let points = self.gradient.iter().zip(&self.pressure);
        points.map(|(gradient, &p)| stress(gradient, p)).collect()
    }
}

fn stress(gradient: &[[f64; 3]; 3], pressure: f64) -> [[f64; 3]; 3] {
    let mut stress = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            stress[i][j] = gradient[i][j] + gradient[j][i];
        }
        stress[i][i] -= pressure;
    }
    stress
}

/// Which kinds of singularity a sum is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularities {
    /// Stokeslets alone.
    Stokeslets,
    /// Stresslets alone.
    Stresslets,
    /// Stokeslets and stresslets.
    Both,
    /// Stokeslets, stresslets, rotlets and sources.
    All,
}

impl Singularities {
    /// Numbers per source.
    pub(crate) fn count(self) -> usize {
        match self {
            Self::Stokeslets => 3,
            Self::Stresslets => 6,
            Self::Both => 9,
            Self::All => 13,
        }
    }

    /// Refuses strengths of other kinds.
    pub(crate) fn admits(self, strengths: &Strengths<'_>) -> Result<(), FmmError> {
        let kinds = [
            (
                strengths.stokeslets.is_some(),
                self != Self::Stresslets,
                "Stokeslets",
            ),
            (
                strengths.stresslets.is_some(),
                self != Self::Stokeslets,
                "stresslets",
            ),
            (strengths.rotlets.is_some(), self == Self::All, "rotlets"),
            (strengths.fluxes.is_some(), self == Self::All, "sources"),
        ];
        match kinds.iter().find(|(given, planned, _)| *given && !planned) {
            Some((_, _, kind)) => Err(FmmError::Unplanned(kind)),
            None => Ok(()),
        }
    }

    /// Scales a strength to lengths that are `scale` times the user's. The flow of all
    /// singularities except Stokeslets has one more order in the length, so their strengths take
    /// the factor `scale`.
    pub(crate) fn weigh(self, strength: &mut [f64; MOST], scale: f64) {
        match self {
            Self::Stokeslets => {}
            Self::Stresslets => strength[..3].iter_mut().for_each(|q| *q *= scale),
            Self::Both | Self::All => {
                strength[3..6].iter_mut().for_each(|q| *q *= scale);
                strength[9..].iter_mut().for_each(|q| *q *= scale);
            }
        }
    }
}

impl Strengths<'_> {
    /// The smallest compiled set that has what is present.
    pub(crate) fn singularities(&self) -> Singularities {
        if self.rotlets.is_some() || self.fluxes.is_some() {
            return Singularities::All;
        }
        match (self.stokeslets.is_some(), self.stresslets.is_some()) {
            (true, true) => Singularities::Both,
            (false, true) => Singularities::Stresslets,
            _ => Singularities::Stokeslets,
        }
    }

    /// Refuses arrays of other lengths than `count` and numbers that are not finite.
    pub(crate) fn validate(&self, count: usize) -> Result<(), FmmError> {
        if let Some(forces) = self.stokeslets {
            check("Stokeslet strengths", forces, count)?;
        }
        if let Some(Stresslets { densities, normals }) = self.stresslets {
            check("stresslet densities", densities, count)?;
            check("stresslet normals", normals, count)?;
        }
        if let Some(torques) = self.rotlets {
            check("rotlet strengths", torques, count)?;
        }
        if let Some(fluxes) = self.fluxes {
            check("fluxes", fluxes.as_chunks::<1>().0, count)?;
        }
        Ok(())
    }

    /// The numbers of source `index` in the layout of `singularities`, zeros for what is absent.
    pub(crate) fn of(&self, index: usize, singularities: Singularities) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        if let Some(forces) = self.stokeslets {
            all[..3].copy_from_slice(&forces[index]);
        }
        if let Some(Stresslets { densities, normals }) = self.stresslets {
            all[3..6].copy_from_slice(&densities[index]);
            all[6..9].copy_from_slice(&normals[index]);
        }
        if let Some(torques) = self.rotlets {
            all[9..12].copy_from_slice(&torques[index]);
        }
        if let Some(fluxes) = self.fluxes {
            all[12] = fluxes[index];
        }
        if singularities == Singularities::Stresslets {
            all.copy_within(3..9, 0);
        }
        all
    }
}

/// Refuses an array of another length than `expected`, and numbers that are not finite.
pub(crate) fn check<const N: usize>(
    what: &'static str,
    entries: &[[f64; N]],
    expected: usize,
) -> Result<(), FmmError> {
    if entries.len() != expected {
        return Err(FmmError::Length {
            what,
            found: entries.len(),
            expected,
        });
    }
    for (index, entry) in entries.iter().enumerate() {
        if let Some(&value) = entry.iter().find(|value| !value.is_finite()) {
            return Err(FmmError::NotFinite { what, index, value });
        }
    }
    Ok(())
}

/// Refuses positions that are not finite, or so far from the origin that the square of a difference
/// overflows. Returns the largest coordinate.
pub(crate) fn check_positions(what: &'static str, positions: &[[f64; 3]]) -> Result<f64, FmmError> {
    check(what, positions, positions.len())?;
    let farthest = positions
        .as_flattened()
        .iter()
        .fold(0.0, |farthest: f64, x| farthest.max(x.abs()));
    if farthest > 1e100 {
        return Err(FmmError::TooFar(farthest));
    }
    Ok(farthest)
}
