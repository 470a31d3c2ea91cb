//! A drop of a plate as arguments say it.

use clatter_assess::units::Quantity;
use clatter_assess::{Model, STANDARD_GRAVITY_M_S2};
use clatter_flight::{Contact, Plate, PlateScene};

use super::{DropArgs, IN_SI, MOST_GYRATION, either};
use crate::Failure;
use crate::inputs;
use crate::numbers::given;
use crate::quantities::{self, PerAxis, Place, Show, Shown, neat};

/// What makes a plate of a bar.
#[derive(Debug, clap::Args)]
pub(crate) struct PlateArgs {
    /// Width of a plate, across its length; --gyration=KX,KY, --center-of-mass=SX,SY and --at=X,Y then take two values, along the
    /// length and along the width; for map and compliant. With --thickness it is that of a box, with three values
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::length, requires = "followed", conflicts_with_all = ["width_m", "product"])]
    width: Option<Quantity>,
    /// Where a tilted plate rises from corner a: 0deg along its length, 90deg along its width, to b and d by the sines of the tilt;
    /// of a box any
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantities::direction, conflicts_with = "direction_deg")]
    direction: Option<Quantity>,
    /// Instead of tilt and direction: heights of corners b and d of a plate as a touches
    #[arg(long, value_name = "HX,HY", allow_hyphen_values = true, value_parser = quantities::gaps, conflicts_with_all = ["gaps_m", "tilt", "tilt_deg", "direction", "direction_deg"])]
    gaps: Option<[Quantity; 2]>,

    /// --width in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m, requires = "followed", conflicts_with = "product", help_heading = IN_SI, hide_short_help = true)]
    width_m: Option<f64>,
    /// --direction in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::number, help_heading = IN_SI, hide_short_help = true)]
    direction_deg: Option<f64>,
    /// --gaps in m
    #[arg(long, value_name = "HX,HY", allow_hyphen_values = true, value_parser = quantities::gaps_m, conflicts_with_all = ["tilt", "tilt_deg", "direction", "direction_deg"], help_heading = IN_SI, hide_short_help = true)]
    gaps_m: Option<[f64; 2]>,
    /// Of a plate whose contacts take time: product of inertia over its mass, about the center of mass; 0 unless given
    #[arg(long, value_name = "M2", allow_hyphen_values = true, value_parser = inputs::number, help_heading = IN_SI, hide_short_help = true)]
    product_of_inertia_m2: Option<f64>,
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
    /// Of contacts that take time.
    pub(crate) contact: Option<Contact>,
    pub(crate) center_of_mass: [f64; 2],
    pub(crate) height_m: Option<f64>,
    pub(crate) tilt_deg: f64,
    /// None of a plate that falls level.
    pub(crate) direction_deg: Option<f64>,
    pub(crate) shown: Shown,
    pub(crate) notes: Vec<(&'static str, String)>,
}

/// Slopes beyond take more than 1.5 % off the lever arms.
const STEEP_DEG: f64 = 10.0;

impl PlateSetup {
    /// Half of each side.
    pub(crate) fn halves_m(&self) -> [f64; 2] {
        self.scene.plate().sides_m().map(|side| 0.5 * side)
    }
    /// Places in half-sides.
    pub(crate) fn places(&self, at: &[PerAxis<Place>]) -> Result<Vec<[f64; 2]>, Failure> {
        let [x, y] = self.halves_m();
        let one = |place: &PerAxis<Place>| {
            let [of_x, of_y] = place.of_plate("--at")?;
            let [x, y] = [(of_x, x), (of_y, y)].map(|(place, half)| quantities::positions(&[place], "--at", half));
            Ok([x?[0], y?[0]])
        };
        at.iter().map(one).collect()
    }
}

impl DropArgs {
    pub(crate) fn is_plate(&self) -> bool {
        self.plate.width().is_some()
    }

