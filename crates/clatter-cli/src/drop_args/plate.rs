//! A drop of a plate as arguments say it.

use clatter::Corner;
use clatter_assess::units::Quantity;
use clatter_assess::{Model, STANDARD_GRAVITY_M_S2};
use clatter_flight::{Contact, Plate, PlateScene};

use super::{DropArgs, IN_SI, MOST_GYRATION, either};
use crate::Failure;
use crate::inputs;
use crate::numbers::given;
use crate::one_drop::{OneDrop, PartSetup};
use crate::quantities::{self, PerAxis, Place, Show, Shown, neat};

/// What makes a plate of a bar.
#[derive(Debug, clap::Args)]
pub(crate) struct PlateArgs {
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
    pub(super) product_of_inertia_m2: Option<[f64; 3]>,
}

impl PlateArgs {
    pub(super) fn width(&self) -> Option<Quantity> {
        either(self.width, self.width_m)
    }
    /// Refuses for a bar what a plate alone has.
    pub(super) fn refuse(&self) -> Result<(), Failure> {
        let direction = self.direction.is_some() || self.direction_deg.is_some();
        if direction || self.gaps.is_some() || self.gaps_m.is_some() {
            return Err(Failure::Usage("--direction and --gaps are those of a plate: give its --width"));
        }
        if self.product_of_inertia_m2.is_some() {
            return Err(Failure::Usage("--product-of-inertia-m2 is that of a plate: give its --width"));
        }
        Ok(())
    }
}

/// A drop of a plate with all that it needs.
pub(crate) struct PlateSetup {
    pub(crate) scene: PlateScene,
    pub(crate) e: f64,
    /// Whether its model has gravity: map has none.
    pub(crate) has_gravity: bool,
    /// Of contacts that take time.
    pub(crate) contact: Option<Contact>,
    /// On the product, as places are.
    pub(crate) center_of_mass: [f64; 2],
    /// Whether the scene runs the other way than the product along its length and along its width, so that corner a is the lowest one.
    pub(crate) mirrored: [bool; 2],
    pub(crate) height_m: Option<f64>,
    pub(crate) tilt_deg: f64,
    /// Of the product; none of a plate that falls level.
    pub(crate) direction_deg: Option<f64>,
    pub(crate) shown: Shown,
    /// The part of a product file.
    pub(crate) part: Option<PartSetup>,
    pub(crate) notes: Vec<(&'static str, String)>,
}

/// What a command has of a plate beside [`DropArgs`].
pub(crate) struct ExtraArgs {
    pub(crate) model: Option<Model>,
    pub(crate) e: Option<f64>,
    pub(crate) gyration: Option<PerAxis<Quantity>>,
    pub(crate) gyration_flag: &'static str,
    /// Rates at which it turns along length and width as corner a touches, b and d upward, over those of the product file.
    pub(crate) spin_rad_s: Option<PerAxis<f64>>,
    /// The product file, if there is one.
    pub(crate) file: Option<OneDrop>,
}

/// Slopes beyond take more than 1.5 % off the lever arms.
const STEEP_DEG: f64 = 10.0;

impl PlateSetup {
    /// Half of each side.
    pub(crate) fn halves_m(&self) -> [f64; 2] {
        self.scene.plate().sides_m().map(|side| 0.5 * side)
    }
    /// −1 for the sides of the product that run the other way in the scene.
    pub(crate) fn signs(&self) -> [f64; 2] {
        self.mirrored.map(|is| if is { -1.0 } else { 1.0 })
    }
    /// Corners of the product: that which touches first, the one along the length, the opposite one, the one along the width.
    pub(crate) fn corners(&self) -> [Corner; 4] {
        let [x, y] = self.mirrored.map(usize::from);
        Corner::ALL.map(|corner| {
            let of_scene = corner as usize;
            // Around the plate from (−x, −y): mirrored along the length a and b change places, c and d too.
            let along = if x == 1 { [1, 0, 3, 2][of_scene] } else { of_scene };
            Corner::ALL[if y == 1 { [3, 2, 1, 0][along] } else { along }]
        })
    }
    pub(crate) fn first(&self) -> Corner {
        self.corners()[0]
    }
    /// The direction as the scene has it.
    pub(crate) fn in_scene_deg(&self) -> Option<f64> {
        self.direction_deg.map(|direction| folded(direction).0)
    }
    /// Places in half-sides, of a plate that goes on so far beyond the feet which are its corners.
    pub(crate) fn places(&self, at: &[PerAxis<Place>], beyond_m: [f64; 2]) -> Result<Vec<[f64; 2]>, Failure> {
        let halves_m = self.halves_m();
        let one = |place: &PerAxis<Place>| {
            let of = place.of_plate("--at")?;
            let on = |side: usize| quantities::positions_beyond(&[of[side]], "--at", halves_m[side], beyond_m[side]);
            Ok([on(0)?[0], on(1)?[0]])
        };
        at.iter().map(one).collect()
    }
}

impl DropArgs {
    pub(crate) fn is_plate(&self) -> bool {
        self.plate.width().is_some()
    }

