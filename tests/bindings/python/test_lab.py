"""algorithms(), advise(), read() and draw()."""

import gzip
import json
import os
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from conftest import scattered

import broadside


def test_lists_algorithms():
    names = {algorithm.name: algorithm for algorithm in broadside.algorithms()}
    assert {"auto", "brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"} <= set(names)
    assert names["grid"].kind == "own" and "cell" in names["grid"].tunables and names["grid"].dimensions == (2, 3)


def test_advises():
    advice = broadside.advise(scattered(500), budget=0.5)
    assert advice.verified and advice.milliseconds > 0 and advice.reasons
    assert advice.algorithm.split(":")[0] in {algorithm.name for algorithm in broadside.algorithms()}
    assert advice.algorithm in str(advice) and advice.ranking[0][1] > 0
    for arguments, error in [
        ({"budget": 0}, ValueError),
        ({"threads": 0}, ValueError),
        ({"algorithms": "nothing"}, broadside.InvalidAlgorithmError),
    ]:
        with pytest.raises(error):
            broadside.advise(scattered(10), **arguments)
    with pytest.raises(broadside.InvalidBoxError, match="box 1") as caught:
        broadside.advise([[0, 0, 1, 1], [np.nan, 0, 1, 1]], budget=0.3)
    assert caught.value.row == 1


def test_reads_files(tmp_path):
    boxes = scattered(20, dtype=np.float64)
    rows = "\n".join(",".join(repr(float(x)) for x in row) for row in boxes)
    csv = tmp_path / "boxes.csv"
    csv.write_text("min_x,min_y,max_x,max_y\n" + rows + "\n")
    np.testing.assert_array_equal(broadside.read(csv), boxes)
    packed = tmp_path / "boxes.csv.gz"
    packed.write_bytes(gzip.compress(csv.read_bytes()))
    np.testing.assert_array_equal(broadside.read(str(packed)), boxes)
    np.save(tmp_path / "boxes.npy", scattered(7, 3))
    assert broadside.read(tmp_path / "boxes.npy").dtype == np.float32
    assert broadside.read(tmp_path / "boxes.npy").shape == (7, 6)
    shapes = [{"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [i, 2]}} for i in (1, 3)]
    map = tmp_path / "points.geojson"
    map.write_text(json.dumps({"type": "FeatureCollection", "features": shapes}))
    np.testing.assert_array_equal(broadside.read(map), [[1, 2, 1, 2], [3, 2, 3, 2]])


def test_reads_files_of_any_name(tmp_path):
    path = os.fsencode(tmp_path) + b"/\xff.csv"
    with open(path, "w") as file:
        file.write("min_x,min_y,max_x,max_y\n0,0,1,1\n")
    for name in (path, os.fsdecode(path)):
        assert broadside.read(name).tolist() == [[0, 0, 1, 1]]
        with pytest.raises(ValueError, match="frame is 5; expected at most 0"):
            broadside.read(name, frame=5)
    with open(path, "a") as file:
        file.write("2,0,1,1\n")
    with pytest.raises(broadside.FileError, match="\udcff.csv"):
        broadside.read(path)
    with pytest.warns(UserWarning):
        assert broadside.read(path, quarantine=True).tolist() == [[0, 0, 1, 1], [np.inf, np.inf, -np.inf, -np.inf]]


def test_says_what_is_wrong_with_a_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        broadside.read(tmp_path / "none.csv")
    path = tmp_path / "boxes.csv"
    path.write_text("min_x,min_y,max_x,max_y\n0,0,1,1\n0,0,one,1\n")
    with pytest.raises(broadside.FileError, match="boxes.csv.*3.*one"):
        broadside.read(path)
    path.write_text("min_x,min_y,max_x,max_y\n0,0,1,1\n2,0,1,1\n")
    with pytest.raises(broadside.FileError, match="boxes.csv"):
        broadside.read(path)
    with pytest.warns(UserWarning):
        assert len(broadside.read(path, quarantine=True)) in (1, 2)
    with pytest.raises(ValueError, match="frame is 5"):
        path.write_text("min_x,min_y,max_x,max_y\n0,0,1,1\n")
        broadside.read(path, frame=5)
    with pytest.raises(ValueError, match="dimension is 4"):
        broadside.read(path, dimension=4)
    with pytest.raises(ValueError, match="frame is -1"):
        broadside.read(path, frame=-1)
    for arguments in ({"frame": 1.5}, {"format": 7}, {"dimension": 2.0}):
        with pytest.raises(TypeError, match="expected"):
            broadside.read(path, **arguments)


def test_draws(tmp_path):
    for boxes in (scattered(200), scattered(200, 3, np.float64)):
        drawing = broadside.draw(boxes, "quadtree,bvh" if boxes.shape[1] == 4 else "grid", title="a < b")
        assert ElementTree.fromstring(drawing._repr_svg_()).tag.endswith("svg")
        assert "a &lt; b" in drawing.svg
    drawing.save(tmp_path / "boxes.svg")
    assert (tmp_path / "boxes.svg").read_text() == drawing.svg
    assert len(broadside.draw(np.empty((0, 4))).svg) > 0
    with pytest.raises(broadside.InvalidAlgorithmError, match="nothing"):
        broadside.draw(scattered(10), "nothing")
    with pytest.raises(ValueError, match="most is 0"):
        broadside.draw(scattered(10), most=0)
    with pytest.raises(TypeError, match="algorithms is of list; expected a str"):
        broadside.draw(scattered(10), ["grid"])
    with pytest.raises(broadside.InvalidBoxError):
        broadside.draw([[0, 0, np.nan, 1]])
