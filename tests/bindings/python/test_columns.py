"""Tables of boxes: which columns are the bounds, what is exact in them, and what is missing."""

import decimal

import numpy as np
import pytest
from conftest import as_set, brute_force, scattered

import broadside

pandas = pytest.importorskip("pandas")
polars = pytest.importorskip("polars")
pa = pytest.importorskip("pyarrow")

BOXES = scattered(50, dtype=np.float64)
PAIRS = brute_force(BOXES)
NAMES = ["xmin", "ymin", "xmax", "ymax"]


def structured(columns):
    made = np.zeros(len(next(iter(columns.values()))), [(name, np.asarray(values).dtype) for name, values in columns.items()])
    for name, values in columns.items():
        made[name] = values
    return made


TABLES = {"pandas": pandas.DataFrame, "polars": polars.DataFrame, "arrow": pa.table, "structured": structured}
tables = pytest.mark.parametrize("table", TABLES.values(), ids=TABLES.keys())


def columns_of(boxes, names):
    return {name: boxes[:, i].copy() for i, name in enumerate(names)}


@tables
@pytest.mark.parametrize(
    "names", [NAMES, ["minx", "miny", "maxx", "maxy"], ["west", "south", "east", "north"], ["x1", "y1", "x2", "y2"], ["left", "bottom", "right", "top"]]
)
def test_finds_the_columns_that_files_have(table, names):
    assert as_set(broadside.pairs(table(columns_of(BOXES, names)))) == PAIRS


@tables
def test_top_and_bottom_follow_the_data(table):
    # As images have them: y grows downwards.
    images = table(columns_of(BOXES[:, [0, 1, 2, 3]], ["left", "top", "right", "bottom"]))
    maps = table(columns_of(BOXES[:, [0, 3, 2, 1]], ["left", "top", "right", "bottom"]))
    for found in (images, maps):
        assert as_set(broadside.pairs(found)) == PAIRS
        np.testing.assert_array_equal(broadside.Index(found).boxes, BOXES)


@tables
def test_one_wrong_row_does_not_turn_top_and_bottom(table):
    maps = BOXES[:, [0, 3, 2, 1]]
    maps[7, [1, 3]] = maps[7, [3, 1]]
    found = table(columns_of(maps, ["left", "top", "right", "bottom"]))
    np.testing.assert_array_equal(broadside.invalid_rows(found), [7])


def sizes_of(boxes):
    return np.hstack([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]])


WHOLE = np.round(BOXES * 1000)


@tables
def test_takes_the_columns_that_a_caller_names(table):
    corner = columns_of(sizes_of(WHOLE), ["x", "y", "w", "h"])
    centre = columns_of(np.hstack([(WHOLE[:, :2] + WHOLE[:, 2:]) / 2, WHOLE[:, 2:] - WHOLE[:, :2]]), ["x", "y", "w", "h"])
    expected = brute_force(WHOLE)
    with pytest.raises(ValueError, match="may be a minimum or a centre"):
        broadside.pairs(table(corner))
    for columns in ("xywh", ["x", "y", "w", "h"]):
        assert as_set(broadside.pairs(table(corner), columns=columns)) == expected
        np.testing.assert_array_equal(broadside.Index(table(corner), columns=columns).boxes, WHOLE)
    np.testing.assert_array_equal(broadside.Index(table(centre), columns="cxcywh").boxes, WHOLE)
    letters = table(columns_of(WHOLE, "abcd") | {"other": np.zeros(50)})
    np.testing.assert_array_equal(broadside.Index(letters, columns=list("abcd")).boxes, WHOLE)
    for columns, message in [
        (["a", "b", "c", "e"], "has the columns a, b, c, d, other; expected one column e"),
        (["a", "b", "c"], "the columns of boxes are a, b, c: .*expected xmin"),
        ("xywh", "has the columns a, b, c, d, other .*; expected columns of 'xywh'"),
        ("whxy", "the columns of boxes are 'whxy'; expected one of xyxy, xywh"),
    ]:
        with pytest.raises(ValueError, match=message):
            broadside.pairs(letters, columns=columns)
    for columns in (7, [7], [["a"]]):
        with pytest.raises(TypeError, match="expected a str or a list of names"):
            broadside.pairs(letters, columns=columns)


