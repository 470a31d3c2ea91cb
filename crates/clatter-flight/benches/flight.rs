//! Cost of the flights, per scene; the counter gives strikes, so that the throughput reads as time a strike.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter_flight::{Contact, ContactLaw, Model, Profile, Scene};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

fn scene(q: f64, e: f64, impacts: usize) -> Scene {
    let half = 0.07;
    let body = Profile::new(2.0 * half, half * ((1.0 - q) / (1.0_f64 + q)).sqrt()).expect("a phone");
    let scene = Scene::new(body, e, 4.43, 5.0, 9.81).expect("a drop from a meter");
    scene.with_impact_limit(impacts).expect("some strikes")
}

fn bench(bencher: Bencher, model: Model, scene: Scene) {
    let strikes = scene.fly(model).expect("a motion").strikes.len();
    bencher.counter(ItemsCount::new(strikes)).bench(|| black_box(scene).fly(model).expect("a motion"));
}

/// To rest: few strikes at large angles, then many at small ones.
#[divan::bench(args = [Model::Ballistic, Model::FiniteTilt])]
fn to_rest(bencher: Bencher, model: Model) {
    bench(bencher, model, scene(0.73, 0.2, 100_000));
}

/// Elastic, so that every strike is at a large angle and every flight long: linear in strikes.
#[divan::bench(args = [1_000, 10_000, 100_000])]
fn elastic_ballistic(bencher: Bencher, strikes: usize) {
    bench(bencher, Model::Ballistic, scene(0.5, 1.0, strikes));
}

/// The same at finite tilt.
#[divan::bench(args = [1_000, 10_000, 100_000])]
fn elastic_finite_tilt(bencher: Bencher, strikes: usize) {
    bench(bencher, Model::FiniteTilt, scene(0.5, 1.0, strikes));
}

/// Contacts of 0.3 ms by both laws: the first four strikes, and all until rest.
#[divan::bench(args = [4, 100_000], consts = [0, 1])]
fn contacts<const LAW: usize>(bencher: Bencher, impacts: usize) {
    let scene = scene(0.5, 0.3, impacts);
    let contact = Contact::new(ContactLaw::ALL[LAW], 0.3, 3e-4).expect("a contact");
    let strikes = scene.fly(Model::Contacts(contact)).expect("a flight").strikes.len();
    bencher.counter(ItemsCount::new(strikes)).bench(|| black_box(scene).fly(Model::Contacts(contact)));
}

/// The same to a precision, until rest; the counter gives phases.
#[divan::bench(args = [1e-2, 1e-3, 1e-4, 1e-5])]
fn contacts_to(bencher: Bencher, precision: f64) {
    let scene = scene(0.5, 0.3, 100_000);
    let contact = Contact::new(ContactLaw::Hysteretic, 0.3, 3e-4).expect("a contact");
    let phases = scene.contacts_until(&contact, precision, |_| false).expect("a flight").phases_s().count();
    let run = || black_box(scene).contacts_until(&contact, precision, |_| false);
    bencher.counter(ItemsCount::new(phases)).bench(run);
}
