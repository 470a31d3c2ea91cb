//! This module reads a drop from the arguments of a command, alone or in place of values of a product file.

use std::path::PathBuf;

use clap::ValueHint;
use clatter::End;
use clatter_answer::{DropInputs, Error};
use clatter_assess::Accuracy;
use clatter_flight::LEAST_OF_BLOCKS;
use clatter_product::{Drop, Input, Model, slip, units::Quantity};

use crate::inputs::{self, Law};
use crate::numbers::given;
use crate::one_drop::{OneDrop, PartSetup, Worst};
use crate::output::Files;
use crate::quantities::{self, PerAxis, Piece, Place, Show, Shown, neat};
use crate::{Failure, Streams};

/// The options whose names hold the unit, and take a number without one.
pub(crate) const IN_SI: &str = "The same as plain numbers in SI units";

/// All of a drop but its model, the inertia and the restitution.
#[derive(Debug, clap::Args)]
pub(crate) struct DropArgs {
    /// Take the drop from a product file, - for standard input, each range at one value, which is told; options given beside it count instead
    #[arg(long, value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath, group = "followed")]
    pub(crate) product: Option<PathBuf>,
    /// The part of the product that is asked about, by its name; may be left out where there is one alone
    #[arg(long, value_name = "NAME", requires = "product")]
    component: Option<String>,
    /// Length of the body from end to end, 2L, such as 150mm
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::length, requires = "followed", conflicts_with = "length_m")]
    length: Option<Quantity>,
    /// Width of a plate, across its length; --gyration=KX,KY, --center-of-mass=SX,SY and --at=X,Y then take two values, along the
    /// length and along the width; for map, ballistic and compliant. With --thickness it is that of a box, with three values
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::length, requires = "followed", conflicts_with_all = ["width_m", "product"])]
    width: Option<Quantity>,
    /// Where a tilted plate rises from corner a: 0deg along its length, 90deg along its width, to b and d by the sines of the tilt;
    /// of a box any, and of the plate of a product file, where the direction tells the corner
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantities::direction, conflicts_with = "direction_deg")]
    direction: Option<Quantity>,
    /// Instead of tilt and direction: heights of corners b and d of a plate as a touches
    #[arg(long, value_name = "HX,HY", allow_hyphen_values = true, value_parser = quantities::gaps, conflicts_with_all = ["gaps_m", "tilt", "tilt_deg", "direction", "direction_deg", "product"])]
    gaps: Option<[Quantity; 2]>,

    /// --width in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m, requires = "followed", conflicts_with = "product", help_heading = IN_SI, hide_short_help = true)]
    width_m: Option<f64>,
    /// --direction in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::number, help_heading = IN_SI, hide_short_help = true)]
    direction_deg: Option<f64>,
    /// --gaps in m
    #[arg(long, value_name = "HX,HY", allow_hyphen_values = true, value_parser = quantities::gaps_m, conflicts_with_all = ["tilt", "tilt_deg", "direction", "direction_deg", "product"], help_heading = IN_SI, hide_short_help = true)]
    gaps_m: Option<[f64; 2]>,
    /// Of a plate or a box, by all models but map: ∫x y dm over its mass, about the center of mass, of a box ∫x z dm and ∫y z dm as
    /// well; 0 unless given
    #[arg(long, value_name = "XY[,XZ,YZ]", allow_hyphen_values = true, value_parser = inputs::products, help_heading = IN_SI, hide_short_help = true)]
    product_of_inertia_m2: Option<[f64; 3]>,
    /// How a box is turned as it lands: the unit quaternion that turns its axes, along length, width and thickness, into those of
    /// the world, z upward; in place of a tilt
    #[arg(long, value_name = "W,X,Y,Z", allow_hyphen_values = true, value_parser = inputs::quaternion, requires = "followed", conflicts_with_all = ["tilt", "tilt_deg", "direction", "direction_deg", "gaps", "gaps_m"])]
    orientation: Option<[f64; 4]>,
    /// Where the center of mass of a box lies from its middle, in m
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = inputs::triple, requires = "followed", conflicts_with = "center_of_mass", help_heading = IN_SI, hide_short_help = true)]
    center_of_mass_m: Option<[f64; 3]>,
    /// Where the center of mass lies, between -1 (end a) and 1 (end b), or as a length from the middle; goes with
    /// --gyration
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = quantities::center_of_mass, conflicts_with = "mass", requires = "followed")]
    center_of_mass: Option<PerAxis<Place>>,
    /// Thickness of the body, at most its length: at a tilt it stands on a corner, half of it below the line through the
    /// center of mass; for finite-tilt, small tilts do not feel it
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::any_length, requires = "followed", conflicts_with = "thickness_m")]
    thickness: Option<Quantity>,
    #[command(flatten)]
    fall: Fall,
    /// Tilt when end a touches, below 90deg; 0deg for a flat drop, in which end a counts as the first
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantities::tilt, requires = "followed", conflicts_with = "tilt_deg")]
    tilt: Option<Quantity>,
    /// Acceleration of gravity; the model map leaves it out [default: 1gn]
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = quantities::gravity, requires = "followed", conflicts_with = "gravity_m_s2")]
    gravity: Option<Quantity>,
    /// How long a lone contact of one end takes, from touch to parting; for compliant, and in `clatter respond` for the
    /// acceleration of a place by the other models. 'clatter init' names public values
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = quantities::contact_time, requires = "followed", conflicts_with = "contact_time_s")]
    contact_time: Option<Quantity>,
    /// What the ground does to an end while it touches, for compliant [default: hysteretic]
    #[arg(long, value_enum, value_name = "LAW", requires = "followed")]
    contact_law: Option<Law>,

    /// Coefficient of friction of the ground under a box, for compliant: of plastics, glass and steel on wood and concrete 0.1 to 0.6, of
    /// rubber up to 1 [default: none]
    #[arg(long, value_name = "MU", allow_hyphen_values = true, value_parser = inputs::number, requires = "followed")]
    friction: Option<f64>,

    /// --length in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    length_m: Option<f64>,
    /// --thickness in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::number, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    thickness_m: Option<f64>,
    /// --tilt in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::tilt_deg, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    tilt_deg: Option<f64>,
    /// --gravity in m/s²
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = inputs::gravity_m_s2, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    gravity_m_s2: Option<f64>,
    /// --contact-time in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::contact_time_s, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    contact_time_s: Option<f64>,
}

