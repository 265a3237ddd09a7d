"""The Arrow C data interface, with the libraries that speak it."""

import gc

import numpy as np
import pytest
from conftest import as_set, brute_force, scattered

import broadside

BOXES = scattered(200, dtype=np.float64)
NAMES = ["xmin", "ymin", "xmax", "ymax"]

pa = pytest.importorskip("pyarrow")


def test_gives_pairs_to_pyarrow_polars_and_duckdb():
    polars = pytest.importorskip("polars")
    duckdb = pytest.importorskip("duckdb")
    found = broadside.pairs(BOXES, output="arrow", sort=True)
    expected = broadside.pairs(BOXES, sort=True)
    assert len(found) == len(expected)
    table = arrow_table = pa.table(found)
    assert table.schema == pa.schema([pa.field(name, pa.uint32(), nullable=False) for name in ("first", "second")])
    batch = pa.record_batch(found)
    frame = polars.DataFrame(found)
    rows = duckdb.sql("select first, second from arrow_table").fetchnumpy()
    del found
    gc.collect()
    for first, second in (
        (table["first"], table["second"]),
        (batch["first"], batch["second"]),
        (frame["first"], frame["second"]),
        (rows["first"], rows["second"]),
    ):
        np.testing.assert_array_equal(np.column_stack([np.asarray(first), np.asarray(second)]), expected)


def test_gives_no_pairs_as_an_empty_table():
    assert pa.table(broadside.pairs(np.empty((0, 4)), output="arrow")).num_rows == 0


def test_shares_the_memory_of_the_table():
    found = broadside.pairs(BOXES, output="arrow")
    before = pa.total_allocated_bytes()
    tables = [pa.table(found) for _ in range(3)]
    assert pa.total_allocated_bytes() == before
    addresses = {table["first"].chunk(0).buffers()[1].address for table in tables}
    assert len(addresses) == 1


def table_of(boxes, type=None):
    return pa.table({name: pa.array(boxes[:, i], type) for i, name in enumerate(NAMES)})


def test_takes_tables_and_arrays():
    polars = pytest.importorskip("polars")
    duckdb = pytest.importorskip("duckdb")
    table = arrow_table = table_of(BOXES)
    lists = pa.FixedSizeListArray.from_arrays(pa.array(BOXES.ravel()), 4)
    structs = pa.StructArray.from_arrays([column.combine_chunks() for column in table.columns], NAMES)
    chunked = pa.concat_tables([table.slice(0, 70), table.slice(70, 1), table.slice(71)])
    expected = brute_force(BOXES)
    for found in (
        table,
        table.select(NAMES[::-1]),
        chunked,
        table.to_batches()[0],
        lists,
        structs,
        pa.chunked_array([lists.slice(0, 90), lists.slice(90)]),
        polars.DataFrame(dict(zip(NAMES, BOXES.T))),
        duckdb.sql("select * from arrow_table"),
        table.append_column("n", pa.array(range(200))),
    ):
        assert as_set(broadside.pairs(found)) == expected, type(found)
    part = table.slice(50, 100)
    assert as_set(broadside.pairs(part)) == brute_force(BOXES[50:150])
    assert as_set(broadside.pairs(lists.slice(50, 100))) == brute_force(BOXES[50:150])
    assert as_set(broadside.pairs(structs.slice(50, 100))) == brute_force(BOXES[50:150])


def test_takes_tables_of_no_rows_in_their_dimension():
    flat = table_of(BOXES).schema.empty_table()
    names = ["xmin", "ymin", "zmin", "xmax", "ymax", "zmax"]
    solid = pa.schema([(name, pa.float32()) for name in names]).empty_table()
    lists = pa.chunked_array([], pa.list_(pa.float32(), 6))
    for found in (solid, lists):
        assert broadside.count(found, np.zeros((2, 6))) == 0
        with pytest.raises(ValueError, match="3D and other in 2D"):
            broadside.pairs(found, flat)
    assert broadside.Index(solid).dtype == np.float32
    with pytest.raises(ValueError, match="has the columns a"):
        broadside.pairs(pa.schema([("a", pa.float32())]).empty_table())


class Same:
    """Gives what it was made of at each call."""

    def __init__(self, table, name):
        self.capsules = getattr(table, name)()
        setattr(type(self), name, lambda self, requested_schema=None: self.capsules)


@pytest.mark.parametrize("name", ["__arrow_c_stream__", "__arrow_c_array__"])
def test_refuses_what_was_taken_already(name):
    table = table_of(BOXES)
    once = type("Once", (Same,), {})(table if "stream" in name else table.to_batches()[0], name)
    assert as_set(broadside.pairs(once)) == brute_force(BOXES)
    with pytest.raises(ValueError, match="was already taken"):
        broadside.pairs(once)


def test_takes_floats_and_integers():
    whole = np.round(BOXES * 100)
    for type in (pa.int8(), pa.uint16(), pa.int32(), pa.int64(), pa.float16(), pa.float32()):
        assert as_set(broadside.pairs(table_of(whole, type))) == brute_force(whole)


def test_refuses_nulls_and_other_types():
    for found, error, message in [
        (table_of(BOXES).set_column(2, "xmax", pa.array([1.0] * 199 + [None])), broadside.InvalidBoxError, "box 199"),
        (table_of(BOXES).set_column(0, "xmin", pa.array(["a"] * 200)), TypeError, "'xmin' is of type text; expected floats"),
        (table_of(BOXES).set_column(0, "xmin", pa.array([True] * 200)), TypeError, "of type bool"),
        (table_of(BOXES).set_column(0, "xmin", pa.array([1] * 200).dictionary_encode()), TypeError, "of type dictionary"),
        (pa.array([1.0, 2.0]), (TypeError, ValueError), "expected"),
        (pa.table({"a": [1.0], "b": [2.0]}), ValueError, "has the columns a, b"),
        (pa.array([0.0] * 8).dictionary_encode(), (TypeError, ValueError), "expected"),
    ]:
        with pytest.raises(error, match=message):
            broadside.pairs(found)
