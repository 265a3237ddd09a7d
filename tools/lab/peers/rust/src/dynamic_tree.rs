//! The dynamic trees of Box2D 3 and Box3D, driven as in their `b2FinalizeBodies` and `b2UpdateBroadPhasePairs`: a box
//! that leaves its margin has its leaf enlarged, the enlarged parts are rebuilt, and the tree is queried with each of
//! these boxes. The pairs of boxes with margins are kept, as the engines keep contacts.

/// `B2_MAX_AABB_MARGIN`, in lengths of a typical box, which is a metre long.
const MAX_MARGIN: f32 = 0.05;

/// `B2_AABB_MARGIN_FRACTION`, of half a diagonal.
const MARGIN_FRACTION: f32 = 0.125;

/// The queries that a thread takes at once: `b2UpdateBroadPhasePairs` has at least so many.
const QUERIES: usize = 64;

macro_rules! dynamic_tree {
    (
        $module:ident, $dimension:literal, $ffi:ident, $aabb:ident, $tree:ident, $create:ident, $destroy:ident,
        $create_proxy:ident, $destroy_proxy:ident, $move_proxy:ident, $enlarge_proxy:ident, $rebuild:ident,
        $root_bounds:ident, $query:ident $(, $require_all_bits:literal)?
    ) => {
        pub mod $module {
            use std::ffi::{c_int, c_void};
            use std::mem::transmute;
            use std::ops::ControlFlow;

            use $ffi::ffi::{
                $aabb, $create, $create_proxy, $destroy, $destroy_proxy, $enlarge_proxy, $move_proxy, $query,
                $rebuild, $root_bounds, $tree,
            };

            use rayon::prelude::*;
            use rayon::ThreadPool;

            use super::{MARGIN_FRACTION, MAX_MARGIN, QUERIES};
            use crate::peer::{pool_of, Bounds, Filter, Follower, Frame, Pairs, Searcher};

            /// All categories: of a box without a filter, and of one in a positive group, which overrides the bits.
            const ALL: u64 = u64::MAX;

            /// The category and the mask of a box.
            fn bits_of(filters: &[Filter], id: u32) -> (u64, u64) {
                let filter = filters.get(id as usize).filter(|filter| filter.group <= 0);
                filter.map_or((ALL, ALL), |filter| (filter.category, filter.mask))
            }

            fn aabb_of(bounds: Bounds<$dimension>) -> $aabb {
                // SAFETY: both are the floats of the minimum and then those of the maximum.
                unsafe { transmute(bounds) }
            }

            struct Tree($tree);

            // SAFETY: queries only read; the engine runs them in several threads.
            unsafe impl Sync for Tree {}

            // SAFETY, in these functions: the tree was created, and callers give proxies that are in it.
            impl Tree {
                fn with_capacity(count: usize) -> Self {
                    Self(unsafe { $create(count as c_int) })
                }

                fn create_proxy(&mut self, id: u32, bounds: Bounds<$dimension>, category: u64) -> c_int {
                    unsafe { $create_proxy(&mut self.0, aabb_of(bounds), category, id.into()) }
                }

                fn destroy_proxy(&mut self, proxy: c_int) {
                    unsafe { $destroy_proxy(&mut self.0, proxy) };
                }

                fn move_proxy(&mut self, proxy: c_int, bounds: Bounds<$dimension>) {
                    unsafe { $move_proxy(&mut self.0, proxy, aabb_of(bounds)) };
                }

                fn enlarge_proxy(&mut self, proxy: c_int, bounds: Bounds<$dimension>) {
                    unsafe { $enlarge_proxy(&mut self.0, proxy, aabb_of(bounds)) };
                }

                fn rebuild_enlarged(&mut self) {
                    unsafe { $rebuild(&mut self.0, false) };
                }

                /// The ids of all boxes, in the order of the leaves.
                fn leaves(&self) -> Vec<u32> {
                    let mut ids = Vec::new();
                    self.query(unsafe { $root_bounds(&self.0) }, ALL, |id| {
                        ids.push(id);
                        true
                    });
                    ids
                }

                /// Calls `found` with the id of each box that overlaps `bounds` and has a category in `mask`, as long as
                /// it returns true.
                fn query<F: FnMut(u32) -> bool>(&self, bounds: $aabb, mask: u64, mut found: F) {
                    unsafe extern "C" fn call<F: FnMut(u32) -> bool>(_: c_int, id: u64, found: *mut c_void) -> bool {
                        (*found.cast::<F>())(id as u32)
                    }
                    let context = (&raw mut found).cast();
                    unsafe { $query(&self.0, bounds, mask, $($require_all_bits,)? Some(call::<F>), context) };
                }
            }

            impl Default for Tree {
                fn default() -> Self {
                    Self::with_capacity(0)
                }
            }

            impl Drop for Tree {
                fn drop(&mut self) {
                    unsafe { $destroy(&mut self.0) };
                }
            }

            /// Calls `query` with each of `ids` and a list for the pairs that it finds, in several threads.
            fn pairs_of(
                pool: &ThreadPool,
                ids: &[u32],
                query: impl Fn(u32, &mut Vec<(u32, u32)>) + Sync,
            ) -> Vec<Vec<(u32, u32)>> {
                let of_some = |some: &[u32]| {
                    let mut found = Vec::new();
                    some.iter().for_each(|&id| query(id, &mut found));
                    found
                };
                pool.install(|| ids.par_chunks(QUERIES).map(of_some).collect())
            }

            #[derive(Default)]
            pub struct TreeSearcher {
                pool: Option<ThreadPool>,
                tree: Tree,
            }

            impl TreeSearcher {
                pub fn new(threads: usize) -> Self {
                    Self { pool: pool_of(threads), ..Self::default() }
                }
            }

            /// Calls `found` with the boxes that overlap `a`, one of each pair, as long as it returns true. With filters,
            /// static boxes look for none, and the others only for the categories of their masks: `b2FindPairsTask` does
            /// the first and considers the second.
            fn look(
                tree: &Tree,
                boxes: &[Bounds<$dimension>],
                filters: &[Filter],
                a: u32,
                mut found: impl FnMut(u32) -> bool,
            ) {
                let looks = |id: u32| !filters.get(id as usize).is_some_and(|filter| filter.is_static);
                if !looks(a) {
                    return;
                }
                let (_, mask) = bits_of(filters, a);
                tree.query(aabb_of(boxes[a as usize]), mask, |b| {
                    if a < b || a > b && !looks(b) {
                        found(b)
                    } else {
                        true
                    }
                });
            }

            impl Searcher<$dimension> for TreeSearcher {
                fn search(&mut self, boxes: &[Bounds<$dimension>], length: f32, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.search_filtered(boxes, &[], length, pairs)
                }

                fn search_filtered(
                    &mut self,
                    boxes: &[Bounds<$dimension>],
                    filters: &[Filter],
                    _: f32,
                    pairs: &mut Pairs,
                ) -> ControlFlow<()> {
                    self.tree = Tree::with_capacity(boxes.len());
                    for (id, &bounds) in (0..).zip(boxes) {
                        let (category, _) = bits_of(filters, id);
                        self.tree.create_proxy(id, bounds, category);
                    }
                    let tree = &self.tree;
                    if let Some(pool) = &self.pool {
                        let query = |a, found: &mut Vec<_>| {
                            look(tree, boxes, filters, a, |b| {
                                found.push((a, b));
                                true
                            });
                        };
                        for &(a, b) in pairs_of(pool, &tree.leaves(), query).iter().flatten() {
                            pairs.add(a, b)?;
                        }
                        return ControlFlow::Continue(());
                    }
                    let mut flow = ControlFlow::Continue(());
                    for a in tree.leaves() {
                        look(tree, boxes, filters, a, |b| {
                            flow = pairs.add(a, b);
                            flow.is_continue()
                        });
                        flow?;
                    }
                    flow
                }

                fn tear_down(&mut self) {
                    self.tree = Tree::default();
                }
            }

            /// A box in the tree, or none.
            #[derive(Clone)]
            struct Proxy {
                proxy: Option<c_int>,
                enlarged: Bounds<$dimension>,
                moved: bool, // in this frame
            }

            #[derive(Default)]
            pub struct TreeFollower {
                pool: Option<ThreadPool>,
                tree: Tree,
                max_margin: f32,
                proxies: Vec<Proxy>,    // by the boxes' ids
                moved: Vec<u32>,        // in this frame and present
                pairs: Vec<(u32, u32)>, // of enlarged boxes
            }

            impl TreeFollower {
                pub fn new(threads: usize) -> Self {
                    Self { pool: pool_of(threads), ..Self::default() }
                }

                fn grow(&mut self, count: usize) {
                    let enlarged = Bounds { min: [0.0; $dimension], max: [0.0; $dimension] };
                    self.proxies.resize(count, Proxy { proxy: None, enlarged, moved: false });
                }

                fn enlarged(&self, bounds: &Bounds<$dimension>) -> Bounds<$dimension> {
                    let diagonal = (0..$dimension).map(|axis| (bounds.max[axis] - bounds.min[axis]).powi(2)).sum::<f32>();
                    let margin = self.max_margin.min(MARGIN_FRACTION * 0.5 * diagonal.sqrt());
                    Bounds { min: bounds.min.map(|at| at - margin), max: bounds.max.map(|at| at + margin) }
                }

                fn put(&mut self, id: u32, bounds: &Bounds<$dimension>) {
                    let enlarged = self.enlarged(bounds);
                    let known = &mut self.proxies[id as usize];
                    match known.proxy {
                        None => known.proxy = Some(self.tree.create_proxy(id, enlarged, ALL)),
                        Some(_) if known.enlarged.contains(bounds) => return,
                        Some(proxy) if known.enlarged.overlaps(bounds) => self.tree.enlarge_proxy(proxy, enlarged),
                        Some(proxy) => self.tree.move_proxy(proxy, enlarged), // as b2Body_SetTransform
                    }
                    known.enlarged = enlarged;
                    known.moved = true;
                    self.moved.push(id);
                }

                fn remove(&mut self, id: u32) {
                    let known = &mut self.proxies[id as usize];
                    if let Some(proxy) = known.proxy.take() {
                        self.tree.destroy_proxy(proxy);
                        known.moved = true;
                    }
                }

                /// Finds the pairs of moved boxes anew, and passes them on.
                fn update_pairs(&mut self, mut found: impl FnMut(u32, u32)) {
                    // Box2D does this after the queries, beside its narrow phase; doing it first was up to a tenth
                    // faster.
                    self.tree.rebuild_enlarged();
                    let first = self.pairs.len();
                    let (tree, proxies) = (&self.tree, &self.proxies);
                    let query = |a: u32, pairs: &mut Vec<_>| {
                        tree.query(aabb_of(proxies[a as usize].enlarged), ALL, |b| {
                            if a < b || a > b && !proxies[b as usize].moved {
                                pairs.push((a, b));
                            }
                            true
                        });
                    };
                    match &self.pool {
                        None => self.moved.iter().for_each(|&a| query(a, &mut self.pairs)),
                        Some(pool) => self.pairs.extend(pairs_of(pool, &self.moved, query).iter().flatten()),
                    }
                    self.pairs[first..].iter().for_each(|&(a, b)| found(a, b));
                    for id in self.moved.drain(..) {
                        self.proxies[id as usize].moved = false;
                    }
                }
            }

            impl Follower<$dimension> for TreeFollower {
                fn build(&mut self, boxes: &[Bounds<$dimension>], length: f32) {
                    self.tree = Tree::with_capacity(boxes.len());
                    self.max_margin = MAX_MARGIN * length;
                    self.proxies.clear();
                    self.moved.clear();
                    self.pairs.clear();
                    self.grow(boxes.len());
                    for (id, bounds) in (0..).zip(boxes).filter(|(_, bounds)| bounds.is_present()) {
                        self.put(id, bounds);
                    }
                    self.update_pairs(|_, _| ());
                }

                fn update(&mut self, frame: &Frame<$dimension>, pairs: &mut Pairs) -> ControlFlow<()> {
                    self.grow(frame.boxes.len());
                    for &id in frame.changed {
                        let bounds = &frame.boxes[id as usize];
                        if bounds.is_present() {
                            self.put(id, bounds);
                        } else {
                            self.remove(id);
                        }
                    }
                    let mut flow = ControlFlow::Continue(());
                    let proxies = &mut self.proxies;
                    self.pairs.retain(|&(a, b)| {
                        if flow.is_continue() && frame.has_changed((a, b)) {
                            flow = pairs.add(a, b);
                        }
                        !(proxies[a as usize].moved || proxies[b as usize].moved)
                    });
                    for &id in frame.changed.iter().filter(|&&id| !frame.boxes[id as usize].is_present()) {
                        proxies[id as usize].moved = false;
                    }
                    self.update_pairs(|a, b| {
                        if flow.is_continue() {
                            flow = pairs.add(a, b);
                        }
                    });
                    flow
                }
            }
        }
    };
}

dynamic_tree!(
    box2d,
    2,
    boxdd_sys,
    b2AABB,
    b2DynamicTree,
    b2DynamicTree_Create,
    b2DynamicTree_Destroy,
    b2DynamicTree_CreateProxy,
    b2DynamicTree_DestroyProxy,
    b2DynamicTree_MoveProxy,
    b2DynamicTree_EnlargeProxy,
    b2DynamicTree_Rebuild,
    b2DynamicTree_GetRootBounds,
    b2DynamicTree_Query
);
dynamic_tree!(
    box3d,
    3,
    boxddd_sys,
    b3AABB,
    b3DynamicTree,
    b3DynamicTree_Create,
    b3DynamicTree_Destroy,
    b3DynamicTree_CreateProxy,
    b3DynamicTree_DestroyProxy,
    b3DynamicTree_MoveProxy,
    b3DynamicTree_EnlargeProxy,
    b3DynamicTree_Rebuild,
    b3DynamicTree_GetRootBounds,
    b3DynamicTree_Query,
    false
);
