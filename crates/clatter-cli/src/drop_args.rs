//! A drop as arguments of a command say it, alone or over what a product file says.

mod block;
mod plate;

use std::path::PathBuf;

use clap::ValueHint;
use clatter::End;
use clatter_assess::units::Quantity;
use clatter_assess::{Accuracy, Model, STANDARD_GRAVITY_M_S2, slip};
use clatter_flight::{ContactLaw, Profile, Scene};

use crate::inputs::{self, Law};
use crate::numbers::given;
use crate::one_drop::{OneDrop, PartSetup, Worst};
use crate::output::Files;
use crate::quantities::{self, PerAxis, Piece, Place, Show, Shown, neat};
use crate::{Failure, Streams};

use block::BlockArgs;
pub(crate) use block::ExtraArgs as BesideBlock;
use plate::PlateArgs;
pub(crate) use plate::{ExtraArgs as BesidePlate, PlateSetup};

/// Largest radius of gyration over the length. A body beyond hardly turns, and clatters for hours.
const MOST_GYRATION: f64 = 2.0;
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
    #[command(flatten)]
    plate: PlateArgs,
    #[command(flatten)]
    block: BlockArgs,
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

/// What a command has of a drop beside [`DropArgs`].
pub(crate) struct ExtraArgs<'a> {
    pub(crate) model: Option<Model>,
    pub(crate) e: Option<f64>,
    pub(crate) gyration: Option<Quantity>,
    pub(crate) masses: &'a [Piece],
    /// Whether both ends land as one, without a tilt.
    pub(crate) flat: bool,
    /// Whether a contact time counts for instant impacts, too.
    pub(crate) instant_contacts: bool,
    /// Angular velocity as end a touches, end b upward, over that of the product file, and its option.
    pub(crate) spin: Option<(f64, &'static str)>,
    /// The end that touches first, over that of the product file.
    pub(crate) first: Option<End>,
    /// Whether places that are typed are those of the product, whichever end touches first; else they are seen from the end that does.
    pub(crate) of_product: bool,
    /// The product file, if there is one.
    pub(crate) file: Option<OneDrop>,
}

/// A drop with all that it needs.
pub(crate) struct Setup {
    pub(crate) model: Model,
    /// The end of the product that touches first; in the scene it is end a.
    pub(crate) first: End,
    pub(crate) scene: Scene,
    /// Position of the center of mass on the body.
    pub(crate) center_of_mass: f64,
    pub(crate) length_m: f64,
    pub(crate) thickness_m: f64,
    pub(crate) height_m: Option<f64>,
    pub(crate) tilt_deg: f64,
    /// Whether both ends land as one.
    pub(crate) flat: bool,
    pub(crate) contact_time_s: Option<f64>,
    pub(crate) contact_law: ContactLaw,
    pub(crate) shown: Shown,
    /// The part of a product file.
    pub(crate) part: Option<PartSetup>,
    /// What is told beside the answer, after what it is.
    pub(crate) notes: Vec<(&'static str, String)>,
}

/// A number that was given one way or the other.
fn either(typed: Option<Quantity>, plain: Option<f64>) -> Option<Quantity> {
    typed.or(plain.map(Quantity::of_si))
}

impl DropArgs {
    /// As it was typed.
    pub(crate) fn contact_time(&self) -> Option<Quantity> {
        either(self.contact_time, self.contact_time_s)
    }

    fn thickness(&self) -> f64 {
        either(self.thickness, self.thickness_m).map_or(0.0, |thickness| thickness.si)
    }

    /// Refuses what the model would leave aside.
    fn check(&self, model: Model) -> Result<(), Failure> {
        if model != Model::Compliant {
            return match self.contact_law {
                Some(_) => Err(Failure::Usage("--contact-law goes with --model=compliant alone")),
                None => Ok(()),
            };
        }
        if self.thickness() == 0.0 {
            return Ok(());
        }
        let (name, allowed) = ("thickness in m", "0 for the model compliant: its contacts are those of a thin bar");
        let reason = clatter::Error::Quantity { name, value: self.thickness(), allowed };
        Err(Failure::Flag { flag: self.thickness_flag(), reason })
    }

