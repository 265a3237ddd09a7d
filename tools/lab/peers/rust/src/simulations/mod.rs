//! Engines that run scenes, so that tools/bench/engines/record_engine.cpp can record what their broad phases do.
//! include/rust_peers.h describes the functions.

mod box2d;
mod box3d;
mod contacts;
mod physx;
mod rapier;

use std::ffi::{c_char, c_int, c_void};

use physx_sys::PxBroadPhaseType;

use crate::peer::{Bounds, Pairs, Takes};
use crate::{guarded, text};

#[derive(PartialEq)]
#[repr(C)]
#[allow(dead_code)] // made in C++
pub enum Kind {
    Fixed,
    Kinematic,
    Dynamic,
}

/// Engines for 2D take x and y.
#[repr(C)]
pub struct Body {
    pub position: [f32; 3],
    pub half: [f32; 3], // of a ball: three times its radius
    pub angle: f32,     // about z, in radians
    pub spin: f32,      // about z, in radians per second
    pub kind: Kind,
    pub is_ball: bool,
}

/// A body has one shape. Slots number bodies; a slot may be used again.
pub trait Simulation {
    fn dimension(&self) -> c_int;

    /// The margin that the engine promises (see Recorder) for boxes that keep their sizes.
    fn margin(&self) -> f32;

    fn set_gravity(&mut self, gravity: [f32; 3]);
    fn add(&mut self, slot: u32, body: &Body);
    fn remove(&mut self, slot: u32);

    /// Puts a body elsewhere, upright, and wakes it.
    fn place(&mut self, slot: u32, position: [f32; 3], velocity: [f32; 3]);

    /// The body's box that the engine would pass to its broad phase if the next step began now.
    fn bounds(&self, slot: u32) -> Bounds<3>;

    /// The enlarged box of this body with which the last step found pairs, if the broad phase keeps such boxes.
    fn enlarged(&self, slot: u32) -> Option<Bounds<3>>;

    /// Runs a step, and gives the pairs that the broad phase held after it found pairs and before bodies moved.
    fn step(&mut self, pairs: &mut Pairs);
}

fn simulation_named(name: &str) -> Box<dyn Simulation> {
    match name {
        "box2d" => Box::<box2d::Box2d>::default(),
        "box3d" => Box::<box3d::Box3d>::default(),
        "physx_abp" => Box::new(physx::PhysX::new(PxBroadPhaseType::Abp)),
        "physx_pabp" => Box::new(physx::PhysX::new(PxBroadPhaseType::Pabp)),
        "physx_sap" => Box::new(physx::PhysX::new(PxBroadPhaseType::Sap)),
        "rapier2d" => Box::<rapier::flat::Rapier>::default(),
        "rapier3d" => Box::<rapier::solid::Rapier>::default(),
        _ => panic!("no engine '{name}'"),
    }
}

pub struct AnySimulation(Box<dyn Simulation>);

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_new(name: *const c_char) -> *mut AnySimulation {
    guarded(|| Box::into_raw(Box::new(AnySimulation(simulation_named(text(name)))))).unwrap_or(std::ptr::null_mut())
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_free(simulation: *mut AnySimulation) {
    guarded(|| drop(Box::from_raw(simulation)));
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_dimension(simulation: *const AnySimulation) -> c_int {
    (*simulation).0.dimension()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_margin(simulation: *const AnySimulation) -> f32 {
    (*simulation).0.margin()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_set_gravity(simulation: *mut AnySimulation, gravity: &[f32; 3]) -> bool {
    guarded(|| (*simulation).0.set_gravity(*gravity)).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_add(simulation: *mut AnySimulation, slot: u32, body: &Body) -> bool {
    guarded(|| (*simulation).0.add(slot, body)).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_remove(simulation: *mut AnySimulation, slot: u32) -> bool {
    guarded(|| (*simulation).0.remove(slot)).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_place(
    simulation: *mut AnySimulation,
    slot: u32,
    position: &[f32; 3],
    velocity: &[f32; 3],
) -> bool {
    guarded(|| (*simulation).0.place(slot, *position, *velocity)).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_bounds(
    simulation: *const AnySimulation,
    slot: u32,
    bounds: &mut Bounds<3>,
) -> bool {
    guarded(|| *bounds = (*simulation).0.bounds(slot)).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_enlarged(
    simulation: *const AnySimulation,
    slot: u32,
    bounds: &mut Bounds<3>,
) -> bool {
    let enlarged = guarded(|| (*simulation).0.enlarged(slot)).flatten();
    enlarged.inspect(|found| *bounds = *found).is_some()
}

#[no_mangle]
pub unsafe extern "C" fn rust_simulation_step(
    simulation: *mut AnySimulation,
    takes: Takes,
    context: *mut c_void,
) -> bool {
    let step = || {
        let mut pairs = Pairs::new(takes, context);
        (*simulation).0.step(&mut pairs);
        let _ = pairs.flush();
    };
    guarded(step).is_some()
}
