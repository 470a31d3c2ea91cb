//! The convergence of the models to one another, measured: rows for the accuracy table.

use clatter_flight::{Contact, ContactLaw, Error, Model, Motion, Profile, Scene, Strike};

/// One model against the one it tends to, as a parameter goes to zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// The model.
    pub model: &'static str,
    /// Its limit.
    pub limit: &'static str,
    /// The parameter that goes to zero.
    pub parameter: &'static str,
    /// The compared quantities.
    pub compared: &'static str,
    /// Order by theory.
    pub expected: f64,
    /// Parameter and largest difference, the parameter falling.
    pub steps: Vec<(f64, f64)>,
}

impl Order {
    /// Returns the order between the last two steps, `ln(error ratio)/ln(parameter ratio)`.
    #[must_use]
    pub fn measured(&self) -> f64 {
        let [.., (p, x), (q, y)] = self.steps.as_slice() else { return f64::NAN };
        libm::log(x / y) / libm::log(p / q)
    }
}

/// A number that would be zero without rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residue {
    /// The compared quantities.
    pub compared: &'static str,
    /// Largest difference, relative.
    pub value: f64,
    /// Value that the documentation promises.
    pub allowed: f64,
}

/// Returns a scene of half-length 70 mm, 4.43 m/s.
fn phone(q: f64, e: f64, tilt_deg: f64, gravity: f64) -> Result<Scene, clatter::Error> {
    let half = 0.07;
    Scene::new(Profile::new(2.0 * half, half * ((1.0 - q) / (1.0 + q)).sqrt())?, e, 4.43, tilt_deg, gravity)
}

/// Returns the largest difference of times (relative) and of shocks (over the drop speed) of the first strikes;
/// infinite if the ends differ.
fn distance(a: &Motion, b: &Motion, speed: f64, strikes: usize) -> f64 {
    let off = |(a, b): (&Strike, &Strike)| {
        let time = (a.time_s - b.time_s).abs() / b.time_s.max(f64::MIN_POSITIVE);
        let shock = (0..2).map(|k| (a.delta_v_m_s[k] - b.delta_v_m_s[k]).abs() / speed).fold(0.0, f64::max);
        if a.point == b.point { time.max(shock) } else { f64::INFINITY }
    };
    a.strikes.iter().zip(&b.strikes).take(strikes).map(off).fold(0.0, f64::max)
}

/// Returns the motion with hysteretic contacts.
fn hysteretic(drop: &Scene, contact_time_s: f64) -> Result<Motion, Error> {
    drop.fly(Model::Contacts(Contact::new(ContactLaw::Hysteretic, drop.e(), contact_time_s)?))
}

/// Returns the orders in which the models tend to one another, measured on a train of four (q = ½, e = 0.3) over its
/// first three strikes, the contact on its second strike.
///
/// ```
/// for order in clatter_studies::orders()? {
///     assert!((order.measured() - order.expected).abs() < 0.05, "{order:?}");
/// }
/// # Ok::<(), clatter_flight::Error>(())
/// ```
///
/// # Errors
/// None: the scenes are valid.
pub fn orders() -> Result<Vec<Order>, Error> {
    let early =
        |a: (Scene, Model), b: (Scene, Model)| Ok::<_, Error>(distance(&a.0.fly(a.1)?, &b.0.fly(b.1)?, 4.43, 3));
    let steps = |parameters: &[f64], of: &dyn Fn(f64) -> Result<f64, Error>| {
        parameters.iter().map(|&p| Ok((p, of(p)?))).collect::<Result<Vec<_>, Error>>()
    };
    let scene = |tilt, gravity| phone(0.5, 0.3, tilt, gravity);
    let compared = "times and shocks of the first three strikes";
    let tilts = [4.0, 2.0, 1.0, 0.5, 0.25];
    let contacts = [1e-2, 1e-3, 1e-4, 1e-5];
    Ok(vec![
        Order {
            model: "finite tilt",
            limit: "map",
            parameter: "tilt in degrees, no gravity",
            compared,
            expected: 2.0,
            steps: steps(&tilts, &|t| early((scene(t, 0.0)?, Model::FiniteTilt), (scene(t, 0.0)?, Model::Map)))?,
        },
        Order {
            model: "finite tilt",
            limit: "ballistic",
            parameter: "tilt in degrees, gravity",
            compared,
            expected: 2.0,
            steps: steps(&tilts, &|t| {
                early((scene(t, 9.81)?, Model::FiniteTilt), (scene(t, 9.81)?, Model::Ballistic))
            })?,
        },
        Order {
            model: "ballistic",
            limit: "map",
            parameter: "g h0/v0^2 at 5 degrees",
            compared,
            expected: 1.0,
            steps: [9.81, 0.981, 0.0981, 0.00981]
                .into_iter()
                .map(|g| {
                    let drop = scene(5.0, g)?;
                    let group = g * drop.height_gap_m() / drop.speed_m_s().powi(2);
                    Ok((group, early((drop, Model::Ballistic), (drop, Model::Map))?))
                })
                .collect::<Result<Vec<_>, Error>>()?,
        },
        Order {
            model: "compliant",
            limit: "map",
            parameter: "contact time over h0/v0, no overlap",
            compared: "time of the second strike",
            expected: 1.0,
            steps: steps(&contacts, &|share| {
                let drop = scene(1e-3, 0.0)?;
                let contact = share * drop.height_gap_m() / drop.speed_m_s();
                let (soft, hard) = (hysteretic(&drop, contact)?, drop.fly(Model::Map)?);
                Ok(soft
                    .strikes
                    .iter()
                    .zip(&hard.strikes)
                    .nth(1)
                    .map_or(f64::INFINITY, |(s, h)| (s.time_s / h.time_s - 1.0).abs()))
            })?,
        },
        Order {
            model: "compliant",
            limit: "finite tilt",
            parameter: "contact time over h0/v0 at 45 degrees, no overlap",
            compared: "time and shocks of the second strike",
            expected: 1.0,
            steps: steps(&contacts, &|share| {
                let drop = scene(45.0, 9.81)?;
                let contact = share * drop.height_gap_m() / drop.speed_m_s();
                let (soft, hard) = (hysteretic(&drop, contact)?, drop.fly(Model::FiniteTilt)?);
                Ok(distance(&soft, &hard, drop.speed_m_s(), 2))
            })?,
        },
    ])
}

