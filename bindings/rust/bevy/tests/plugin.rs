//! The plugin, without a window: its pairs are those of testing every two entities in every frame.
use std::collections::BTreeSet;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_transform::prelude::*;
use broadside::{Aabb, Bounds, Box2, Box3, Filter};
use broadside_bevy::{BoxCollider, BroadPhase, BroadPhasePlugin, OverlapEnd, OverlapStart};

const UNIT: Box3 = Box3::new([-0.5; 3], [0.5; 3]);

fn app<const D: usize>() -> App
where
    Aabb<D>: Bounds,
{
    let mut app = App::new();
    app.add_plugins((TransformPlugin, BroadPhasePlugin::<D>::default()));
    app
}

fn place(app: &mut App, entity: Entity, x: f32) {
    app.world_mut().get_mut::<Transform>(entity).unwrap().translation.x = x;
}

fn sorted(a: Entity, b: Entity) -> (Entity, Entity) {
    (a.min(b), a.max(b))
}

/// Takes the messages of one kind, as pairs.
fn take<M: Message>(app: &mut App, pair_of: fn(M) -> (Entity, Entity)) -> Vec<(Entity, Entity)> {
    app.world_mut().resource_mut::<Messages<M>>().drain().map(pair_of).collect()
}

/// Updates, and returns the pairs that began and those that ended.
fn update(app: &mut App) -> [Vec<(Entity, Entity)>; 2] {
    app.update();
    let starts = take(app, |OverlapStart { first, second }| sorted(first, second));
    [starts, take(app, |OverlapEnd { first, second }| sorted(first, second))]
}

fn spawn(app: &mut App, collider: BoxCollider<3>, x: f32) -> Entity {
    app.world_mut().spawn((collider, Transform::from_xyz(x, 0.0, 0.0))).id()
}

#[test]
fn tells_which_begin_and_end() {
    let mut app = app::<3>();
    let [a, b] = [0.0, 3.0].map(|x| spawn(&mut app, UNIT.into(), x));
    assert_eq!(update(&mut app), [vec![], vec![]]);
    place(&mut app, b, 1.0);
    assert_eq!(update(&mut app), [vec![sorted(a, b)], vec![]]);
    assert_eq!(update(&mut app), [vec![], vec![]]);
    app.world_mut().despawn(a);
    assert_eq!(update(&mut app), [vec![], vec![sorted(a, b)]]);
    app.world_mut().entity_mut(b).remove::<BoxCollider<3>>();
    update(&mut app);
    assert!(app.world().resource::<BroadPhase<3>>().world().is_empty());
}

#[test]
fn sees_changes_of_colliders() {
    let mut app = app::<3>();
    let ghost = BoxCollider { bounds: UNIT, filter: Filter { mask: 0, ..Default::default() } };
    let [a, b] = [spawn(&mut app, UNIT.into(), 0.0), spawn(&mut app, ghost, 0.5)];
    assert_eq!(update(&mut app), [vec![], vec![]]);
    app.world_mut().entity_mut(b).insert(BoxCollider::from(UNIT));
    assert_eq!(update(&mut app), [vec![sorted(a, b)], vec![]]);
    app.world_mut().entity_mut(b).remove::<BoxCollider<3>>().insert(BoxCollider::from(UNIT));
    assert_eq!(update(&mut app), [vec![], vec![]]);
    app.world_mut().get_mut::<BoxCollider<3>>(b).unwrap().bounds = Box3::point([5.0; 3]);
    assert_eq!(update(&mut app), [vec![], vec![sorted(a, b)]]);
    place(&mut app, a, f32::NAN);
    assert_eq!(update(&mut app), [vec![], vec![]]);
}

#[test]
fn places_boxes_as_transforms_do() {
    let mut app = app::<2>();
    let mut turned = Transform::from_scale([2.0; 3].into());
    turned.rotate_z(std::f32::consts::FRAC_PI_2);
    let floor = Box2::new([f32::NEG_INFINITY, -1.0], [f32::INFINITY, 0.0]);
    let floor = app.world_mut().spawn((BoxCollider::from(floor), Transform::from_xyz(7.0, -2.0, 9.0))).id();
    let child = (BoxCollider::from(Box2::new([1.0, 0.0], [3.0, 1.0])), Transform::from_xyz(2.0, 0.0, 0.0));
    let child = app.world_mut().spawn(child).id();
    app.world_mut().spawn(turned).add_child(child);
    app.update();
    let broad_phase = app.world().resource::<BroadPhase<2>>();
    let box_of = |entity| broad_phase.world().box_of(broad_phase.handle(entity).unwrap()).unwrap();
    assert_eq!(box_of(floor), Box2::new([f32::NEG_INFINITY, -3.0], [f32::INFINITY, -2.0]));
    let Box2 { min, max } = box_of(child);
    for (found, expected) in [(min[0], -2.0), (min[1], 6.0), (max[0], 0.0), (max[1], 10.0)] {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
}

#[test]
fn has_the_pairs_of_testing_all() {
    let mut app = app::<3>();
    let mut state = 1_u64;
    let mut random = |bound: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % bound
    };
    let mut entities: Vec<_> = (0..80).map(|i| spawn(&mut app, UNIT.into(), i as f32)).collect();
    let mut held = BTreeSet::new();
    let mut changes = 0;
    for _ in 0..40 {
        for _ in 0..20 {
            let at = random(80) as usize;
            match random(5) {
                0 => {
                    app.world_mut().despawn(entities[at]);
                    entities[at] = spawn(&mut app, UNIT.into(), random(40) as f32);
                }
                _ => place(&mut app, entities[at], random(40) as f32),
            }
        }
        let [starts, ends] = update(&mut app);
        changes += starts.len() + ends.len();
        for pair in ends {
            assert!(held.remove(&pair));
        }
        for pair in starts {
            assert!(held.insert(pair));
        }
        let x = |entity| app.world().get::<Transform>(entity).unwrap().translation.x;
        let all = entities.iter().flat_map(|&a| entities.iter().map(move |&b| (a, b)));
        let expected: BTreeSet<_> = all.filter(|&(a, b)| a < b && (x(a) - x(b)).abs() <= 1.0).collect();
        assert_eq!(held, expected);
    }
    assert!(changes > 1000, "{changes}");
}