@pytest.mark.parametrize("made", [np.asarray, np.ndarray.tolist, pandas.DataFrame, lambda rows: pa.FixedSizeListArray.from_arrays(pa.array(rows.ravel()), rows.shape[1])])
def test_rows_without_names_are_what_a_caller_says(made):
    solid = np.round(scattered(20, 3, np.float64) * 1000)
    sizes = np.hstack([solid[:, :3], solid[:, 3:] - solid[:, :3]])
    centres = np.hstack([(solid[:, :3] + solid[:, 3:]) / 2, solid[:, 3:] - solid[:, :3]])
    for rows, columns, expected in [
        (WHOLE, "xyxy", WHOLE),
        (sizes_of(WHOLE), "xywh", WHOLE),
        (sizes_of(WHOLE), ["x", "y", "w", "h"], WHOLE),
        (WHOLE[:, [0, 2, 1, 3]], ["xmin", "xmax", "ymin", "ymax"], WHOLE),
        (solid, "xyzxyz", solid),
        (sizes, "xyzwhd", solid),
        (centres, "cxcyczwhd", solid),
    ]:
        np.testing.assert_array_equal(broadside.Index(made(rows), columns=columns).boxes, expected)
    with pytest.raises(ValueError, match="has 4 columns, and columns is 'xyzwhd'; expected 6"):
        broadside.pairs(made(WHOLE), columns="xyzwhd")


def test_names_the_convention_by_which_all_rows_are_valid():
    rows = np.array([[0, 0, 10, 10], [12, 12, 6, 4.0]])
    calls = (broadside.pairs, broadside.count, broadside.components, broadside.Index, broadside.Tracker(2).update)
    for call in (*calls, broadside.World(2).add, lambda found: broadside.pairs(WHOLE, found)):
        with pytest.raises(broadside.InvalidBoxError, match="would be valid with columns='xywh' or columns='cxcywh' .check") as caught:
            call(rows)
        assert caught.value.row == 1
        with pytest.raises(broadside.InvalidBoxError, match="would be valid with columns='xywh'"):
            call(pandas.DataFrame({"image": [1, 1], "bbox": rows.tolist()}))
        for names in (NAMES, ["x1", "y1", "x2", "y2"]):
            with pytest.raises(broadside.InvalidBoxError, match="would be valid as an array without names and with columns='xywh'"):
                call(pandas.DataFrame(rows, columns=names))
    rows[0, 2] = -1
    with pytest.raises(broadside.InvalidBoxError) as caught:
        broadside.pairs(rows)
    assert "columns=" not in str(caught.value)
    solid = np.array([[0, 0, 1, 1, 5, 6], [0, 1, 2, 3, 4, np.nan]])  # four of its columns are boxes in 2D
    with pytest.raises(broadside.InvalidBoxError) as caught:
        broadside.pairs(solid)
    assert "columns=" not in str(caught.value)


def test_says_how_many_rows_are_invalid_and_whether_one_is_swapped():
    rows = WHOLE.copy()
    rows[7, [1, 3]] = rows[7, [3, 1]]
    swapped = r"^1 of 50 rows is invalid: (added )?box 7 has .* \(are its minimum and maximum on y swapped\?\)$"
    for call in (broadside.pairs, broadside.components, broadside.Index, broadside.Tracker(2).update, broadside.World(2).add):
        for found in (rows, pandas.DataFrame(rows, columns=NAMES), pandas.DataFrame({"bbox": rows.tolist()})):
            with pytest.raises(broadside.InvalidBoxError, match=swapped):
                call(found)
    with pytest.raises(broadside.InvalidBoxError, match="^other: 1 of 50 rows is invalid: box 7 has .*swapped") as caught:
        broadside.pairs(WHOLE, rows)
    assert (caught.value.row, caught.value.argument) == (7, "other")
    rows[[3, 7]] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="^2 of 50 rows are invalid: box 3 has ") as caught:
        broadside.count(rows)
    assert "swapped" not in str(caught.value)
    with pytest.raises(broadside.InvalidBoxError, match="^1 of 50 rows is invalid: box 7 has ") as caught:
        broadside.count(np.insert(sizes_of(WHOLE)[1:], 7, [0, 0, -1, 1], axis=0), columns="xywh")
    assert "swapped" not in str(caught.value)


