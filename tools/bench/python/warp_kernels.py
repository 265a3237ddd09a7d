"""Warp compiles kernels from their source file. Their annotations are read as objects, so no `annotations` import here."""

import warp as wp


@wp.kernel
def find_pairs(
    tree: wp.uint64,
    lower: wp.array[wp.vec3],
    upper: wp.array[wp.vec3],
    is_self: bool,
    found: wp.array[wp.vec2i],
    count: wp.array[int],
):
    """Each box's query; of pairs of the boxes in the tree, each once."""
    i = wp.tid()
    query = wp.bvh_query_aabb(tree, lower[i], upper[i])
    j = int(0)
    while wp.bvh_query_next(query, j):
        if i < j or not is_self:
            at = wp.atomic_add(count, 0, 1)
            if at < found.shape[0]:
                found[at] = wp.vec2i(i, j)
