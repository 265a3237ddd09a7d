//! Finds out which pairs Box2D 3 and Box3D hold.

use std::collections::BTreeSet;

use crate::peer::{Bounds, Pairs};

pub const EVERYWHERE: f32 = 1e9; // half the width of what debug drawing draws

#[derive(Default)]
pub struct Contacts {
    held: BTreeSet<(u32, u32)>,
    enlarged: Vec<Bounds<3>>, // the box of each slot in the engine's tree
    pub drawn: usize,         // the slot of the shape drawn last
}

impl Contacts {
    /// Called when the engine asks whether it may make a pair. It also asks before it sweeps a fast body; `finish_step`
    /// drops those pairs.
    pub fn begin(&mut self, a: u32, b: u32) {
        self.held.insert((a.min(b), a.max(b)));
    }

    pub fn remove(&mut self, slot: u32) {
        self.held.retain(|&(a, b)| a != slot && b != slot);
    }

    /// Takes the enlarged box of the shape drawn last.
    pub fn enlarged_drawn(&mut self, bounds: Bounds<3>) {
        let nowhere = Bounds { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };
        self.enlarged.resize(self.enlarged.len().max(self.drawn + 1), nowhere);
        self.enlarged[self.drawn] = bounds;
    }

    pub fn enlarged(&self, slot: u32) -> Bounds<3> {
        self.enlarged[slot as usize]
    }

    /// Ends pairs as the engine does: a pair with an awake body ends if its enlarged boxes did not overlap when the
    /// step began. Panics if the engine then holds a different number of pairs.
    pub fn finish_step(&mut self, awake: &[bool], count: usize, pairs: &mut Pairs) {
        let Self { held, enlarged, .. } = self;
        held.retain(|&(a, b)| {
            let (a, b) = (a as usize, b as usize);
            enlarged[a].overlaps(&enlarged[b]) || !(awake[a] || awake[b])
        });
        assert_eq!(held.len(), count, "pairs by the engine's events and enlarged boxes, and contacts that it counts");
        for &(a, b) in &*held {
            let _ = pairs.add(a, b);
        }
    }
}
