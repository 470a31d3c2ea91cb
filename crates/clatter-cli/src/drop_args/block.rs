//! A drop of a box, as options say it.

use clatter_assess::STANDARD_GRAVITY_M_S2;
use clatter_assess::units::Quantity;
use clatter_flight::{Block, BlockDrop, Contact};

use super::{DropArgs, IN_SI, either};
use crate::Failure;
use crate::block::Setup;
use crate::inputs::{self, ModelName, Numbers};
use crate::quantities;

/// What a box has beside a bar.
#[derive(Debug, clap::Args)]
pub(crate) struct BlockArgs {
    /// Width of a box; with --length, --thickness and --gyration-m=KX,KY,KZ it lands on any of its eight corners, for compliant
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::length, requires = "followed", conflicts_with = "width_m")]
    width: Option<Quantity>,
    /// How a box is turned as it lands: the unit quaternion that turns its axes, along length, width and thickness, into those of
    /// the world, z upward; in place of a tilt
    #[arg(long, value_name = "W,X,Y,Z", allow_hyphen_values = true, value_parser = inputs::quaternion, conflicts_with_all = ["tilt", "tilt_deg"])]
    orientation: Option<[f64; 4]>,
    /// Where the side of a tilted box is that is up: from its length towards its width [default: 0deg]
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = quantities::direction, conflicts_with_all = ["orientation", "direction_deg"])]
    direction: Option<Quantity>,
    /// --width in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    width_m: Option<f64>,
    /// --direction in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::number, conflicts_with = "orientation", help_heading = IN_SI, hide_short_help = true)]
    direction_deg: Option<f64>,
    /// Where the center of mass of a box lies from its middle, in m
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = inputs::triple, conflicts_with = "center_of_mass", help_heading = IN_SI, hide_short_help = true)]
    center_of_mass_m: Option<[f64; 3]>,
}

/// What a command has of a box beside [`DropArgs`].
pub(crate) struct Beside {
    pub(crate) model: Option<ModelName>,
    pub(crate) e: Option<f64>,
    pub(crate) gyration_m: Option<Numbers>,
    pub(crate) spin_rad_s: [f64; 3],
    pub(crate) time_limit_s: Option<f64>,
    pub(crate) impact_limit: usize,
}

impl DropArgs {
    /// Whether a box is given and no bar.
    pub(crate) fn is_block(&self) -> bool {
        let BlockArgs { width, orientation, direction, width_m, direction_deg, center_of_mass_m } = &self.block;
        let is_turned = orientation.is_some() || direction.is_some() || direction_deg.is_some();
        width.is_some() || width_m.is_some() || is_turned || center_of_mass_m.is_some()
    }

    /// The drop of a box.
    pub(crate) fn block(&self, beside: &Beside) -> Result<Setup, Failure> {
        if self.product.is_some() {
            return Err(Failure::Usage("a product file says a bar: the options of a box do not go with --product"));
        }
        if beside.model.is_some_and(|model| model != ModelName::Compliant) {
            return Err(Failure::Usage(
                "a box is followed with contacts that take time alone: --model=compliant with a short --contact-time",
            ));
        }
        let si = |typed, plain| either(typed, plain).map(|quantity| quantity.si);
        let size = [
            si(self.length, self.length_m),
            si(self.block.width, self.block.width_m),
            si(self.thickness, self.thickness_m),
        ];
        let gyration = beside.gyration_m.and_then(Numbers::three);
        let tilt = self.tilt_deg.map(f64::to_radians).or(self.tilt.map(|tilt| tilt.si));
        let gravity = si(self.gravity, self.gravity_m_s2).unwrap_or(STANDARD_GRAVITY_M_S2);
        let speed = si(self.fall.speed, self.fall.speed_m_s);
        let speed = speed.or(si(self.fall.height, self.fall.height_m).map(|height| (2.0 * gravity * height).sqrt()));
        let time = self.contact_time().map(|time| time.si);
        let missing = [
            (size[0].is_some(), "--length=LENGTH"),
            (size[1].is_some(), "--width=LENGTH"),
            (size[2].is_some(), "--thickness=LENGTH"),
            (gyration.is_some(), "--gyration-m=KX,KY,KZ (radii of gyration about the axes of the box, in m)"),
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
        let block = Block::new([length, width, thickness], self.block.center_of_mass_m.unwrap_or_default(), gyration)?;
        let drop = match (self.block.orientation, tilt) {
            (Some(orientation), _) => BlockDrop::new(block, orientation, speed, gravity)?,
            (None, tilt) => {
                let typed = self.block.direction.map(|direction| direction.si);
                let direction = self.block.direction_deg.map(f64::to_radians).or(typed).unwrap_or_default();
                BlockDrop::tilted(block, tilt.unwrap_or_default(), direction, speed, gravity)?
            }
        };
        let drop = drop.with_spin(beside.spin_rad_s)?.with_impact_limit(beside.impact_limit);
        let drop = beside.time_limit_s.map_or(Ok(drop), |limit| drop.with_time_limit_s(limit))?;
        let law = self.contact_law.map(Into::into).unwrap_or_default();
        Ok(Setup { drop, contact: Contact::new(law, e, time)? })
    }
}
