"""Figures: readable as printed, without names from the code, the same bytes for the same drawing."""

import tempfile
import unittest
from pathlib import Path

from tools.paper import figures
from tools.paper.experiment import Unusable
from tools.paper.statistics import Estimate

AT = [Estimate(1, 0.9, 1.1, (1,)), Estimate(2, 1.8, 2.2, (2,))]


def drawn(x="boxes", name="the draft's grid"):
    drawing, (axes,) = figures.new()
    figures.line(axes, [10, 100], AT, name)
    figures.label(axes, x, "milliseconds")
    figures.legend(axes)
    return figures.Figure("one", "One.", drawing), axes


class Figures(unittest.TestCase):
    def test_of_words_of_eight_points_or_more_are_taken(self):
        figures.check(drawn()[0])

    def test_with_small_labels_are_refused(self):
        figure, axes = drawn()
        axes.set_title("small", fontsize=7.5)
        with self.assertRaisesRegex(Unusable, "'small' has 7.5 points; expected 8 or more"):
            figures.check(figure)

    def test_with_names_from_the_code_are_refused(self):
        for figure, _ in (drawn(name="paper_grid"), drawn(x="grid:cell")):
            with self.assertRaisesRegex(Unusable, "is a name from the code"):
                figures.check(figure)

    def test_with_labels_that_are_cut_off_are_refused(self):
        with self.assertRaisesRegex(Unusable, "is cut off; expected a label that fits"):
            figures.check(drawn(x="a label that says more than a column holds " * 3)[0])

    def test_have_legends_below_where_no_data_are(self):
        drawing, (left, right) = figures.new(columns=2)
        height = drawing.get_figheight()
        for axes, names in ((left, ("one", "two")), (right, ("a line of a long name", "another of such a name"))):
            for name in names:
                figures.line(axes, [10, 100], AT, name)
            figures.label(axes, "boxes", "milliseconds")
            figures.legend(axes, "lines")
        drawing.draw_without_rendering()
        for axes in (left, right):
            legend, labels = axes.get_legend().get_window_extent(), axes.xaxis.label.get_window_extent()
            self.assertLess(legend.y1, labels.y0)
            self.assertGreaterEqual(legend.y0, 0)
        self.assertLess(left.get_legend().get_window_extent().x1, right.get_legend().get_window_extent().x0)
        self.assertGreater(drawing.get_figheight(), height)

    def test_wider_than_the_text_are_refused(self):
        figure, _ = drawn()
        figure.drawing.set_figwidth(8)
        with self.assertRaisesRegex(Unusable, "is 8 inches wide"):
            figures.check(figure)

    def test_are_the_same_bytes_each_time(self):
        with tempfile.TemporaryDirectory() as folder:
            for copy in ("a", "b"):
                figures.save(drawn()[0], Path(folder) / copy)
            for name in ("one.svg", "one.pdf"):
                self.assertEqual((Path(folder) / "a" / name).read_bytes(), (Path(folder) / "b" / name).read_bytes())


if __name__ == "__main__":
    unittest.main()