def test_names_the_row_of_a_list_that_has_another_length():
    for rows in ([None, [0, 0, 1, 1], [0, 0, 1]], [None, np.zeros(4), np.zeros(3)]):
        with pytest.raises(ValueError, match="column bbox of boxes has 4 elements in row 1 and 3 in row 2; expected rows of the same length"):
            broadside.pairs(pandas.DataFrame({"bbox": rows}))
    with pytest.raises(ValueError, match="boxes has no columns; expected xmin, ymin"):
        broadside.pairs(pandas.DataFrame())


def test_two_columns_are_no_points_if_one_has_boxes():
    frame = pandas.DataFrame({"image": [1, 1], "bbox": [[0, 0, 2, 2], [1, 1, 3, 3]]})
    assert len(broadside.Index(frame).overlapping(frame).box) == 4
    assert broadside.pairs(frame, within=1).tolist() == [[0, 1]]


@pytest.mark.parametrize("order", [["xmin", "xmax", "ymin", "ymax"], ["xmin", "ymax", "xmax", "ymin"]])
def test_names_an_order_before_the_conventions(order):
    rows = WHOLE[:, [NAMES.index(name) for name in order]]
    with pytest.raises(broadside.InvalidBoxError) as caught:
        broadside.pairs(rows)
    assert f"would be valid with columns={order}" in str(caught.value)
    np.testing.assert_array_equal(broadside.Index(rows, columns=order).boxes, WHOLE)


def test_each_function_of_boxes_takes_columns():
    rows, kinds = sizes_of(WHOLE), {"columns": "xywh"}
    expected = brute_force(WHOLE)
    assert broadside.count(rows, **kinds) == len(expected)
    assert as_set(broadside.pairs(rows, WHOLE, **kinds)) == as_set(broadside.pairs(WHOLE, rows, other_columns="xywh"))
    world = broadside.World(2)
    handles = world.add(rows, **kinds)
    world.move(handles, rows, **kinds)
    np.testing.assert_array_equal(world.boxes(handles), WHOLE)
    assert as_set(broadside.Tracker(2).update(rows, **kinds).begun) == expected
    partition = broadside.Partition(rows, 3, **kinds)
    np.testing.assert_array_equal(partition.assign(rows, **kinds).row, partition.assign(WHOLE).row)
    assert broadside.draw(rows, **kinds).svg == broadside.draw(WHOLE).svg
    rows[7, 2] = -1
    assert broadside.invalid_rows(rows, **kinds).tolist() == [7]
    with pytest.raises(broadside.InvalidBoxError, match="box 7"):
        broadside.advise(rows, budget=0.1, **kinds)
    with pytest.raises(ValueError, match="other_columns are given without other"):
        broadside.pairs(rows, other_columns="xywh")


HUGE = 2**53 + 1  # which float64 does not hold


@tables
def test_refuses_integers_of_mixed_tables_that_float64_does_not_hold(table):
    # Rounded, the boxes would touch.
    for kind in (np.int64, np.uint64):
        columns = {
            "xmin": np.array([0, HUGE], kind),
            "ymin": np.array([0.5, 0.5]),
            "xmax": np.array([HUGE - 1, HUGE + 1], kind),
            "ymax": np.array([1.0, 1.0], np.float32),
        }
        with pytest.raises(ValueError, match=f"column xmin of boxes is {HUGE} in row 1, which float64 does not hold"):
            broadside.pairs(table(columns))
        columns["xmin"][1] += 1
        assert broadside.count(table(columns)) == 0
    with pytest.raises(ValueError, match="column y of points is 9007199254740993 in row 0"):
        broadside.Index(BOXES).containing(table({"x": np.array([0.5]), "y": np.array([HUGE])}))


@pytest.mark.parametrize(
    "values",
    [[0, HUGE], [decimal.Decimal(0), decimal.Decimal(HUGE)], pandas.array([0, HUGE], "Int64"), pandas.array([0, HUGE], "UInt64"),
     pandas.array([0, HUGE], "int64[pyarrow]"), [0, 10**400], [0, 2**64 + 1]],
    ids=["int", "Decimal", "Int64", "UInt64", "arrow", "10**400", "2**64 + 1"],
)  # fmt: skip
def test_refuses_integers_of_any_column_of_pandas(values):
    series = values if hasattr(values, "dtype") else pandas.Series(values, dtype=object)
    frame = pandas.DataFrame({"xmin": series, "ymin": [0.5, 0.5], "xmax": [1e300, 1e300], "ymax": [1.0, 1.0]})
    with pytest.raises(ValueError, match="column xmin of boxes is [0-9]* in row 1, which float64 does not hold"):
        broadside.pairs(frame)


