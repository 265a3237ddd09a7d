"""What is taken for boxes: without a copy, by one, or not at all."""

import array
import pickle
import subprocess
import sys

import numpy as np
import pytest
from conftest import as_set, brute_force, scattered

import broadside

BOXES = scattered(50, dtype=np.float64)
PAIRS = brute_force(BOXES)
FLOATS = np.dtype([(name, float) for name in ("category", "mask", "group", "is_static")])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_takes_rows_in_one_piece_without_a_copy(no_conversion, dtype):
    boxes = BOXES.astype(dtype)
    expected = brute_force(boxes)
    read_only = boxes.copy()
    read_only.flags.writeable = False
    wide = np.full((50, 7), np.nan, dtype)
    wide[:, 1:5] = boxes
    every_other = np.repeat(boxes, 2, axis=0)[::2]
    record = np.zeros(50, [("id", np.uint8), ("box", dtype, 4)])  # not aligned
    record["box"] = boxes
    for kept in (boxes, read_only, wide[:, 1:5], every_other, record["box"], memoryview(boxes)):
        assert as_set(broadside.pairs(kept)) == expected
        assert as_set(broadside.pairs(kept, boxes)) == brute_force(boxes, boxes)


@pytest.mark.parametrize(
    "convert",
    [
        lambda b: b.tolist(),
        lambda b: tuple(map(tuple, b)),
        np.asfortranarray,
        lambda b: b[::-1][::-1],
        lambda b: np.array(b[::-1])[::-1],
        lambda b: b.astype(">f8"),
        lambda b: b.astype(">f4").astype(">f8"),
        lambda b: np.ma.masked_array(b),
        lambda b: np.array(b).view(np.matrix),
        lambda b: np.repeat(b, 3, axis=1)[:, ::3],
        lambda b: np.hstack([b[:, ::-1]])[:, ::-1],
    ],
)
def test_converts_other_layouts(convert):
    boxes = BOXES.astype(np.float32).astype(np.float64)
    assert as_set(broadside.pairs(convert(boxes))) == brute_force(boxes)


@pytest.mark.parametrize("dtype", [np.int8, np.uint8, np.int16, np.int32, np.uint32, np.int64, np.uint64, np.float16])
def test_converts_integers_exactly(dtype):
    boxes = np.array([[0, 0, 2, 2], [2, 2, 3, 3], [4, 4, 5, 5]], dtype)
    assert as_set(broadside.pairs(boxes)) == {(0, 1)}


def test_takes_integers_that_float64_holds_and_no_others():
    assert broadside.count(np.array([[0, 0, 2**53 + 2, 1], [2**53 + 2, 0, 2**60, 1]])) == 1
    with pytest.raises(ValueError, match=r"9007199254740993 in row 1, which float64 does not hold"):
        broadside.pairs(np.array([[0, 0, 1, 1], [0, 0, 2**53 + 1, 1]]))
    with pytest.raises(ValueError, match="float64 does not hold"):
        broadside.pairs(np.array([[0, 0, 1, 2**64 - 1]], np.uint64))


