"""broadside.dask.pairs: the pairs of broadside.pairs, whatever the chunks, the parts and the workers that die."""

import gc
import os
import runpy
import signal
import sys

import numpy as np
import pytest
from conftest import as_set, scattered

import broadside

dask = pytest.importorskip("dask")
da = pytest.importorskip("dask.array")
dd = pytest.importorskip("dask.dataframe")
pd = pytest.importorskip("pandas")

import broadside.dask

NAMES = {4: ["xmin", "ymin", "xmax", "ymax"], 6: ["xmin", "ymin", "zmin", "xmax", "ymax", "zmax"]}


def frame_of(boxes, **more):
    return pd.DataFrame(dict(zip(NAMES[boxes.shape[1]], boxes.T)) | more)


def is_same(found, boxes, other=None):
    """Sorted, byte for byte."""
    rows = found.compute().sort_values(["first", "second"]).to_numpy()
    assert rows.dtype == np.int64
    return rows.astype(np.uint32).tobytes() == broadside.pairs(boxes, other, sort=True).tobytes()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_finds_the_pairs_of_one_set_and_of_two(dimension, dtype):
    boxes, other = scattered(5000, dimension, dtype), scattered(3000, dimension, dtype, seed=2)
    left, right = da.from_array(boxes, chunks=(900, 3)), da.from_array(other, chunks=(1000, -1))
    assert is_same(broadside.dask.pairs(left), boxes)
    assert is_same(broadside.dask.pairs(left).persist(), boxes)
    assert is_same(broadside.dask.pairs(left, right), boxes, other)
    assert is_same(broadside.dask.pairs(left, right, parts=3, algorithm="grid", threads=None), boxes, other)
    assert is_same(broadside.dask.pairs(left, left), boxes, boxes)