def test_refuses_integers_of_nested_lists():
    for rows in ([[0, 0, HUGE - 1, 1], [HUGE, 0.5, HUGE + 1, 1]], ((0, 0.0, 1, 1), (0, 0, HUGE, 1)), [[0, 0.5, 2**64 + 1, 1]]):
        with pytest.raises(ValueError, match="boxes is [0-9]* in row [01], which float64 does not hold"):
            broadside.pairs(rows)
    assert broadside.count([[0, 0, 2**64, 1], [2**64, 0.5, 1e300, 1], [float("inf"), 0, float("inf"), 1]]) == 1
    assert broadside.count([[decimal.Decimal("0.5"), 0, 1, 1], [1, 0, 2, 1]]) == 1


def test_refuses_integers_of_chunks():
    dask_frame = pytest.importorskip("dask.dataframe")
    import broadside.dask

    frame = pandas.DataFrame({"xmin": [0, HUGE], "ymin": [0.5, 0.5], "xmax": [HUGE - 1, HUGE + 1], "ymax": [1.0, 1.0]})
    chunked = dask_frame.from_pandas(frame, npartitions=1)
    for call in (broadside.dask.pairs, broadside.pairs):
        with pytest.raises(ValueError, match=f"column xmin of .*boxes is {HUGE} in row 1"):
            call(chunked)


def test_refuses_columns_of_one_name():
    doubled = pandas.DataFrame(np.zeros((2, 6)), columns=["xmin", "ymin", "xmin", "xmax", "ymax", "ymax"])
    arrow = pa.table([pa.array([0.0])] * 5, names=["xmin", "ymin", "xmax", "ymax", "xmax"])
    for found in (doubled, arrow, doubled.rename(columns={"xmin": "XMin"})):
        with pytest.raises(ValueError, match="columns .* mean the same"):
            broadside.pairs(found)
    with pytest.raises(ValueError, match="boxes has 2 columns xmin; expected one column xmin"):
        broadside.pairs(doubled, columns=NAMES)


@tables
def test_refuses_half_of_a_pair_of_bounds(table):
    for name in ("zmin", "zmax"):
        with pytest.raises(ValueError, match=f"column '?{name}'? alone does not give bounds on the z axis"):
            broadside.pairs(table(columns_of(BOXES, NAMES) | {name: np.zeros(50)}))


def test_looks_at_no_other_columns():
    other = {"text": ["a", None] * 25, "when": pandas.to_datetime([0] * 50), "flag": [True] * 50, "huge": [HUGE] * 50}
    lists = {"lists": [[1, 2], None] * 25, "objects": [{"a": 1}] * 50}
    frame = pandas.DataFrame(columns_of(BOXES, NAMES) | other | lists)
    table = pa.table(columns_of(BOXES, NAMES) | other | lists)
    table = table.append_column("codes", pa.array(["a", "b"] * 25).dictionary_encode())
    table = table.append_column("nothing", pa.nulls(50))
    for found in (frame, table, polars.DataFrame(table.drop_columns(["when"]))):
        assert as_set(broadside.pairs(found)) == PAIRS


def test_takes_a_struct_of_bounds():
    rows = [dict(zip(NAMES, row)) for row in BOXES.tolist()]
    numbers = pa.array(range(50))
    for kind in (pa.float64(), pa.float32()):
        struct = pa.array(rows, pa.struct([(name, kind) for name in NAMES]))
        table = pa.table({"id": numbers, "bbox": struct})
        expected = BOXES.astype(kind.to_pandas_dtype())
        for found in (table, pa.concat_tables([table[:20], table[20:]]), polars.DataFrame(table), table.to_pandas()):
            np.testing.assert_array_equal(broadside.Index(found).boxes, expected)
        np.testing.assert_array_equal(broadside.Index(table[10:30]).boxes, expected[10:30])
    solid = scattered(9, 3, np.float64)
    names = ["xmin", "ymin", "zmin", "xmax", "ymax", "zmax"]
    struct = pa.array([dict(zip(names, row)) for row in solid.tolist()])
    np.testing.assert_array_equal(broadside.Index(pa.table({"bbox": struct})).boxes, solid)