@pytest.mark.parametrize(
    ("found", "error", "message"),
    [
        (np.zeros((3, 4), bool), TypeError, "dtype bool; expected float32 or float64"),
        (np.zeros((3, 4), complex), TypeError, "dtype complex128; expected"),
        (np.array([["a"] * 4]), TypeError, "dtype <U1"),
        (np.array([[object()] * 4]), TypeError, r"dtype object \(its element in row 0 is an object\)"),
        (np.array([[None] * 4]), TypeError, "in row 0 is None"),
        (np.zeros((3, 4), "M8[s]"), TypeError, r"datetime64\[s\]"),
        (np.zeros((3, 4), np.longdouble), TypeError, "float128|longdouble"),
        (np.zeros((3, 5)), ValueError, r"shape \(3, 5\); expected \(n, 4\)"),
        (np.zeros(4), ValueError, r"shape \(4,\)"),
        (np.zeros((2, 2, 4)), ValueError, r"shape \(2, 2, 4\)"),
        (np.zeros((3, 0)), ValueError, r"shape \(3, 0\)"),
        ([[0, 0, 1, 1], [0, 0]], ValueError, "rows of the same length"),
        ("boxes", TypeError, "str; expected an array"),
        (b"0000", TypeError, "bytes"),
        (None, TypeError, "boxes is None; expected an array"),
        (7, TypeError, "int; expected an array"),
        ({"xmin": [0]}, TypeError, "dict"),
        (array.array("d", [0, 0, 1, 1]), ValueError, r"shape \(4,\)"),
        (np.ma.masked_array(np.zeros((1, 4)), True), ValueError, "masked"),
        (np.zeros(2, [("a", "f8"), ("b", "f8")]), ValueError, r"has the columns a, b \(.*\); expected xmin"),
        (np.zeros(2, [(name, "f8") for name in ("x", "y", "width", "height")]), ValueError, "columns x, y, width, height .*centre"),
        (np.zeros(2, [(name, "f8") for name in "01234"]), ValueError, "has the columns 0, 1, 2, 3, 4 .*; expected xmin"),
        (np.zeros(2, [("x", "f8"), ("y", "f8")]), ValueError, "has the columns x, y .*points"),
    ],
)
def test_refuses_what_is_no_boxes(found, error, message):
    for call in (broadside.pairs, broadside.count, broadside.draw, broadside.World(2).add):
        with pytest.raises(error, match=message):
            call(found)
    if "has the columns a, b" not in message and "points" not in message:  # which an index takes as points
        with pytest.raises(error, match=message):
            broadside.Index(found)


@pytest.mark.parametrize("box", [[0, 0, np.nan, 1], [np.nan] * 4, [1, 0, 0, 1], [np.inf, np.inf, np.inf, -np.inf]])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_refuses_invalid_boxes_by_row(box, dtype):
    boxes = scattered(20_000, dtype=dtype)
    boxes[12_345] = box
    for call in (broadside.pairs, broadside.count, broadside.Index, lambda b: broadside.World(2, dtype=dtype).add(b)):
        with pytest.raises(broadside.InvalidBoxError, match="12345") as caught:
            call(boxes)
        assert caught.value.row == 12_345
        assert isinstance(caught.value, ValueError)


def test_refuses_arguments_that_do_not_fit():
    boxes = scattered(10)
    for arguments, error, message in [
        ({"algorithm": "gird"}, broadside.InvalidAlgorithmError, "did you mean 'grid'"),
        ({"algorithm": "grid:cell=-1"}, broadside.InvalidAlgorithmError, "cell"),
        ({"algorithm": 7}, TypeError, "algorithm is an int; expected a str"),
        ({"algorithm": None}, TypeError, "algorithm is None"),
        ({"threads": 2**70}, ValueError, "threads is 1180591620717411303424; expected 1 to 1024"),
        ({"threads": True}, TypeError, "threads is a bool"),
        ({"threads": 1.5}, TypeError, "threads is a float; expected an int, or None for all"),
        ({"output": "pandas"}, ValueError, "expected 'numpy', 'arrow' or 'sparse'"),
        ({"threads": 0}, ValueError, "threads is 0; expected 1 to 1024"),
        ({"threads": "all"}, TypeError, "threads is a str; expected an int, or None for all"),
        ({"threads": 2, "algorithm": "grid:threads=2"}, ValueError, "expected one of the two"),
        ({"filters": broadside.filters(9)}, ValueError, r"shape \(9,\); expected \(10,\)"),
        ({"filters": np.zeros(10)}, TypeError, "expected what broadside.filters"),
        ({"filters": broadside.filters(10).astype(FLOATS)}, TypeError, "expected what broadside.filters"),
        ({"other_filters": broadside.filters(10)}, ValueError, "without other boxes"),
        ({"ignored": [[0, 10]]}, ValueError, "ignored has 10; expected integers from 0 to 9"),
        ({"ignored": [[0, -1]]}, ValueError, "ignored has -1"),
        ({"ignored": [[0.5, 1]]}, TypeError, "float64; expected integers"),
        ({"ignored": [0, 1, 2]}, ValueError, r"expected \(n, 2\)"),
        ({"ignored": [[0, 1]], "other": boxes}, ValueError, "one set alone"),
        ({"other": scattered(10, 3)}, ValueError, "2D and other in 3D"),
        ({"other": "boxes"}, TypeError, "other is a str"),
    ]:
        with pytest.raises(error, match=message):
            broadside.pairs(boxes, **arguments)
    with pytest.raises(TypeError):
        broadside.pairs(boxes, None, "grid")  # all but the boxes by name
    with pytest.raises(ValueError, match="group has"):
        broadside.filters(2, group=2**31)
    for category, found in (([2**64, 1], 2**64), (-1, -1), ([2**63, -1], -1), (2**64, 2**64)):
        with pytest.raises(ValueError, match=f"category has {found}; expected integers from 0 to 18446744073709551615"):
            broadside.filters(2, category=category)
    assert broadside.filters(2, category=[2**63, 1], mask=2**64 - 1)["category"].tolist() == [2**63, 1]
    for category in ([1.0, 2.0], [2**63, 1.5], "a", None):
        with pytest.raises(TypeError, match="category has dtype .*; expected integers"):
            broadside.filters(2, category=category)
    with pytest.raises(TypeError, match="expected booleans"):
        broadside.filters(2, is_static=[1, 0])


