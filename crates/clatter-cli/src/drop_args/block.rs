//! A drop of a box, as options say it.

use clatter_assess::units::Quantity;
use clatter_assess::{Model, STANDARD_GRAVITY_M_S2};
use clatter_flight::{Block, BlockDrop, Contact};

use super::{DropArgs, IN_SI, either};
use crate::Failure;
use crate::block::Setup;
use crate::inputs;

/// What a box has beside a plate.
#[derive(Debug, clap::Args)]
pub(crate) struct BlockArgs {
    /// How a box is turned as it lands: the unit quaternion that turns its axes, along length, width and thickness, into those of
    /// the world, z upward; in place of a tilt
    #[arg(long, value_name = "W,X,Y,Z", allow_hyphen_values = true, value_parser = inputs::quaternion, requires = "followed", conflicts_with_all = ["tilt", "tilt_deg", "direction", "direction_deg", "gaps", "gaps_m"])]
    orientation: Option<[f64; 4]>,
    /// Where the center of mass of a box lies from its middle, in m
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = inputs::triple, requires = "followed", conflicts_with = "center_of_mass", help_heading = IN_SI, hide_short_help = true)]
    center_of_mass_m: Option<[f64; 3]>,
}

/// What a command has of a box beside [`DropArgs`].
pub(crate) struct ExtraArgs {
    pub(crate) model: Option<Model>,
    pub(crate) e: Option<f64>,
    pub(crate) gyration: Option<[Quantity; 3]>,
    pub(crate) spin_rad_s: [f64; 3],
    pub(crate) time_limit_s: Option<f64>,
    pub(crate) impact_limit: usize,
}

impl DropArgs {
    /// Whether a box is given and no bar.
    pub(crate) fn is_block(&self) -> bool {
        let is_thick = self.thickness.or(self.thickness_m.map(Quantity::of_si)).is_some();
        let is_in_space = self.block.orientation.is_some() || self.block.center_of_mass_m.is_some();
        self.plate.width().is_some() && is_thick || is_in_space
    }

    /// The drop of a box.
    pub(crate) fn block(&self, beside: &ExtraArgs) -> Result<Setup, Failure> {
        if self.product.is_some() {
            return Err(Failure::Usage("a product file says a bar: the options of a box do not go with --product"));
        }
        if beside.model.is_some_and(|model| model != Model::Compliant) {
            return Err(Failure::Usage(
                "a box is followed with contacts that take time alone: --model=compliant with a short --contact-time",
            ));
        }
        let si = |typed, plain| either(typed, plain).map(|quantity| quantity.si);
        let width = self.plate.width().map(|width| width.si);
        let size = [si(self.length, self.length_m), width, si(self.thickness, self.thickness_m)];
        let gyration = beside.gyration.map(|radii| radii.map(|radius| radius.si));
        let tilt = self.tilt_deg.map(f64::to_radians).or(self.tilt.map(|tilt| tilt.si));
        let gravity = si(self.gravity, self.gravity_m_s2).unwrap_or(STANDARD_GRAVITY_M_S2);
        let speed = si(self.fall.speed, self.fall.speed_m_s);
        let speed = speed.or(si(self.fall.height, self.fall.height_m).map(|height| (2.0 * gravity * height).sqrt()));
        let time = self.contact_time().map(|time| time.si);
        let missing = [
            (size[0].is_some(), "--length=LENGTH"),
            (size[1].is_some(), "--width=LENGTH"),
            (size[2].is_some(), "--thickness=LENGTH"),
            (gyration.is_some(), "--gyration=KX,KY,KZ (about the axes of the box)"),
            (beside.e.is_some(), "--e=E"),
            (speed.is_some(), "--speed=SPEED or --height=LENGTH"),
            (tilt.is_some() || self.block.orientation.is_some(), "--orientation=W,X,Y,Z or --tilt=ANGLE"),
            (time.is_some(), "--contact-time=TIME"),
        ];
        let missing: Vec<_> = missing.iter().filter(|(is_given, _)| !is_given).map(|(_, name)| *name).collect();
        let ([Some(length), Some(width), Some(thickness)], Some(gyration), Some(e), Some(speed), Some(time), []) =
            (size, gyration, beside.e, speed, time, &missing[..])
        else {
            return Err(Failure::Wrong(format!("the drop of the box is not whole: give {}", missing.join(", "))));
        };
        let size = [length, width, thickness];
        let block = Block::new(size, self.center_of_block(size)?, gyration)?;
        let products = self.plate.product_of_inertia_m2.unwrap_or_default();
        let flag = Failure::flag("--product-of-inertia-m2");
        let block = block.with_products_of_inertia(products).map_err(flag)?;
        let drop = match (self.block.orientation, tilt) {
            (Some(orientation), _) => BlockDrop::new(block, orientation, speed, gravity)?,
            (None, tilt) => {
                let direction = self.direction_deg().unwrap_or_default().to_radians();
                BlockDrop::tilted(block, tilt.unwrap_or_default(), direction, speed, gravity)?
            }
        };
        let drop = drop.with_spin(beside.spin_rad_s)?.with_impact_limit(beside.impact_limit);
        let drop = beside.time_limit_s.map_or(Ok(drop), |limit| drop.with_time_limit_s(limit))?;
        let law = self.contact_law.map(|law| law.0).unwrap_or_default();
        Ok(Setup { drop, contact: Contact::new(law, e, time)? })
    }

    /// The center of mass from the middle.
    fn center_of_block(&self, size: [f64; 3]) -> Result<[f64; 3], Failure> {
        let (flag, mut center) = ("--center-of-mass", self.block.center_of_mass_m.unwrap_or_default());
        if let Some(typed) = self.center_of_mass {
            for ((center, place), size) in center.iter_mut().zip(typed.of_block(flag)?).zip(size) {
                *center = 0.5 * size * place.relative(flag, Some(0.5 * size))?;
            }
        }
        Ok(center)
    }
}