    /// The drop of a plate, over that of the product file where there is one.
    pub(crate) fn plate_setup(&self, beside: ExtraArgs) -> Result<PlateSetup, Failure> {
        let ExtraArgs { model, e, gyration, gyration_flag, spin_rad_s, mut file } = beside;
        let model = self.plate_model(model, file.is_some())?;
        let (compliant, has_gravity) = (model == Model::Compliant, model != Model::Map);
        let width = self.plate.width().map(|width| width.si).or(file.as_ref().and_then(OneDrop::width).map(|w| w.m()));
        let length = either(self.length, self.length_m);
        let length_m = match (length, &file) {
            (Some(length), Some(file)) => Some(file.length_of(length.si)?),
            (length, file) => length.map(|length| length.si).or(file.as_ref().map(OneDrop::length_m)),
        };
        let of_file = |file: &mut Option<OneDrop>| file.as_mut().filter(|_| compliant)?.contact_time_s();
        let contact_time = self.contact_time().map(|time| time.si).or_else(|| of_file(&mut file));
        let e = e.or_else(|| file.as_mut().map(OneDrop::restitution));
        let tilted = self.tilt_of_plate(file.as_mut());
        let gravity = either(self.gravity, self.gravity_m_s2).map(|gravity| gravity.si);
        let gravity = gravity.or(file.as_ref().map(OneDrop::gravity_m_s2)).unwrap_or(STANDARD_GRAVITY_M_S2);
        let mut speed = either(self.fall.speed, self.fall.speed_m_s).map(|speed| speed.si);
        let mut height = either(self.fall.height, self.fall.height_m).map(|height| height.si);
        if speed.is_none() && height.is_none() {
            (speed, height) = file.as_mut().map_or((None, None), OneDrop::fall);
        }
        let missing = [
            (length_m.is_some(), "--length=LENGTH"),
            (gyration.is_some() || file.is_some(), "--gyration=KX,KY"),
            (e.is_some(), "--e=E"),
            (speed.is_some() || height.is_some(), "--speed=SPEED or --height=LENGTH"),
            (tilted.is_some(), "--tilt=ANGLE and --direction=ANGLE, or --gaps=HX,HY"),
            (!compliant || contact_time.is_some(), "--contact-time=TIME"),
        ];
        let missing: Vec<_> = missing.iter().filter(|(is_given, _)| !is_given).map(|(_, name)| *name).collect();
        let (Some(length_m), Some(width), Some(e), Some(tilted), []) = (length_m, width, e, tilted, &missing[..])
        else {
            return Err(Failure::Wrong(format!("the drop is not whole: give {}", missing.join(", "))));
        };
        if height.is_some() && gravity == 0.0 {
            return Err(Failure::Usage(
                "a height (--height, --height-m) needs gravity: give --speed, or gravity above 0",
            ));
        }
        let speed = speed.unwrap_or_else(|| (2.0 * gravity * height.unwrap_or(f64::NAN)).sqrt());
        let halves = [0.5 * length_m, 0.5 * width];
        let Landing { gaps_m, tilt_deg, direction_deg, mirrored } = tilted.on(halves, file.is_some())?;
        let (center_of_mass, plate) = self.plate_of(
            halves,
            mirrored,
            has_gravity,
            gyration.map(|k| k.of_plate(gyration_flag)).transpose()?,
            gyration_flag,
            file.as_mut(),
        )?;
        let gaps_flag = if matches!(tilted, Tilted::Gaps(_)) { "--gaps" } else { "--tilt" };
        let scene = PlateScene::new(plate, speed, gaps_m, gravity).map_err(Failure::flag(gaps_flag))?;
        let spin = match (spin_rad_s, file.as_mut()) {
            (Some(spin), _) => Some(spin.of_plate("--spin-rad-s")?),
            (None, Some(file)) => {
                let (spin, (sin, cos)) = (file.spin_rad_s(), libm::sincos(folded(direction_deg).0.to_radians()));
                Some([spin * cos, spin * sin])
            }
            (None, None) => None,
        };
        let scene = spin.map_or(Ok(scene), |spin| scene.with_spin(spin).map_err(Failure::flag("--spin-rad-s")))?;
        let law = self.contact_law.map(|law| law.0).or(file.as_ref().map(OneDrop::contact_law)).unwrap_or_default();
        let contact = contact_time.filter(|_| compliant);
        let contact = contact.map(|time| Contact::new(law, e, time)).transpose()?;
        let part = file.as_mut().map(|file| file.part(halves)).transpose()?.flatten();
        let shown = self.shown_of_plate(length, file.as_ref());
        let mut notes = plate_notes(tilt_deg);
        if let Some(mut file) = file {
            if length.is_some() && gyration.is_none() {
                file.note("the radius of gyration and the center of mass along it go with the length");
            }
            notes.extend(file.into_notes().map(|note| ("note", note)));
        }
        let is_tilted = gaps_m.iter().any(|gap| *gap > 0.0);
        Ok(PlateSetup {
            scene,
            e,
            has_gravity,
            contact,
            center_of_mass,
            mirrored,
            height_m: height,
            tilt_deg,
            direction_deg: is_tilted.then_some(direction_deg),
            shown,
            part,
            notes,
        })
    }

