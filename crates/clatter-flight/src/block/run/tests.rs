//! Tests of boxes that come to rest: their later motion keeps the stated bounds.

use super::*;
use crate::ContactLaw;

const GRAVITY: f64 = 9.81;

/// Returns a block of evenly spread mass.
fn block(size: [f64; 3]) -> Block {
    let [x, y, z] = size.map(|side| side * side / 12.0);
    Block::new(size, [0.0; 3], [y + z, x + z, x + y].map(f64::sqrt)).unwrap()
}

/// Returns the speed of the fastest corner, up or down.
fn fastest(run: &Run<'_, SMOOTH>) -> f64 {
    let speed = |corner: [f64; 3]| System::place(&run.y, corner).1.abs();
    run.system.corners.map(speed).into_iter().fold(0.0, f64::max)
}

/// A box that is followed on after its rest never has a corner faster than a shock of the bound makes it. A sheet that
/// is set on its long edge stands for a while, and falls over.
#[test]
fn nothing_after_rest_passes_its_bound() {
    let handheld = ([0.15, 0.07, 0.014], 0.3);
    let sheet = ([0.15, 0.06, 1.2e-3], 0.02);
    let mut rested = 0;
    let kinds = [handheld, handheld, handheld, sheet, sheet];
    'drops: for (n, (size, speed)) in (0_u32..40).zip(kinds.into_iter().cycle()) {
        let x = |k: u32| f64::from((n * k + 7) % 41) / 41.0;
        let [across, along] = [x(11) - 0.5, x(17) - 0.5];
        let upward = if speed < 0.1 { [1e-3 * along, 1.0, 0.02 * across] } else { [0.6 * along, 0.6 * across, 0.5] };
        let drop = BlockDrop::upright(block(size), upward, speed, GRAVITY).unwrap();
        let law = if n % 2 == 0 { ContactLaw::Hysteretic } else { ContactLaw::Dashpot };
        let contacts = [Contact::new(law, 0.1 + 0.5 * x(23), 1e-4).unwrap(); 8];
        let mut run: Run<'_, SMOOTH> = Run::new(&drop, &contacts);
        run.first_touches();
        let bound = loop {
            match run.ends() {
                // A sheet on its edge may rock for long.
                None if run.now > 2.0 => continue 'drops,
                None => assert!(!run.step(&mut |_| ()), "{n}: the time has no limit"),
                Some(Stop::AtRest { shock_bound_m_s, .. }) => break shock_bound_m_s,
                Some(stop) => panic!("{n}: {stop:?}"),
            }
        };
        let until = run.now + 0.2;
        while run.now < until {
            run.step(&mut |_| ());
            // A shock of the bound stops a corner of this speed and gives back its restitution.
            let most = bound / (1.0 + run.restitution);
            assert!(fastest(&run) <= most * (1.0 + 1e-6), "{n}: {} m/s at {} s, not {most}", fastest(&run), run.now);
        }
        rested += 1;
    }
    assert!(rested > 30, "{rested} of 40 came to rest");
}

/// A pressed corner parts at the predicted height, also in the dent of an earlier press.
#[test]
fn dents_add_up() {
    let drop = BlockDrop::tilted(block([0.15, 0.07, 0.014]), 0.1, 0.3, 1.0, GRAVITY).unwrap();
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.5, 1e-4).unwrap(); 8];
    let mut run: Run<'_, SMOOTH> = Run::new(&drop, &contacts);
    run.first_touches();
    let i = run.strikes[0].corner;
    // These are two presses by 10 µm, of which a quarter springs back.
    for dent in [-7.5e-6, -15e-6] {
        run.system.holds[i].hold = Hold::Unloads(1e-5);
        assert!((run.system.dent(i, &run.y) - dent).abs() < 1e-15);
        run.turns(i);
        assert!((run.system.holds[i].ground - dent).abs() < 1e-15, "{}", run.system.holds[i].ground);
    }
}

/// Each step may have a small error: their sum ends the flight.
#[test]
fn a_flight_ends_where_its_energy_is_off_by_a_hundredth() {
    let drop = BlockDrop::tilted(block([0.15, 0.07, 0.014]), 0.1, 0.3, 1.0, GRAVITY).unwrap();
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.5, 1e-4).unwrap(); 8];
    for (off, ends) in [(0.0099, false), (0.0101, true)] {
        let mut run: Run<'_, SMOOTH> = Run::new(&drop, &contacts);
        run.misfit = off * run.opened;
        assert_eq!(matches!(run.ends(), Some(Stop::EnergyLimit { .. })), ends, "off by {off}");
    }
}

/// Without gravity a box that rises is left once its center of mass is higher than its reach: before, a corner may come
/// down again.
#[test]
fn without_gravity_it_is_clear_where_no_corner_reaches_the_ground() {
    let drop = BlockDrop::tilted(block([0.15, 0.07, 0.014]), 0.1, 0.3, 1.0, 0.0).unwrap();
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.5, 1e-4).unwrap(); 8];
    let reach = 0.5 * (0.15_f64.powi(2) + 0.07_f64.powi(2) + 0.014_f64.powi(2)).sqrt();
    for (height, rises, clear) in [(0.99, 1.0, false), (1.01, 1.0, true), (1.01, -1.0, false)] {
        let mut run: Run<'_, SMOOTH> = Run::new(&drop, &contacts);
        (run.y[0], run.y[1]) = (height * reach, rises);
        assert_eq!(matches!(run.ends(), Some(Stop::BouncedClear { .. })), clear, "{height}, {rises}");
    }
}

/// A box that spins lands with a corner faster than its center of mass, within the bound of the engine.
#[test]
fn no_corner_of_a_spinning_box_is_faster_than_reckoned_with() {
    let drop = BlockDrop::tilted(block([0.15, 0.07, 0.014]), 0.1, 0.3, 1.0, GRAVITY).unwrap();
    let drop = drop.with_spin([5.0, -20.0, 3.0]).unwrap();
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.5, 1e-4).unwrap(); 8];
    let fastest = fastest(&Run::new(&drop, &contacts));
    assert!(fastest > 2.0 && drop.fastest() >= fastest && drop.fastest() < 1.5 * fastest, "{fastest}");
}

/// A box is left where it lands again, and not as a corner touches while others press.
#[test]
fn a_box_is_left_with_no_more_than_its_weight_on_the_ground() {
    let contacts = [Contact::new(ContactLaw::Hysteretic, 0.1, 1.3e-3).unwrap(); 8];
    let mut left = 0;
    for n in 0_u32..40 {
        let [tilt, direction] = [0.002 + 0.001 * f64::from(n), 0.61 * f64::from(n)];
        let drop = BlockDrop::tilted(block([0.25, 0.22, 0.02]), tilt, direction % std::f64::consts::TAU, 3.0, GRAVITY)
            .unwrap();
        let mut pressed = 0.0;
        let flight = drop.until_it_lands_after_s(1.5e-3).own_contacts(&contacts, |step| {
            pressed = step.force_per_mass_m_s2(1.0).iter().sum();
        });
        left += u32::from(matches!(flight.unwrap().stop, Stop::TimeLimit { .. }));
        assert!(pressed <= 2.0 * GRAVITY * (1.0 + 1e-9), "{n}: {pressed} m/s²");
    }
    assert!(left > 20, "{left} of 40 land again");
}
