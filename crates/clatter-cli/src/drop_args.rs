//! A drop in SI units, as arguments of a command say it: one that has an argument `model`.

use clatter::Mass;
use clatter_flight::{Body, ContactLaw, Scene};

use crate::Failure;
use crate::inputs::{self, LawName, ModelName};

/// With every model there is.
const WITH_MODEL: [(&str, &str); 4] =
    [("model", "map"), ("model", "ballistic"), ("model", "finite-tilt"), ("model", "compliant")];

/// Largest radius of gyration over the length. A body beyond hardly turns, and clatters for hours.
const MOST_GYRATION: f64 = 2.0;

/// All of a drop but its model, the inertia and the restitution.
#[derive(Debug, clap::Args)]
pub(crate) struct DropArgs {
    /// Length of the body from end to end, 2L, in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m, requires = "model", required_if_eq_any = WITH_MODEL)]
    length_m: Option<f64>,
    /// Where the center of mass lies, between -1 (end a) and 1 (end b); goes with --gyration-m
    #[arg(long, value_name = "S", default_value = "0", allow_hyphen_values = true, value_parser = inputs::center_of_mass, conflicts_with = "mass", requires = "model")]
    center_of_mass: f64,
    /// Thickness of the body, in m, at most its length: at a tilt it stands on a corner, half of it below the line
    /// through the center of mass; for finite-tilt, small tilts do not feel it
    #[arg(long, value_name = "M", default_value = "0", allow_hyphen_values = true, value_parser = inputs::number, requires = "model")]
    pub(crate) thickness_m: f64,
    #[command(flatten)]
    pub(crate) fall: Fall,
    /// Tilt when end a touches, in degrees, below 90; 0 for a flat drop, in which end a counts as the first
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::tilt_deg, requires = "model", required_if_eq_any = WITH_MODEL)]
    tilt_deg: Option<f64>,
    /// Acceleration of gravity, in m/s²; the model map leaves it out
    #[arg(long, value_name = "G", default_value = "9.80665", allow_hyphen_values = true, value_parser = inputs::gravity_m_s2, requires = "model")]
    pub(crate) gravity_m_s2: f64,
    /// How long a lone contact presses, in s; for compliant, and in `clatter respond` for the acceleration of a place by
    /// the other models
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::contact_time_s, requires = "model", required_if_eq("model", "compliant"))]
    pub(crate) contact_time_s: Option<f64>,
    /// What the ground does to an end while it touches, for compliant [default: hysteretic]
    #[arg(long, value_enum, value_name = "LAW", requires = "contact_time_s")]
    contact_law: Option<LawName>,
}

/// How fast it comes down; the argument `model` requires one of them.
#[derive(Debug, clap::Args)]
#[group(id = "fall", multiple = false)]
pub(crate) struct Fall {
    /// Speed of the center of mass when end a touches, in m/s
    #[arg(long, value_name = "V", allow_hyphen_values = true, value_parser = inputs::speed_m_s, requires = "model")]
    speed_m_s: Option<f64>,
    /// Instead of the speed: height of the lower end before it is let go, in m; needs gravity
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = inputs::height_m, requires = "model")]
    pub(crate) height_m: Option<f64>,
}

impl DropArgs {
    /// The two that clap requires with a model.
    pub(crate) fn length_m(&self) -> f64 {
        self.length_m.unwrap_or(f64::NAN)
    }
    pub(crate) fn tilt_deg(&self) -> f64 {
        self.tilt_deg.unwrap_or(f64::NAN)
    }
    pub(crate) fn contact_law(&self) -> ContactLaw {
        self.contact_law.map_or_else(ContactLaw::default, Into::into)
    }

    /// Refuses what the model would leave aside.
    pub(crate) fn check(&self, model: ModelName) -> Result<(), Failure> {
        if model != ModelName::Compliant {
            return match self.contact_law {
                Some(_) => Err(Failure::Usage("--contact-law goes with --model=compliant alone")),
                None => Ok(()),
            };
        }
        if self.thickness_m == 0.0 {
            return Ok(());
        }
        let (name, allowed) = ("thickness in m", "0 for the model compliant: its contacts are those of a thin bar");
        let reason = clatter::Error::Quantity { name, value: self.thickness_m, allowed };
        Err(Failure::Flag { flag: "--thickness-m", reason })
    }

    /// The body, and where its center of mass lies.
    pub(crate) fn body(&self, gyration_m: Option<f64>, mass: &[Mass], e: f64) -> Result<(f64, Body), Failure> {
        let half = 0.5 * self.length_m();
        let [(center, center_flag), (gyration, gyration_flag)] = if let Some(gyration) = gyration_m {
            [(self.center_of_mass, "--center-of-mass"), (gyration, "--gyration-m")]
        } else {
            let bar = inputs::bar_of(mass, e)?;
            [bar.center_of_mass(), half * bar.gyration_ratio()].map(|x| (x, "--mass"))
        };
        let (a, b) = (half * (1.0 + center), half * (1.0 - center));
        Body::off_center(a, b, 0.0).map_err(Failure::flag(center_flag))?;
        let body = Body::off_center(a, b, gyration).map_err(Failure::flag(gyration_flag))?;
        if gyration > MOST_GYRATION * 2.0 * half {
            let (name, allowed) =
                ("radius of gyration in m", "at most 2 lengths, as in product files: two masses at the ends have 0.5");
            let reason = clatter::Error::Quantity { name, value: gyration, allowed };
            return Err(Failure::Flag { flag: gyration_flag, reason });
        }
        let body = body.with_thickness(self.thickness_m).map_err(Failure::flag("--thickness-m"))?;
        Ok((center, body))
    }

    /// The drop without spin, not limited in time.
    pub(crate) fn scene(&self, body: Body, e: f64) -> Result<Scene, Failure> {
        let (tilt, gravity) = (self.tilt_deg(), self.gravity_m_s2);
        Ok(match (self.fall.speed_m_s, self.fall.height_m) {
            (Some(speed), _) => Scene::new(body, e, speed, tilt, gravity)?,
            (None, Some(_)) if gravity == 0.0 => {
                return Err(Failure::Usage("--height-m needs gravity: give --speed-m-s, or a --gravity-m-s2 above 0"));
            }
            // clap requires one of the two with a model.
            (None, height) => Scene::from_height(body, e, height.unwrap_or(f64::NAN), tilt, gravity)
                .map_err(Failure::flag("--height-m"))?,
        })
    }
}