/// Returns differences that would be zero without rounding: weak gravity against none, the restitution of a contact
/// against the one it is fitted to, the energy of elastic bodies over 10⁴ strikes.
///
/// # Errors
/// None: the scenes are valid.
pub fn residues() -> Result<Vec<Residue>, Error> {
    let mut weak = 0.0_f64;
    for (q, e) in [(0.73, 0.2), (0.5, 0.3), (0.5, 0.5), (0.9, 0.5), (0.95, 0.9), (-0.4, 0.7)] {
        // Gravity of 1e-40 changes no digit, but takes the way of the parabolas, while no gravity takes that of the
        // map.
        let drop = |g| phone(q, e, 5.0, g)?.with_impact_limit(40);
        weak = weak.max(distance(&drop(1e-40)?.fly(Model::Ballistic)?, &drop(0.0)?.fly(Model::Map)?, 4.43, 40));
    }
    let mut fitted = 0.0_f64;
    for e in [0.01, 0.05, 0.13, 0.136, 0.3, 0.7, 0.99, 1.0] {
        for (law, contact) in [(ContactLaw::Hysteretic, 1e-3), (ContactLaw::Dashpot, 1e-3), (ContactLaw::Dashpot, 1e-6)]
        {
            // A body that touches with one point below its center of mass does not turn.
            let lone = Scene::new(Profile::of_points([[0.0, -1.0]], 0.5)?, e, 4.43, 0.0, 0.0)?;
            let lone = lone.contacts_until(&Contact::new(law, e, contact)?, 1e-4, |_| false)?;
            let had = lone.strikes.first().map_or(f64::NAN, |s| -(s.delta_v_m_s[0] / s.approach_m_s) - 1.0);
            fitted = fitted.max((had - e).abs());
        }
    }
    let drift = |model, q| {
        let drop = phone(q, 1.0, 5.0, 9.81)?.with_impact_limit(10_000)?;
        Ok::<_, Error>(energy_drift(&drop, &drop.fly(model)?))
    };
    Ok(vec![
        Residue { compared: "ballistic without gravity and the map, 40 strikes", value: weak, allowed: 1e-12 },
        Residue { compared: "restitution fitted and had, both contact laws", value: fitted, allowed: 1e-9 },
        Residue {
            compared: "energy over 10^4 elastic strikes, ballistic",
            value: drift(Model::Ballistic, 0.5)?,
            allowed: 1e-13,
        },
        Residue {
            compared: "energy over 10^4 elastic strikes, finite tilt",
            value: drift(Model::FiniteTilt, 0.5)?,
            allowed: 1e-13,
        },
        Residue { compared: "the same at q = 0.95", value: drift(Model::FiniteTilt, 0.95)?, allowed: 1e-13 },
    ])
}

/// Returns the largest relative change of the energy after a strike from that before the first.
fn energy_drift(scene: &Scene, flight: &Motion) -> f64 {
    let [a, b] = scene.body().arms_m();
    let center = |of: [f64; 2]| (b * of[0] + a * of[1]) / (a + b);
    let g = scene.gravity_m_s2();
    let first = 0.5 * scene.speed_m_s().powi(2) + g * center([0.0, scene.height_gap_m()]);
    let off = |s: &Strike| {
        let turning = scene.body().gyration_m() * s.spin_rad_s;
        let now = 0.5 * (center(s.velocity_m_s).powi(2) + turning * turning) + g * center(s.height_m);
        (now / first - 1.0).abs()
    };
    flight.strikes.iter().map(off).fold(0.0, f64::max)
}