/// How fast it comes down.
#[derive(Debug, clap::Args)]
#[group(id = "fall", multiple = false)]
struct Fall {
    /// Speed of the center of mass when end a touches, such as 4.85m/s
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, value_parser = quantities::speed, requires = "followed")]
    speed: Option<Quantity>,
    /// Instead of the speed: height of the lower end before it is let go; needs gravity
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::height, requires = "followed")]
    height: Option<Quantity>,
    /// --speed in m/s
    #[arg(long, value_name = "V", allow_hyphen_values = true, value_parser = inputs::speed_m_s, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    speed_m_s: Option<f64>,
    /// --height in m
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = inputs::height_m, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    height_m: Option<f64>,
}

/// The arguments of a command about a drop, in addition to [`DropArgs`].
pub(crate) struct ExtraArgs<'a> {
    pub(crate) model: Option<Model>,
    pub(crate) e: Option<f64>,
    pub(crate) gyration: Option<PerAxis<Quantity>>,
    pub(crate) masses: &'a [Piece],
    /// True where both ends land at the same instant, without a tilt.
    pub(crate) is_flat: bool,
    /// True where a contact time counts for instant impacts, too.
    pub(crate) instant_contacts: bool,
    /// Angular velocity at the first touch, in place of that of the product file.
    pub(crate) spin_rad_s: Option<PerAxis<f64>>,
    /// The end that touches first, in place of that of the product file.
    pub(crate) first: Option<End>,
    /// The product file, if there is one.
    pub(crate) file: Option<OneDrop>,
}