def test_takes_only_true_and_false_for_a_flag():
    boxes = scattered(100)
    for flag in (1, np.bool_(True)):
        np.testing.assert_array_equal(broadside.pairs(boxes, sort=flag), broadside.pairs(boxes, sort=True))
    for call, name in [
        (lambda flag: broadside.pairs(boxes, touching=flag), "touching"),
        (lambda flag: broadside.count(boxes, quarantine=flag), "quarantine"),
        (lambda flag: broadside.Tracker(2, touching=flag), "touching"),
        (lambda flag: broadside.Partition(boxes, 2).assign(boxes, quarantine=flag), "quarantine"),
        (lambda flag: broadside.neighbour_lists([[0, 1]], 2, full=flag), "full"),
    ]:
        for flag, kind in (("no", "a str"), (None, "None"), (2, "an int")):
            with pytest.raises(TypeError, match=f"{name} is {kind}; expected True or False"):
                call(flag)


def test_an_empty_list_is_no_boxes():
    flat, solid = scattered(5), scattered(5, 3)
    for found in ([], ()):
        assert broadside.pairs(found).shape == (0, 2)
        assert broadside.pairs(found, output="sparse").shape == (0, 0)
        assert broadside.count(found, solid) == broadside.count(solid, found) == broadside.count(found, flat) == 0
        assert broadside.count(found, found) == 0 and len(broadside.invalid_rows(found)) == 0
        world = broadside.World(3)
        assert world.add(found).shape == (0,) and len(world.overlapping(found).box) == 0
        world.move(found, found)
        assert len(broadside.Tracker(3).update(found).begun) == 0
        assert len(broadside.Index(solid).containing(found).box) == 0
        index = broadside.Index(found)
        assert (len(index), index.dimension, index.dtype) == (0, 2, np.float64)
        assert len(index.overlapping(flat).box) == len(index.nearest([[0.1, 0.2]]).box[0]) - 1 == 0
        assert len(broadside.draw(found).svg) > 0 and len(broadside.Partition(found, 4)) == 1


def test_names_the_argument_of_an_invalid_box():
    boxes, bad = scattered(10), scattered(10)
    bad[3, 0] = np.nan
    sets = [(bad, boxes, "boxes"), (boxes, bad, "other"), (boxes[:2], bad, "other"), (bad, bad, "boxes")]
    for left, right, name in sets:
        with pytest.raises(broadside.InvalidBoxError, match=f"^{name}: 1 of 10 rows is invalid: box 3") as caught:
            broadside.pairs(left, right)
        assert (caught.value.argument, caught.value.row) == (name, 3)
        again = pickle.loads(pickle.dumps(caught.value))
        assert (str(again), again.argument, again.row) == (str(caught.value), name, 3)
    with pytest.raises(broadside.InvalidBoxError) as caught:
        broadside.pairs(bad)
    assert caught.value.argument == "boxes"


class WithArray:
    def __array__(self, dtype=None, copy=None):
        return BOXES


class WithDlpack:
    def __dlpack__(self, **arguments):
        return BOXES.__dlpack__(**arguments)

    def __dlpack_device__(self):
        return BOXES.__dlpack_device__()


