//! The four bars by Rapier: scenes as JSON from standard input, impacts, largest shock and time as JSON to standard
//! output.
//!
//! A bar is one body with a small ball at each end, over a half-space. Steps of 1 µs; contacts are foreseen no further
//! ahead than bodies of this speed need, which is faster and changes nothing; the rest is as Rapier ships, which came
//! out best: fewer solver iterations lose late impacts, more of them too.

use rapier2d_f64::prelude::*;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

const STEP_S: f64 = 1e-6;
/// Radius of the balls; the ground is as much lower.
const RADIUS_M: f64 = 1e-3;
/// Changes of velocity below this share of the drop speed are rounding; the last shocks are 2·10⁻¹³ of it.
const ROUNDING: f64 = 1e-14;

struct Scene {
    e: f64,
    half_length_m: f64,
    gyration_m: f64,
    tilt_rad: f64,
    speed_m_s: f64,
    until_s: f64,
}

/// Returns the number of impacts, and the largest jump of the velocity of an end; the bar begins `lifted_m` above its
/// first touch.
fn run(scene: &Scene, lifted_m: f64) -> (u32, f64) {
    let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::default() };
    world.integration_parameters.dt = STEP_S;
    world.integration_parameters.normalized_prediction_distance = 1e-5;
    let ground = ColliderBuilder::new(SharedShape::halfspace(Vector::Y)).friction(0.0).restitution(scene.e);
    world.insert(RigidBodyBuilder::fixed().translation(Vector::new(0.0, -RADIUS_M)), ground);
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, scene.half_length_m * scene.tilt_rad.sin() + lifted_m))
        .rotation(scene.tilt_rad)
        .linvel(Vector::new(0.0, -scene.speed_m_s))
        .can_sleep(false)
        .additional_mass_properties(MassProperties::new(Vector::ZERO, 1.0, scene.gyration_m.powi(2)));
    let body = world.insert_body(body);
    for side in [-1.0, 1.0] {
        let ball = ColliderBuilder::ball(RADIUS_M)
            .translation(Vector::new(side * scene.half_length_m, 0.0))
            .density(0.0)
            .friction(0.0)
            .restitution(scene.e);
        world.insert_collider(ball, Some(body));
    }
    let motion = |world: &PhysicsWorld| {
        let body = &world.bodies[body];
        (body.linvel().y, body.angvel(), scene.half_length_m * body.rotation().angle().cos())
    };
    let (mut velocity, mut spin, _) = motion(&world);
    let (mut impacts, mut largest, mut time) = (0, 0.0_f64, 0.0);
    while time < scene.until_s {
        world.step();
        time += STEP_S;
        let (v, w, arm) = motion(&world);
        let jump = (v - velocity).abs() + arm * (w - spin).abs();
        if jump > ROUNDING * scene.speed_m_s {
            impacts += 1;
            largest = largest.max(jump);
        }
        (velocity, spin) = (v, w);
    }
    (impacts, largest)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let input: Value = serde_json::from_reader(std::io::stdin())?;
    let number = |v: &Value, key: &str| v[key].as_f64().ok_or_else(|| format!("no number \"{key}\" in the scene"));
    let speed_m_s = number(&input, "speed_m_s")?;
    let mut bars = Vec::new();
    for bar in input["bars"].as_array().ok_or("no list \"bars\" in the scene")? {
        let scene = Scene {
            e: number(bar, "e")?,
            half_length_m: number(&input, "half_length_m")?,
            gyration_m: number(bar, "gyration_m")?,
            tilt_rad: number(&input, "tilt_deg")?.to_radians(),
            speed_m_s,
            until_s: number(bar, "until_s")?,
        };
        let (begin, mut least, mut runs, mut answer) = (Instant::now(), Duration::MAX, 0, (0, 0.0));
        while runs < 5 || begin.elapsed().as_secs_f64() < 0.3 {
            let start = Instant::now();
            answer = run(&scene, 0.0);
            least = least.min(start.elapsed());
            runs += 1;
        }
        let parts = input["lifted_steps"].as_array().ok_or("no list \"lifted_steps\" in the scene")?;
        let lifted = parts.iter().filter_map(Value::as_f64).map(|part| run(&scene, part * STEP_S * speed_m_s).0);
        let (low, high) = lifted.fold((u32::MAX, 0), |(low, high), n| (low.min(n), high.max(n)));
        let ms = 1e3 * least.as_secs_f64();
        bars.push(json!({ "impacts": answer.0, "largest_m_s": answer.1, "ms": ms, "impacts_lifted": [low, high] }));
    }
    println!("{}", json!({ "version": "0.36.0", "bars": bars }));
    Ok(())
}
