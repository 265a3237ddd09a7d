"""same, different and components(): against the pairs without them."""

import numpy as np
import pytest
from conftest import as_set, brute_force, scattered

import broadside

RNG = np.random.default_rng(3)
BOXES = np.concatenate([corner := RNG.random((400, 2)), corner + 0.1], axis=1)
KEYS = {
    "integers": RNG.integers(-3, 3, 400),
    "far apart": RNG.choice(np.array([-(2**63), 0, 2**63 - 1]), 400),
    "unsigned": RNG.choice(np.array([2**64 - 1, 2**64 - 2], np.uint64), 400),
    "32 bits, far apart": RNG.choice(np.array([-(2**31), 5, 2**31 - 1], np.int32), 400),
    "strings": RNG.choice(["a", "b", "c"], 400),
    "bytes": RNG.choice(np.array([b"a", b"bc"]), 400),
    "objects": np.array(RNG.choice(["a", "b", "c"], 400).tolist(), object),
    "a list": RNG.integers(0, 9, 400).tolist(),
    "whole floats": RNG.integers(-3, 3, 400).astype(np.float32),
    "all": np.arange(400),
}


@pytest.mark.parametrize("keys", KEYS.values(), ids=KEYS)
def test_only_the_same_or_only_different_keys_pair(keys):
    everything = brute_force(BOXES)
    equal = {(a, b) for a, b in everything if keys[a] == keys[b]}
    assert as_set(broadside.pairs(BOXES, same=keys)) == equal
    assert as_set(broadside.pairs(BOXES, different=keys)) == everything - equal
    assert broadside.count(BOXES, same=keys) == len(equal)


def test_keys_of_both_kinds_must_hold():
    images = KEYS["integers"]
    for name in ("strings", "far apart", "all"):
        classes = KEYS[name]
        expected = {(a, b) for a, b in brute_force(BOXES) if images[a] == images[b] and classes[a] != classes[b]}
        assert as_set(broadside.pairs(BOXES, same=images, different=classes)) == expected
        assert broadside.count(BOXES, same=images, different=classes) == len(expected)
        of_each = broadside.components(BOXES, same=images, different=classes)
        assert all(of_each[a] == of_each[b] for a, b in expected)
        between = {(a, b - 150) for a, b in expected if a < 150 <= b}
        both = {"same": (images[:150], images[150:]), "different": (classes[:150], classes[150:])}
        assert as_set(broadside.pairs(BOXES[:150], BOXES[150:], **both)) == between
    with pytest.raises(ValueError, match="filters with categories or masks are given with same"):
        broadside.pairs(BOXES, same=images, different=images, filters=broadside.filters(400, mask=2))


def test_a_key_means_the_same_in_two_sets():
    left, right = BOXES[:250], BOXES[250:]
    for keys in KEYS.values():
        both = (keys[:250], keys[250:])
        equal = {(a, b) for a, b in brute_force(left, right) if both[0][a] == both[1][b]}
        assert as_set(broadside.pairs(left, right, same=both)) == equal
        assert broadside.count(left, right, different=both) == len(brute_force(left, right)) - len(equal)
    texts = (np.array(["a", "bcd"]), np.array(["bcd"]), np.array(["bcd"], object))  # of other types
    for other in texts[1:]:
        assert broadside.pairs(BOXES[[0, 0]], BOXES[[0]], same=(texts[0], other)).tolist() == [[1, 0]]
    far = (np.array([0, 2**62]), np.array([2**62], np.uint64))
    assert broadside.pairs(BOXES[[0, 0]], BOXES[[0]], same=far).tolist() == [[1, 0]]