class OnADevice(WithDlpack):
    def __dlpack__(self, **arguments):
        raise BufferError("the array is on a device")


@pytest.mark.parametrize("made", [WithArray, WithDlpack])
def test_takes_the_arrays_of_other_libraries(made):
    assert as_set(broadside.pairs(made())) == PAIRS


def test_refuses_the_memory_of_a_device():
    with pytest.raises(TypeError, match="DLPack: the array is on a device; expected an array in the CPU's memory"):
        broadside.pairs(OnADevice())


def test_takes_shapely_and_geopandas():
    shapely = pytest.importorskip("shapely")
    geopandas = pytest.importorskip("geopandas")
    geometries = shapely.box(*BOXES.T)
    geometries[3] = None
    geometries[4] = shapely.Point()
    kept = {pair for pair in PAIRS if not {3, 4} & set(pair)}
    series = geopandas.GeoSeries(geometries)
    frame = geopandas.GeoDataFrame({"n": range(50)}, geometry=series)
    for found in (geometries, geometries.tolist(), series, series.array, frame, frame.set_index("n")):
        assert as_set(broadside.pairs(found)) == kept
    nothing = geopandas.GeoSeries([None, None])
    for none in (series[:0], frame[:0], series[:0].array, nothing, geopandas.GeoDataFrame(geometry=nothing)):
        assert broadside.pairs(none).shape == (0, 2)
        assert broadside.count(series, none) == broadside.count(none, series) == 0
    bounds = series.bounds.drop([3, 4])
    assert len(broadside.pairs(bounds)) == len(kept)
    assert as_set(broadside.pairs(frame, BOXES)) == {p for p in brute_force(BOXES, BOXES) if p[0] not in (3, 4)}


def test_takes_data_frames_by_the_names_of_their_columns():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(BOXES, columns=["xmin", "ymin", "xmax", "ymax"])
    assert as_set(broadside.pairs(frame[["ymax", "xmin", "ymin", "xmax"]])) == PAIRS
    assert as_set(broadside.pairs(frame.assign(geometry="a text"))) == PAIRS
    assert as_set(broadside.pairs(pandas.DataFrame(BOXES))) == PAIRS
    for names in ("a b", "x y width height", "id a b c", "0 1 2 3 id", "x y"):
        with pytest.raises(ValueError, match=f"boxes has the columns {', '.join(names.split())} .*; expected xmin, ymin"):
            broadside.pairs(pandas.DataFrame({name: [1.0, 2.0] for name in names.split()}))


def test_the_lab_s_rows_are_what_the_program_finds(tmp_path):
    path = tmp_path / "boxes.npy"
    np.save(path, BOXES)
    np.testing.assert_array_equal(broadside.read(path), BOXES)


def test_is_imported_without_other_packages():
    code = "import sys, broadside; print(sorted({'scipy', 'pandas', 'pyarrow', 'shapely'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_names_the_argument_that_is_meant():
    boxes = np.zeros((3, 4))
    for call, argument, meant in [
        (broadside.pairs, "sorted", "sort"),
        (broadside.pairs, "whithin", "within"),
        (broadside.count, "by", "same"),
        (broadside.components, "distance", "within"),
        (broadside.nearest_pairs, "radius", "max_distance"),
        (broadside.Index, "colums", "columns"),
        (lambda _, **more: broadside.Tracker(2, **more), "touch", "touching"),
        (lambda _, **more: broadside.World(2, **more), "margins", "margin"),
    ]:
        with pytest.raises(TypeError, match=f"has no argument '{argument}'; did you mean '{meant}'.$"):
            call(boxes, **{argument: 1})
    with pytest.raises(TypeError, match="filters.. has no argument 'colour'; expected one of: n, category, mask"):
        broadside.filters(3, colour=1)
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'boxes'"):
        broadside.pairs()
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'dimension'"):
        broadside.World(margin=0.1)

    class Own:
        def __array__(self, **_):
            return np.zeros(boxes.shape, dtypo=float)

    with pytest.raises(TypeError, match="zeros"):  # an error within the call is not about its arguments
        broadside.pairs(Own(), sort=True)
