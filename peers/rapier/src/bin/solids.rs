//! Plates and boxes by Rapier: drops as JSON from standard input, the corners that touch, their times and the largest
//! changes of velocity as JSON to standard output.
//!
//! A body is a small ball at each corner over a half-space, or one cuboid. A touch is a step whose impulse changes the
//! velocity. Of a cuboid the lowest corner is the one that touches.

use cpu_time::ProcessTime;
use rapier3d_f64::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Radius of the balls; the ground is as much lower.
const RADIUS_M: f64 = 1e-3;
/// Changes of velocity below this share of the speed are rounding.
const ROUNDING: f64 = 1e-9;

#[derive(Deserialize)]
struct Input {
    setting: Setting,
    drops: Vec<Drop>,
    /// Starts, in steps of travel above the first touch.
    lifted_steps: Vec<f64>,
    /// Time for which the first start is run again for its least time on the processor.
    timed_s: f64,
}

#[derive(Deserialize)]
struct Setting {
    step_s: f64,
    balls: bool,
    iterations: usize,
    recycling: bool,
    prediction_m: f64,
    gyroscopic: bool,
}

/// A body of mass 1; the vertical is z, the ground at 0.
#[derive(Deserialize)]
struct Drop {
    corners_m: Vec<[f64; 3]>,
    gyration_m: [f64; 3],
    turned: [f64; 4],
    height_m: f64,
    speed_m_s: f64,
    gravity_m_s2: f64,
    e: f64,
    until_s: f64,
    touches: usize,
}

#[derive(Default)]
struct Answer {
    corners: Vec<usize>,
    times_s: Vec<f64>,
    peaks_m_s: Vec<f64>,
}

/// Returns the world, its body and the shapes at the corners, or the one of a cuboid.
fn world(
    setting: &Setting,
    drop: &Drop,
    lifted_m: f64,
) -> (PhysicsWorld, RigidBodyHandle, ColliderHandle, Vec<ColliderHandle>) {
    let mut world = PhysicsWorld { gravity: Vector::new(0.0, 0.0, -drop.gravity_m_s2), ..PhysicsWorld::default() };
    let parameters = &mut world.integration_parameters;
    parameters.dt = setting.step_s;
    parameters.num_solver_iterations = setting.iterations;
    parameters.contact_recycling = setting.recycling;
    parameters.normalized_prediction_distance = setting.prediction_m;
    let surface = |shape: ColliderBuilder| shape.density(0.0).friction(0.0).restitution(drop.e);
    let radius = if setting.balls { RADIUS_M } else { 0.0 };
    let fixed = world.insert_body(RigidBodyBuilder::fixed().translation(Vector::new(0.0, 0.0, -radius)));
    let ground = world.insert_collider(surface(ColliderBuilder::new(SharedShape::halfspace(Vector::Z))), Some(fixed));
    let [w, x, y, z] = drop.turned;
    let pose = Pose::from_parts(Vector::new(0.0, 0.0, drop.height_m + lifted_m), Rotation::from_xyzw(x, y, z, w));
    let [gx, gy, gz] = drop.gyration_m;
    let body = world.insert_body(
        RigidBodyBuilder::dynamic()
            .pose(pose)
            .linvel(Vector::new(0.0, 0.0, -drop.speed_m_s))
            .can_sleep(false)
            .gyroscopic_forces_enabled(setting.gyroscopic)
            .additional_mass_properties(MassProperties::new(Vector::ZERO, 1.0, Vector::new(gx * gx, gy * gy, gz * gz))),
    );
    let corner = |c: &[f64; 3]| Vector::new(c[0], c[1], c[2]);
    let shapes = if setting.balls {
        let ball = |c| surface(ColliderBuilder::ball(RADIUS_M)).translation(corner(c));
        drop.corners_m.iter().map(|c| world.insert_collider(ball(c), Some(body))).collect()
    } else {
        let half = drop.corners_m[0].map(f64::abs);
        vec![world.insert_collider(surface(ColliderBuilder::cuboid(half[0], half[1], half[2])), Some(body))]
    };
    (world, body, ground, shapes)
}

fn run(setting: &Setting, drop: &Drop, lifted_m: f64) -> Answer {
    let (mut world, handle, ground, shapes) = world(setting, drop, lifted_m);
    let corners: Vec<_> = drop.corners_m.iter().map(|c| Vector::new(c[0], c[1], c[2])).collect();
    let turned = |world: &PhysicsWorld, c: Vector| *world.bodies[handle].rotation() * c;
    let vertical = |world: &PhysicsWorld| -> Vec<f64> {
        let body = &world.bodies[handle];
        corners.iter().map(|c| body.linvel().z + body.angvel().cross(turned(world, *c)).z).collect()
    };
    let mut answer = Answer { peaks_m_s: vec![0.0; corners.len()], ..Answer::default() };
    let (mut pressed, mut before, mut begun) = (Vec::new(), Vec::new(), 0.0);
    let (mut step, steps) = (0.0, drop.until_s / setting.step_s);
    while step < steps {
        let linear = world.bodies[handle].linvel();
        let last = if pressed.is_empty() { vertical(&world) } else { Vec::new() };
        world.step();
        step += 1.0;
        let body = &world.bodies[handle];
        let fall = Vector::new(0.0, 0.0, drop.gravity_m_s2 * setting.step_s);
        let now: Vec<usize> = if (body.linvel() - linear + fall).length() < ROUNDING * drop.speed_m_s {
            Vec::new()
        } else if setting.balls {
            let pushed = |shape| {
                world.narrow_phase.contact_pair(ground, shape).is_some_and(|p| p.total_impulse_magnitude() > 0.0)
            };
            (0..corners.len()).filter(|i| pushed(shapes[*i])).collect()
        } else {
            let height = |i: &usize| turned(&world, corners[*i]).z;
            (0..corners.len()).min_by(|i, j| height(i).total_cmp(&height(j))).into_iter().collect()
        };
        if pressed.is_empty() && !now.is_empty() {
            (before, begun) = (last, step);
        }
        for corner in now.iter().filter(|c| !pressed.contains(*c)) {
            answer.corners.push(*corner);
            answer.times_s.push(step * setting.step_s);
        }
        if now.is_empty() && !pressed.is_empty() {
            let fallen = drop.gravity_m_s2 * setting.step_s * (step - begun + 1.0);
            for ((peak, v), before) in answer.peaks_m_s.iter_mut().zip(vertical(&world)).zip(&before) {
                *peak = peak.max((v - before + fallen).abs());
            }
            if answer.corners.len() >= drop.touches {
                break;
            }
        }
        pressed = now;
    }
    answer
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let input: Input = serde_json::from_reader(std::io::stdin())?;
    let setting = &input.setting;
    let drops = input.drops.iter().map(|drop| {
        let (begin, mut least) = (Instant::now(), Duration::MAX);
        while least == Duration::MAX || begin.elapsed().as_secs_f64() < input.timed_s {
            let start = ProcessTime::now();
            run(setting, drop, 0.0);
            least = least.min(start.elapsed());
        }
        let starts = input.lifted_steps.iter().map(|part| {
            let answer = run(setting, drop, part * setting.step_s * drop.speed_m_s);
            json!({ "corners": answer.corners, "times_s": answer.times_s, "peaks_m_s": answer.peaks_m_s })
        });
        json!({ "starts": starts.collect::<Vec<_>>(), "ms": 1e3 * least.as_secs_f64() })
    });
    println!("{}", json!({ "version": "0.36.0", "drops": drops.collect::<Vec<Value>>() }));
    Ok(())
}