@pytest.mark.parametrize("direct", [10**6, 0])
def test_sorts_as_broadside_pairs_does(monkeypatch, direct):
    # With few links allowed, all go by way of groups of chunks and parts.
    monkeypatch.setattr(broadside.dask, "_MOST_DIRECT_LINKS", direct)
    boxes, other = scattered(4000), scattered(3000, seed=2)
    left, right = da.from_array(boxes, chunks=(300, -1)), da.from_array(other, chunks=(1000, -1))
    for second, array in ((None, None), (right, other)):
        expected = broadside.pairs(boxes, array, sort=True)
        for parts in (1, 5, 40):
            found = broadside.dask.pairs(left, second, parts=parts, sort=True)
            np.testing.assert_array_equal(found.compute().to_numpy(), expected)
            assert found.npartitions == 14
            assert set(found.partitions[1].compute()["first"] // 300) == {1}
            assert is_same(broadside.dask.pairs(left, second, parts=parts), boxes, array)


def test_widens_floats_beside_doubles():
    floats, doubles = scattered(2000), scattered(2000, dtype=np.float64, seed=2)
    mixed = da.concatenate([da.from_array(floats, chunks=(500, -1))])
    assert is_same(broadside.dask.pairs(mixed, da.from_array(doubles, chunks=(700, -1))), floats, doubles)
    assert is_same(broadside.dask.pairs([floats, doubles]), np.concatenate([floats.astype(float), doubles]))


def test_takes_frames_by_the_names_of_their_columns():
    for boxes in (scattered(2000), scattered(2000, 3, np.float64)):
        frame = dd.from_pandas(frame_of(boxes, name="a"), npartitions=4)
        assert is_same(broadside.dask.pairs(frame), boxes)
        names = list("abcdef")[: boxes.shape[1]]
        renamed = frame.rename(columns=dict(zip(NAMES[boxes.shape[1]], names)))
        assert is_same(broadside.dask.pairs(renamed, columns=names), boxes)
        assert is_same(broadside.dask.pairs(frame, renamed, other_columns=names), boxes, boxes)
        with pytest.raises(ValueError, match="boxes has the columns a, b, .*; expected xmin"):
            broadside.dask.pairs(renamed)
        numbers = dd.from_pandas(pd.DataFrame(boxes), npartitions=3)
        assert is_same(broadside.dask.pairs(numbers), boxes)


def test_takes_chunks_in_a_list_and_arrays_in_memory(monkeypatch):
    boxes = scattered(3000)
    pieces = [boxes[:1000], boxes[1000:1000], boxes[1000:]]
    assert is_same(broadside.dask.pairs(pieces), boxes)
    assert is_same(broadside.dask.pairs([frame_of(piece) for piece in pieces]), boxes)
    delayed = [dask.delayed(pieces[0]), pieces[1], dask.delayed(frame_of)(pieces[2])]
    assert is_same(broadside.dask.pairs(delayed), boxes)
    assert is_same(broadside.dask.pairs(dask.delayed(boxes)), boxes)
    monkeypatch.setattr(broadside._dask_chunks, "ROWS_OF_CHUNK", 700)
    for whole in (boxes, frame_of(boxes)):
        found = broadside.dask.pairs(whole, sort=True)
        assert found.npartitions == 5 and is_same(found, boxes)
    assert is_same(broadside.dask.pairs([[0, 0, 1, 1], [1, 1, 2, 2]]), [[0, 0, 1, 1], [1, 1, 2, 2]])


@pytest.mark.parametrize("sort", [False, True])
def test_takes_what_cannot_be_cut(sort):
    at_one_place = np.tile(np.array([[0, 0, 1, 1]], np.float32), (60, 1))
    with_a_huge_one = np.concatenate([scattered(1000), [[-9, -9, 9, 9], [-np.inf, -np.inf, np.inf, np.inf]]])
    absent = np.tile([[np.inf, np.inf, -np.inf, -np.inf]], (50, 1))
    for boxes in (at_one_place, with_a_huge_one, absent, np.concatenate([absent, with_a_huge_one]), np.empty((0, 6))):
        found = broadside.dask.pairs(da.from_array(boxes, chunks=(17, -1)), parts=9, sort=sort)
        assert is_same(found, boxes)
        assert is_same(broadside.dask.pairs(da.from_array(boxes, chunks=(17, -1)), boxes, sort=sort), boxes, boxes)
    assert len(broadside.dask.pairs([], sort=sort)) == 0
    assert len(broadside.dask.pairs([], scattered(10, 3), sort=sort)) == 0
    assert len(broadside.dask.pairs(scattered(10, 3), [], sort=sort)) == 0


def test_takes_chunks_that_became_empty():
    boxes = scattered(3000)
    frame = dd.from_pandas(frame_of(boxes), npartitions=6)
    some = frame[frame.xmin > 0.5].partitions[:4]
    expected = boxes[:2000][boxes[:2000, 0] > 0.5]
    assert is_same(broadside.dask.pairs(some), expected)
    none_in_some = dd.concat([frame[frame.xmin > 2], frame])
    assert is_same(broadside.dask.pairs(none_in_some), boxes)


def test_names_boxes_by_the_index():
    boxes = scattered(1000)
    labels = [f"box {row:04}" for row in range(1000)]
    frame = dd.from_pandas(frame_of(boxes).set_index(pd.Index(labels)), npartitions=4)
    other = dd.from_pandas(frame_of(boxes).set_index(np.arange(1000) + 5), npartitions=3)
    found = broadside.dask.pairs(frame, ids="index")
    assert found.dtypes.equals(found.compute().dtypes)
    rows = found.compute()
    assert as_set(broadside.pairs(boxes)) == {(int(a[4:]), int(b[4:])) for a, b in zip(rows["first"], rows["second"])}
    rows = broadside.dask.pairs(frame, other, ids="index").compute()
    assert as_set(broadside.pairs(boxes, boxes)) == {(int(a[4:]), b - 5) for a, b in zip(rows["first"], rows["second"])}
    for refused, error, message in (
        (lambda: broadside.dask.pairs(frame, ids="index", sort=True), ValueError, "expected ids of 'row'"),
        (lambda: broadside.dask.pairs(frame, ids="name"), ValueError, "ids is 'name'; expected"),
        (lambda: broadside.dask.pairs(boxes, ids="index"), TypeError, "chunk 0 of boxes is a ndarray; expected a DataFrame"),
        (
            lambda: broadside.dask.pairs([frame_of(boxes), frame_of(boxes).set_index(pd.Index(labels))], ids="index"),
            TypeError,
            "index of chunk 0 of boxes has dtype int64 and that of chunk 1 (str|object)",
        ),
    ):
        with pytest.raises(error, match=message):
            refused()


def test_reads_and_writes_parquet(tmp_path):
    boxes = scattered(3000, dtype=np.float64)
    dd.from_pandas(frame_of(boxes, name="a"), npartitions=5).to_parquet(tmp_path / "boxes")
    broadside.dask.pairs(dd.read_parquet(tmp_path / "boxes")).to_parquet(tmp_path / "pairs")
    assert is_same(dd.read_parquet(tmp_path / "pairs"), boxes)


@pytest.fixture
def geometries():
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    boxes = scattered(1500, dtype=np.float64)
    return geopandas.GeoDataFrame({"name": ["a"] * 1502}, geometry=[*shapely.box(*boxes.T), None, shapely.Polygon()])


def test_takes_the_bounds_of_geopandas(geometries):
    boxes = broadside.pairs(geometries, sort=True)
    pieces = [geometries[:500], geometries[500:500], geometries[500:]]
    for chunks in (pieces, [piece.geometry for piece in pieces], [dask.delayed(piece) for piece in pieces], geometries):
        np.testing.assert_array_equal(broadside.dask.pairs(chunks, sort=True).compute().to_numpy(), boxes)


def test_takes_dask_geopandas_and_finds_what_its_join_finds(geometries):
    dask_geopandas = pytest.importorskip("dask_geopandas")
    frame = dask_geopandas.from_geopandas(geometries, npartitions=4)
    expected = broadside.pairs(geometries, geometries, sort=True)
    for chunks in (frame, frame.geometry):
        np.testing.assert_array_equal(broadside.dask.pairs(chunks, chunks, sort=True).compute().to_numpy(), expected)
    joined = dask_geopandas.sjoin(frame, frame, predicate="intersects").compute()
    found = broadside.dask.pairs(frame, frame, ids="index").compute()
    assert set(zip(found["first"], found["second"])) == set(zip(joined.index, joined["index_right"]))


def test_names_the_chunk_and_row_of_an_invalid_box():
    boxes = scattered(1000)
    boxes[707, 0] = np.nan
    boxes[808] = [1, 1, 0, 0]
    chunks = da.from_array(boxes, chunks=(100, -1))
    message = r"box 707 of {}, row 7 of chunk 7, has min \(nan, .*; expected numbers with min <= max"
    for name, sets in (("boxes", [chunks]), ("other", [scattered(10), chunks])):
        with pytest.raises(broadside.InvalidBoxError, match=message.format(name)) as caught:
            broadside.dask.pairs(*sets)
        assert (caught.value.row, caught.value.argument) == (707, name)
    found = broadside.dask.pairs(chunks, quarantine=True, sort=True).compute()
    np.testing.assert_array_equal(found.to_numpy(), broadside.pairs(boxes, quarantine=True, sort=True))


def test_refuses_what_does_not_fit():
    boxes = scattered(100)
    frame = dd.from_pandas(frame_of(boxes), npartitions=2)
    pairs = broadside.dask.pairs
    for refused, error, message in (
        (lambda: pairs(da.zeros((10, 5))), ValueError, r"boxes has shape \(10, 5\); expected \(n, 4\) or \(n, 6\)"),
        (lambda: pairs([boxes, scattered(10, 3)]), ValueError, "chunk 0 of boxes is in 2D and chunk 1 of boxes in 3D"),
        (lambda: pairs(boxes, scattered(10, 3)), ValueError, "chunk 0 of boxes is in 2D and chunk 0 of other in 3D"),
        (lambda: pairs(da.zeros((10, 4), dtype=bool)), TypeError, "chunk 0 of boxes has dtype bool"),
        (lambda: pairs([dask.delayed("a")]), TypeError, "chunk 0 of boxes is a str"),
        (lambda: pairs(frame.xmin), TypeError, "boxes is a Series of float32; expected a DataFrame"),
        (lambda: pairs(frame.xmin, columns=list("abcd")), TypeError, "boxes is a Series of float32; expected a DataFrame"),
        (lambda: pairs(frame, columns=["xmin", "ymin", "a", "b"]), ValueError, "the columns xmin, .*; expected one column a"),
        (lambda: pairs([frame_of(boxes)], columns=["xmin", "ymin", "a", "b"]), ValueError, "chunk 0 of boxes .* expected one column a"),
        (lambda: pairs(boxes, columns=list("abcd")), ValueError, "the columns of chunk 0 of boxes are a, b, c, d"),
        (lambda: pairs(frame, columns=["xmin"]), ValueError, "the columns of boxes are xmin: "),
        (lambda: pairs(frame, columns="xmin"), ValueError, "the columns of boxes are 'xmin'; expected one of xyxy"),
        (lambda: pairs(frame, other_columns=list("abcd")), ValueError, "other_columns are given without other"),
        (lambda: pairs(boxes, parts=0), ValueError, "parts is 0; expected 1 to"),
        (lambda: pairs(boxes, algorithm="none"), broadside.InvalidAlgorithmError, "none"),
        (lambda: pairs(boxes, threads=0), ValueError, "threads is 0"),
    ):
        with pytest.raises(error, match=message):
            refused()


def test_refuses_a_chunk_that_changed_since_the_call():
    boxes = scattered(1000)
    boxes = boxes[boxes[:, 0].argsort()]
    made = []

    def changing(later):
        made.append(later)
        return boxes[:500] if len(made) == 1 else later

    for later, message in ((boxes[:400], r"chunk 0 of boxes has shape \(400, 4\); expected \(500, 4\)"), (boxes[500:], "chunk 0 .* where it had none")):
        made.clear()
        chunk = dask.delayed(changing)(later)
        found = broadside.dask.pairs([chunk, boxes[500:]], parts=20)
        with pytest.raises(ValueError, match=message):
            found.compute()


def test_says_that_it_needs_dask(monkeypatch):
    monkeypatch.setitem(sys.modules, "dask", None)
    with pytest.raises(ImportError, match=r'expected Dask: pip install "broadside\[dask\]"'):
        runpy.run_path(broadside.dask.__file__)


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        yield cluster


@pytest.fixture
def client(cluster):
    distributed = pytest.importorskip("distributed")
    with distributed.Client(cluster) as client:
        client.wait_for_workers(2)
        yield client


def test_runs_on_a_cluster_whose_errors_arrive(client):
    boxes = scattered(5000)
    chunks = da.from_array(boxes, chunks=(500, -1))
    np.testing.assert_array_equal(broadside.dask.pairs(chunks, sort=True).compute(), broadside.pairs(boxes, sort=True))
    boxes[3210] = [1, 0, 0, 1]
    with pytest.raises(broadside.InvalidBoxError, match="box 3210 of boxes, row 210 of chunk 6, has") as caught:
        broadside.dask.pairs(da.from_array(boxes, chunks=(500, -1)))
    assert (caught.value.row, caught.value.argument) == (3210, "boxes")


def test_takes_what_a_cluster_holds_already(client):
    boxes = scattered(5000)
    array = da.from_array(boxes, chunks=(500, -1))
    frame = dd.from_pandas(frame_of(boxes), npartitions=3)
    for held in (
        lambda: array.persist(),
        lambda: array.persist() + np.float32(0),
        lambda: frame.persist(),
        lambda: [dask.delayed(boxes).persist()],
    ):
        found = broadside.dask.pairs(held())  # which alone refers to them from now on
        gc.collect()
        assert is_same(found.persist(), boxes)
    held = array.persist()
    assert is_same(broadside.dask.pairs(list(held.to_delayed()[:2, 0])), boxes[:1000])


@pytest.mark.parametrize("sort", [False, True])
def test_a_killed_worker_costs_its_parts_only(cluster, client, sort):
    from distributed.diagnostics.plugin import SchedulerPlugin

    class Killer(SchedulerPlugin):
        """Kills a worker as soon as it has joined its third part, and notes who joined which part."""

        def __init__(self, pids):
            self.pids = pids
            self.killed = None
            self.joined = []

        def transition(self, key, start, finish, *args, worker=None, **kwargs):
            if (start, finish) != ("processing", "memory") or not str(key).startswith("('broadside-join"):
                return
            self.joined.append((key, worker))
            if self.killed is None and sum(who == worker for _, who in self.joined) == 3:
                self.killed = worker
                os.kill(self.pids[worker], signal.SIGKILL)

    boxes = scattered(60_000)
    found = broadside.dask.pairs(da.from_array(boxes, chunks=(6000, -1)), parts=24, sort=sort)
    killer = Killer(client.run(os.getpid))
    cluster.scheduler.add_plugin(killer, name="killer")
    rows = found.compute().to_numpy()
    cluster.scheduler.remove_plugin("killer")
    expected = broadside.pairs(boxes, sort=True)
    np.testing.assert_array_equal(rows if sort else rows[np.lexsort((rows[:, 1], rows[:, 0]))], expected)
    assert killer.killed is not None
    where = {}
    for key, worker in killer.joined:
        where.setdefault(key, []).append(worker)
    assert len(where) == 24
    again = {key: workers for key, workers in where.items() if len(workers) > 1}
    assert len(again) >= 1
    if sort:
        return  # what the killed worker had sorted may come from parts that others had joined and let go
    for workers in again.values():
        assert workers[0] == killer.killed and len(workers) == 2 and workers[1] != killer.killed
