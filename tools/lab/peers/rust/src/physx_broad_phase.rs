//! PhysX's broad phases through their low-level interface, `PxBroadPhase`: batches of boxes that are added, moved and
//! removed, and events of pairs that begin and end.

use std::ops::ControlFlow;
use std::slice;
use std::sync::Once;

use physx_sys::{
    phys_PxCreateBroadPhase, phys_PxGetBroadPhaseDynamicFilterGroup, physx_create_foundation, PxBroadPhase,
    PxBroadPhaseDesc_new, PxBroadPhasePair, PxBroadPhaseResults_new, PxBroadPhaseType, PxBroadPhaseUpdateData_new,
    PxBroadPhase_release_mut, PxBroadPhase_update_mut_1,
};

use crate::kept_pairs::KeptPairs;
use crate::peer::{Bounds, Follower, Frame, Pairs, Searcher};

fn ids(pair: &PxBroadPhasePair) -> (u32, u32) {
    (pair.mID0.min(pair.mID1), pair.mID0.max(pair.mID1))
}

/// A broad phase and the arrays that it reads, by id.
struct Phase {
    kind: PxBroadPhaseType,
    phase: Option<*mut PxBroadPhase>,
    bounds: Vec<Bounds<3>>,
    groups: Vec<u32>,
    distances: Vec<f32>,
}

impl Phase {
    fn new(kind: PxBroadPhaseType) -> Self {
        Self { kind, phase: None, bounds: Vec::new(), groups: Vec::new(), distances: Vec::new() }
    }

    fn release(&mut self) {
        if let Some(phase) = self.phase.take() {
            // SAFETY: it was created, and nothing else has it.
            unsafe { PxBroadPhase_release_mut(phase) };
        }
    }

    fn restart(&mut self) {
        static FOUNDATION: Once = Once::new();
        // SAFETY: the first call creates what all broad phases share.
        FOUNDATION.call_once(|| assert!(!unsafe { physx_create_foundation() }.is_null()));
        self.release();
        // SAFETY: the description is complete.
        self.phase = Some(unsafe { phys_PxCreateBroadPhase(&PxBroadPhaseDesc_new(self.kind)) });
    }

    /// Makes room for `count` ids, and one more, which PhysX may read.
    fn grow(&mut self, count: usize) {
        self.bounds.resize(count + 1, Bounds { min: [0.0; 3], max: [0.0; 3] });
        self.distances.resize(count + 1, 0.0);
        // Boxes of one group form no pairs. SAFETY: a function of the id alone.
        self.groups
            .extend((self.groups.len()..=count).map(|id| unsafe { phys_PxGetBroadPhaseDynamicFilterGroup(id as u32) }));
    }

    fn set(&mut self, id: u32, bounds: &Bounds<3>) {
        // -0 and 0 differ in the integers that PhysX sorts; the sum is never -0.
        self.bounds[id as usize] = Bounds { min: bounds.min.map(|at| at + 0.0), max: bounds.max.map(|at| at + 0.0) };
    }

    /// The pairs that began and those that ended. Valid until the next call.
    fn update(&mut self, created: &[u32], updated: &[u32], removed: &[u32]) -> [&[PxBroadPhasePair]; 2] {
        let phase = self.phase.expect("a broad phase");
        // SAFETY: the slices outlive the call, and PxBounds3 is the floats of the minimum and then of the maximum.
        unsafe {
            let data = PxBroadPhaseUpdateData_new(
                created.as_ptr(),
                created.len() as u32,
                updated.as_ptr(),
                updated.len() as u32,
                removed.as_ptr(),
                removed.len() as u32,
                self.bounds.as_ptr().cast(),
                self.groups.as_ptr(),
                self.distances.as_ptr(),
                self.bounds.len() as u32,
            );
            let mut results = PxBroadPhaseResults_new();
            PxBroadPhase_update_mut_1(phase, &mut results, &data);
            let pairs = |data: *const PxBroadPhasePair, count: u32| match count {
                0 => &[][..],
                _ => slice::from_raw_parts(data, count as usize),
            };
            [
                pairs(results.mCreatedPairs, results.mNbCreatedPairs),
                pairs(results.mDeletedPairs, results.mNbDeletedPairs),
            ]
        }
    }
}