def test_columns_of_tables_are_keys():
    pandas = pytest.importorskip("pandas")
    names = KEYS["strings"]
    expected = broadside.count(BOXES, same=names)
    for column in (pandas.Series(names), pandas.Series(names, dtype="category"), pandas.Categorical(names)):
        assert broadside.count(BOXES, same=column) == expected
    objects = pandas.Series(names.tolist(), dtype=object)
    for column in (objects, pandas.Index(names), objects.astype("string"), pandas.Series([*names, "d"]).astype("category")[:400]):
        assert broadside.count(BOXES, same=column) == expected
        assert broadside.count(BOXES, BOXES, same=(column, names)) == 2 * expected + 400
    with pytest.raises(TypeError, match="same has a float in row 2"):
        broadside.pairs(BOXES[:3], same=pandas.Series(["a", "a", 0.5], dtype=object))
    left = pandas.Series(["a", "b"], dtype="category")
    right = pandas.Series(["b"], dtype="category")
    assert broadside.pairs(BOXES[[0, 0]], BOXES[[0]], same=(left, right)).tolist() == [[1, 0]]
    for missing in (pandas.Series(["a", None]), pandas.Series(["a", None], dtype="category"), pandas.Series([1, None])):
        with pytest.raises(ValueError, match="same has no key in row 1; expected integers, strings or categories"):
            broadside.pairs(BOXES[:2], same=missing)


def test_several_keys_are_one_and_columns_go_by_name():
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    images, classes = RNG.integers(-3, 4, 400), RNG.choice(["cat", "dog"], 400)
    columns = dict(zip(["xmin", "ymin", "xmax", "ymax"], BOXES.T)) | {"image": images, "class": classes}
    structured = np.zeros(400, [(name, np.asarray(column).dtype) for name, column in columns.items()])
    for name, column in columns.items():
        structured[name] = column
    equal = {(a, b) for a, b in brute_force(BOXES) if images[a] == images[b] and classes[a] == classes[b]}
    unequal = brute_force(BOXES) - equal
    assert equal and unequal
    assert as_set(broadside.pairs(BOXES, same=(images, classes))) == equal
    between = broadside.count(BOXES, BOXES, same=((images, classes), (images, classes)))
    for table in (pandas.DataFrame(columns), polars.DataFrame(columns), pyarrow.table(columns), structured):
        both = table[["image", "class"]] if hasattr(table, "loc") else ["class", "image"]
        for keys in (["image", "class"], ("image", "class"), both):
            assert as_set(broadside.pairs(table, same=keys)) == equal
            assert as_set(broadside.pairs(table, different=keys)) == unequal
        assert broadside.count(table, table, same=["image", "class"]) == between
        assert broadside.count(table, same="image") == broadside.count(BOXES, same=images)
        assert broadside.count(table, table, same=("image", "image")) == broadside.count(BOXES, BOXES, same=(images, images))
        with pytest.raises(TypeError, match="same is 'imgae', which no column of the boxes is called"):
            broadside.pairs(table, same="imgae")
    with pytest.raises(ValueError, match="same has 400 and 3 keys"):
        broadside.pairs(BOXES, same=(images, classes[:3]))
    with pytest.raises(ValueError, match="same has 2 keys for a box and 1 for one of other"):
        broadside.pairs(BOXES, BOXES, same=((images, classes), images))


def test_arrow_columns_are_keys():
    pyarrow = pytest.importorskip("pyarrow")
    names = pyarrow.array(KEYS["strings"].tolist())
    expected = broadside.count(BOXES, same=KEYS["strings"])
    chunks = [names[:1].dictionary_encode(), names[1:].dictionary_encode()]
    assert not chunks[0].dictionary.equals(chunks[1].dictionary)
    for column in (names, names.dictionary_encode(), pyarrow.chunked_array([names[:7], names[7:]]), pyarrow.chunked_array(chunks)):
        assert broadside.count(BOXES, same=column) == expected
        assert broadside.count(BOXES, BOXES, same=(column, KEYS["strings"])) == 2 * expected + 400
    integers = pyarrow.array(KEYS["integers"])
    for column in (integers, integers.dictionary_encode()):
        assert broadside.count(BOXES, same=column) == broadside.count(BOXES, same=KEYS["integers"])
    assert broadside.count([], same=names[:0]) == broadside.count([], same=names[:0].dictionary_encode()) == 0
    for missing in (pyarrow.array(["a", None]), pyarrow.array(["a", None]).dictionary_encode()):
        with pytest.raises(ValueError, match="same has no key in row 1"):
            broadside.pairs(BOXES[:2], same=missing)


