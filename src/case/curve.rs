//! From a shape's specification to its generating curve.

use std::sync::Arc;

use super::ShapeSpec;
use bodies_of_revolution::{
    Biconcave, Capsule, CurveError, GeneratingCurve, Polar, Profile, Spheroid, Torus,
    curve::check_simple,
};

impl ShapeSpec {
    /// The generating curve, checked to bound a body.
    ///
    /// # Errors
    /// What the curve's own constructor or [`check_simple`] says.
    pub fn curve(&self) -> Result<Arc<dyn GeneratingCurve>, CurveError> {
        let curve: Arc<dyn GeneratingCurve> = match self {
            Self::Sphere { radius } => Arc::new(Spheroid::sphere(*radius)?),
            Self::Spheroid { polar, equatorial } => Arc::new(Spheroid::new(*polar, *equatorial)?),
            Self::Capsule { radius, length } => Arc::new(Capsule::new(*radius, *length)?),
            Self::Torus { major, minor } => Arc::new(Torus::new(*major, *minor)?),
            Self::Biconcave { radius } => Arc::new(Biconcave::new(*radius)?),
            Self::Polar { coefficients } => {
                let polar = Polar::new(coefficients)?;
                check_simple(&polar)?;
                Arc::new(polar)
            }
            Self::Profile { file } => {
                let profile = Profile::from_csv(file)?;
                check_simple(&profile)?;
                Arc::new(profile)
            }
        };
        Ok(curve)
    }
}
