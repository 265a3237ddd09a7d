//! Box2D 3. A step finds pairs, ends those whose enlarged boxes have parted, and then moves bodies. There is no list of
//! pairs, and no event when one ends, so `Contacts` works them out: debug drawing shows the enlarged boxes, the custom
//! filter is asked about each pair that begins, and the number of contacts confirms the result.

use std::ffi::{c_int, c_void};
use std::ptr::from_mut;

use boxdd_sys::ffi::*;

use super::contacts::{Contacts, EVERYWHERE};
use super::{Body, Kind, Simulation};
use crate::peer::{Bounds, Pairs};

const MAX_MARGIN: f32 = 0.05; // B2_MAX_AABB_MARGIN

pub struct Box2d {
    world: b2WorldId,
    handles: Vec<(b2BodyId, b2ShapeId)>,
    contacts: Box<Contacts>, // the world has its address
}

fn bounds_of(aabb: b2AABB) -> Bounds<3> {
    Bounds { min: [aabb.lowerBound.x, aabb.lowerBound.y, 0.0], max: [aabb.upperBound.x, aabb.upperBound.y, 0.0] }
}

fn vector([x, y, _]: [f32; 3]) -> b2Vec2 {
    b2Vec2 { x, y }
}

fn rotation(angle: f32) -> b2Rot {
    b2Rot { c: angle.cos(), s: angle.sin() }
}

unsafe extern "C" fn begins(a: b2ShapeId, b: b2ShapeId, contacts: *mut c_void) -> bool {
    let slot = |shape| b2Shape_GetUserData(shape) as u32;
    (*contacts.cast::<Contacts>()).begin(slot(a), slot(b));
    true
}

unsafe extern "C" fn draw_polygon(
    _: b2WorldTransform,
    _: *const b2Vec2,
    _: c_int,
    _: f32,
    color: b2HexColor,
    contacts: *mut c_void,
) {
    (*contacts.cast::<Contacts>()).drawn = color as usize - 1;
}

unsafe extern "C" fn draw_circle(_: b2WorldTransform, _: b2Vec2, _: f32, color: b2HexColor, contacts: *mut c_void) {
    (*contacts.cast::<Contacts>()).drawn = color as usize - 1;
}

unsafe extern "C" fn draw_bounds(aabb: b2AABB, _: b2HexColor, contacts: *mut c_void) {
    (*contacts.cast::<Contacts>()).enlarged_drawn(bounds_of(aabb));
}

impl Default for Box2d {
    fn default() -> Self {
        let mut contacts = Box::<Contacts>::default();
        let world = unsafe {
            let world = b2CreateWorld(&b2DefaultWorldDef());
            b2World_SetCustomFilterCallback(world, Some(begins), from_mut(&mut *contacts).cast());
            world
        };
        Self { world, handles: Vec::new(), contacts }
    }
}

impl Drop for Box2d {
    fn drop(&mut self) {
        unsafe { b2DestroyWorld(self.world) };
    }
}

impl Simulation for Box2d {
    fn dimension(&self) -> c_int {
        2
    }

    fn margin(&self) -> f32 {
        2.0 * MAX_MARGIN
    }

    fn set_gravity(&mut self, gravity: [f32; 3]) {
        unsafe { b2World_SetGravity(self.world, vector(gravity)) };
    }

    fn add(&mut self, slot: u32, body: &Body) {
        unsafe {
            let mut definition = b2DefaultBodyDef();
            definition.type_ = match body.kind {
                Kind::Fixed => b2BodyType_b2_staticBody,
                Kind::Kinematic => b2BodyType_b2_kinematicBody,
                Kind::Dynamic => b2BodyType_b2_dynamicBody,
            };
            definition.position = vector(body.position);
            definition.rotation = rotation(body.angle);
            definition.angularVelocity = body.spin;
            let handle = b2CreateBody(self.world, &definition);

            let mut shape = b2DefaultShapeDef();
            shape.userData = slot as usize as *mut c_void;
            shape.enableCustomFiltering = true;
            shape.invokeContactCreation = true;
            shape.material.customColor = slot + 1; // by which debug drawing names it
            let shape = if body.is_ball {
                let circle = b2Circle { center: vector([0.0; 3]), radius: body.half[0] };
                b2CreateCircleShape(handle, &shape, &circle)
            } else {
                b2CreatePolygonShape(handle, &shape, &b2MakeBox(body.half[0], body.half[1]))
            };
            let slots = self.handles.len().max(slot as usize + 1);
            self.handles.resize(slots, (handle, shape));
            self.handles[slot as usize] = (handle, shape);
        }
    }

    fn remove(&mut self, slot: u32) {
        unsafe { b2DestroyBody(self.handles[slot as usize].0) };
        self.contacts.remove(slot);
    }

    fn place(&mut self, slot: u32, position: [f32; 3], velocity: [f32; 3]) {
        unsafe {
            let body = self.handles[slot as usize].0;
            b2Body_SetTransform(body, vector(position), rotation(0.0));
            b2Body_SetLinearVelocity(body, vector(velocity));
            b2Body_SetAngularVelocity(body, 0.0);
            b2Body_SetAwake(body, true);
        }
    }

    fn bounds(&self, slot: u32) -> Bounds<3> {
        bounds_of(unsafe { b2Shape_GetAABB(self.handles[slot as usize].1) })
    }

    fn enlarged(&self, slot: u32) -> Option<Bounds<3>> {
        Some(self.contacts.enlarged(slot))
    }

    fn step(&mut self, pairs: &mut Pairs) {
        unsafe {
            let mut draw = b2DefaultDebugDraw();
            draw.drawingBounds = b2AABB { lowerBound: vector([-EVERYWHERE; 3]), upperBound: vector([EVERYWHERE; 3]) };
            draw.drawShapes = true;
            draw.drawBounds = true;
            draw.DrawSolidPolygonFcn = Some(draw_polygon);
            draw.DrawSolidCircleFcn = Some(draw_circle);
            draw.DrawBoundsFcn = Some(draw_bounds);
            draw.context = from_mut(&mut *self.contacts).cast();
            b2World_Draw(self.world, &mut draw);

            let is_awake = |&(body, shape): &_| b2Shape_IsValid(shape) && b2Body_IsAwake(body);
            let awake: Vec<bool> = self.handles.iter().map(is_awake).collect();
            b2World_Step(self.world, 1.0 / 60.0, 4);
            let count = b2World_GetCounters(self.world).contactCount;
            self.contacts.finish_step(&awake, count as usize, pairs);
        }
    }
}
