//! A Bevy plugin: entities with a [`BoxCollider`] follow their transforms into a [`World`], and [`OverlapStart`] and
//! [`OverlapEnd`] say which of them begin and cease to overlap. It finds overlapping boxes, and leaves shapes, contacts
//! and forces to you. For 2D write 2 in place of 3; `z` is then ignored.
//!
//! ```
//! use bevy_app::{App, Update};
//! use bevy_ecs::prelude::*;
//! use bevy_transform::prelude::*;
//! use broadside::Box3;
//! use broadside_bevy::{BoxCollider, BroadPhase, BroadPhasePlugin, OverlapStart};
//!
//! const UNIT: Box3 = Box3::new([-0.5; 3], [0.5; 3]);
//!
//! fn spawn(mut commands: Commands) {
//!     commands.spawn((BoxCollider::from(UNIT), Transform::from_xyz(0.0, 0.0, 0.0)));
//!     commands.spawn((BoxCollider::from(UNIT), Transform::from_xyz(0.9, 0.0, 0.0)));
//! }
//!
//! fn print(mut starts: MessageReader<OverlapStart>) {
//!     for OverlapStart { first, second } in starts.read() {
//!         println!("{first} touches {second}");
//!     }
//! }
//!
//! fn look(broad_phase: Res<BroadPhase<3>>) -> Result {
//!     let from = Box3::point([0.0, 9.0, 0.0]);
//!     if let Some(hit) = broad_phase.world().query().first_hit(from, [0.0, -1.0, 0.0], 100.0)? {
//!         assert_eq!(hit.t_enter, 8.5);
//!         println!("below: {}", broad_phase.entity(hit.id)?);
//!     }
//!     Ok(())
//! }
//!
//! let mut app = App::new();
//! app.add_plugins((TransformPlugin, BroadPhasePlugin::<3>::default())); // DefaultPlugins has TransformPlugin
//! app.add_systems(bevy_app::Startup, spawn).add_systems(Update, (print, look));
//! app.update();
//! app.update();
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_transform::prelude::*;
use broadside::{Aabb, Bounds, Filter, Handle, World, WorldOptions};

/// The box of an entity, which takes part in the broad phase as long as the entity has it.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
pub struct BoxCollider<const D: usize> {
    /// In the entity's own coordinates. The world has the smallest box around it as the transform places it.
    pub bounds: Aabb<D>,
    /// With which others it pairs, and whether it is static.
    pub filter: Filter,
}

impl<const D: usize> From<Aabb<D>> for BoxCollider<D> {
    fn from(bounds: Aabb<D>) -> Self {
        BoxCollider { bounds, filter: Filter::default() }
    }
}

/// Two entities overlap from this frame on. Systems before [`BroadPhaseSystems`] read it in the next frame.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverlapStart {
    /// One entity.
    pub first: Entity,
    /// The other entity.
    pub second: Entity,
}

/// Two entities overlap no longer; they may have been despawned.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverlapEnd {
    /// One entity.
    pub first: Entity,
    /// The other entity.
    pub second: Entity,
}

/// The boxes as they were at the last update, for queries.
#[derive(Resource)]
pub struct BroadPhase<const D: usize>
where
    Aabb<D>: Bounds,
{
    world: World<Aabb<D>>,
    handles: EntityHashMap<Handle>,
}

impl<const D: usize> BroadPhase<D>
where
    Aabb<D>: Bounds,
{
    /// The world of boxes; see [`World::query`].
    pub fn world(&self) -> &World<Aabb<D>> {
        &self.world
    }

    /// The entity of a box that a query has found.
    pub fn entity(&self, handle: Handle) -> Result<Entity, broadside::Error> {
        self.world.user_data(handle).map(Entity::from_bits)
    }

    /// The box of an entity, such as one that a query leaves out.
    pub fn handle(&self, entity: Entity) -> Option<Handle> {
        self.handles.get(&entity).copied()
    }
}

/// When the broad phase is updated: in `PostUpdate`, after transforms have been propagated.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BroadPhaseSystems;

