//! Errors, handles, threads and callbacks. The examples in the documentation test the rest.
use crate::equivalence::Random;
use broadside::{
    find_pairs, find_pairs_batch, Box2, Error, Filter, FindOptions, Frame, Index, Pair, Reach, Tracker, World,
    WorldOptions,
};
use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};

const ORIGIN: Box2 = Box2::point([0.0, 0.0]);
const INVALID: Box2 = Box2::point([f32::NAN, 0.0]);

#[test]
fn have_the_library_s_version() {
    assert_eq!(broadside::version(), env!("CARGO_PKG_VERSION"));
}

#[test]
fn refuse_invalid_boxes() {
    let boxes = [ORIGIN, INVALID];
    let is_box_1 = |error: Error| matches!(error, Error::InvalidInput { index: 1, .. });
    assert!(is_box_1(find_pairs(&boxes).unwrap_err()));
    assert!(is_box_1(Tracker::new().unwrap().update(&boxes).unwrap_err()));
    assert!(is_box_1(Index::new(&boxes).err().unwrap()));
    let mut world = World::new().unwrap();
    assert!(is_box_1(world.add(&boxes).unwrap_err()));
    assert!(world.is_empty());
    let query = world.query().overlapping(INVALID);
    assert!(matches!(query, Err(Error::InvalidQuery(_))));
    let quarantine = FindOptions { quarantine: true, ..Default::default() };
    assert_eq!(quarantine.find_pairs(&boxes), Ok(vec![]));
}

/// The library would read beyond the end of a shorter array.
#[test]
fn refuse_arrays_of_other_lengths() {
    let boxes = [ORIGIN; 3];
    let (filters, radii) = ([Filter::default(); 2], [1.0; 2]);
    let all = FindOptions::default();
    let is_refused = |result: Result<(), Error>| match result {
        Err(Error::InvalidFrame(message)) => assert!(message.contains("expected"), "{message}"),
        other => panic!("{other:?}"),
    };
    for options in [
        FindOptions { filters: &filters, ..all },
        FindOptions { right_filters: &filters, ..all },
        FindOptions { reach: Reach::Radii(&radii), ..all },
        FindOptions { reach: Reach::RadiiBetween(&radii, &radii), ..all },
        FindOptions { periods: &[1.0], ..all },
    ] {
        is_refused(options.find_pairs(&boxes).map(drop));
        is_refused(options.count_pairs(&boxes, None).map(drop));
        is_refused(options.components(&boxes).map(drop));
    }
    let options = FindOptions { reach: Reach::Distance(0.0), touching: false, ..all };
    assert!(matches!(options.find_pairs(&boxes), Err(Error::InvalidArgument(_))));
    let options = FindOptions { right_filters: &filters, ..all };
    is_refused(options.find_pairs_between(&boxes, &boxes).map(drop));
    for offsets in [&[][..], &[0], &[0, 4], &[1, 3], &[0, 2, 1, 3]] {
        is_refused(find_pairs_batch(&boxes, offsets).map(drop));
    }
    let frame = Frame { changed: None, filters: &filters };
    is_refused(Tracker::new().unwrap().update_with(&boxes, &frame).map(drop));
    is_refused(Index::new(&boxes).unwrap().update_with(&boxes, &frame));
    let beyond = Frame { changed: Some(&[3]), filters: &[] };
    let mut tracker = Tracker::new().unwrap();
    tracker.update(&boxes).unwrap();
    is_refused(tracker.update_with(&boxes, &beyond).map(drop));
    let mut world = World::new().unwrap();
    is_refused(world.add_with(&boxes, &filters, &[]).map(drop));
    is_refused(world.add_with(&boxes, &[], &[1, 2]).map(drop));
    let handles = world.add(&boxes).unwrap();
    is_refused(world.move_to(&handles[..2], &boxes));
    is_refused(world.move_with_velocities(&handles, &boxes, &[[0.0, 0.0]]));
}

#[test]
fn refuse_unknown_names() {
    for algorithm in ["gird", "grid:cell=-1", "grid\0"] {
        let options = FindOptions { algorithm, ..Default::default() };
        assert!(matches!(options.find_pairs(&[ORIGIN]), Err(Error::InvalidSpec(_))), "{algorithm}");
    }
    let options = WorldOptions { settings: "world:shadows=yes", ..Default::default() };
    assert!(World::<Box2>::with_options(&options).is_err());
}