    /// Refuses what a plate has not.
    fn plate_model(&self, model: Option<Model>, of_file: bool) -> Result<Model, Failure> {
        if self.thickness() != 0.0 {
            return Err(Failure::Usage("--thickness is that of a bar or, with --width, of a box"));
        }
        match model {
            None if of_file => Ok(Model::Compliant),
            Some(Model::Map | Model::Ballistic) if self.contact_time().is_some() || self.contact_law.is_some() => {
                Err(Failure::Usage("--contact-time and --contact-law go with --model=compliant alone"))
            }
            Some(model @ (Model::Map | Model::Ballistic | Model::Compliant)) => Ok(model),
            Some(_) => Err(Failure::Usage(
                "--model=finite-tilt follows bars: a plate is followed by map, without gravity, by ballistic or by compliant",
            )),
            None => Err(Failure::Usage("a plate needs a --model: map, ballistic or compliant")),
        }
    }

    fn tilt_of_plate(&self, file: Option<&mut OneDrop>) -> Option<Tilted> {
        let gaps = self.plate.gaps_m.or(self.plate.gaps.map(|gaps| gaps.map(|gap| gap.si)));
        if let Some(gaps) = gaps {
            return Some(Tilted::Gaps(gaps));
        }
        let degrees = |angle: Quantity| neat(angle.si.to_degrees());
        let (tilt, direction) = (self.tilt_deg.or(self.tilt.map(degrees)), self.direction_deg());
        let Some(file) = file else {
            let tilt = tilt?;
            // A level plate has none.
            return Some(Tilted::Angles([tilt, direction.or((tilt == 0.0).then_some(0.0))?]));
        };
        let tilt = tilt.unwrap_or_else(|| file.tilt_deg());
        Some(Tilted::Angles([tilt, direction.unwrap_or_else(|| file.direction_deg())]))
    }

