"""algorithms(), advise(), read() and draw()."""

import gzip
import io
import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
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


def test_reads_the_columns_that_a_caller_names(tmp_path):
    named, plain, bbox = (tmp_path / name for name in ("named.csv", "plain.csv", "bbox.csv"))
    named.write_text("id,h,w,y,x\n7,6,4,2,1\n")
    plain.write_text("1,2,4,6\n")
    bbox.write_text('id,bbox\n7,"[1, 2, 4, 6]"\n')
    for path in (named, plain, bbox):
        assert broadside.read(path, columns="xywh").tolist() == [[1, 2, 5, 8]]
    assert broadside.read(plain, columns=["x", "y", "w", "h"]).tolist() == [[1, 2, 5, 8]]
    assert broadside.read(plain, columns="x,y,w,h").tolist() == [[1, 2, 5, 8]]
    assert broadside.read(bbox, columns="bbox=xywh").tolist() == [[1, 2, 5, 8]]
    with pytest.raises(ValueError, match="the columns of the file are 'wh'; expected one of xyxy"):
        broadside.read(plain, columns="wh")
    behind = tmp_path / "behind.csv"
    behind.write_text("id,h,w,y,x\n9,6,4,2,1\n")
    assert broadside.read(behind, columns=["x", "y", "w", "h"]).tolist() == [[1, 2, 5, 8]]
    assert broadside.read(behind, columns="-,h,w,y,x").tolist() == [[1, 2, 5, 8]]
    assert broadside.read(behind, columns="x,y,w,h").tolist() == [[9, 6, 13, 8]], "from left to right"
    assert broadside.read(behind, columns=["-", "ymax", "xmax", "ymin", "xmin"]).tolist() == [[1, 2, 4, 6]], "none of its names"
    with pytest.raises(broadside.FileError, match="'id,h,w,y,x'; expected a column 'width', as columns names it"):
        broadside.read(behind, columns=["x", "y", "width", "h"])
    with pytest.raises(broadside.FileError, match="'id,h,w,y,x'; expected a column 'xmin', as columns names it"):
        broadside.read(behind, columns=["xmin", "ymin", "xmax", "ymax"])
    with pytest.raises(broadside.FileError, match="columns='a,b,c,d': no columns"):
        broadside.read(plain, columns="a,b,c,d")


def test_selects_columns_in_any_spelling_and_keeps_frames(tmp_path):
    names = ["xmin", "ymin", "xmax", "ymax"]
    path = tmp_path / "selected.csv"
    for header in ("id,XMIN,YMIN,XMAX,YMAX", "7,x_min,Y-min,XMax,ymax", "# id xMin yMin xMax yMax"):
        path.write_text(f"{header}\n9,1,2,4,6\n")
        assert broadside.read(path, columns=names).tolist() == [[1, 2, 4, 6]], header
    path.write_text("XMIN,xmin,ymin,xmax,ymax\n9,1,2,4,6\n")
    assert broadside.read(path, columns=names).tolist() == [[1, 2, 4, 6]], "the exact name first"
    path.write_text("e,c,d,a,b\n9,4,6,1,2\n")
    assert broadside.read(path, columns=["a", "b", "c", "d"]).tolist() == [[1, 2, 4, 6]], "minima, then maxima"
    path.write_text('id,bounds,bbox\n9,"[0, 0, 1, 1]","[1, 2, 3, 4]"\n')
    assert broadside.read(path, columns=["BBox=xywh"]).tolist() == [[1, 2, 4, 6]]
    path.write_text("frame,box,cx,xmin,ymin,xmax,ymax\n0,0,9,1,2,4,6\n0,1,9,0,0,1,1\n1,0,9,1,2,4,7\n")
    assert broadside.read(path, columns=names).tolist() == [[1, 2, 4, 6], [0, 0, 1, 1]]
    assert broadside.read(path, columns=names, frame=1).tolist() == [[1, 2, 4, 7], [0, 0, 1, 1]]


def test_speaks_of_its_own_arguments(tmp_path):
    path = tmp_path / "boxes.csv"
    path.write_text("0,0,10,10\n12,12,6,4\n")
    with pytest.raises(broadside.FileError, match="say columns='x,y,w,h'"):
        broadside.read(path)
    path.write_text("1,2,3\n")
    with pytest.raises(broadside.FileError, match="names with columns=") as caught:
        broadside.read(path)
    assert "--" not in str(caught.value)
    for found, kind in ((np.zeros((2, 4)), "a ndarray|an ndarray"), (7, "an int")):
        with pytest.raises(TypeError, match=f"path is ({kind}); expected the path of a file.*take them as they are"):
            broadside.read(found)


