"""Figures, drawn by Matplotlib at the size at which they are printed, so that they are readable there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import blended_transform_factory

from .experiment import NAME_FROM_THE_CODE, Unusable
from .statistics import Estimate

WIDTH = 5.6          # inches: the width of the printed text
LEAST_POINTS = 8     # minimum size of any label, as printed
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]  # Okabe and Ito
MARKERS = "os^Dv<>"

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 8.5, "axes.titlesize": 9, "axes.labelsize": 8.5,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "legend.fontsize": 8, "legend.frameon": False,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.5, "lines.linewidth": 1.2, "lines.markersize": 3.5, "axes.prop_cycle":
    matplotlib.cycler(color=COLOURS), "svg.hashsalt": "broadside", "svg.fonttype": "path",
    "figure.constrained_layout.use": True, "figure.max_open_warning": 0, "pdf.fonttype": 42,
})

# The names of algorithms in figures and tables.
NAMES = {
    "paper_brute_force": "the draft's brute force", "paper_grid": "the draft's grid",
    "paper_sweep_and_prune": "the draft's sweep", "paper_quadtree": "the draft's quadtree",
    "brute_force": "our brute force", "grid": "our grid", "sweep_and_prune": "our sweep",
    "quadtree": "our quadtree", "bvh": "our tree of bounds", "auto": "our own choice",
}


@dataclass(frozen=True)
class Figure:
    """A figure of an experiment: its name, its caption, and the drawing."""

    name: str
    caption: str
    drawing: pyplot.Figure


def new(columns: int = 1, height: float = 2.6) -> tuple[pyplot.Figure, list[Axes]]:
    """A drawing as wide as the text, with axes side by side."""
    drawing, axes = pyplot.subplots(1, columns, figsize=(WIDTH, height), squeeze=False)
    return drawing, list(axes[0])


def label(axes: Axes, x: str, y: str, title: str = "", log: str = "xy") -> None:
    """Labels the axes, with units in words; `log` names the logarithmic axes. Call after drawing the lines."""
    axes.set(xlabel=x, ylabel=y, title=title)
    for set_scale, axis, is_log in ((axes.set_xscale, axes.xaxis, "x" in log),
                                    (axes.set_yscale, axes.yaxis, "y" in log)):
        if is_log:
            set_scale("log")
            low, high = sorted(axis.get_view_interval())
            decades = numpy.log10(high / low) if low > 0 else numpy.inf
            subs = (1, 2, 5) if decades < 1.2 else (1, 3) if decades < 2.5 else (1,)
            axis.set_major_locator(matplotlib.ticker.MaxNLocator(4) if decades < 0.5 else
                                   matplotlib.ticker.LogLocator(subs=subs))
            axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:,.10g}"))
            axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def line(axes: Axes, x: Sequence, y: Sequence, name: str = "", joined: bool = True) -> None:
    """A line through figures, with their intervals as bars: numbers along one axis, estimates along the other. Only
    points if there is nothing to interpolate."""
    number = len(axes.containers)
    (x, x_bars), (y, y_bars) = _values_and_bars(x), _values_and_bars(y)
    axes.errorbar(x, y, y_bars, x_bars, label=name or None, marker=MARKERS[number % len(MARKERS)], capsize=2,
                  elinewidth=0.8, linestyle="-" if joined else "none")


def legend(axes: Axes, title: str = "", is_shared: bool = False) -> None:
    """The legend of the lines, at the bottom, clear of the data: below the axes, or below all if they share it. The
    drawing grows by its height."""
    drawing = axes.figure
    width = drawing.bbox.width if is_shared else drawing.bbox.width / len(drawing.axes)
    place = drawing.transFigure if is_shared else blended_transform_factory(axes.transAxes, drawing.transFigure)
    for columns in range(len(axes.get_legend_handles_labels()[0]), 0, -1):
        made = axes.legend(title=title, ncols=columns, loc="lower center", borderaxespad=0.2, bbox_to_anchor=(0.5, 0),
                           bbox_transform=place)
        extent = made.get_window_extent(drawing.canvas.get_renderer())
        if extent.width <= width:
            break
    made.set_in_layout(False)
    layout = drawing.get_layout_engine()
    kept = (layout.get()["rect"] or (0, 0, 1, 1))[1] * drawing.get_figheight()
    needed = max(kept, extent.height / drawing.dpi + 0.05)
    height = drawing.get_figheight() + needed - kept
    drawing.set_figheight(height)
    layout.set(rect=(0, needed / height, 1, 1 - needed / height))


def _values_and_bars(numbers: Sequence) -> tuple[Sequence[float], numpy.ndarray | None]:
    numbers = list(numbers)
    if not isinstance(numbers[0], Estimate):
        return numbers, None
    bars = numpy.nan_to_num([[at.value - at.low, at.high - at.value] for at in numbers])
    return [at.value for at in numbers], numpy.abs(bars).T


def check(figure: Figure) -> None:
    """Raises Unusable if a label is too small to read or cut off, or is a name from the code."""
    if figure.drawing.get_figwidth() > WIDTH + 1e-6:
        raise Unusable(f"figure {figure.name} is {figure.drawing.get_figwidth():g} inches wide; expected at "
                       f"most {WIDTH:g}, as wide as it is printed")
    for text in figure.drawing.findobj(Text):
        words = text.get_text()
        if not words or not text.get_visible():
            continue
        if text.get_fontsize() < LEAST_POINTS:
            raise Unusable(f"figure {figure.name}: '{words}' has {text.get_fontsize():g} points; expected "
                           f"{LEAST_POINTS} or more")
        if NAME_FROM_THE_CODE.search(words):
            raise Unusable(f"figure {figure.name}: '{words}' is a name from the code; expected words")
    figure.drawing.draw_without_rendering()
    page = figure.drawing.bbox.padded(1)
    for text in (text for axes in figure.drawing.axes for text in (axes.xaxis.label, axes.yaxis.label, axes.title)):
        place = text.get_window_extent()
        if text.get_text() and not (page.contains(*place.min) and page.contains(*place.max)):
            raise Unusable(f"figure {figure.name}: '{text.get_text()}' is cut off; expected a label that fits")


def save(figure: Figure, folder: Path) -> None:
    """Writes SVG for pages and PDF for print; the same drawing gives the same bytes."""
    check(figure)
    folder.mkdir(parents=True, exist_ok=True)
    figure.drawing.savefig(folder / f"{figure.name}.svg", metadata={"Date": None})
    figure.drawing.savefig(folder / f"{figure.name}.pdf", metadata={"CreationDate": None})
    pyplot.close(figure.drawing)