    /// The drop of a plate.
    pub(crate) fn plate_setup(
        &self,
        model: Option<Model>,
        e: Option<f64>,
        gyration: Option<PerAxis<Quantity>>,
        gyration_flag: &'static str,
    ) -> Result<PlateSetup, Failure> {
        let model = self.plate_model(model)?;
        let (length, width) = (either(self.length, self.length_m), self.plate.width());
        let speed = either(self.fall.speed, self.fall.speed_m_s).map(|speed| speed.si);
        let height = either(self.fall.height, self.fall.height_m).map(|height| height.si);
        let contact_time = self.contact_time();
        let tilted = self.tilt_of_plate();
        let missing = [
            (length.is_some(), "--length=LENGTH"),
            (gyration.is_some(), "--gyration=KX,KY"),
            (e.is_some(), "--e=E"),
            (speed.is_some() || height.is_some(), "--speed=SPEED or --height=LENGTH"),
            (tilted.is_some(), "--tilt=ANGLE and --direction=ANGLE, or --gaps=HX,HY"),
            (model != Model::Compliant || contact_time.is_some(), "--contact-time=TIME"),
        ];
        let missing: Vec<_> = missing.iter().filter(|(is_given, _)| !is_given).map(|(_, name)| *name).collect();
        let (Some(length), Some(width), Some(gyration), Some(e), Some(tilted), []) =
            (length, width, gyration, e, tilted, &missing[..])
        else {
            return Err(Failure::Wrong(format!("the drop is not whole: give {}", missing.join(", "))));
        };
        let halves = [0.5 * length.si, 0.5 * width.si];
        let center_of_mass = self.center_of_plate(halves)?;
        let gyration_m = gyration.of_plate(gyration_flag)?;
        let mut plate = Self::plate_of(halves, center_of_mass, gyration_m, gyration_flag)?;
        if let Some(product) = self.plate.product_of_inertia_m2 {
            if model != Model::Compliant {
                return Err(Failure::Usage("--product-of-inertia-m2 is followed by --model=compliant alone"));
            }
            plate = plate.with_product_of_inertia(product).map_err(Failure::flag("--product-of-inertia-m2"))?;
        }
        let gravity = either(self.gravity, self.gravity_m_s2).map_or(STANDARD_GRAVITY_M_S2, |gravity| gravity.si);
        if height.is_some() && gravity == 0.0 {
            return Err(Failure::Usage(
                "a height (--height, --height-m) needs gravity: give --speed, or gravity above 0",
            ));
        }
        let speed = speed.unwrap_or_else(|| (2.0 * gravity * height.unwrap_or(f64::NAN)).sqrt());
        let gaps = match tilted {
            Tilted::Gaps(gaps) => gaps,
            Tilted::Angles([_, direction]) if !(0.0..=90.0).contains(&direction) => {
                let (name, allowed) =
                    ("direction in degrees", "in [0, 90]: else it is not corner a that touches first");
                let reason = clatter::Error::Quantity { name, value: direction, allowed };
                return Err(Failure::Flag { flag: "--direction", reason });
            }
            Tilted::Angles([tilt, direction]) => {
                let [tilt, direction] = [tilt, direction].map(f64::to_radians);
                [
                    2.0 * halves[0] * libm::sin(tilt) * libm::cos(direction),
                    2.0 * halves[1] * libm::sin(tilt) * libm::sin(direction),
                ]
            }
        };
        let gaps_flag = if matches!(tilted, Tilted::Gaps(_)) { "--gaps" } else { "--tilt" };
        let scene = PlateScene::new(plate, speed, gaps, gravity).map_err(Failure::flag(gaps_flag))?;
        let slopes = [gaps[0] / (2.0 * halves[0]), gaps[1] / (2.0 * halves[1])];
        let tilt = libm::hypot(slopes[0], slopes[1]);
        let [tilt_deg, direction_deg] = match tilted {
            Tilted::Angles(angles) => angles,
            Tilted::Gaps(_) => {
                [neat(libm::asin(tilt).to_degrees()), neat(libm::atan2(slopes[1], slopes[0]).to_degrees())]
            }
        };
        let law = self.contact_law.map(|law| law.0).unwrap_or_default();
        let contact = contact_time.filter(|_| model == Model::Compliant);
        let contact = contact.map(|time| Contact::new(law, e, time.si)).transpose()?;
        Ok(PlateSetup {
            scene,
            e,
            contact,
            center_of_mass,
            height_m: height,
            tilt_deg,
            direction_deg: (tilt > 0.0).then_some(direction_deg),
            shown: self.shown_of_plate(length),
            notes: plate_notes(tilt_deg),
        })
    }