/// A drop with all that is reported about it.
pub(crate) struct Setup {
    pub(crate) drop: Drop,
    pub(crate) model: Model,
    pub(crate) shown: Shown,
    /// The part of a product file.
    pub(crate) part: Option<PartSetup>,
    /// Notes to report with the answer: the kind and the words of each.
    pub(crate) notes: Vec<(&'static str, String)>,
}

/// Returns a number that was given one way or the other.
fn either(typed: Option<Quantity>, plain: Option<f64>) -> Option<Quantity> {
    typed.or(plain.map(Quantity::of_si))
}

/// A plate beyond has lever arms that are 1.5 % shorter than those of a level one.
const STEEP_RAD: f64 = 0.174_532_925_199_432_95;

impl DropArgs {
    /// Returns the contact time as it was typed.
    pub(crate) fn contact_time(&self) -> Option<Quantity> {
        either(self.contact_time, self.contact_time_s)
    }
    fn sizes(&self) -> [Option<Quantity>; 3] {
        let (width, thickness) = (either(self.width, self.width_m), either(self.thickness, self.thickness_m));
        [either(self.length, self.length_m), width, thickness]
    }

    /// Returns the product file, where there is one, with its drop: that of its ranges with the highest demand, or one value of each.
    pub(crate) fn file(
        &self,
        first: Option<End>,
        worst: Option<(Worst, Accuracy)>,
        files: &Files<'_>,
        streams: &mut Streams<'_>,
    ) -> Result<Option<OneDrop>, Failure> {
        let Some(path) = &self.product else { return Ok(None) };
        let file = OneDrop::read(path, self.component.as_deref(), first, worst.is_some(), files, streams)?;
        Ok(Some(match worst {
            Some((of, accuracy)) => file.at_worst(of, &accuracy)?,
            None => file,
        }))
    }

    /// Makes the drop; the arguments replace the values of the product file where there is one.
    pub(crate) fn setup(&self, mut beside: ExtraArgs<'_>) -> Result<Setup, Failure> {
        let mut file = beside.file.take();
        let mut notes = self.slips(&beside);
        if let Some(worst) = file.as_ref().and_then(OneDrop::worst).copied() {
            return self.finish(&worst.drop, worst.model, &beside, file, notes);
        }
        let contact_time = self.contact_time();
        let fullest = |drop: &Drop| contact_time.map_or(Model::fullest(drop), |_| Model::Compliant);
        let of_file = file.as_mut().map(|file| self.of_file(file, &beside));
        let (base, height_m) = of_file.map_or((None, None), |(drop, height_m)| (Some(drop), height_m));
        let model = beside.model.or(base.as_ref().map(fullest)).unwrap_or(Model::Compliant);
        if model != Model::Compliant && self.contact_law.is_some() {
            return Err(Failure::Usage("--contact-law goes with --model=compliant alone"));
        }
        if model != Model::Compliant && contact_time.is_some() && !beside.instant_contacts {
            return Err(Failure::Usage("--contact-time and --contact-time-s go with --model=compliant alone"));
        }
        if beside.is_flat && model == Model::Compliant {
            return Err(Failure::Usage(
                "--flat goes with instant impacts: contacts that take time land flat with --tilt=0deg",
            ));
        }
        let mut inputs = self.inputs(&beside, file.as_ref(), base.as_ref())?;
        // The height of the file, with the gravity that is given.
        inputs.height_m = inputs.height_m.or(height_m.filter(|_| inputs.speed_m_s.is_none()));
        let half_m = 0.5 * inputs.length_m.unwrap_or(f64::INFINITY);
        let beyond = beside.masses.iter().flat_map(|piece| piece.slips(half_m));
        notes.extend(beyond.map(|slip| ("warning", slip.to_string())));
        let thick = inputs.thickness_m.filter(|m| model == Model::Compliant && !inputs.is_box() && *m != 0.0);
        if let Some(value) = thick {
            let (name, allowed) = ("thickness in m", "0 for the model compliant: its contacts are those of a thin bar");
            let reason = clatter::Error::Quantity { name, value, allowed }.to_string();
            return Err(self.named("thickness_m", beside.gyration, &reason));
        }
        let failure = |error| self.failure(error, beside.gyration);
        let drop = inputs.over(base.as_ref(), model).map_err(failure)?;
        let is_stretched = inputs.length_m.is_some() && inputs.gyration_m.is_none();
        if let Some(file) = file.as_mut().filter(|_| is_stretched) {
            file.note("the radius of gyration and the center of mass along it go with the length");
        }
        self.finish(&drop, model, &beside, file, notes)
    }