    /// The name of the option for the thickness as it was given.
    fn thickness_flag(&self) -> &'static str {
        if self.thickness_m.is_some() { "--thickness-m" } else { "--thickness" }
    }

    /// A flight that was refused, with the option whose value it refuses where there is one.
    pub(crate) fn named(&self, error: clatter_flight::Error, gyration: Option<Quantity>) -> Failure {
        let clatter_flight::Error::Bound { name, .. } = &error else { return Failure::Flight(error) };
        let (given, typed, plain) = match *name {
            "contact time" => (self.contact_time(), "--contact-time", "--contact-time-s"),
            _ => (gyration, "--gyration", "--gyration-m"),
        };
        match given {
            Some(Quantity { unit: Some(_), .. }) => Failure::Wrong(format!("invalid value for '{typed}': {error}")),
            Some(Quantity { si, unit: None }) => Failure::Wrong(format!("invalid value {si:?} for '{plain}': {error}")),
            None => Failure::Flight(error),
        }
    }

    /// The product file, where there is one, with its drop: that of its ranges that asks most, or one value of each.
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

    /// The drop, over that of the product file where there is one.
    pub(crate) fn setup(&self, mut beside: ExtraArgs<'_>) -> Result<Setup, Failure> {
        self.plate.refuse()?;
        let mut file = beside.file.take();
        let beside = &beside;
        let mut notes = self.slips(beside);
        let mirrored = file.as_ref().map_or(beside.first == Some(End::B), OneDrop::is_mirrored);
        if let Some(file) = file.as_mut().filter(|_| mirrored && !beside.of_product) {
            file.note(
                "end b touches first and is called a here: places of the file are turned around; those of --at, \
                 --center-of-mass and --mass are not, they count towards the end that strikes second",
            );
        }
        let length = either(self.length, self.length_m);
        let length_m = match (length, &file) {
            (Some(length), Some(file)) => Some(file.length_of(length.si)?),
            (length, file) => length.map(|length| length.si).or(file.as_ref().map(OneDrop::length_m)),
        };
        let tilt_deg =
            self.tilt_deg.or(self.tilt.map(|tilt| neat(tilt.si.to_degrees()))).or(beside.flat.then_some(0.0));
        let contact_time = self.contact_time();
        let model = beside.model.unwrap_or(match (contact_time, &file) {
            (None, Some(file)) if !file.has_contact_time() => Model::FiniteTilt,
            _ => Model::Compliant,
        });
        self.check(model)?;
        let compliant = model == Model::Compliant;
        let flat = beside.flat || file.as_ref().is_some_and(OneDrop::is_flat);
        if beside.flat && compliant {
            return Err(Failure::Usage(
                "--flat goes with instant impacts: contacts that take time land flat with --tilt=0deg",
            ));
        }
        let asked = compliant || beside.instant_contacts;
        let of_file = |file: &mut Option<OneDrop>| file.as_mut().filter(|_| asked)?.contact_time_s();
        let contact_time_s = contact_time.map(|time| time.si).or_else(|| of_file(&mut file));
        let e = beside.e.or_else(|| file.as_mut().map(OneDrop::restitution));
        let tilt_deg = tilt_deg.or_else(|| file.as_mut().map(OneDrop::tilt_deg));
        let gravity = either(self.gravity, self.gravity_m_s2).map(|gravity| gravity.si);
        let gravity = gravity.or(file.as_ref().map(OneDrop::gravity_m_s2)).unwrap_or(STANDARD_GRAVITY_M_S2);
        let mut speed = either(self.fall.speed, self.fall.speed_m_s).map(|speed| speed.si);
        let mut height_m = either(self.fall.height, self.fall.height_m).map(|height| height.si);
        if speed.is_none() && height_m.is_none() {
            (speed, height_m) = file.as_mut().map_or((None, None), OneDrop::fall);
        }
        let inertia = beside.gyration.is_some() || !beside.masses.is_empty() || file.is_some();
        let missing = [
            (length_m.is_some(), "--length=LENGTH"),
            (inertia, "--gyration=LENGTH or --mass=M@S"),
            (e.is_some(), "--e=E"),
            (speed.is_some() || height_m.is_some(), "--speed=SPEED or --height=LENGTH"),
            (tilt_deg.is_some(), "--tilt=ANGLE"),
            (!compliant || contact_time_s.is_some(), "--contact-time=TIME"),
        ];
        let missing: Vec<_> = missing.iter().filter(|(is_given, _)| !is_given).map(|(_, name)| *name).collect();
        let (Some(length_m), Some(e), Some(tilt_deg), []) = (length_m, e, tilt_deg, &missing[..]) else {
            let product = if file.is_none() { "; or --product=FILE, which says all of it" } else { "" };
            return Err(Failure::Wrong(format!("the drop is not whole: give {}{product}", missing.join(", "))));
        };
        let half = 0.5 * length_m;
        notes
            .extend(beside.masses.iter().flat_map(|piece| piece.slips(half)).map(|slip| ("warning", slip.to_string())));
        let turned = mirrored && beside.of_product;
        let (center_of_mass, body) = self.body(half, beside, e, file.as_mut(), if turned { -1.0 } else { 1.0 })?;
        let scene = self.scene(body, e, [speed, height_m], tilt_deg, gravity)?;
        let scene = match (beside.spin, file.as_mut()) {
            (Some((spin, flag)), _) => scene.with_spin(spin).map_err(Failure::flag(flag))?,
            (None, Some(file)) => scene.with_spin(file.spin_rad_s())?,
            (None, None) => scene,
        };
        let part = file.as_mut().map(|file| file.part([half, 0.0])).transpose()?.flatten();
        let shown = self.shown(length.and_then(|length| length.unit), beside, file.as_ref());
        let law = self.contact_law.map(|law| law.0).or(file.as_ref().map(OneDrop::contact_law)).unwrap_or_default();
        if let Some(mut file) = file {
            if length.is_some() && beside.gyration.is_none() && beside.masses.is_empty() {
                file.note("the radius of gyration and the center of mass go with the length");
            }
            notes.extend(file.into_notes().map(|note| ("note", note)));
        }
        Ok(Setup {
            model,
            first: if mirrored { End::B } else { End::A },
            scene,
            center_of_mass,
            length_m,
            thickness_m: self.thickness(),
            height_m,
            tilt_deg,
            flat,
            contact_time_s,
            contact_law: law,
            shown,
            part,
            notes,
        })
    }

