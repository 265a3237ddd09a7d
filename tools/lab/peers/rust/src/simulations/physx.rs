//! PhysX 5. A step finds pairs and then moves bodies. Its filter callback is told of each pair that begins and ends,
//! for boxes enlarged by the contact offset of their shapes.
//!
//! The crate does not bind that callback, so `PairLog` is laid out as GCC and Clang lay out the C++ class on x86-64.

use std::collections::HashMap;
use std::ffi::{c_int, c_void};
use std::ptr::{from_mut, null, null_mut};
use std::sync::OnceLock;

use physx_sys::*;

use super::{Body, Kind, Simulation};
use crate::peer::{Bounds, Pairs};

const STEP: f32 = 1.0 / 60.0;

pub struct PhysX {
    scene: *mut PxScene,
    material: *mut PxMaterial,
    bodies: Vec<Option<Actor>>,
    log: Box<PairLog>, // the scene has its address
}

struct Actor {
    actor: *mut PxRigidActor,
    shape: *mut PxShape,
    spin: f32, // of a kinematic body
    angle: f32,
}

#[repr(C)]
struct PairLog {
    functions: *const [*const c_void; 5],
    held: HashMap<u32, (u32, u32)>, // by the engine's number of the pair
}

struct FunctionTable([*const c_void; 5]);
unsafe impl Sync for FunctionTable {}

static FUNCTIONS: FunctionTable = FunctionTable([
    pair_found as *const c_void,
    pair_lost as *const c_void,
    status_changes as *const c_void,
    never_called as *const c_void, // the destructors, which the engine has no access to
    never_called as *const c_void,
]);

/// PxFlags and PxFilterData have copy constructors, so that the ABI passes them by address.
unsafe extern "C" fn pair_found(
    flags: *mut u16,
    log: *mut PairLog,
    id: u32,
    _: u32,
    a: *const PxFilterData,
    _: *const PxActor,
    _: *const PxShape,
    _: u32,
    b: *const PxFilterData,
    _: *const PxActor,
    _: *const PxShape,
    _: *mut PxPairFlags,
) -> *mut u16 {
    (*log).held.insert(id, ((*a).word0, (*b).word0));
    *flags = 1 << 3 | 1 << 2; // PxFilterFlag::eNOTIFY: tell when it is lost
    flags
}

unsafe extern "C" fn pair_lost(
    log: *mut PairLog,
    id: u32,
    _: u32,
    _: *const PxFilterData,
    _: u32,
    _: *const PxFilterData,
    _: bool,
) {
    (*log).held.remove(&id);
}

unsafe extern "C" fn status_changes(_: *mut PairLog, _: *mut u32, _: *mut u16, _: *mut u16) -> bool {
    false
}

unsafe extern "C" fn never_called() {}

unsafe extern "C" fn filter(info: *mut FilterShaderCallbackInfo) -> PxFilterFlags {
    *(*info).pairFlags = PxPairFlags::SolveContact | PxPairFlags::DetectDiscreteContact;
    PxFilterFlags::Callback
}

/// The engine exists once in a process.
fn physics() -> *mut PxPhysics {
    static PHYSICS: OnceLock<usize> = OnceLock::new();
    let made = PHYSICS.get_or_init(|| unsafe { physx_create_physics(physx_create_foundation()) as usize });
    *made as *mut PxPhysics
}

fn vector([x, y, z]: [f32; 3]) -> PxVec3 {
    PxVec3 { x, y, z }
}

fn pose(position: PxVec3, angle: f32) -> PxTransform {
    let q = PxQuat { x: 0.0, y: 0.0, z: (angle / 2.0).sin(), w: (angle / 2.0).cos() };
    PxTransform { q, p: position }
}

impl PhysX {
    pub fn new(broad_phase: PxBroadPhaseType) -> Self {
        assert!(cfg!(all(unix, target_arch = "x86_64")), "PhysX's filter callback is laid out for x86-64 and Unix");
        let mut log = Box::new(PairLog { functions: &FUNCTIONS.0, held: HashMap::new() });
        unsafe {
            let mut description = PxSceneDesc_new(PxPhysics_getTolerancesScale(physics()));
            let waits = PxDefaultCpuDispatcherWaitForWorkMode::WaitForWork;
            description.cpuDispatcher = phys_PxDefaultCpuDispatcherCreate(0, null_mut(), waits, 0).cast();
            enable_custom_filter_shader(&mut description, filter, 0);
            description.filterCallback = from_mut(&mut *log).cast();
            description.broadPhaseType = broad_phase;
            let scene = PxPhysics_createScene_mut(physics(), &description);
            assert!(!scene.is_null(), "PhysX refuses the scene");
            let material = PxPhysics_createMaterial_mut(physics(), 0.5, 0.5, 0.1);
            Self { scene, material, bodies: Vec::new(), log }
        }
    }

