//! All pairs of boxes in 3D, found from nothing, by this crate and by others. All must find as many pairs.
use std::ops::ControlFlow;

use broadside::{find_pairs, Box3};
use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use packed_spatial_index::{Box3D, Index3DBuilder};
use parry3d::bounding_volume::Aabb;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder, ColliderSet};

/// Boxes of edge 1, spread so that each overlaps some four others.
fn uniform(count: usize) -> Vec<Box3> {
    let side = (count as f32 * 2.0).cbrt();
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32 * side
    };
    let corners = (0..count).map(|_| [random(), random(), random()]);
    corners.map(|min| Box3::new(min, min.map(|at| at + 1.0))).collect()
}

fn packed(boxes: &[Box3]) -> usize {
    let mut builder = Index3DBuilder::new(boxes.len());
    for Box3 { min, max } in boxes {
        let ([a, b, c], [d, e, f]) = (min.map(f64::from), max.map(f64::from));
        builder.add(Box3D::new(a, b, c, d, e, f));
    }
    let mut pairs = Vec::new();
    let _ = builder.finish().expect("valid boxes").pairs_each(|a, b| {
        pairs.push((a as u32, b as u32));
        ControlFlow::<()>::Continue(())
    });
    pairs.len()
}

fn aabb_of(bounds: &Box3) -> Aabb {
    Aabb::new(bounds.min.into(), bounds.max.into())
}

fn parry(boxes: &[Box3]) -> usize {
    let aabbs: Vec<_> = boxes.iter().map(aabb_of).collect();
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &aabbs);
    let mut pairs = Vec::new();
    bvh.traverse_bvtt_single_tree::<false>(&mut BvhWorkspace::default(), &mut |a, b| pairs.push((a, b)));
    pairs.len()
}

/// Rapier's pairs are those of enlarged boxes, so they are tested once more. Making the colliders is not measured.
fn rapier(boxes: &[Box3], colliders: &ColliderSet) -> usize {
    let parameters = IntegrationParameters::default();
    let mut broad_phase = BroadPhaseBvh::new();
    for (bounds, (handle, _)) in boxes.iter().zip(colliders.iter()) {
        broad_phase.set_aabb(&parameters, handle, aabb_of(bounds));
    }
    let mut events = Vec::new();
    broad_phase.update(&parameters, colliders, &RigidBodySet::new(), &[], &[], &mut events);
    let overlap = |event: &BroadPhasePairEvent| match event {
        BroadPhasePairEvent::AddPair(pair) => {
            let [a, b] = [pair.collider1, pair.collider2].map(|handle| handle.into_raw_parts().0 as usize);
            boxes[a].overlaps(&boxes[b]).then_some((a as u32, b as u32))
        }
        BroadPhasePairEvent::DeletePair(_) => None,
    };
    events.iter().filter_map(overlap).collect::<Vec<_>>().len()
}

fn all_pairs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("all pairs, 3D");
    group.sample_size(20);
    for count in [1_000, 100_000] {
        let boxes = uniform(count);
        let mut colliders = ColliderSet::new();
        for _ in 0..count {
            colliders.insert(ColliderBuilder::ball(0.5).active_collision_types(ActiveCollisionTypes::all()));
        }
        let expected = find_pairs(&boxes).unwrap().len();
        let mut add = |name: &str, search: &dyn Fn() -> usize| {
            assert_eq!(search(), expected, "{name}");
            group.bench_function(BenchmarkId::new(name, count), |bencher| bencher.iter(search));
        };
        add("broadside", &|| find_pairs(&boxes).unwrap().len());
        add("packed_spatial_index", &|| packed(&boxes));
        add("parry", &|| parry(&boxes));
        add("rapier", &|| rapier(&boxes, &colliders));
    }
    group.finish();
}

criterion_group!(benches, all_pairs);
criterion_main!(benches);