TEXT = "min_x,min_y,max_x,max_y\n0,0,1,1\n1,1,2,2\n"


def test_reads_what_is_open(tmp_path):
    expected = [[0, 0, 1, 1], [1, 1, 2, 2]]
    path = tmp_path / "boxes.csv"
    path.write_text(TEXT)
    packed = gzip.compress(TEXT.encode())
    beside = io.BytesIO(b"before" + TEXT.encode())
    beside.seek(len(b"before"))
    with open(path, "rb") as binary, open(path) as text, open(path, "rb", buffering=0) as raw:
        for file in (binary, text, raw, io.BytesIO(TEXT.encode()), io.StringIO(TEXT), io.BytesIO(packed), beside):
            assert broadside.read(file).tolist() == expected
            assert not file.read()
    with gzip.open(io.BytesIO(packed)) as file:
        assert broadside.read(file, format="csv").tolist() == expected
    array = io.BytesIO()
    np.save(array, scattered(5, 3))
    array.seek(0)
    np.testing.assert_array_equal(broadside.read(array), scattered(5, 3))
    with pytest.raises(broadside.FileError, match="the file object:2: .*one"):
        broadside.read(io.BytesIO(b"min_x,min_y,max_x,max_y\n0,0,one,1\n"))
    with open(path, "w") as file:
        file.write(TEXT + "0,0,one,1\n")
    with open(path, "rb") as file, pytest.raises(broadside.FileError, match="boxes.csv:4: .*one"):
        broadside.read(file)

    class Numbers:
        def read(self, size):
            return 7

    with pytest.raises(TypeError, match="of Numbers gave int; expected bytes or a str"):
        broadside.read(Numbers())


def test_reads_parquet_that_is_open():
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    file = io.BytesIO()
    parquet.write_table(pyarrow.table({"min_x": [0.0], "min_y": [0.0], "max_x": [1.0], "max_y": [1.0]}), file)
    file.seek(0)
    assert broadside.read(file).tolist() == [[0, 0, 1, 1]]
    with pytest.raises(broadside.FileError, match="the file object: cannot be read as Parquet"):
        broadside.read(io.BytesIO(file.getvalue()[:-20]))


class Endless(io.RawIOBase):
    def readable(self):
        return True

    def readinto(self, buffer):
        return len(buffer)


def test_holds_no_more_than_memory_can(monkeypatch):
    monkeypatch.setattr("broadside._lab._most_bytes", lambda: 10_000_000)
    with pytest.raises(broadside.FileError, match="goes on after 1[01][0-9]{6} bytes"):
        broadside.read(Endless())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="without named pipes")
@pytest.mark.parametrize("content", [TEXT.encode(), gzip.compress(TEXT.encode())], ids=["plain", "gzip"])
def test_reads_a_pipe_until_it_is_closed(tmp_path, content):
    path = tmp_path / "pipe.csv"
    os.mkfifo(path)
    writer = threading.Thread(target=path.write_bytes, args=(content,))
    writer.start()
    assert broadside.read(path).tolist() == [[0, 0, 1, 1], [1, 1, 2, 2]]
    writer.join()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="without named pipes")
def test_waits_for_a_pipe_until_ctrl_c(tmp_path):
    path = tmp_path / "pipe.csv"
    os.mkfifo(path)
    code = f"""
        import signal, broadside
        signal.signal(signal.SIGINT, signal.default_int_handler)
        print("waits", flush=True)
        try:
            broadside.read({str(path)!r})
        except KeyboardInterrupt:
            print("ended")
    """
    with subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "waits\n"
        with open(path, "wb") as writer:  # waits until it is opened for reading
            writer.write(b"min_x")
            writer.flush()
            # Python misses a signal that comes just before it begins to wait. A user then presses Ctrl-C again.
            for _ in range(20):
                process.send_signal(signal.SIGINT)
                try:
                    assert process.communicate(timeout=5)[0] == "ended\n"
                    return
                except subprocess.TimeoutExpired:
                    continue
            process.kill()
            pytest.fail("Ctrl-C does not end the reading")


def test_says_what_is_wrong_with_a_file(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        broadside.read(tmp_path / "none.csv")
    assert caught.value.filename == str(tmp_path / "none.csv")
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
    with pytest.raises(TypeError, match="algorithms is a list; expected a str"):
        broadside.draw(scattered(10), ["grid"])
    with pytest.raises(broadside.InvalidBoxError):
        broadside.draw([[0, 0, np.nan, 1]])
