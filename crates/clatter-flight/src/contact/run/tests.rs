//! Tests that the ground does not change the energy of a body without reason.

use super::super::planar::Planar;
use super::*;
use crate::ContactLaw;
use crate::{Profile, Scene};

/// Returns a flight whose end a has just touched, and the phase in which it presses.
fn pressing<'a>(scene: &Scene<2>, contacts: &'a [Contact; 2]) -> (Run<'a, Planar<2>, 2>, Phase<Planar<2>, 2>, f64) {
    let log = Log::new(f64::INFINITY, 100_000);
    let mut run = Run::new(Planar::start(scene), log, contacts, 1e-4, f64::INFINITY);
    assert!(run.first_touches(), "end a is on the ground and comes down");
    let Lasting { phase, dt, .. } = run.next();
    (run, phase, dt)
}

fn scene() -> Scene<2> {
    Scene::new(Profile::new(0.15, 0.045).unwrap(), 0.3, 4.0, 3.0, 9.81).unwrap()
}

/// A phase whose springs are claimed to be half as stiff again as those of its motion gives the body energy from
/// nowhere.
#[test]
fn a_phase_that_makes_energy_is_no_motion() {
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.3, 1e-3).unwrap(); 2];
    let (mut run, phase, dt) = pressing(&scene(), &contacts);
    // The spring is still pressed then.
    let dt = 0.5 * dt;
    run.advance(&phase, dt).unwrap();
    assert!(run.misfit < 1e-6 * run.opened, "a sound phase keeps it: {}", run.misfit / run.opened);
    let (mut run, mut phase, _) = pressing(&scene(), &contacts);
    for line in phase.lines.iter_mut().flatten() {
        line.stiffness *= 1.5;
    }
    let Err(Refused::Other(Error::Energy { share })) = run.advance(&phase, dt) else { panic!("it passes") };
    assert!(share > 0.01 && share < 1.0, "{share}");
}

/// Each of many phases may have a small error: their sum ends the flight.
#[test]
fn a_flight_ends_where_its_energy_is_off_by_a_hundredth() {
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.3, 1e-3).unwrap(); 2];
    for (off, ends) in [(0.0099, false), (0.0101, true)] {
        let (mut run, ..) = pressing(&scene(), &contacts);
        run.misfit = off * run.opened;
        assert_eq!(run.step(&mut |_| false).unwrap(), !ends, "off by {off}");
        assert_eq!(matches!(run.log.flight.stop, Stop::EnergyLimit { .. }), ends, "off by {off}");
    }
}
