//! The same moving boxes in a `World` and in rapier's broad phase: the same pairs in every frame, and the times.
//!
//! `cargo run --release --example moving_boxes`
use std::collections::HashSet;
use std::time::Instant;

use broadside::{Box3, Error, HandlePair, Pair, World, WorldOptions};
use broadside_benches::{overlap, places, random, uniform, Colliders};
use rapier3d::geometry::{BroadPhaseBvh, BroadPhasePairEvent};

const FRAMES: usize = 60;

fn sorted(pairs: impl Iterator<Item = Pair>) -> Vec<Pair> {
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort_unstable();
    pairs
}

fn places_of(pair: &HandlePair) -> Pair {
    Pair { first: pair.first.slot, second: pair.second.slot }
}

/// Does it, and adds how many milliseconds it took.
fn timed<T>(times: &mut Vec<f64>, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    times.push(start.elapsed().as_secs_f64() * 1e3);
    result
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Frames in which the first `moving` of `count` boxes move by up to a twentieth of their edge along each axis.
fn compare(count: usize, moving: usize) -> Result<(), Error> {
    let mut random = random();
    let mut boxes = uniform(count, &mut random);
    let velocities: Vec<_> = (0..moving).map(|_| [random(), random(), random()].map(|at| (at - 0.5) * 0.1)).collect();

    let mut exact = World::new()?;
    let handles = exact.add(&boxes)?;
    exact.update()?;
    // Like rapier's, boxes are enlarged, so that most moves cost next to nothing; pairs are those of the enlarged boxes.
    let mut enlarged =
        World::with_options(&WorldOptions { margin: 0.1, reports_enlarged: true, ..Default::default() })?;
    assert_eq!(enlarged.add(&boxes)?, handles);
    assert!(handles.iter().zip(0..).all(|(handle, place)| handle.slot == place));
    enlarged.update()?;
    let (colliders, mut rapier) = (Colliders::new(count), BroadPhaseBvh::new());
    let mut held = HashSet::new();
    let mut hold = |events: Vec<BroadPhasePairEvent>, boxes: &[Box3]| {
        for event in events {
            match event {
                BroadPhasePairEvent::AddPair(pair) => held.insert(places(&pair)),
                BroadPhasePairEvent::DeletePair(pair) => held.remove(&places(&pair)),
            };
        }
        sorted(held.iter().copied().filter(|&pair| overlap(boxes, pair)))
    };
    hold(colliders.update(&mut rapier, &boxes), &boxes);

    let [mut exact_times, mut enlarged_times, mut rapier_times] = [vec![], vec![], vec![]];
    let mut pairs = 0;
    for _ in 0..FRAMES {
        for (bounds, velocity) in boxes.iter_mut().zip(&velocities) {
            for axis in 0..3 {
                bounds.min[axis] += velocity[axis];
                bounds.max[axis] = bounds.min[axis] + 1.0;
            }
        }
        for (world, times) in [(&mut exact, &mut exact_times), (&mut enlarged, &mut enlarged_times)] {
            timed(times, || world.move_to(&handles[..moving], &boxes[..moving]).and(world.update().map(drop)))?;
        }
        let events = timed(&mut rapier_times, || colliders.update(&mut rapier, &boxes[..moving]));

        let expected: Vec<_> = exact.pairs()?.iter().map(places_of).collect();
        let found = enlarged.pairs()?.iter().map(places_of).filter(|&pair| overlap(&boxes, pair));
        assert!(sorted(found) == expected, "enlarged boxes have other pairs");
        assert!(hold(events, &boxes) == expected, "rapier has other pairs");
        pairs = expected.len();
    }
    let [exact, enlarged, rapier] = [exact_times, enlarged_times, rapier_times].map(|mut times| median(&mut times));
    println!("{count:>7}  {moving:>7}  {pairs:>7}  {exact:>9.3}  {enlarged:>9.3}  {rapier:>9.3}");
    Ok(())
}

fn main() -> Result<(), Error> {
    println!("Median of {FRAMES} frames in ms, moves included; both have the same pairs in every frame.\n");
    println!("  boxes   moving    pairs      World   enlarged     rapier");
    for count in [1_000, 10_000, 100_000] {
        compare(count, count)?;
        compare(count, count / 10)?;
    }
    Ok(())
}