    /// Values that no product has.
    fn slips(&self, beside: &ExtraArgs<'_>) -> Vec<(&'static str, String)> {
        let given = [
            ("length", either(self.length, self.length_m)),
            ("speed", either(self.fall.speed, self.fall.speed_m_s)),
            ("height", either(self.fall.height, self.fall.height_m)),
            ("contact_time", self.contact_time()),
            ("radius_of_gyration", beside.gyration),
        ];
        let slips = given.into_iter().filter_map(|(key, quantity)| slip(key, &quantity?));
        slips.map(|slip| ("warning", slip.to_string())).collect()
    }

    /// Units as they were typed, here or in the file.
    fn shown(
        &self,
        length: Option<&'static clatter_assess::units::Unit>,
        beside: &ExtraArgs<'_>,
        file: Option<&OneDrop>,
    ) -> Shown {
        let of = |quantity: Option<Quantity>| quantity.and_then(|quantity| quantity.unit);
        let lengths = length.or(of(beside.gyration)).or(of(self.thickness)).or(of(self.fall.height));
        Shown {
            length: Show { unit: lengths.or(file.and_then(OneDrop::length_unit)), name: "m" },
            speed: Show { unit: of(self.fall.speed).or(file.and_then(OneDrop::speed_unit)), name: "m/s" },
            time: Show { unit: of(self.contact_time).or(file.and_then(OneDrop::time_unit)), name: "s" },
            acceleration: Show { unit: of(self.gravity).or(file.and_then(OneDrop::acceleration_unit)), name: "m/s²" },
            spin: Show { unit: None, name: "rad/s" },
            angle: of(self.tilt),
        }
    }

