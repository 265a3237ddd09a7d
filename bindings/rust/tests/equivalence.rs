//! The same answers as testing everything, for boxes with many ties.
use broadside::{
    find_pairs, find_pairs_batch, find_pairs_between, find_pairs_within, Aabb, Bounds, FindOptions, Index, Pair, Reach,
    Tracker, World,
};
use std::collections::BTreeSet;

/// Random whole numbers: xorshift64*.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % bound
    }
}

trait Model: Bounds {
    /// A box with corners on a grid of whole numbers.
    fn random(random: &mut Random) -> Self;
    fn touches(&self, other: &Self) -> bool;
    fn distance_squared(&self, other: &Self) -> f64;
    fn along(axis: usize) -> Self::Point;
    /// Where a box that moves along an axis from 0 on meets this one.
    fn meets(&self, other: &Self, axis: usize) -> Option<f64>;
}

macro_rules! model {
    ($dimensions:literal, $real:ident) => {
        impl Model for Aabb<$dimensions, $real> {
            fn random(random: &mut Random) -> Self {
                let mut made = Self::point([0.0; $dimensions]);
                for axis in 0..$dimensions {
                    made.min[axis] = random.below(24) as $real;
                    made.max[axis] = made.min[axis] + random.below(4) as $real;
                }
                made
            }
            fn touches(&self, other: &Self) -> bool {
                self.overlaps(other)
            }
            fn distance_squared(&self, other: &Self) -> f64 {
                let gap = |axis: usize| {
                    let (left, right) = (other.min[axis] - self.max[axis], self.min[axis] - other.max[axis]);
                    f64::from(left.max(right).max(0.0))
                };
                (0..$dimensions).map(|axis| gap(axis) * gap(axis)).sum()
            }
            fn along(axis: usize) -> Self::Point {
                let mut direction = [0.0; $dimensions];
                direction[axis] = 1.0;
                direction
            }
            fn meets(&self, other: &Self, axis: usize) -> Option<f64> {
                let mut moved = *other;
                moved.min[axis] = self.min[axis];
                moved.max[axis] = self.max[axis];
                let enters = f64::from((self.min[axis] - other.max[axis]).max(0.0));
                (moved.overlaps(self) && self.max[axis] >= other.min[axis]).then_some(enters)
            }
        }
    };
}
model!(2, f32);
model!(3, f32);
model!(2, f64);
model!(3, f64);

fn boxes<B: Model>(random: &mut Random, count: usize) -> Vec<B> {
    (0..count).map(|_| B::random(random)).collect()
}

/// The places of pairs for which `holds` is true.
fn pairs_of(count: usize, holds: impl Fn(usize, usize) -> bool) -> BTreeSet<Pair> {
    let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    all.filter(|&(a, b)| holds(a, b)).map(|(a, b)| Pair { first: a as u32, second: b as u32 }).collect()
}

/// The pairs as a set; each is there once.
fn set_of(pairs: &[Pair]) -> BTreeSet<Pair> {
    let set: BTreeSet<_> = pairs.iter().copied().collect();
    assert_eq!(set.len(), pairs.len());
    set
}

fn check_pairs<B: Model>() {
    let mut random = Random(7);
    for count in [0, 1, 2, 17, 300] {
        let boxes: Vec<B> = boxes(&mut random, count);
        let expected = pairs_of(count, |a, b| boxes[a].touches(&boxes[b]));
        assert_eq!(set_of(&find_pairs(&boxes).unwrap()), expected);
        for algorithm in ["brute_force", "grid", "sweep_and_prune", "quadtree", "bvh", "auto:threads=2"] {
            let options = FindOptions { algorithm, ..Default::default() };
            assert_eq!(set_of(&options.find_pairs(&boxes).unwrap()), expected, "{algorithm}");
            assert_eq!(options.count_pairs(&boxes, None).unwrap(), expected.len() as u64);
        }
        let near = pairs_of(count, |a, b| boxes[a].distance_squared(&boxes[b]) <= 25.0);
        assert_eq!(set_of(&find_pairs_within(&boxes, Reach::Distance(5.0)).unwrap()), near);
        let radii: Vec<f64> = (0..count).map(|i| (i % 4) as f64).collect();
        let near = pairs_of(count, |a, b| boxes[a].distance_squared(&boxes[b]) <= (radii[a] + radii[b]).powi(2));
        assert_eq!(set_of(&find_pairs_within(&boxes, Reach::Radii(&radii)).unwrap()), near);

        let (left, right) = boxes.split_at(count / 3);
        let between =
            expected.iter().filter(|pair| (pair.first as usize) < left.len() && pair.second as usize >= left.len());
        let between = between.map(|pair| Pair { first: pair.first, second: pair.second - left.len() as u32 }).collect();
        assert_eq!(set_of(&find_pairs_between(left, right).unwrap()), between);
        let batch = find_pairs_batch(&boxes, &[0, count / 3, count]).unwrap();
        assert_eq!(batch.of(0), find_pairs(left).unwrap());
        assert_eq!(batch.of(1), find_pairs(right).unwrap());
        let labels = FindOptions::default().components(&boxes).unwrap();
        assert!(expected.iter().all(|pair| labels[pair.first as usize] == labels[pair.second as usize]));
    }
}