    fn finish(
        &self,
        drop: &Drop,
        model: Model,
        beside: &ExtraArgs<'_>,
        mut file: Option<OneDrop>,
        mut notes: Vec<(&'static str, String)>,
    ) -> Result<Setup, Failure> {
        if drop.body.is_wide() && !drop.is_solid() && drop.tilt_rad > STEEP_RAD {
            let tilt = given(neat(format!("{:.3e}", drop.tilt_rad.to_degrees()).parse().unwrap_or(0.0)));
            let steep = "its lever arms are shorter";
            notes.push((
                "warning",
                format!("a plate is followed as if almost level: at a tilt of {tilt} degrees {steep}"),
            ));
        }
        let part = file.as_mut().map(OneDrop::part).transpose()?.flatten();
        part.as_ref().map_or(Ok(()), |part| part.check_within(drop.sides_m()))?;
        let shown = self.shown(beside, file.as_ref());
        notes.extend(file.into_iter().flat_map(OneDrop::into_notes).map(|note| ("note", note)));
        let e = drop.restitution;
        if drop.is_solid() && drop.contact_law.leaves_a_dent() && e < LEAST_OF_BLOCKS {
            let followed = format!("e = {e:?} is followed as {LEAST_OF_BLOCKS}");
            let why = "hysteretic contacts of a box rebound with that at least";
            notes.push(("warning", format!("{followed}: {why}")));
        }
        Ok(Setup { drop: *drop, model, shown, part, notes })
    }

    /// Returns the drop of a product file; inputs that are given here are left out of the reported ones.
    fn of_file(&self, file: &mut OneDrop, beside: &ExtraArgs<'_>) -> (Drop, Option<f64>) {
        let fall = &self.fall;
        let falls =
            fall.speed.is_some() || fall.speed_m_s.is_some() || fall.height.is_some() || fall.height_m.is_some();
        let is_instant = beside.model.is_some_and(|model| model != Model::Compliant) && !beside.instant_contacts;
        file.drop(|input| match input {
            Input::Height | Input::Speed => falls,
            Input::Tilt => self.tilt.is_some() || self.tilt_deg.is_some() || beside.is_flat,
            Input::Direction => self.direction.is_some() || self.direction_deg.is_some(),
            Input::Restitution => beside.e.is_some(),
            Input::ContactTime => self.contact_time().is_some() || is_instant,
            Input::Gyration => beside.gyration.is_some() || !beside.masses.is_empty(),
            Input::Spin => beside.spin_rad_s.is_some(),
            Input::Friction => self.friction.is_some(),
            Input::First => beside.first.is_some(),
        })
    }

    /// Returns the inputs that are given here, in SI units and degrees.
    fn inputs(
        &self,
        beside: &ExtraArgs<'_>,
        file: Option<&OneDrop>,
        base: Option<&Drop>,
    ) -> Result<DropInputs, Failure> {
        let si = |typed, plain| either(typed, plain).map(|quantity| quantity.si);
        let degrees =
            |typed: Option<Quantity>, plain: Option<f64>| plain.or(typed.map(|angle| quantities::degrees(angle.si)));
        let [length_m, width_m, thickness_m] = self.sizes().map(|size| size.map(|size| size.si));
        let length_m = match (length_m, &file) {
            (Some(length_m), Some(file)) => Some(file.length_of(length_m)?),
            _ => length_m,
        };
        let halves_m = [
            length_m.or(base.map(|drop| drop.body.length_m())),
            width_m.or(base.and_then(|drop| drop.body.width).map(|width| width.m())),
            thickness_m,
        ]
        .map(|side| side.map(|m| 0.5 * m));
        let mut inputs = DropInputs {
            length_m,
            width_m,
            thickness_m,
            gyration_m: beside.gyration.map(|radii| radii.values().into_iter().map(|radius| radius.si).collect()),
            center_of_mass_m: self.center_of_mass_m,
            product_of_inertia_m2: self.product_of_inertia_m2,
            e: beside.e,
            speed_m_s: si(self.fall.speed, self.fall.speed_m_s),
            height_m: si(self.fall.height, self.fall.height_m),
            tilt_deg: degrees(self.tilt, self.tilt_deg),
            direction_deg: degrees(self.direction, self.direction_deg),
            gaps_m: self.gaps_m.or(self.gaps.map(|gaps| gaps.map(|gap| gap.si))),
            orientation: self.orientation,
            spin_rad_s: beside.spin_rad_s.map(PerAxis::values),
            gravity_m_s2: si(self.gravity, self.gravity_m_s2),
            contact_time_s: self.contact_time().map(|time| time.si),
            contact_law: self.contact_law.map(|law| law.0),
            friction: self.friction,
            first: beside.first,
            is_flat: beside.is_flat,
            ..DropInputs::default()
        };
        if let Some(center) = self.center_of_mass {
            let along = center.values().into_iter().zip(halves_m);
            let relative = along.map(|(place, half_m)| place.relative("--center-of-mass", half_m));
            inputs.center_of_mass = Some(relative.collect::<Result<_, Failure>>()?);
        }
        if let ([_, ..], [Some(half_m), None, _]) = (beside.masses, halves_m) {
            let e = inputs.e.or(base.map(|drop| drop.restitution)).unwrap_or(0.0);
            let bar = inputs::bar_of(&quantities::masses(beside.masses, Some(half_m))?, e)?;
            inputs.center_of_mass = Some(vec![bar.center_of_mass()]);
            inputs.gyration_m = Some(vec![half_m * bar.gyration_ratio()]);
        } else if !beside.masses.is_empty() && halves_m[1].is_some() {
            return Err(Failure::Usage(
                "--mass is that of a bar: a plate takes --gyration=KX,KY and --center-of-mass=SX,SY",
            ));
        }
        Ok(inputs)
    }

    /// Returns warnings about values that no product has.
    fn slips(&self, beside: &ExtraArgs<'_>) -> Vec<(&'static str, String)> {
        let radius = beside.gyration.map(PerAxis::values).filter(|radii| radii.len() == 1).map(|radii| radii[0]);
        let given = [
            ("length", either(self.length, self.length_m)),
            ("speed", either(self.fall.speed, self.fall.speed_m_s)),
            ("height", either(self.fall.height, self.fall.height_m)),
            ("contact_time", self.contact_time()),
            ("radius_of_gyration", radius),
            ("friction", self.friction.map(Quantity::of_si)),
        ];
        let slips = given.into_iter().filter_map(|(key, quantity)| slip(key, &quantity?));
        slips.map(|slip| ("warning", slip.to_string())).collect()
    }

    /// Returns the units as they were typed, here or in the file.
    fn shown(&self, beside: &ExtraArgs<'_>, file: Option<&OneDrop>) -> Shown {
        let of = |quantity: Option<Quantity>| quantity.and_then(|quantity| quantity.unit);
        let radius = beside.gyration.map(|radii| radii.values()[0]);
        let [length, _, thickness] = self.sizes();
        let lengths = of(length).or(of(radius)).or(of(thickness)).or(of(self.fall.height));
        Shown {
            length: Show { unit: lengths.or(file.and_then(OneDrop::length_unit)), name: "m" },
            speed: Show { unit: of(self.fall.speed).or(file.and_then(OneDrop::speed_unit)), name: "m/s" },
            time: Show { unit: of(self.contact_time).or(file.and_then(OneDrop::time_unit)), name: "s" },
            acceleration: Show { unit: of(self.gravity).or(file.and_then(OneDrop::acceleration_unit)), name: "m/s²" },
            spin: Show { unit: None, name: "rad/s" },
            angle: of(self.tilt),
        }
    }

    /// Returns the option that gives an input, as it was given: `--height`, or `--height-m` for a plain number.
    fn flag(&self, name: &str, gyration: Option<PerAxis<Quantity>>) -> String {
        let (fall, kebab) = (&self.fall, name.replace('_', "-"));
        let radius = gyration.map(|radii| radii.values()[0]);
        let is_plain = match name {
            "length_m" => self.length_m.is_some(),
            "width_m" => self.width_m.is_some(),
            "thickness_m" => self.thickness_m.is_some(),
            "speed_m_s" => fall.speed_m_s.is_some(),
            "height_m" => fall.height_m.is_some(),
            "tilt_deg" => self.tilt_deg.is_some(),
            "direction_deg" => self.direction_deg.is_some(),
            "gaps_m" => self.gaps_m.is_some(),
            "gravity_m_s2" => self.gravity_m_s2.is_some(),
            "contact_time_s" => self.contact_time_s.is_some(),
            "gyration_m" => radius.is_some_and(|radius| radius.unit.is_none()),
            _ => true,
        };
        let units = ["-m-s2", "-m-s", "-deg", "-m", "-s"];
        let typed = units.iter().find_map(|unit| kebab.strip_suffix(unit)).filter(|_| !is_plain);
        format!("--{}", typed.unwrap_or(&kebab))
    }

    fn named(&self, name: &str, gyration: Option<PerAxis<Quantity>>, reason: &str) -> Failure {
        Failure::Wrong(format!("invalid value for '{}': {reason}", self.flag(name, gyration)))
    }

    /// Makes the failure of a drop that was refused, with the options that give it.
    pub(crate) fn failure(&self, error: Error, gyration: Option<PerAxis<Quantity>>) -> Failure {
        match error {
            Error::Missing(names) => {
                let option = |name: &&str| match *name {
                    "length_m" => "--length=LENGTH",
                    "width_m" => "--width=LENGTH",
                    "thickness_m" => "--thickness=LENGTH",
                    "gyration_m" if self.sizes()[1].is_none() => "--gyration=LENGTH or --mass=M@S",
                    "gyration_m" if self.sizes()[2].is_none() => "--gyration=KX,KY",
                    "gyration_m" => "--gyration=KX,KY,KZ (about the axes of the box)",
                    "e" => "--e=E",
                    "speed_m_s or height_m" => "--speed=SPEED or --height=LENGTH",
                    "tilt_deg or gaps_m" => "--tilt=ANGLE and --direction=ANGLE, or --gaps=HX,HY",
                    "orientation or tilt_deg" => "--orientation=W,X,Y,Z or --tilt=ANGLE",
                    "direction_deg" => "--direction=ANGLE",
                    "tilt_deg" => "--tilt=ANGLE",
                    _ => "--contact-time=TIME",
                };
                let (give, file) =
                    (names.iter().map(option).collect::<Vec<_>>().join(", "), "--product=FILE, which says all of it");
                let or = if self.product.is_none() { format!("; or {file}") } else { String::new() };
                Failure::Wrong(format!("the drop is not whole: give {give}{or}"))
            }
            Error::Input { name, reason } => self.named(name, gyration, &reason),
            Error::Flight(error @ clatter_flight::Error::Bound { name, .. }) => {
                let (name, given) = match name {
                    "contact time" => ("contact_time_s", self.contact_time_s),
                    _ => (
                        "gyration_m",
                        gyration.map(|radii| radii.values()[0]).filter(|k| k.unit.is_none()).map(|k| k.si),
                    ),
                };
                let plain = given.map_or(String::new(), |si| format!("{si:?}: "));
                self.named(name, gyration, &format!("{plain}{error}"))
            }
            error => error.into(),
        }
    }
}

impl Setup {
    /// Converts a typed place to half-sides along each side of the body, which goes on so far beyond its feet.
    pub(crate) fn relative(&self, at: PerAxis<Place>, beyond_m: [f64; 2]) -> Result<Vec<f64>, Failure> {
        let (flag, body) = ("--at", &self.drop.body);
        let places = match (self.drop.is_solid(), body.is_wide()) {
            (true, _) => at.of_block(flag)?.to_vec(),
            (_, true) => at.of_plate(flag)?.to_vec(),
            _ => vec![at.of_bar(flag)?],
        };
        let on = |(axis, place): (usize, Place)| {
            let beyond_m = beyond_m.get(axis).copied().unwrap_or(0.0);
            quantities::position(place, flag, 0.5 * self.sides_m()[axis], beyond_m)
        };
        places.into_iter().enumerate().map(on).collect()
    }
    /// Converts a typed place to m from the middle.
    pub(crate) fn place_m(&self, at: PerAxis<Place>, beyond_m: [f64; 2]) -> Result<[f64; 3], Failure> {
        let mut at_m = [0.0; 3];
        for (axis, s) in self.relative(at, beyond_m)?.into_iter().enumerate() {
            at_m[axis] = 0.5 * self.sides_m()[axis] * s;
        }
        Ok(at_m)
    }
    fn sides_m(&self) -> [f64; 3] {
        let body = &self.drop.body;
        [body.length_m(), body.width_m(), body.thickness().m()]
    }
}
