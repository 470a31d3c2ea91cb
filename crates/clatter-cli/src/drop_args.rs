//! A drop in SI units, and the model that follows it, as arguments of a command say them: one that has an argument
//! `model`.

use clap::ValueEnum;
use clatter::Mass;
use clatter::flight::{Body, CompliantFlight, Contact, Flight, Model, Pulse, Scene};

use crate::Failure;
use crate::inputs;

/// Strikes followed at most unless told.
const IMPACT_LIMIT: usize = 100_000;

/// With every model there are.
const WITH_MODEL: [(&str, &str); 4] =
    [("model", "map"), ("model", "ballistic"), ("model", "finite-tilt"), ("model", "compliant")];

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
    /// Angular velocity when end a touches, in rad/s; positive turns end b upward
    #[arg(long, value_name = "W", default_value = "0", allow_hyphen_values = true, value_parser = inputs::number, requires = "model")]
    spin_rad_s: f64,
    /// For compliant: how long a lone contact presses, in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::contact_time_s, requires = "model", required_if_eq("model", "compliant"))]
    pub(crate) contact_time_s: Option<f64>,
    /// Follow the motion until this time after the first touch, in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::time_limit_s, requires = "model")]
    pub(crate) time_limit_s: Option<f64>,
    /// Follow the motion for at most so many strikes
    #[arg(long, value_name = "N", default_value_t = IMPACT_LIMIT, allow_hyphen_values = true, value_parser = inputs::impact_limit, requires = "model")]
    impact_limit: usize,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelName {
    /// Small tilt, no gravity, instant impacts
    Map,
    /// Small tilt, gravity, instant impacts
    Ballistic,
    /// Any tilt, gravity, instant impacts
    FiniteTilt,
    /// Any tilt, gravity, contacts that take time
    Compliant,
}

impl ModelName {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
}

/// What a model says of a scene.
pub(crate) enum Motion {
    Instant(Model, Flight),
    /// With the time that a lone contact takes, in s.
    Compliant(f64, Box<CompliantFlight>),
}

impl Motion {
    pub(crate) fn flight(&self) -> &Flight {
        match self {
            Self::Instant(_, flight) => flight,
            Self::Compliant(_, compliant) => &compliant.flight,
        }
    }
    pub(crate) fn pulses(&self) -> &[Pulse] {
        match self {
            Self::Instant(..) => &[],
            Self::Compliant(_, compliant) => &compliant.pulses,
        }
    }
}

impl DropArgs {
    /// Whether a limit of its own may end it before rest.
    pub(crate) fn is_cut_short(&self) -> bool {
        self.time_limit_s.is_some() || self.impact_limit != IMPACT_LIMIT
    }
    /// The two that clap requires with a model.
    pub(crate) fn length_m(&self) -> f64 {
        self.length_m.unwrap_or(f64::NAN)
    }
    pub(crate) fn tilt_deg(&self) -> f64 {
        self.tilt_deg.unwrap_or(f64::NAN)
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
        let body = body.with_thickness(self.thickness_m).map_err(Failure::flag("--thickness-m"))?;
        Ok((center, body))
    }

    pub(crate) fn scene(&self, body: Body, e: f64) -> Result<Scene, Failure> {
        let (tilt, gravity) = (self.tilt_deg(), self.gravity_m_s2);
        let scene = match (self.fall.speed_m_s, self.fall.height_m) {
            (Some(speed), _) => Scene::new(body, e, speed, tilt, gravity)?,
            (None, Some(_)) if gravity == 0.0 => {
                return Err(Failure::Usage("--height-m needs gravity: give --speed-m-s, or a --gravity-m-s2 above 0"));
            }
            // clap requires one of the two with a model.
            (None, height) => Scene::from_height(body, e, height.unwrap_or(f64::NAN), tilt, gravity)
                .map_err(Failure::flag("--height-m"))?,
        };
        let scene = scene.with_spin(self.spin_rad_s).map_err(Failure::flag("--spin-rad-s"))?;
        let scene = scene.with_impact_limit(self.impact_limit)?;
        Ok(self.time_limit_s.map_or(Ok(scene), |limit| scene.with_time_limit_s(limit))?)
    }

    pub(crate) fn motion(&self, model: ModelName, scene: &Scene) -> Result<Motion, Failure> {
        let model = match (model, self.contact_time_s) {
            (ModelName::Compliant, contact_time) => {
                let time = contact_time.unwrap_or(f64::NAN); // clap requires it
                Contact::new(scene.e(), time).map_err(Failure::flag("--e"))?;
                let body = scene.body();
                let flag = match () {
                    () if body.thickness_m() > 0.0 => "--thickness-m",
                    () if body.gyration_m() < 0.05 * body.length_m() => "--gyration-m",
                    () => "--contact-time-s",
                };
                let compliant = scene.simulate_compliant(time).map_err(Failure::flag(flag))?;
                return Ok(Motion::Compliant(time, Box::new(compliant)));
            }
            (_, Some(_)) => return Err(Failure::Usage("--contact-time-s goes with --model=compliant alone")),
            (ModelName::Map, None) => Model::Map,
            (ModelName::Ballistic, None) => Model::Ballistic,
            (ModelName::FiniteTilt, None) => Model::FiniteTilt,
        };
        Ok(Motion::Instant(model, scene.simulate(model)))
    }
}
