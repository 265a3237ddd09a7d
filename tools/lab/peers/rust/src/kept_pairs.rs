//! The pairs that a library's events began and did not end.

use parry3d::utils::hashmap::HashMap;

#[derive(Default)]
pub struct KeptPairs {
    pairs: Vec<(u32, u32)>,
    places: HashMap<(u32, u32), u32>, // in pairs
}

impl KeptPairs {
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.places.clear();
    }

    /// Each pair has the smaller id first.
    pub fn iter(&self) -> impl Iterator<Item = &(u32, u32)> {
        self.pairs.iter()
    }

    pub fn begin(&mut self, pair: (u32, u32)) {
        self.places.insert(pair, self.pairs.len() as u32);
        self.pairs.push(pair);
    }

    pub fn end(&mut self, pair: (u32, u32)) {
        if let Some(place) = self.places.remove(&pair) {
            self.pairs.swap_remove(place as usize);
            if let Some(moved) = self.pairs.get(place as usize) {
                self.places.insert(*moved, place);
            }
        }
    }

    pub fn retain(&mut self, keeps: impl Fn((u32, u32)) -> bool) {
        self.pairs.retain(|&pair| keeps(pair));
        self.places.clear();
        self.places.extend(self.pairs.iter().zip(0..).map(|(&pair, place)| (pair, place)));
    }
}