    /// Where a tilted body rises, in degrees.
    pub(super) fn direction_deg(&self) -> Option<f64> {
        let typed = self.plate.direction.map(|angle| neat(angle.si.to_degrees()));
        self.plate.direction_deg.or(typed)
    }

    /// Where the center of mass is typed to be.
    fn center_of_plate(&self, halves: [f64; 2]) -> Result<Option<[f64; 2]>, Failure> {
        let flag = "--center-of-mass";
        let Some(center) = self.center_of_mass else { return Ok(None) };
        let [x, y] = center.of_plate(flag)?;
        let center = [x.relative(flag, Some(halves[0]))? + 0.0, y.relative(flag, Some(halves[1]))? + 0.0];
        for value in center {
            if value.abs() >= 1.0 {
                let (name, allowed) = ("center of mass", "in (-1, 1), between the edges");
                return Err(Failure::Flag { flag, reason: clatter::Error::Quantity { name, value, allowed } });
            }
        }
        Ok(Some(center))
    }

    /// The center of mass on the product, and the plate as the scene has it.
    fn plate_of(
        &self,
        halves: [f64; 2],
        mirrored: [bool; 2],
        has_gravity: bool,
        gyration: Option<[Quantity; 2]>,
        flag: &'static str,
        file: Option<&mut OneDrop>,
    ) -> Result<([f64; 2], Plate), Failure> {
        // What the file has is stretched with the length.
        let of_file = file.and_then(|file| {
            let width = file.width()?;
            let (along, ratio) = if gyration.is_none() { file.inertia() } else { (file.center_of_mass(), f64::NAN) };
            let stretched = 2.0 * halves[0] / file.length_m();
            let center = [along, width.center_m() / halves[1]];
            Some((center, [ratio * halves[0], width.gyration_m], stretched * file.product_of_inertia_m2()))
        });
        let (own_center, own_gyration, own_product) = of_file.unwrap_or(([0.0; 2], [f64::NAN; 2], 0.0));
        let center = self.center_of_plate(halves)?.unwrap_or(own_center);
        let radii = gyration.map_or(own_gyration, |radii| radii.map(|k| k.si));
        for (half, k) in halves.into_iter().zip(radii) {
            let most = MOST_GYRATION * 2.0 * half;
            if k > most {
                let [k, most] = [k, most].map(|m| given(neat(1e3 * m)));
                return Err(Failure::Wrong(format!(
                    "invalid value for '{flag}': radius of gyration {k} mm: at most {most} mm here, twice the side along it; two masses at its ends have 0.5"
                )));
            }
        }
        let [sx, sy] = mirrored.map(|is| if is { -1.0 } else { 1.0 });
        let [[x, y], [cx, cy]] = [halves, [sx * center[0], sy * center[1]]];
        let edges = [x * (1.0 + cx), x * (1.0 - cx), y * (1.0 + cy), y * (1.0 - cy)];
        let plate = Plate::new(edges, radii).map_err(Failure::flag(flag))?;
        if self.plate.product_of_inertia_m2.is_some_and(|[_, xz, yz]| xz != 0.0 || yz != 0.0) {
            return Err(Failure::Usage("--product-of-inertia-m2 of a plate is one value"));
        }
        let product = self.plate.product_of_inertia_m2.map_or(own_product, |[xy, ..]| xy);
        if !has_gravity && (product != 0.0 || self.plate.product_of_inertia_m2.is_some()) {
            return Err(Failure::Usage(
                "--product-of-inertia-m2 and masses that lie askew are followed by --model=ballistic and --model=compliant alone",
            ));
        }
        let flag = "--product-of-inertia-m2";
        Ok((center, plate.with_product_of_inertia(sx * sy * product).map_err(Failure::flag(flag))?))
    }