def test_takes_a_column_of_lists():
    lists = sizes_of(WHOLE).tolist()
    fixed = pa.array(lists, pa.list_(pa.float64(), 4))
    for found in (pandas.DataFrame({"id": range(50), "bbox": lists}), pa.table({"id": range(50), "bbox": fixed})):
        np.testing.assert_array_equal(broadside.Index(found, columns="xywh").boxes, WHOLE)
    found = pandas.DataFrame({"bbox": [[0, 0, 1, 1], None, [0.5, 0, 2, 2]]})
    assert broadside.Index(found).boxes.tolist() == [[0, 0, 1, 1], ABSENT, [0.5, 0, 2, 2]]
    for wrong in (["0 0 1 1"], [[0, 0, 1]], [{"a": 1}]):
        with pytest.raises((TypeError, ValueError), match="boxes has|of boxes has|shape"):
            broadside.pairs(pandas.DataFrame({"bbox": wrong}))


ABSENT = [np.inf, np.inf, -np.inf, -np.inf]


def with_nulls(rows, kind=None):
    columns = zip(*[[None] * 4 if row is None else row for row in rows])
    return {name: pa.array(column, kind) for name, column in zip(NAMES, columns)}


def test_treats_nulls_alike_in_arrow_frames_and_parquet(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    rows, half = [[0, 0, 1, 1], None, [1, 1, 2, 2]], [[0, 0, 1, 1], [0, None, 1, 1]]

    def forms(rows, kind):
        table = pa.table(with_nulls(rows, kind))
        yield table
        yield pa.concat_tables([table[:1], table[1:]])
        yield polars.DataFrame(table)
        yield table.to_pandas()
        yield table.to_pandas(types_mapper=pandas.ArrowDtype)
        yield table.to_pandas().astype("Float64" if pa.types.is_floating(kind) else "Int64")
        yield pa.table({"bbox": pa.array([row and dict(zip(NAMES, row)) for row in rows], pa.struct([(name, kind) for name in NAMES]))})
        yield pa.array(rows, pa.list_(kind, 4))
        path = tmp_path / "boxes.parquet"
        parquet.write_table(table, path)
        yield path

    for kind in (pa.int64(), pa.float32(), pa.float64()):
        for found in forms(rows, kind):
            array = broadside.read(found) if hasattr(found, "suffix") else broadside.Index(found).boxes
            assert array.tolist() == [rows[0], ABSENT, rows[2]], type(found)
        for found in forms(half, kind):
            with pytest.raises((broadside.InvalidBoxError, broadside.FileError), match="(box|row) 1"):
                broadside.pairs(broadside.read(found) if hasattr(found, "suffix") else found)
            if not hasattr(found, "suffix"):
                assert broadside.count(found, quarantine=True) == 0 and broadside.invalid_rows(found).tolist() == [1]


def test_takes_points_by_their_names():
    index = broadside.Index(BOXES)
    points = (BOXES[:, :2] + BOXES[:, 2:]) / 2
    expected = index.containing(points)
    for found in (pandas.DataFrame(points[:, ::-1], columns=["y", "x"]), pandas.DataFrame(points), pa.table({"b": points[:, 0], "a": points[:, 1]})):
        np.testing.assert_array_equal(index.containing(found).box, expected.box)
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    for found in (geopandas.GeoSeries(shapely.points(points)), geopandas.GeoDataFrame(geometry=shapely.points(points))):
        np.testing.assert_array_equal(index.containing(found).box, expected.box)
    with pytest.raises(TypeError, match="points has a Polygon in row 1; expected a point"):
        index.containing(geopandas.GeoSeries([shapely.Point(0, 0), shapely.box(0, 0, 1, 1)]))
    with pytest.raises(ValueError, match="points has the columns a, b, c; expected x, y"):
        index.containing(pandas.DataFrame(np.zeros((2, 3)), columns=["a", "b", "c"]))


@tables
@pytest.mark.parametrize("names", [["x", "y"], ["px", "py"], ["lon", "lat"]])
def test_points_of_a_table_are_points_of_an_array(table, names):
    points = BOXES[:, :2]
    frame = table(columns_of(points, names) | {"id": np.arange(50)})
    backwards = table(columns_of(points[:, ::-1], names[::-1]))
    for columns, found in [(names, frame), (names, backwards), (None, table(columns_of(points, names)))]:
        near = broadside.pairs(found, within=0.1, columns=columns, sort=True)
        assert near.tolist() == broadside.pairs(points, within=0.1, sort=True).tolist()
        between = broadside.count(found, frame, within=0.1, columns=columns, other_columns=names)
        assert between == broadside.count(points, points, within=0.1)
        assert broadside.components(found, within=0.1, columns=columns).tolist() == broadside.components(points, within=0.1).tolist()
        expected = broadside.distances(points, near)
        np.testing.assert_array_equal(broadside.distances(found, near, columns=columns), expected)
        np.testing.assert_array_equal(broadside.nearest_pairs(found, columns=columns).box, broadside.nearest_pairs(points).box)
    assert broadside.count(points.tolist(), within=0.1) == len(near)


def test_points_are_refused_where_columns_say_something_else():
    frame = pandas.DataFrame(BOXES, columns=["px", "py", "qx", "qy"])
    for call in (broadside.pairs, broadside.invalid_rows, broadside.draw):
        for columns in (["px", "py"], ["px", "py", "qx"]):
            with pytest.raises(ValueError, match="the columns of boxes are px, py.*; for points say within=, or use nearest_pairs"):
                call(frame, columns=columns)
    for columns, message in [
        (["xmin", "xmax"], "no columns that give bounds on the y axis"),
        (["xmin", "foo"], "column 'xmin' alone|column xmin alone"),
        (["x", "foo", "bar"], "no columns that give bounds on the x axis"),
    ]:
        named = pandas.DataFrame(np.zeros((3, len(columns))), columns=columns)
        for call in (broadside.nearest_pairs, lambda found, **which: broadside.pairs(found, within=1, **which)):
            with pytest.raises(ValueError, match=message):
                call(named, columns=columns)
            with pytest.raises(ValueError, match="has the columns"):
                call(named)
    for names in (["id", "px", "py"], ["px", "py", "id", "label"]):  # which of them is an id?
        with pytest.raises(ValueError, match="has the columns .*for points|has the columns"):
            broadside.nearest_pairs(pandas.DataFrame(np.zeros((3, len(names))), columns=names))
    interval = pandas.DataFrame({"start": [0, 5], "end": [4, 6]})
    for columns in (None, ["start", "end"]):
        assert broadside.nearest_pairs(interval, columns=columns).distance_squared.tolist() == [[1], [1]]


def test_takes_a_series_of_lists_or_dicts():
    sizes = pandas.Series(sizes_of(WHOLE).tolist(), name="box")
    np.testing.assert_array_equal(broadside.Index(sizes, columns="xywh").boxes, WHOLE)
    bounds = pandas.Series([dict(zip(NAMES, row)) for row in BOXES.tolist()])
    assert as_set(broadside.pairs(bounds)) == PAIRS
    for numbers in (pandas.Series([1.0, 2.0]), pandas.Series([1, 2], dtype="Int64")):
        with pytest.raises(ValueError, match=r"shape \(2,\)"):
            broadside.pairs(numbers)


def test_refuses_sets_in_two_reference_systems():
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    import broadside.dask

    plain = geopandas.GeoSeries(shapely.box(*BOXES.T))
    degrees, metres = plain.set_crs(4326), plain.set_crs(3857)
    message = "has the CRS EPSG:4326 and .* EPSG:3857; expected one, as to_crs"
    index, world = broadside.Index(degrees), broadside.World(2)
    world.add(degrees)
    for call in (
        lambda found: broadside.pairs(degrees, found),
        lambda found: broadside.count(geopandas.GeoDataFrame(geometry=degrees), geopandas.GeoDataFrame(geometry=found)),
        lambda found: broadside.pairs(degrees.array, found.array),
        lambda found: broadside.dask.pairs(degrees, found),
        index.overlapping,
        world.overlapping,
        world.add,
    ):
        for same in (degrees, plain):
            call(same)
        with pytest.raises(ValueError, match=message):
            call(metres)
    with pytest.raises(ValueError, match="boxes has the CRS EPSG:4326 and other EPSG:3857"):
        broadside.pairs(degrees, metres)