def test_filters_are_applied_as_well_or_refused():
    statics = broadside.filters(400, is_static=np.arange(400) % 2 == 0)
    keys = KEYS["integers"]
    for rule in ("same", "different"):
        expected = {(a, b) for a, b in brute_force(BOXES) if (keys[a] == keys[b]) == (rule == "same") and (a % 2 or b % 2)}
        assert as_set(broadside.pairs(BOXES, filters=statics, **{rule: keys})) == expected
    masks = broadside.filters(400, category=[1, 2] * 200, mask=1)
    expected = {(a, b) for a, b in brute_force(BOXES) if keys[a] != keys[b] and a % 2 == b % 2 == 0}
    assert as_set(broadside.pairs(BOXES, filters=masks, different=keys)) == expected
    with pytest.raises(ValueError, match="filters with categories or masks are given with same"):
        broadside.pairs(BOXES, filters=masks, same=keys)
    with pytest.raises(ValueError, match="filters with groups are given with different"):
        broadside.pairs(BOXES, filters=broadside.filters(400, group=1), different=keys)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"same": [1, 2, 3]}, ValueError, "same has 3 keys for 400 boxes; expected one for each box"),
        ({"same": KEYS["all"], "different": KEYS["all"][:3]}, ValueError, "different has 3 keys for 400 boxes"),
        ({"same": [np.nan] * 400}, ValueError, "same has no key in row 0"),
        ({"same": [1.0, 0.5] * 200}, TypeError, 'same has dtype float64 and is 0.5 in row 1; .*.astype."Int64".'),
        ({"same": [1.0, np.inf] * 200}, TypeError, "same has dtype float64 and is inf in row 1"),
        ({"same": [1.0, 2.0**54] * 200}, TypeError, "same has dtype float64 and is 1.8.* in row 1"),
        ({"same": [[1]] * 400}, ValueError, r"same has shape \(400, 1\)"),
        ({"different": [None] * 400}, ValueError, "different has no key in row 0"),
        ({"different": "layer"}, TypeError, "different is 'layer', which no column of the boxes is called"),
        ({"other": BOXES, "same": KEYS["all"]}, TypeError, r"same has keys for one set of boxes \(a ndarray\), .* same=\(keys_of_boxes, keys_of_other\)"),
        ({"other": BOXES, "same": (KEYS["all"], KEYS["strings"])}, TypeError, "same has strings for one set"),
    ],
)
def test_refuses_other_keys(arguments, error, message):
    with pytest.raises(error, match=message):
        broadside.pairs(BOXES, **arguments)


def test_components_are_those_of_the_pairs():
    for width in (0.01, 0.04, 0.1):
        boxes = np.concatenate([BOXES[:, :2], BOXES[:, :2] + width], axis=1)
        labels = np.arange(400)
        for _ in range(400):
            for a, b in brute_force(boxes):
                labels[a] = labels[b] = min(labels[a], labels[b])
            if all(labels[a] == labels[b] for a, b in brute_force(boxes)):
                break
        found = broadside.components(boxes)
        assert found.dtype == np.uint32 and found.tolist() == labels.tolist()
    assert broadside.components(BOXES, same=KEYS["all"]).tolist() == list(range(400))
    many = scattered(50_000, 2)
    assert (broadside.components(many, threads=2) == broadside.components(many, algorithm="sweep_and_prune")).all()
    assert broadside.components([]).shape == (0,)
