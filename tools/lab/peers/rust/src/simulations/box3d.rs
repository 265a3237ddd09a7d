//! Box3D. Its pairs are found in the same way as Box2D's.

use std::ffi::{c_int, c_void};
use std::ptr::from_mut;

use boxddd_sys::ffi::*;

use super::contacts::{Contacts, EVERYWHERE};
use super::{Body, Kind, Simulation};
use crate::peer::{Bounds, Pairs};

const MAX_MARGIN: f32 = 0.05; // B3_MAX_AABB_MARGIN

pub struct Box3d {
    world: b3WorldId,
    handles: Vec<(b3BodyId, b3ShapeId)>,
    contacts: Box<Contacts>, // the world has its address
}

fn bounds_of(aabb: b3AABB) -> Bounds<3> {
    let array = |of: b3Vec3| [of.x, of.y, of.z];
    Bounds { min: array(aabb.lowerBound), max: array(aabb.upperBound) }
}

fn vector([x, y, z]: [f32; 3]) -> b3Vec3 {
    b3Vec3 { x, y, z }
}

fn rotation(angle: f32) -> b3Quat {
    b3Quat { v: vector([0.0, 0.0, (angle / 2.0).sin()]), s: (angle / 2.0).cos() }
}

unsafe extern "C" fn begins(a: b3ShapeId, b: b3ShapeId, contacts: *mut c_void) -> bool {
    let slot = |shape| b3Shape_GetUserData(shape) as u32;
    (*contacts.cast::<Contacts>()).begin(slot(a), slot(b));
    true
}

/// The shape's name in debug drawing: its slot plus one.
unsafe extern "C" fn name_shape(shape: *const b3DebugShape, _: *mut c_void) -> *mut c_void {
    b3Shape_GetUserData((*shape).shapeId).wrapping_byte_add(1)
}

/// Without it, the engine would call a null pointer.
unsafe extern "C" fn forget_shape(_: *mut c_void, _: *mut c_void) {}

unsafe extern "C" fn draw_shape(shape: *mut c_void, _: b3WorldTransform, _: b3HexColor, contacts: *mut c_void) {
    (*contacts.cast::<Contacts>()).drawn = shape as usize - 1;
}

unsafe extern "C" fn draw_bounds(aabb: b3AABB, _: b3HexColor, contacts: *mut c_void) {
    (*contacts.cast::<Contacts>()).enlarged_drawn(bounds_of(aabb));
}

impl Default for Box3d {
    fn default() -> Self {
        let mut contacts = Box::<Contacts>::default();
        let world = unsafe {
            let mut definition = b3DefaultWorldDef();
            definition.createDebugShape = Some(name_shape);
            definition.destroyDebugShape = Some(forget_shape);
            let world = b3CreateWorld(&definition);
            b3World_SetCustomFilterCallback(world, Some(begins), from_mut(&mut *contacts).cast());
            world
        };
        Self { world, handles: Vec::new(), contacts }
    }
}

impl Drop for Box3d {
    fn drop(&mut self) {
        unsafe { b3DestroyWorld(self.world) };
    }
}

impl Simulation for Box3d {
    fn dimension(&self) -> c_int {
        3
    }

    fn margin(&self) -> f32 {
        2.0 * MAX_MARGIN
    }

    fn set_gravity(&mut self, gravity: [f32; 3]) {
        unsafe { b3World_SetGravity(self.world, vector(gravity)) };
    }

    fn add(&mut self, slot: u32, body: &Body) {
        unsafe {
            let mut definition = b3DefaultBodyDef();
            definition.type_ = match body.kind {
                Kind::Fixed => b3BodyType_b3_staticBody,
                Kind::Kinematic => b3BodyType_b3_kinematicBody,
                Kind::Dynamic => b3BodyType_b3_dynamicBody,
            };
            definition.position = vector(body.position);
            definition.rotation = rotation(body.angle);
            definition.angularVelocity = vector([0.0, 0.0, body.spin]);
            let handle = b3CreateBody(self.world, &definition);

            let mut shape = b3DefaultShapeDef();
            shape.userData = slot as usize as *mut c_void;
            shape.enableCustomFiltering = true;
            shape.invokeContactCreation = true;
            let shape = if body.is_ball {
                let sphere = b3Sphere { center: vector([0.0; 3]), radius: body.half[0] };
                b3CreateSphereShape(handle, &shape, &sphere)
            } else {
                let [x, y, z] = body.half;
                let hull = b3MakeBoxHull(x, y, z); // whose parts lie behind its base
                b3CreateHullShape(handle, &shape, (&raw const hull).cast())
            };
            let slots = self.handles.len().max(slot as usize + 1);
            self.handles.resize(slots, (handle, shape));
            self.handles[slot as usize] = (handle, shape);
        }
    }

    fn remove(&mut self, slot: u32) {
        unsafe { b3DestroyBody(self.handles[slot as usize].0) };
        self.contacts.remove(slot);
    }

    fn place(&mut self, slot: u32, position: [f32; 3], velocity: [f32; 3]) {
        unsafe {
            let body = self.handles[slot as usize].0;
            b3Body_SetTransform(body, vector(position), rotation(0.0));
            b3Body_SetLinearVelocity(body, vector(velocity));
            b3Body_SetAngularVelocity(body, vector([0.0; 3]));
            b3Body_SetAwake(body, true);
        }
    }

    fn bounds(&self, slot: u32) -> Bounds<3> {
        bounds_of(unsafe { b3Shape_GetAABB(self.handles[slot as usize].1) })
    }

    fn enlarged(&self, slot: u32) -> Option<Bounds<3>> {
        Some(self.contacts.enlarged(slot))
    }

    fn step(&mut self, pairs: &mut Pairs) {
        unsafe {
            let mut draw = b3DefaultDebugDraw();
            draw.drawingBounds = b3AABB { lowerBound: vector([-EVERYWHERE; 3]), upperBound: vector([EVERYWHERE; 3]) };
            draw.drawShapes = true;
            draw.drawBounds = true;
            draw.DrawShapeFcn = Some(draw_shape);
            draw.DrawBoundsFcn = Some(draw_bounds);
            draw.context = from_mut(&mut *self.contacts).cast();
            b3World_Draw(self.world, &mut draw, u64::MAX);

            let is_awake = |&(body, shape): &_| b3Shape_IsValid(shape) && b3Body_IsAwake(body);
            let awake: Vec<bool> = self.handles.iter().map(is_awake).collect();
            b3World_Step(self.world, 1.0 / 60.0, 4);
            let count = b3World_GetCounters(self.world).contactCount;
            self.contacts.finish_step(&awake, count as usize, pairs);
        }
    }
}