    /// Refuses what a plate has not.
    fn plate_model(&self, model: Option<Model>) -> Result<Model, Failure> {
        match model {
            Some(model @ Model::Compliant) => Ok(model),
            Some(Model::Map) if self.contact_time().is_some() || self.contact_law.is_some() => {
                Err(Failure::Usage("--contact-time and --contact-law go with --model=compliant alone"))
            }
            Some(Model::Map) => Ok(Model::Map),
            Some(_) => Err(Failure::Usage(
                "--model=ballistic and --model=finite-tilt follow bars: a plate is followed by map, without gravity, or by compliant",
            )),
            None => Err(Failure::Usage("a plate needs a --model: map or compliant")),
        }
    }

    fn tilt_of_plate(&self) -> Option<Tilted> {
        let gaps = self.plate.gaps_m.or(self.plate.gaps.map(|gaps| gaps.map(|gap| gap.si)));
        if let Some(gaps) = gaps {
            return Some(Tilted::Gaps(gaps));
        }
        let degrees = |angle: Quantity| neat(angle.si.to_degrees());
        let tilt = self.tilt_deg.or(self.tilt.map(degrees))?;
        // A level plate has none.
        Some(Tilted::Angles([tilt, self.direction_deg().or((tilt == 0.0).then_some(0.0))?]))
    }

    /// Where a tilted body rises, in degrees.
    pub(super) fn direction_deg(&self) -> Option<f64> {
        let typed = self.plate.direction.map(|angle| neat(angle.si.to_degrees()));
        self.plate.direction_deg.or(typed)
    }

    fn center_of_plate(&self, halves: [f64; 2]) -> Result<[f64; 2], Failure> {
        let flag = "--center-of-mass";
        let Some(center) = self.center_of_mass else { return Ok([0.0; 2]) };
        let [x, y] = center.of_plate(flag)?;
        let center = [x.relative(flag, Some(halves[0]))? + 0.0, y.relative(flag, Some(halves[1]))? + 0.0];
        for value in center {
            if value.abs() >= 1.0 {
                let (name, allowed) = ("center of mass", "in (-1, 1), between the edges");
                return Err(Failure::Flag { flag, reason: clatter::Error::Quantity { name, value, allowed } });
            }
        }
        Ok(center)
    }

    fn plate_of(
        halves: [f64; 2],
        center: [f64; 2],
        gyration: [Quantity; 2],
        flag: &'static str,
    ) -> Result<Plate, Failure> {
        for (half, k) in halves.into_iter().zip(gyration) {
            let most = MOST_GYRATION * 2.0 * half;
            if k.si > most {
                let [k, most] = [k.si, most].map(|m| given(neat(1e3 * m)));
                return Err(Failure::Wrong(format!(
                    "invalid value for '{flag}': radius of gyration {k} mm: at most {most} mm here, twice the side along it; two masses at its ends have 0.5"
                )));
            }
        }
        let [[x, y], [sx, sy]] = [halves, center];
        let edges = [x * (1.0 + sx), x * (1.0 - sx), y * (1.0 + sy), y * (1.0 - sy)];
        Plate::new(edges, gyration.map(|k| k.si)).map_err(Failure::flag(flag))
    }

    fn shown_of_plate(&self, length: Quantity) -> Shown {
        let of = |quantity: Option<Quantity>| quantity.and_then(|quantity| quantity.unit);
        Shown {
            length: Show { unit: length.unit.or(of(self.fall.height)), name: "m" },
            speed: Show { unit: of(self.fall.speed), name: "m/s" },
            time: Show { unit: of(self.contact_time), name: "s" },
            acceleration: Show { unit: of(self.gravity), name: "m/s²" },
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

fn plate_notes(tilt_deg: f64) -> Vec<(&'static str, String)> {
    if tilt_deg <= STEEP_DEG {
        return Vec::new();
    }
    let tilt = given(neat(format!("{tilt_deg:.3e}").parse().unwrap_or(tilt_deg)));
    let what =
        format!("a plate is followed as if almost level: at a tilt of {tilt} degrees its lever arms are shorter");
    vec![("warning", what)]
}