/// Adds a [`BroadPhase`] in 2D or 3D, and keeps it up to date.
pub struct BroadPhasePlugin<const D: usize> {
    /// The world's options. By default, a box with a NaN pairs with nothing; otherwise it is an error.
    pub options: WorldOptions<'static>,
}

impl<const D: usize> Default for BroadPhasePlugin<D> {
    fn default() -> Self {
        BroadPhasePlugin { options: WorldOptions { quarantine: true, ..WorldOptions::default() } }
    }
}

impl<const D: usize> Plugin for BroadPhasePlugin<D>
where
    Aabb<D>: Bounds,
{
    fn build(&self, app: &mut App) {
        let world = World::with_options(&self.options).expect("valid options of the world");
        app.insert_resource(BroadPhase::<D> { world, handles: EntityHashMap::default() })
            .add_message::<OverlapStart>()
            .add_message::<OverlapEnd>()
            .add_systems(PostUpdate, update::<D>.in_set(BroadPhaseSystems).after(TransformSystems::Propagate));
    }
}

/// The smallest box around `local` as the transform places it. For each axis, the corners' extreme coordinates are sums of
/// extreme products (Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems, 1990).
fn placed<const D: usize>(local: &Aabb<D>, transform: &GlobalTransform) -> Aabb<D> {
    let columns = transform.affine().to_cols_array(); // three of the matrix, and the translation
    let mut bounds = Aabb::point(std::array::from_fn(|axis| columns[9 + axis]));
    for axis in 0..D {
        for from in 0..D {
            let factor = columns[3 * from + axis];
            if factor != 0.0 {
                let ends = [factor * local.min[from], factor * local.max[from]]; // not of 0: extents may be infinite
                bounds.min[axis] += if factor < 0.0 { ends[1] } else { ends[0] };
                bounds.max[axis] += if factor < 0.0 { ends[0] } else { ends[1] };
            }
        }
    }
    bounds
}

type HasChanged<const D: usize> = Or<(Changed<BoxCollider<D>>, Changed<GlobalTransform>)>;

fn update<const D: usize>(
    mut broad_phase: ResMut<BroadPhase<D>>,
    changed: Query<(Entity, Ref<BoxCollider<D>>, &GlobalTransform), HasChanged<D>>,
    colliders: Query<(), With<BoxCollider<D>>>,
    mut removed: RemovedComponents<BoxCollider<D>>,
    mut starts: MessageWriter<OverlapStart>,
    mut ends: MessageWriter<OverlapEnd>,
) -> Result
where
    Aabb<D>: Bounds,
{
    let BroadPhase { world, handles } = &mut *broad_phase;
    // One that was removed and inserted again stays.
    let gone = removed.read().filter(|&entity| !colliders.contains(entity));
    let gone: Vec<_> = gone.filter_map(|entity| handles.remove(&entity)).collect();
    world.remove(&gone)?;

    let (mut moved, mut moved_boxes) = (Vec::new(), Vec::new());
    let (mut added, mut added_boxes, mut added_filters) = (Vec::new(), Vec::new(), Vec::new());
    for (entity, collider, transform) in &changed {
        let bounds = placed(&collider.bounds, transform);
        if let Some(&handle) = handles.get(&entity) {
            moved.push(handle);
            moved_boxes.push(bounds);
            if collider.is_changed() {
                world.set_filter(handle, collider.filter)?;
            }
        } else {
            added.push(entity);
            added_boxes.push(bounds);
            added_filters.push(collider.filter);
        }
    }
    world.move_to(&moved, &moved_boxes)?;
    let user_data: Vec<_> = added.iter().map(|entity| entity.to_bits()).collect();
    handles.extend(added.into_iter().zip(world.add_with(&added_boxes, &added_filters, &user_data)?));

    world.update()?;
    let entity = |handle| world.user_data(handle).map(Entity::from_bits);
    for pair in world.events().begun {
        starts.write(OverlapStart { first: entity(pair.first)?, second: entity(pair.second)? });
    }
    for pair in world.events().ended {
        ends.write(OverlapEnd { first: entity(pair.first)?, second: entity(pair.second)? });
    }
    Ok(())
}