    /// The body, and where its center of mass lies.
    fn body(
        &self,
        half: f64,
        beside: &ExtraArgs<'_>,
        e: f64,
        file: Option<&mut OneDrop>,
        side: f64,
    ) -> Result<(f64, Profile), Failure> {
        let flag = "--center-of-mass";
        let center = self.center_of_mass.map(|place| place.of_bar(flag)?.relative(flag, Some(half))).transpose()?;
        let center = center.map(|center| side * center + 0.0);
        let [(center, center_flag), (gyration, gyration_flag)] = match (beside.gyration, beside.masses) {
            (None, []) => {
                // The file has the rest; its body takes another length as it is stretched.
                let (own_center, own_gyration) = file.map_or((0.0, f64::NAN), OneDrop::inertia);
                [(center.unwrap_or(own_center), "--center-of-mass"), (half * own_gyration, "--product")]
            }
            (Some(gyration), _) => {
                let flag = if gyration.unit.is_some() { "--gyration" } else { "--gyration-m" };
                let center = center.or(file.map(|file| file.center_of_mass())).unwrap_or(0.0);
                [(center, "--center-of-mass"), (gyration.si, flag)]
            }
            (None, pieces) => {
                let bar = inputs::bar_of(&quantities::masses(pieces, Some(half))?, e)?;
                [side * bar.center_of_mass() + 0.0, half * bar.gyration_ratio()].map(|x| (x, "--mass"))
            }
        };
        let (a, b) = (half * (1.0 + center), half * (1.0 - center));
        Profile::off_center(a, b, 0.0).map_err(Failure::flag(center_flag))?;
        let body = Profile::off_center(a, b, gyration).map_err(Failure::flag(gyration_flag))?;
        let most = MOST_GYRATION * 2.0 * half;
        if gyration > most {
            let [given, most] = [gyration, most].map(|m| given(neat(1e3 * m)));
            return Err(Failure::Wrong(format!(
                "invalid value for '{gyration_flag}': radius of gyration {given} mm: at most {most} mm here, 2 lengths, as in product files; two masses at the ends have 0.5"
            )));
        }
        let flag = self.thickness_flag();
        let body = body.with_thickness(self.thickness()).map_err(Failure::flag(flag))?;
        Ok((center, body))
    }

    /// The drop without spin yet, not limited in time.
    fn scene(
        &self,
        body: Profile,
        e: f64,
        [speed, height]: [Option<f64>; 2],
        tilt: f64,
        gravity: f64,
    ) -> Result<Scene, Failure> {
        Ok(match (speed, height) {
            (Some(speed), _) => Scene::new(body, e, speed, tilt, gravity)?,
            (None, Some(_)) if gravity == 0.0 => {
                return Err(Failure::Usage(
                    "a height (--height, --height-m) needs gravity: give --speed, or a --gravity or --gravity-m-s2 above 0",
                ));
            }
            // That there is one of the two was checked before.
            (None, height) => {
                let flag = if self.fall.height_m.is_some() { "--height-m" } else { "--height" };
                Scene::from_height(body, e, height.unwrap_or(f64::NAN), tilt, gravity).map_err(Failure::flag(flag))?
            }
        })
    }
}
