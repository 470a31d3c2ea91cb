//! This module describes a worst drop in words, which are the same wherever the drop is shown.

use clatter_assess::WorstCase;
use clatter_product::{Axis, DropName, Input, Stops};

use crate::{letter, significant};

/// Returns a worst drop in words: how it falls, and the part in it.
///
/// ```
/// use clatter_answer::drop_in_words;
/// use clatter_product::{EXAMPLE, ProductFile};
/// let assessment = clatter_assess::assess(&ProductFile::read(EXAMPLE, "example.toml")?)?;
/// let worst = assessment.components[0].limits[0].worst_case.expect("a worst drop");
/// assert!(drop_in_words(&worst).contains(" m/s, e "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn drop_in_words(worst: &WorstCase) -> String {
    let four = |x: f64| significant(x, 4);
    let contact = worst.drop.contact_time_s.map_or(String::new(), |s| format!(", contacts of {} ms", four(1e3 * s)));
    let friction = Input::Friction.value(&worst.drop).map_or(String::new(), |of| format!(", friction {}", four(of)));
    let gyration = worst.gyration_m().map_or(String::new(), |m| format!(", radius of gyration {} mm", four(1e3 * m)));
    let part = worst.frequency_hz().zip(worst.damping_ratio());
    let part = part.map_or(String::new(), |(hz, ratio)| format!(", {} Hz, damping ratio {}", four(hz), four(ratio)));
    let stop = worst.part.suspension.and_then(|part| part.stop()).map_or(String::new(), |stop| {
        let [gap_m, time_s, e] = Stops::numbers(&stop);
        format!(", stops at {} mm with contacts of {} ms, e {}", four(1e3 * gap_m), four(1e3 * time_s), four(e))
    });
    let lands = if worst.drop.is_flat {
        "flat".to_owned()
    } else {
        let attitude = worst.landing.and_then(DropName::attitude);
        let landing = attitude.map(|attitude| format!("{attitude}, {} deg off", four(worst.tilt_deg())));
        match worst.direction_deg() {
            _ if landing.is_some() => landing.unwrap_or_default(),
            Some(direction) => format!("{} deg, rising to {} deg", four(worst.tilt_deg()), four(direction)),
            None => format!("{} first, {} deg", letter(worst.drop.first()), four(worst.tilt_deg())),
        }
    };
    let place = if worst.drop.body.is_wide() {
        format!("{}, {}", four(1e3 * worst.part.place.at_m[0]), four(1e3 * worst.part.place.at_m[1]))
    } else {
        four(1e3 * worst.part.place.at_m[0])
    };
    let axis = worst.axis().map_or(String::new(), |axis| match axis {
        Axis::Any => ", along the blow".to_owned(),
        axis => format!(", along {}", axis.name()),
    });
    let optional = worst.optional().map(|(row, optional, x)| format!(", {} {} {}", optional.phrase, four(x), row.unit));
    let optional: String = optional.collect();
    let own = worst.drop.own_contacts.told(worst.drop.restitution, worst.drop.contact_time_s);
    let one = |(at, e, time_s): (&str, f64, Option<f64>)| {
        format!(", at {at} e {} and {} ms", four(e), four(1e3 * time_s.unwrap_or(0.0)))
    };
    let own: String = own.map(one).collect();
    let number = worst.landing.and_then(DropName::number).map_or(String::new(), |n| format!("drop {n}, "));
    format!(
        "{number}{lands}, {} m/s{optional}, e {}{contact}{own}{friction}{gyration}; at {place} mm{axis}{part}{stop}",
        four(worst.drop.speed_m_s),
        four(worst.drop.restitution),
    )
}