#[test]
fn refuse_handles_of_removed_boxes() {
    let mut world = World::new().unwrap();
    let old = world.add(&[ORIGIN]).unwrap()[0];
    world.remove(&[old]).unwrap();
    for _ in 0..3 {
        world.update().unwrap();
    }
    let new = world.add(&[ORIGIN]).unwrap()[0];
    assert_eq!(new.slot, old.slot);
    assert!(world.contains(new) && !world.contains(old));
    assert!(matches!(world.box_of(old), Err(Error::InvalidHandle(_))));
    assert!(matches!(world.user_data(old), Err(Error::InvalidHandle(_))));
    assert!(matches!(world.move_to(&[old], &[ORIGIN]), Err(Error::InvalidHandle(_))));
    assert!(matches!(world.remove(&[new, old]), Err(Error::InvalidHandle(_))));
    assert!(world.contains(new));
}

#[test]
fn give_events_that_outlive_other_changes() {
    let mut world = World::new().unwrap();
    let handles = world.add(&[ORIGIN; 3]).unwrap();
    world.update().unwrap();
    world.add(&[ORIGIN; 100]).unwrap();
    world.remove(&handles[..1]).unwrap();
    assert_eq!(world.events().begun.len(), 3);
    assert_eq!(world.box_of(world.events().begun[0].first), Ok(ORIGIN));
    let then = world.snapshot().unwrap();
    assert!(world.restore(b"no snapshot").is_err());
    assert_eq!(world.events().begun.len(), 3);
    world.restore(&then).unwrap();
    assert!(world.events().begun.is_empty());
    assert_eq!(world.update().unwrap().ended.len(), 2);
}

#[test]
fn stop_where_a_callback_breaks_or_panics() {
    let boxes = [ORIGIN; 200]; // 19,900 pairs, in many chunks
    let mut chunks = 0;
    let mut take = |_: &[Pair]| {
        chunks += 1;
        ControlFlow::Break(())
    };
    FindOptions::default().for_each_pairs(&boxes, None, &mut take).unwrap();
    assert_eq!(chunks, 1);
    let panic = catch_unwind(AssertUnwindSafe(|| {
        FindOptions::default().for_each_pairs(&boxes, None, |pairs| panic!("after {} pairs", pairs.len() / 100_000))
    }));
    assert_eq!(panic.unwrap_err().downcast_ref::<String>().unwrap(), "after 0 pairs");
}

#[test]
fn share_worlds_and_indexes_between_threads() {
    fn is_shared<T: Send + Sync>(shared: T) -> T {
        shared
    }
    is_shared(Tracker::<Box2>::new().unwrap());
    let boxes: Vec<_> = (0..1000).map(|i| Box2::point([i as f32, 0.0])).collect();
    let index = is_shared(Index::new(&boxes).unwrap());
    let mut world = is_shared(World::new().unwrap());
    let handles = world.add(&boxes).unwrap();
    std::thread::scope(|scope| {
        for seed in 1..4 {
            let (index, world, boxes, handles) = (&index, &world, &boxes, &handles);
            scope.spawn(move || {
                let mut random = Random(seed);
                for _ in 0..200 {
                    let place = random.below(1000) as usize;
                    assert_eq!(index.query().overlapping(boxes[place]).unwrap(), [place as u32]);
                    assert_eq!(world.query().overlapping(boxes[place]).unwrap(), [handles[place]]);
                }
            });
        }
    });
    std::thread::spawn(move || drop((world, index))).join().unwrap();
}

#[cfg(feature = "bytemuck")]
#[test]
fn take_rows_of_floats_as_boxes() {
    let rows = [0.0_f32, 0.0, 2.0, 2.0, 1.0, 1.0, 3.0, 3.0];
    let boxes: &[Box2] = bytemuck::cast_slice(&rows);
    let pairs = find_pairs(boxes).unwrap();
    assert_eq!(bytemuck::cast_slice::<Pair, u32>(&pairs), [0, 1]);
}

#[test]
fn take_vectors_of_other_crates() {
    struct Vec2(f32, f32);
    impl From<Vec2> for [f32; 2] {
        fn from(vector: Vec2) -> Self {
            [vector.0, vector.1]
        }
    }
    assert_eq!(Box2::from((Vec2(0.0, 1.0), Vec2(2.0, 3.0))), Box2::new([0.0, 1.0], [2.0, 3.0]));
    assert_eq!(Box2::from(([0.0; 2], [1.0; 2])), Box2::new([0.0; 2], [1.0; 2]));
}
