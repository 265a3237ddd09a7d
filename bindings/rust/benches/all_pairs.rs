//! All pairs of boxes in 3D, found from nothing, by this crate and by others. All must find the same pairs.
use std::ops::ControlFlow;

use broadside::{find_pairs, Box3, Pair};
use broadside_benches::{aabb_of, overlap, places, random, uniform, Colliders};
use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use packed_spatial_index::{Box3D, Index3DBuilder};
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::geometry::{BroadPhaseBvh, BroadPhasePairEvent};

fn packed(boxes: &[Box3]) -> Vec<Pair> {
    let mut builder = Index3DBuilder::new(boxes.len());
    for Box3 { min, max } in boxes {
        let ([a, b, c], [d, e, f]) = (min.map(f64::from), max.map(f64::from));
        builder.add(Box3D::new(a, b, c, d, e, f));
    }
    let mut pairs = Vec::new();
    let _ = builder.finish().expect("valid boxes").pairs_each(|a, b| {
        pairs.push(Pair { first: a as u32, second: b as u32 });
        ControlFlow::<()>::Continue(())
    });
    pairs
}

fn parry(boxes: &[Box3]) -> Vec<Pair> {
    let aabbs: Vec<_> = boxes.iter().map(aabb_of).collect();
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &aabbs);
    let mut pairs = Vec::new();
    let mut add = |first, second| pairs.push(Pair { first, second });
    bvh.traverse_bvtt_single_tree::<false>(&mut BvhWorkspace::default(), &mut add);
    pairs
}

/// Rapier's pairs are those of enlarged boxes, so they are tested once more. Making the colliders is not measured.
fn rapier(boxes: &[Box3], colliders: &Colliders) -> Vec<Pair> {
    let events = colliders.update(&mut BroadPhaseBvh::new(), boxes);
    let began = events.iter().filter_map(|event| match event {
        BroadPhasePairEvent::AddPair(pair) => Some(places(pair)),
        BroadPhasePairEvent::DeletePair(_) => None,
    });
    began.filter(|&pair| overlap(boxes, pair)).collect()
}

fn sorted(pairs: Vec<Pair>) -> Vec<Pair> {
    let ordered = |Pair { first, second }: Pair| Pair { first: first.min(second), second: first.max(second) };
    let mut pairs: Vec<_> = pairs.into_iter().map(ordered).collect();
    pairs.sort_unstable();
    pairs
}

fn all_pairs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("all pairs, 3D");
    group.sample_size(20);
    for count in [10, 1_000, 100_000] {
        let boxes = uniform(count, &mut random());
        let colliders = Colliders::new(count);
        let expected = sorted(find_pairs(&boxes).unwrap());
        let mut add = |name: &str, search: &dyn Fn() -> Vec<Pair>| {
            assert!(sorted(search()) == expected, "{name} finds other pairs");
            group.bench_function(BenchmarkId::new(name, count), |bencher| bencher.iter(search));
        };
        add("broadside", &|| find_pairs(&boxes).unwrap());
        add("packed_spatial_index", &|| packed(&boxes));
        add("parry", &|| parry(&boxes));
        add("rapier", &|| rapier(&boxes, &colliders));
    }
    group.finish();
}

criterion_group!(benches, all_pairs);
criterion_main!(benches);
