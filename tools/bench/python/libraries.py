"""How compare.py calls each library. docs/peers.md says why so."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

import numpy as np

from rounds import KINDS, LATTICE, Driver, Library, self_pairs

Boxes = np.ndarray


def halves(boxes: Boxes) -> tuple[Boxes, Boxes]:
    half = boxes.shape[1] // 2
    return boxes[:, :half], boxes[:, half:]


def make_broadside(threads: int) -> Driver:
    broadside = importlib.import_module("broadside")
    return Driver(lambda given: broadside.pairs(*given, threads=threads))


def make_broadside_index(threads: int) -> Driver:
    broadside = importlib.import_module("broadside")
    return Driver(
        build=lambda given: (given[0], broadside.Index(given[1])),
        search=lambda built: built[1].overlapping(built[0]),
        rows=np.column_stack,
    )


def make_shapely(threads: int) -> Driver:
    shapely = importlib.import_module("shapely")

    def take(a: Boxes, b: Boxes | None) -> Any:
        return shapely.box(*a.T), None if b is None else shapely.box(*b.T)

    def build(given: Any) -> Any:
        left, right = given
        return shapely.STRtree(left if right is None else right), left, right is None

    def search(built: Any) -> Any:
        tree, left, is_self = built
        rows = tree.query(left).T  # by the bounds alone
        return self_pairs(rows) if is_self else rows

    return Driver(search, take, build)


def make_geopandas(threads: int) -> Driver:
    geopandas = importlib.import_module("geopandas")
    shapely = importlib.import_module("shapely")

    def take(a: Boxes, b: Boxes | None) -> Any:
        return [None if boxes is None else geopandas.GeoDataFrame(geometry=shapely.box(*boxes.T)) for boxes in (a, b)]

    def search(given: Any) -> Any:
        left, right = given
        right_geometry = left.geometry.array if right is None else right.geometry.array
        # A frame keeps its index once it has one.
        right = geopandas.GeoDataFrame(geometry=right_geometry.copy())
        joined = geopandas.sjoin(left, right, predicate="intersects")
        rows = np.column_stack([joined.index.to_numpy(), joined["index_right"].to_numpy()])
        return self_pairs(rows) if given[1] is None else rows

    return Driver(search, take)


def make_rtree(threads: int) -> Driver:
    index = importlib.import_module("rtree.index")

    def build(given: Any) -> Any:
        a, b = given
        lower, upper = halves(np.ascontiguousarray(a if b is None else b))
        properties = index.Property(dimension=lower.shape[1])
        return index.Index((np.arange(len(lower)), lower, upper), properties=properties), a, b is None

    def search(built: Any) -> Any:
        tree, a, is_self = built
        found, counts = tree.intersection_v(*halves(a))
        rows = np.column_stack([np.repeat(np.arange(len(a)), counts.astype(np.int64)), found])
        return self_pairs(rows) if is_self else rows

    return Driver(search, build=build)


def make_prtree(threads: int) -> Driver:
    # It uses as many threads as there are processors for it.
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:threads])
    prtree = importlib.import_module("python_prtree")

    def build(given: Any) -> Any:
        a, b = given
        kind = prtree.PRTree2D if a.shape[1] == 4 else prtree.PRTree3D
        right = a if b is None else b
        return kind(np.arange(len(right)), right), a, b is None

    def search(built: Any) -> Any:
        tree, a, is_self = built
        return tree.batch_query(a), is_self

    def rows(found: Any) -> Any:
        lists, is_self = found
        counts = [len(one) for one in lists]
        columns = [np.repeat(np.arange(len(lists)), counts), np.concatenate([np.asarray(one, np.int64) for one in lists])]
        return self_pairs(np.column_stack(columns)) if is_self else np.column_stack(columns)

    return Driver(search, build=build, rows=rows)


def make_scipy(threads: int) -> Driver:
    """A tree of points: finds centres within the longest side, and filters the overlapping boxes."""
    spatial = importlib.import_module("scipy.spatial")

    def search(given: Any) -> Any:
        a, b = given
        right = a if b is None else b
        (a_lower, a_upper), (lower, upper) = halves(a), halves(right)
        tree = spatial.cKDTree((lower + upper) / 2)
        # Rounding of centres must lose no pair.
        radius = ((a_upper - a_lower).max() / 2 + (upper - lower).max() / 2) * (1 + 1e-9)
        if b is None:
            rows = tree.query_pairs(radius, p=np.inf, output_type="ndarray")
        else:
            centres = spatial.cKDTree((a_lower + a_upper) / 2)
            found = centres.sparse_distance_matrix(tree, radius, p=np.inf, output_type="ndarray")
            rows = np.column_stack([found["i"], found["j"]])
        i, j = rows.T
        return rows[((a_lower[i] <= upper[j]) & (lower[j] <= a_upper[i])).all(axis=1)]

    return Driver(search)


def make_coal(threads: int) -> Driver:
    """Its broad phase as a physics engine uses it, with an object per box. Python can only count the pairs."""
    coal = importlib.import_module("coal")

    def objects(boxes: Boxes) -> list[Any]:
        return [coal.CollisionObject(coal.Box(*(row[3:] - row[:3])), np.eye(3), (row[3:] + row[:3]) / 2) for row in boxes]

    def build(given: Any) -> Any:
        managers = []
        for one_set in given:
            if one_set is not None:
                managers.append(coal.DynamicAABBTreeCollisionManager())
                for one in one_set:
                    managers[-1].registerObject(one)
                managers[-1].setup()
        return managers, coal.CollisionCallBackCollect(100 * len(given[0]))

    def search(built: Any) -> Any:
        (manager, *others), counter = built
        manager.collide(*others, counter)
        return counter.numCollisionPairs()

    return Driver(search, lambda a, b: (objects(a), None if b is None else objects(b)), build)


def make_ipctk(threads: int) -> Driver:
    """A box is that of a vertex which moves from one corner to the other; of two sets, edges and faces of corners."""
    ipctk = importlib.import_module("ipctk")
    ipctk.set_num_threads(threads)

    def take(a: Boxes, b: Boxes | None) -> Any:
        edges, faces = np.empty((0, 2), np.int32), np.empty((0, 3), np.int32)
        if b is None:
            return *map(np.asfortranarray, halves(a)), edges, faces
        corners = np.vstack([*halves(a), *halves(b)])
        edges = np.arange(2 * len(a)).reshape(2, -1).T
        faces = 2 * len(a) + np.arange(2 * len(b)).reshape(2, -1).T
        faces = np.column_stack([faces, faces[:, 1]])
        return np.asfortranarray(corners), *(np.asfortranarray(one.astype(np.int32)) for one in (edges, faces))

    def build(given: Any) -> Any:
        tree = ipctk.LBVH()
        tree.build(*given)
        return tree, len(given) == 4

    def search(built: Any) -> Any:
        tree, is_self = built
        return tree.detect_vertex_vertex_candidates() if is_self else tree.detect_edge_face_candidates()

    def rows(found: Any) -> Any:
        is_self = not found or hasattr(found[0], "vertex0_id")
        names = ("vertex0_id", "vertex1_id") if is_self else ("edge_id", "face_id")
        return np.column_stack([np.fromiter((getattr(one, name) for one in found), np.int64, len(found)) for name in names])

    return Driver(search, take, build, rows)


def duckdb_driver(connection: Any, columns: str, condition: str, self_condition: str = "", operator: str = "") -> Driver:
    """Joins tables of `columns`. An Arrow table would have no statistics, and DuckDB would compare all pairs of rows."""
    pyarrow = importlib.import_module("pyarrow")
    tables = 0

    def table(boxes: Boxes) -> str:
        nonlocal tables
        tables += 1
        bounds = [f"{end}_{axis}" for end in ("min", "max") for axis in "xyz"[: boxes.shape[1] // 2]]
        rows = {"id": np.arange(len(boxes))} | dict(zip(bounds, map(np.ascontiguousarray, boxes.T)))
        connection.register("boxes", pyarrow.table(rows))
        connection.execute(f"create table t{tables} as select id, {columns} from boxes")
        return f"t{tables}"

    def take(a: Boxes, b: Boxes | None) -> Any:
        left = table(a)
        right = left if b is None else table(b)
        on = " and ".join(dict.fromkeys(condition.format(x=x) for x in "xyz"[: a.shape[1] // 2]))
        query = f"select l.id as i, r.id as j from {left} l join {right} r on {on}" + (self_condition if b is None else "")
        plan = connection.execute("explain " + query).fetchall()[0][1]
        if operator not in plan:
            raise RuntimeError(f"the plan has no {operator}")
        return query, b is None and not self_condition

    def search(given: Any) -> Any:
        query, has_both_orders = given
        found = connection.execute(query).fetchnumpy()
        rows = np.column_stack([found["i"], found["j"]])
        return self_pairs(rows) if has_both_orders else rows

    return Driver(search, take)


def make_duckdb(threads: int) -> Driver:
    """Its join of any inequalities, on columns of bounds."""
    connection = importlib.import_module("duckdb").connect(config={"threads": threads})
    overlap = "l.min_{x} <= r.max_{x} and r.min_{x} <= l.max_{x}"
    return duckdb_driver(connection, "columns('m.*')", overlap, " and l.id < r.id")


def make_duckdb_spatial(threads: int) -> Driver:
    """Its join by one spatial condition: `l.id < r.id` beside it would make another plan."""
    connection = importlib.import_module("duckdb").connect(config={"threads": threads})
    extension = importlib.import_module("duckdb_extension_spatial")
    [path] = (Path(extension.__file__).parent / "extensions").glob("*/spatial.duckdb_extension")
    connection.load_extension(str(path))
    geometry = "ST_MakeEnvelope(min_x, min_y, max_x, max_y) as geom"
    return duckdb_driver(connection, geometry, "ST_Intersects_Extent(l.geom, r.geom)", operator="SPATIAL_JOIN")


def make_sedona(threads: int) -> Driver:
    context = importlib.import_module("sedonadb").connect()
    pyarrow = importlib.import_module("pyarrow")
    shapely = importlib.import_module("shapely")
    context.sql(f"set datafusion.execution.target_partitions = {threads}").execute()
    views = 0

    def view(boxes: Boxes) -> str:
        nonlocal views
        views += 1
        wkb = pyarrow.array(shapely.to_wkb(shapely.box(*boxes.T)), pyarrow.binary())
        context.create_data_frame(pyarrow.table({"id": np.arange(len(boxes)), "wkb": wkb})).to_view("wkb", overwrite=True)
        context.sql("select id, ST_GeomFromWKB(wkb) as geom from wkb").to_memtable().to_view(f"t{views}")
        return f"t{views}"

    def take(a: Boxes, b: Boxes | None) -> Any:
        left = view(a)
        return left, left if b is None else view(b), b is None

    def search(given: Any) -> Any:
        left, right, is_self = given
        condition = "ST_Intersects(l.geom, r.geom)" + (" and l.id < r.id" if is_self else "")
        return pyarrow.table(context.sql(f"select l.id as i, r.id as j from {left} l join {right} r on {condition}"))

    return Driver(search, take, rows=lambda found: np.column_stack([found["i"].to_numpy(), found["j"].to_numpy()]))


def bounds_of_floats(wp: Any, boxes: Boxes) -> tuple[Any, Any]:
    """Flat boxes at z = 0 in 2D."""
    flat = [np.pad(half, ((0, 0), (0, 3 - half.shape[1]))).astype(np.float32) for half in halves(boxes)]
    return wp.array(flat[0], dtype=wp.vec3, device="cpu"), wp.array(flat[1], dtype=wp.vec3, device="cpu")


def make_warp(threads: int) -> Driver:
    wp = importlib.import_module("warp")
    kernels = importlib.import_module("warp_kernels")

    def take(a: Boxes, b: Boxes | None) -> Any:
        return a.shape[1] // 2, bounds_of_floats(wp, a), None if b is None else bounds_of_floats(wp, b)

    def build(given: Any) -> Any:
        dimension, left, right = given
        # The fastest here of the builders for processors, with the fastest size of leaves.
        tree = wp.Bvh(*(left if right is None else right), constructor="cubql" if dimension == 2 else "median", leaf_size=8)
        return tree, left, right is None

    def search(built: Any) -> Any:
        tree, left, is_self = built
        room = 8 * len(left[0])
        while True:
            found = wp.empty(room, dtype=wp.vec2i, device="cpu")
            count = wp.zeros(1, dtype=int, device="cpu")
            wp.launch(kernels.find_pairs, len(left[0]), [tree.id, *left, is_self, found, count], device="cpu")
            room = int(count.numpy()[0])
            if room <= len(found):
                return found, room

    return Driver(search, take, build, rows=lambda found: found[0].numpy()[: found[1]])


def make_newton(threads: int) -> Driver:
    """Sweep and prune; its other broad phase compares all pairs."""
    wp = importlib.import_module("warp")
    geometry = importlib.import_module("newton.geometry")

    def take(a: Boxes, b: Boxes | None) -> Any:
        n = len(a)
        groups = wp.full(n, 1, dtype=int, device="cpu")
        worlds = wp.zeros(n, dtype=int, device="cpu")
        # A model that is simulated has one broad phase from its start.
        return geometry.BroadPhaseSAP(np.zeros(n, np.int32), sort_type="auto", device="cpu"), bounds_of_floats(wp, a), groups, worlds

    def search(given: Any) -> Any:
        phase, (lower, upper), groups, worlds = given
        n = len(groups)
        found = wp.empty(8 * n, dtype=wp.vec2i, device="cpu")
        count = wp.zeros(1, dtype=int, device="cpu")
        phase.launch(lower, upper, None, groups, worlds, n, found, count)
        return found, int(count.numpy()[0])

    return Driver(search, take, rows=lambda found: found[0].numpy()[: found[1]])


def whole(a: Boxes, b: Boxes | None) -> list[tuple[Boxes, Boxes, Boxes]]:
    """Closed intervals as the starts and ends of half-open ones of whole numbers, and their ids; twice for one set."""
    sets = [(np.rint(rows * LATTICE).astype(np.int64) + [0, 1]).T for rows in ((a, a) if b is None else (a, b))]
    return [(np.ascontiguousarray(start), np.ascontiguousarray(end), np.arange(len(start))) for start, end in sets]


def make_ncls(threads: int) -> Driver:
    ncls = importlib.import_module("ncls")

    def search(given: Any) -> Any:
        (left, right), is_self = given
        rows = np.column_stack(ncls.NCLS(*right).all_overlaps_both(*left))
        return self_pairs(rows) if is_self else rows

    return Driver(search, lambda a, b: (whole(a, b), b is None))


def make_superintervals(threads: int) -> Driver:
    superintervals = importlib.import_module("superintervals")

    def search(given: Any) -> Any:
        (left, right), is_self = given
        found = superintervals.IntervalMap.from_arrays(*right)  # it sorts what it is given
        found.build()
        return found.search_values_batch(left[0], left[1]), is_self

    def rows(found: Any) -> Any:
        lists, is_self = found
        counts = [len(one) for one in lists]
        pairs = np.column_stack([np.repeat(np.arange(len(lists)), counts), np.concatenate(lists).astype(np.int64)])
        return self_pairs(pairs) if is_self else pairs

    def take(a: Boxes, b: Boxes | None) -> Any:
        closed = [(start.astype(np.int32), (end - 1).astype(np.int32), ids) for start, end, ids in whole(a, b)]
        return closed, b is None

    return Driver(search, take, rows=rows)


def make_bioframe(threads: int) -> Driver:
    bioframe = importlib.import_module("bioframe")
    pandas = importlib.import_module("pandas")

    def take(a: Boxes, b: Boxes | None) -> Any:
        return [pandas.DataFrame({"chrom": "1", "start": start, "end": end}) for start, end, _ in whole(a, b)], b is None

    def search(given: Any) -> Any:
        (left, right), is_self = given
        found = bioframe.overlap(left, right, how="inner", return_input=False, return_index=True)
        rows = found.to_numpy(np.int64)
        return self_pairs(rows) if is_self else rows

    return Driver(search, take)


def make_broadside_intervals(threads: int) -> Driver:
    broadside = importlib.import_module("broadside")

    def search(given: Any) -> Any:
        return broadside.pairs(*(None if rows is None else broadside.intervals(*rows.T) for rows in given), threads=threads)

    return Driver(search)


LIBRARIES = (
    Library("broadside", ("broadside",), make_broadside, has_threads=True),
    Library("broadside intervals", ("broadside",), make_broadside_intervals, (1,), has_threads=True),
    Library("ncls", ("ncls",), make_ncls, (1,)),
    Library("superintervals", ("superintervals",), make_superintervals, (1,)),
    Library("bioframe", ("bioframe",), make_bioframe, (1,)),
    Library("broadside Index", ("broadside",), make_broadside_index, kinds=("queries",)),
    Library("shapely STRtree", ("shapely",), make_shapely, (2,), KINDS),
    Library("geopandas sjoin", ("geopandas", "shapely"), make_geopandas, (2,)),
    Library("rtree", ("rtree",), make_rtree, kinds=KINDS),
    Library("python-prtree", ("python-prtree",), make_prtree, kinds=KINDS, has_threads=True),
    Library("scipy cKDTree", ("scipy",), make_scipy),
    Library("coal dynamic tree", ("coal",), make_coal, (3,)),
    Library("ipctk LBVH", ("ipctk",), make_ipctk, has_threads=True),
    Library("DuckDB range join", ("duckdb", "pyarrow"), make_duckdb, has_threads=True),
    Library("DuckDB SPATIAL_JOIN", ("duckdb-extension-spatial", "duckdb", "pyarrow"), make_duckdb_spatial, (2,), has_threads=True),
    Library("SedonaDB", ("sedonadb", "shapely", "pyarrow"), make_sedona, (2,), has_threads=True),
    Library("Warp Bvh", ("warp-lang",), make_warp, kinds=KINDS),
    Library("Newton SAP", ("newton", "warp-lang"), make_newton, kinds=KINDS[:1]),
)