    fn shown_of_plate(&self, length: Option<Quantity>, file: Option<&OneDrop>) -> Shown {
        let of = |quantity: Option<Quantity>| quantity.and_then(|quantity| quantity.unit);
        Shown {
            length: Show {
                unit: of(length).or(of(self.fall.height)).or(file.and_then(OneDrop::length_unit)),
                name: "m",
            },
            speed: Show { unit: of(self.fall.speed).or(file.and_then(OneDrop::speed_unit)), name: "m/s" },
            time: Show { unit: of(self.contact_time).or(file.and_then(OneDrop::time_unit)), name: "s" },
            acceleration: Show { unit: of(self.gravity).or(file.and_then(OneDrop::acceleration_unit)), name: "m/s²" },
            spin: Show { unit: None, name: "rad/s" },
            angle: of(self.tilt),
        }
    }

    /// A flight of a plate that was refused.
    pub(crate) fn named_plate(&self, error: clatter_flight::Error, gyration_flag: &'static str) -> Failure {
        let clatter_flight::Error::Bound { name, .. } = &error else { return Failure::Flight(error) };
        let flag = match *name {
            "contact time" if self.contact_time_s.is_some() => "--contact-time-s",
            "contact time" => "--contact-time",
            _ => gyration_flag,
        };
        Failure::Wrong(format!("invalid value for '{flag}': {error}"))
    }
}

/// How a plate is tilted as a touches: heights of b and d, or tilt and direction in degrees.
#[derive(Clone, Copy)]
enum Tilted {
    Gaps([f64; 2]),
    Angles([f64; 2]),
}

/// How a plate is as its lowest corner touches.
struct Landing {
    /// Heights of the corners next to it.
    gaps_m: [f64; 2],
    tilt_deg: f64,
    /// Of the product.
    direction_deg: f64,
    mirrored: [bool; 2],
}

impl Tilted {
    /// On a plate of these half-sides. That of a product file may land on any corner.
    fn on(self, halves: [f64; 2], is_of_file: bool) -> Result<Landing, Failure> {
        let [length, width] = halves.map(|half| 2.0 * half);
        match self {
            Self::Gaps(gaps) => {
                let slopes = [gaps[0] / length, gaps[1] / width];
                let tilt = libm::asin(libm::hypot(slopes[0], slopes[1])).to_degrees();
                let direction = libm::atan2(slopes[1], slopes[0]).to_degrees();
                let [tilt_deg, direction_deg] = [tilt, direction].map(neat);
                Ok(Landing { gaps_m: gaps, tilt_deg, direction_deg, mirrored: [false; 2] })
            }
            Self::Angles([_, direction]) if !is_of_file && !(0.0..=90.0).contains(&direction) => {
                let (name, allowed) =
                    ("direction in degrees", "in [0, 90]: else it is not corner a that touches first");
                let reason = clatter::Error::Quantity { name, value: direction, allowed };
                Err(Failure::Flag { flag: "--direction", reason })
            }
            Self::Angles([tilt, direction]) => {
                let (folded, mirrored) = folded(direction);
                let (rise, direction_rad) = (libm::sin(tilt.to_radians()), folded.to_radians());
                let gaps_m = [length * rise * libm::cos(direction_rad), width * rise * libm::sin(direction_rad)];
                Ok(Landing { gaps_m, tilt_deg: tilt, direction_deg: direction, mirrored })
            }
        }
    }
}

/// A direction as it is seen from the lowest corner, within a quarter turn, and the sides that run the other way there.
fn folded(direction_deg: f64) -> (f64, [bool; 2]) {
    match direction_deg.rem_euclid(360.0) {
        x if x <= 90.0 => (x, [false, false]),
        x if x <= 180.0 => (180.0 - x, [true, false]),
        x if x < 270.0 => (x - 180.0, [true, true]),
        x => (360.0 - x, [false, true]),
    }
}

fn plate_notes(tilt_deg: f64) -> Vec<(&'static str, String)> {
    if tilt_deg <= STEEP_DEG {
        return Vec::new();
    }
    let tilt = given(neat(format!("{tilt_deg:.3e}").parse().unwrap_or(tilt_deg)));
    let what =
        format!("a plate is followed as if almost level: at a tilt of {tilt} degrees its lever arms are shorter");
    vec![("warning", what)]
}
