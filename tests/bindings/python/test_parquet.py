"""read() of Parquet and GeoParquet."""

import json
import sys

import numpy as np
import pytest
from conftest import scattered

import broadside

pyarrow = pytest.importorskip("pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

BOXES = np.array([[0, 0, 2, 2], [1, 1, 3, 3], [5, 5, 6, 6]], np.float64)
ABSENT = [np.inf, np.inf, -np.inf, -np.inf]


def write(path, columns, geo=None):
    table = pyarrow.table(columns)
    if geo is not None:
        table = table.replace_schema_metadata({"geo": json.dumps(geo)})
    parquet.write_table(table, path)
    return path


def columns_of(boxes, names=("min_x", "min_y", "max_x", "max_y")):
    return dict(zip(names, boxes.T))


def geo(column="geometry", encoding="WKB", **more):
    return {"version": "1.1.0", "primary_column": column, "columns": {column: {"encoding": encoding, **more}}}


COVERING = {"bbox": {name: ["bbox", name] for name in ("xmin", "ymin", "xmax", "ymax")}}


def covering_of(boxes, dtype=None):
    rows = [dict(zip(("xmin", "ymin", "xmax", "ymax"), row)) if row is not None else None for row in boxes]
    number = dtype or pyarrow.float64()
    return pyarrow.array(rows, pyarrow.struct([(name, number) for name in ("xmin", "ymin", "xmax", "ymax")]))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_takes_columns_by_their_names(tmp_path, dtype, dimension):
    boxes = scattered(1000, dimension, dtype)
    names = ["min_x", "min_y", "min_z"][:dimension] + ["max_x", "max_y", "max_z"][:dimension]
    path = write(tmp_path / "boxes.parquet", {"name": ["a"] * 1000} | columns_of(boxes, names))
    found = broadside.read(path)
    assert found.dtype == dtype and found.flags.c_contiguous
    np.testing.assert_array_equal(found, boxes)
    if dimension == 3:
        np.testing.assert_array_equal(broadside.read(path, dimension=2), boxes[:, [0, 1, 3, 4]])
    else:
        with pytest.raises(broadside.FileError, match="boxes.parquet.*min_z and max_z"):
            broadside.read(path, dimension=3)


@pytest.mark.parametrize(
    "names",
    [
        ("xmin", "ymin", "xmax", "ymax"),
        ("Min X", "Min Y", "Max X", "Max Y"),
        ("left", "bottom", "right", "top"),
        ("west", "south", "east", "north"),
        ("min_lon", "min_lat", "max_lon", "max_lat"),
        ("bbox_lower_x", "bbox_lower_y", "bbox_upper_x", "bbox_upper_y"),
    ],
)
def test_knows_the_names_that_csv_has(tmp_path, names):
    path = write(tmp_path / "boxes.parquet", columns_of(BOXES, names))
    np.testing.assert_array_equal(broadside.read(path), BOXES)
    csv = tmp_path / "boxes.csv"
    csv.write_text(",".join(names) + "\n" + "\n".join(",".join(map(str, row)) for row in BOXES) + "\n")
    np.testing.assert_array_equal(broadside.read(csv), BOXES)


def test_takes_a_struct_of_bounds(tmp_path):
    path = write(tmp_path / "boxes.parquet", {"bbox": covering_of(BOXES), "other": [1, 2, 3]})
    np.testing.assert_array_equal(broadside.read(path), BOXES)


def test_takes_integers_that_doubles_hold(tmp_path):
    path = write(tmp_path / "boxes.parquet", columns_of(BOXES.astype(np.int64)))
    np.testing.assert_array_equal(broadside.read(path), BOXES)
    large = BOXES.astype(np.int64)
    large[1, 2] = 2**53 + 1
    with pytest.raises(broadside.FileError, match="boxes.parquet: column max_x of .* is 9007199254740993 in row 1"):
        broadside.read(write(tmp_path / "boxes.parquet", columns_of(large)))


def test_takes_the_covering_of_geoparquet_without_its_geometries(tmp_path):
    columns = {"geometry": [b"no well-known binary"] * 3, "bbox": covering_of(BOXES)}
    path = write(tmp_path / "a.parquet", columns, geo(covering=COVERING))
    np.testing.assert_array_equal(broadside.read(path), BOXES)
    single = {"geometry": [b""] * 3, "bbox": covering_of(BOXES, pyarrow.float32())}
    assert broadside.read(write(tmp_path / "b.parquet", single, geo(covering=COVERING))).dtype == np.float32


def test_takes_a_row_without_bounds_for_an_absent_box(tmp_path):
    nan = [float("nan")] * 4
    columns = {"geometry": [b""] * 3, "bbox": covering_of([BOXES[0], None, nan])}
    path = write(tmp_path / "a.parquet", columns, geo(covering=COVERING))
    assert broadside.read(path).tolist() == [BOXES[0].tolist(), ABSENT, ABSENT]
    nulls = {name: [column[0], None] for name, column in columns_of(BOXES).items()}
    path = write(tmp_path / "b.parquet", nulls)
    assert broadside.read(path).tolist() == [BOXES[0].tolist(), ABSENT]
    integers = {name: pyarrow.array([int(column[0]), None]) for name, column in columns_of(BOXES).items()}
    assert broadside.read(write(tmp_path / "c.parquet", integers)).tolist() == [BOXES[0].tolist(), ABSENT]


def test_computes_bounds_of_well_known_binary(tmp_path):
    shapely = pytest.importorskip("shapely")
    shapes = [shapely.box(*BOXES[0]), shapely.Point(7, 8), shapely.Polygon(), None, shapely.LineString([(3, 1), (1, 4)])]
    texts = [None if shape is None else shapely.to_wkb(shape) for shape in shapes]
    path = write(tmp_path / "a.parquet", {"shape": texts}, geo("shape"))
    assert broadside.read(path).tolist() == [[0, 0, 2, 2], [7, 8, 7, 8], ABSENT, ABSENT, [1, 1, 3, 4]]
    with pytest.raises(broadside.FileError, match="in 2D"):
        broadside.read(path, dimension=3)
    with pytest.raises(broadside.FileError, match="'point'; expected WKB"):
        broadside.read(write(tmp_path / "b.parquet", {"shape": texts}, geo("shape", "point")))
    with pytest.raises(broadside.FileError, match="no well-known binary"):
        broadside.read(write(tmp_path / "c.parquet", {"shape": [b"\x01\x02"]}, geo("shape")))


@pytest.mark.parametrize("covering", [False, True])
def test_takes_what_geopandas_writes(tmp_path, covering):
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    path = tmp_path / "a.parquet"
    frame = geopandas.GeoDataFrame({"geometry": [shapely.box(*row) for row in BOXES] + [None]})
    frame.to_parquet(path, write_covering_bbox=covering)
    assert broadside.read(path).tolist() == [*BOXES.tolist(), ABSENT]


def test_names_the_row_that_is_no_box(tmp_path):
    wrong = BOXES.copy()
    wrong[1] = [3, 1, 1, 3]
    path = write(tmp_path / "boxes.parquet", columns_of(wrong))
    with pytest.raises(broadside.FileError, match="boxes.parquet: row 1 of the columns min_x, .*3.0, 1.0, 1.0, 3.0"):
        broadside.read(path)
    with pytest.warns(UserWarning, match="left out 1 invalid"):
        assert broadside.read(path, quarantine=True).tolist() == [BOXES[0].tolist(), ABSENT, BOXES[2].tolist()]
    wrong[1] = [0, np.nan, 1, 1]
    with pytest.raises(broadside.FileError, match="row 1"):
        broadside.read(write(path, columns_of(wrong)))
    half = columns_of(BOXES) | {"max_x": [2.0, None, 6.0]}
    with pytest.raises(broadside.FileError, match="row 1 .*no null"):
        broadside.read(write(path, half))


def test_says_what_is_wrong_with_a_file(tmp_path):
    path = tmp_path / "a.parquet"
    for columns, metadata, found in [
        ({"a": [1.0]}, None, r"has the columns a \(.*\); expected xmin"),
        (columns_of(BOXES) | {"xmin": [0.0] * 3}, None, "min_x'? and '?xmin'? mean the same"),
        ({"min_x": ["0"], "min_y": [0.0], "max_x": [1.0], "max_y": [1.0]}, None, "'min_x' is of type text; expected floats"),
        ({"a": [1.0]}, {"version": "1.1.0"}, "metadata of GeoParquet"),
        ({"a": [1.0]}, geo("b"), "no column b"),
        ({"a": [1.0]}, geo("a", covering=COVERING), "no column bbox.xmin"),
        ({"a": [1.0]}, geo("a", covering={"bbox": {"xmin": ["a"]}}), "a covering without ymin"),
        ({"a": [1.0]}, geo("a", covering={"bbox": {"xmin": "a"}}), "metadata of GeoParquet"),
    ]:
        with pytest.raises(broadside.FileError, match="a.parquet.*" + found):
            broadside.read(write(path, columns, metadata))
    whole = write(path, columns_of(scattered(1000, dtype=np.float64))).read_bytes()
    for damaged in (b"", b"PAR1", whole[:-100], whole[: len(whole) // 2], b"PAR1" + b"\xff" * 100 + whole[-200:]):
        path.write_bytes(damaged)
        with pytest.raises(broadside.FileError, match="a.parquet: cannot be read as Parquet"):
            broadside.read(path)


def test_is_told_by_content_or_name_or_format(tmp_path):
    bytes_ = write(tmp_path / "boxes.parquet", columns_of(BOXES)).read_bytes()
    other = tmp_path / "boxes"
    other.write_bytes(bytes_)
    np.testing.assert_array_equal(broadside.read(other), BOXES)
    np.testing.assert_array_equal(broadside.read(other, format="parquet"), BOXES)
    with pytest.raises(broadside.FileError):
        broadside.read(other, format="csv")
    np.testing.assert_array_equal(broadside.read(other, columns=["min_x", "min_y", "max_x", "max_y"]), BOXES)
    with pytest.raises(broadside.FileError, match="expected one column a"):
        broadside.read(other, columns="a,b")
    with pytest.raises(ValueError, match="is Parquet; expected None"):
        broadside.read(other, boxes="features")
    with pytest.raises(ValueError, match="frame is 1; expected at most 0"):
        broadside.read(other, frame=1)
    with pytest.raises(ValueError, match="dimension is 4"):
        broadside.read(other, dimension=4)


@pytest.mark.parametrize("missing", ["pyarrow", "shapely"])
def test_says_what_is_not_installed(tmp_path, monkeypatch, missing):
    path = write(tmp_path / "a.parquet", {"shape": [b""]}, geo("shape"))
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(ImportError, match=f"a.parquet.*{missing}.*pip install {missing}"):
        broadside.read(path)