fn check_motion<B: Model>() {
    let mut random = Random(8);
    let mut now: Vec<B> = boxes(&mut random, 150);
    let mut tracker = Tracker::new().unwrap();
    let mut world = World::new().unwrap();
    let handles = world.add(&now).unwrap();
    let places = |pairs: &[broadside::HandlePair]| -> Vec<Pair> {
        pairs.iter().map(|pair| Pair { first: pair.first.slot, second: pair.second.slot }).collect()
    };
    let mut held = BTreeSet::new();
    for _ in 0..10 {
        let holds = pairs_of(now.len(), |a, b| now[a].touches(&now[b]));
        let begun: Vec<_> = holds.difference(&held).copied().collect();
        let ended: Vec<_> = held.difference(&holds).copied().collect();
        let events = tracker.update(&now).unwrap();
        assert_eq!((events.begun, events.ended), (&begun[..], &ended[..]));
        world.move_to(&handles, &now).unwrap();
        let events = world.update().unwrap();
        assert_eq!((places(events.begun), places(events.ended)), (begun, ended));
        assert_eq!(places(world.pairs().unwrap()), holds.iter().copied().collect::<Vec<_>>());
        held = holds;
        for _ in 0..20 {
            let moved = random.below(now.len() as u64) as usize;
            now[moved] = B::random(&mut random);
        }
    }
}

fn check_queries<B: Model>() {
    let mut random = Random(9);
    let boxes: Vec<B> = boxes(&mut random, 300);
    let index = Index::new(&boxes).unwrap();
    let mut world = World::new().unwrap();
    let handles = world.add(&boxes).unwrap();
    for _ in 0..50 {
        let at = B::random(&mut random);
        let expected: Vec<u32> = (0..300).filter(|&i| boxes[i as usize].touches(&at)).collect();
        let mut found = index.query().overlapping(at).unwrap();
        found.sort_unstable();
        assert_eq!(found, expected);
        let mut found = world.query().overlapping(at).unwrap();
        found.sort_unstable();
        assert_eq!(found, expected.iter().map(|&i| handles[i as usize]).collect::<Vec<_>>());

        let mut by_distance: Vec<_> =
            (0..300_u32).map(|i| (boxes[i as usize].distance_squared(&at) as u64, i)).collect();
        by_distance.sort_unstable();
        let nearest = index.query().nearest(at, 300).unwrap();
        let nearest: Vec<_> = nearest.iter().map(|one| (one.distance_squared as u64, one.id)).collect();
        assert_eq!(nearest, by_distance);

        let expected: Vec<_> = (0..300_u32)
            .filter_map(|i| Some((i, boxes[i as usize].meets(&at, 0)?)))
            .filter(|hit| hit.1 <= 9.0)
            .collect();
        let mut hits: Vec<_> =
            index.query().hits(at, B::along(0), 9.0).unwrap().iter().map(|hit| (hit.id, hit.t_enter)).collect();
        hits.sort_by_key(|hit| hit.0);
        assert_eq!(hits, expected);
        let first = world.query().first_hit(at, B::along(0), 9.0).unwrap();
        let least = expected.iter().map(|hit| hit.1).reduce(f64::min);
        assert_eq!(first.map(|hit| hit.t_enter), least);
    }
}

macro_rules! of_all_kinds {
    ($($name:ident: $check:ident,)*) => {
        $(#[test]
        fn $name() {
            $check::<Aabb<2, f32>>();
            $check::<Aabb<3, f32>>();
            $check::<Aabb<2, f64>>();
            $check::<Aabb<3, f64>>();
        })*
    };
}
of_all_kinds! {
    of_pairs: check_pairs,
    of_motion: check_motion,
    of_queries: check_queries,
}