    fn body(&self, slot: u32) -> &Actor {
        self.bodies[slot as usize].as_ref().expect("a body")
    }
}

impl Drop for PhysX {
    fn drop(&mut self) {
        unsafe { PxScene_release_mut(self.scene) };
    }
}

impl Simulation for PhysX {
    fn dimension(&self) -> c_int {
        3
    }

    fn margin(&self) -> f32 {
        0.0
    }

    fn set_gravity(&mut self, gravity: [f32; 3]) {
        unsafe { PxScene_setGravity_mut(self.scene, &vector(gravity)) };
    }

    fn add(&mut self, slot: u32, body: &Body) {
        unsafe {
            let [x, y, z] = body.half;
            let cuboid = PxBoxGeometry_new(x, y, z);
            let ball = PxSphereGeometry_new(x);
            let geometry: *const PxGeometry = match body.is_ball {
                true => (&raw const ball).cast(),
                false => (&raw const cuboid).cast(),
            };
            let at = pose(vector(body.position), body.angle);
            let none = PxTransform_new_2(PxIDENTITY::PxIdentity);
            let actor: *mut PxRigidActor = match body.kind {
                Kind::Fixed => phys_PxCreateStatic(physics(), &at, geometry, self.material, &none).cast(),
                Kind::Kinematic => phys_PxCreateKinematic(physics(), &at, geometry, self.material, 1.0, &none).cast(),
                Kind::Dynamic => {
                    let dynamic = phys_PxCreateDynamic(physics(), &at, geometry, self.material, 1.0, &none);
                    PxRigidDynamic_setAngularVelocity_mut(dynamic, &vector([0.0, 0.0, body.spin]), true);
                    dynamic.cast()
                }
            };
            let mut shape: *mut PxShape = null_mut();
            PxRigidActor_getShapes(actor, &mut shape, 1, 0);
            PxShape_setSimulationFilterData_mut(shape, &PxFilterData { word0: slot, word1: 0, word2: 0, word3: 0 });
            PxScene_addActor_mut(self.scene, actor.cast(), null());
            let slots = self.bodies.len().max(slot as usize + 1);
            self.bodies.resize_with(slots, || None);
            let spin = if body.kind == Kind::Kinematic { body.spin } else { 0.0 };
            self.bodies[slot as usize] = Some(Actor { actor, shape, spin, angle: body.angle });
        }
    }

    fn remove(&mut self, slot: u32) {
        unsafe { PxRigidActor_release_mut(self.body(slot).actor) };
        self.bodies[slot as usize] = None;
    }

    fn place(&mut self, slot: u32, position: [f32; 3], velocity: [f32; 3]) {
        unsafe {
            let actor = self.body(slot).actor;
            PxRigidActor_setGlobalPose_mut(actor, &pose(vector(position), 0.0), true);
            if PxActor_getType(actor.cast()) == PxActorType::RigidDynamic {
                PxRigidDynamic_setLinearVelocity_mut(actor.cast(), &vector(velocity), true);
                PxRigidDynamic_setAngularVelocity_mut(actor.cast(), &vector([0.0; 3]), true);
            }
        }
    }

    fn bounds(&self, slot: u32) -> Bounds<3> {
        unsafe {
            let &Actor { actor, shape, .. } = self.body(slot);
            let mut bounds = PxBounds3 { minimum: vector([0.0; 3]), maximum: vector([0.0; 3]) };
            let at = PxRigidActor_getGlobalPose(actor);
            let flags = PxGeometryQueryFlags::SimdGuard;
            PxGeometryQuery_computeGeomBounds(&mut bounds, PxShape_getGeometry(shape), &at, 0.0, 1.0, flags);
            let offset = PxShape_getContactOffset(shape); // which the broad phase adds
            let PxBounds3 { minimum: min, maximum: max } = bounds;
            Bounds {
                min: [min.x - offset, min.y - offset, min.z - offset],
                max: [max.x + offset, max.y + offset, max.z + offset],
            }
        }
    }

    fn enlarged(&self, _: u32) -> Option<Bounds<3>> {
        None
    }

    fn step(&mut self, pairs: &mut Pairs) {
        unsafe {
            for body in self.bodies.iter_mut().flatten().filter(|body| body.spin != 0.0) {
                body.angle += STEP * body.spin;
                let at = PxRigidActor_getGlobalPose(body.actor);
                PxRigidDynamic_setKinematicTarget_mut(body.actor.cast(), &pose(at.p, body.angle));
            }
            PxScene_simulate_mut(self.scene, STEP, null_mut(), null_mut(), 0, true);
            PxScene_fetchResults_mut(self.scene, true, null_mut());
            for &(a, b) in self.log.held.values() {
                let _ = pairs.add(a, b);
            }
        }
    }
}