impl Drop for Phase {
    fn drop(&mut self) {
        self.release();
    }
}

pub struct PhaseSearcher(Phase);

impl PhaseSearcher {
    pub fn new(kind: PxBroadPhaseType) -> Self {
        Self(Phase::new(kind))
    }
}

impl Searcher<3> for PhaseSearcher {
    fn search(&mut self, boxes: &[Bounds<3>], _: f32, pairs: &mut Pairs) -> ControlFlow<()> {
        self.0.restart();
        self.0.grow(boxes.len());
        let created: Vec<u32> = (0..boxes.len() as u32).collect();
        for (id, bounds) in (0..).zip(boxes) {
            self.0.set(id, bounds);
        }
        let [begun, _] = self.0.update(&created, &[], &[]);
        for (a, b) in begun.iter().map(ids) {
            // Some broad phases round bounds.
            if boxes[a as usize].overlaps(&boxes[b as usize]) {
                pairs.add(a, b)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn tear_down(&mut self) {
        self.0.release();
    }
}

pub struct PhaseFollower {
    phase: Phase,
    is_there: Vec<bool>, // by id
    created: Vec<u32>,
    updated: Vec<u32>,
    removed: Vec<u32>,
    pairs: KeptPairs,
}

impl PhaseFollower {
    pub fn new(kind: PxBroadPhaseType) -> Self {
        Self {
            phase: Phase::new(kind),
            is_there: Vec::new(),
            created: Vec::new(),
            updated: Vec::new(),
            removed: Vec::new(),
            pairs: KeptPairs::default(),
        }
    }

    fn put(&mut self, id: u32, bounds: &Bounds<3>) {
        let known = std::mem::replace(&mut self.is_there[id as usize], bounds.is_present());
        if bounds.is_present() {
            self.phase.set(id, bounds);
            if known { &mut self.updated } else { &mut self.created }.push(id);
        } else if known {
            self.removed.push(id);
        }
    }
}

impl Follower<3> for PhaseFollower {
    fn build(&mut self, boxes: &[Bounds<3>], _: f32) {
        *self = Self::new(self.phase.kind);
        self.phase.restart();
        self.phase.grow(boxes.len());
        self.is_there.resize(boxes.len(), false);
        for (id, bounds) in (0..).zip(boxes) {
            self.put(id, bounds);
        }
        let [begun, _] = self.phase.update(&self.created, &[], &[]);
        begun.iter().map(ids).for_each(|pair| self.pairs.begin(pair));
    }

    fn update(&mut self, frame: &Frame<3>, pairs: &mut Pairs) -> ControlFlow<()> {
        self.phase.grow(frame.boxes.len());
        self.is_there.resize(frame.boxes.len(), false);
        self.created.clear();
        self.updated.clear();
        self.removed.clear();
        for &id in frame.changed {
            self.put(id, &frame.boxes[id as usize]);
        }
        for &(a, b) in self.pairs.iter().filter(|&&pair| frame.has_changed(pair)) {
            pairs.add(a, b)?;
        }
        if !self.removed.is_empty() {
            // PhysX reports no end for their pairs.
            let is_there = |id: u32| self.is_there[id as usize];
            self.pairs.retain(|(a, b)| is_there(a) && is_there(b));
        }
        let [begun, ended] = self.phase.update(&self.created, &self.updated, &self.removed);
        ended.iter().map(ids).for_each(|pair| self.pairs.end(pair));
        for (a, b) in begun.iter().map(ids) {
            self.pairs.begin((a, b));
            pairs.add(a, b)?;
        }
        ControlFlow::Continue(())
    }
}
