"""Error against time, one small picture a ladder, with its fitted order: FOLDER/accuracy.png."""
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator  # noqa: E402

# Pictures in their order: title and the ladders drawn in it; time on the abscissa, else the count.
PICTURES = [
    ("Time step: Hertz impact", ["hertz impact, duration", "hertz impact, rebound"]),
    ("Time step: free rotation", ["free rotation"]),
    ("Sieve method", ["sieve size"]),
    ("Slices of a clump", ["slices of a clump"]),
    ("Spheres of a clump", ["spheres of a clump"]),
    ("Dilated grain: cells, Steiner", ["dilated grain"]),
    ("Elements: manufactured solution", ["elements, Q1", "elements, Q1 with incompatible modes", "elements, Q2"]),
    ("Bending", ["bending, Q1", "bending, Q1 with incompatible modes", "bending, Q2"]),
    ("Poisson's ratio .4999", ["near-incompressible, Q1", "near-incompressible, Q1 with mean dilatation",
                               "near-incompressible, Q1 with incompatible modes", "near-incompressible, Q2",
                               "near-incompressible, Q2 with mean dilatation"]),
    ("Reduction", ["reduction, sleeper by modes", "reduction, soil condensed"]),
    ("Matched boundary: reflection", ["reflection, matched"]),
    ("Size of the domain", ["size of the domain"]),
    ("Exchange schedule: growth", ["exchange schedule"]),
    ("Sub-cycling: growth", ["sub-cycling"]),
    ("Step of the exchange: growth", ["step, predicted", "step, lagged"]),
]
BY_COUNT = {"spheres of a clump", "step, predicted", "step, lagged", "sub-cycling", "exchange schedule"}
# Rungs that are words: each is named, (to its right or left, points up).
NAMED = {"sieve size": {"equal_cube": (1, 4), "equal_sphere": (1, -10), "elias2014": (1, 0), "shao2017": (-1, -2),
                        "min_shadow": (1, -11), "exact to 0.1": (-1, 4), "exact to 0.01": (-1, 2),
                        "exact to 0.001": (-1, 0), "exact to 0.0001": (-1, 0), "exact": (1, 6)},
         "exchange schedule": {"lagged": (1, -3), "predicted": (1, -3), "explicit": (1, 4), "iterated": (-1, 4)},
         "sub-cycling": {}}
SHORT = {"with incompatible modes": "incompatible", "with mean dilatation": "mean dilatation"}


def short(label):
    for words, less in SHORT.items():
        label = label.replace(words, less)
    return label


def draw(axes, ladder, rows, colour, label):
    counted = ladder in BY_COUNT
    least = min(float(r["error"]) for r in rows if float(r["error"]) > 0)
    points = [(float(r["count"] if counted else r["seconds"]), float(r["error"]) or 0.1 * least, r["rung"]) for r in rows]
    ladder_points = [p for p, r in zip(points, rows) if float(r["size"]) > 0]
    order = float(rows[0]["fitted_order"])
    text = f"{short(label)}{', ' if label else ''}order {order:.2f}" if math.isfinite(order) else short(label)
    if len(ladder_points) > 1:
        axes.plot([p[0] for p in ladder_points], [p[1] for p in ladder_points], color=colour, lw=0.9)
    for (x, y, _), row in zip(points, rows):    # hollow: exact, drawn a decade below the others
        axes.plot([x], [y], "o", ms=3.5, color=colour, markerfacecolor=colour if float(row["error"]) > 0 else "white")
    axes.plot([], [], "o", ms=3.5, color=colour, label=text or None)
    places = NAMED.get(ladder)
    named = points if places is not None else [points[0], points[-1]]
    if not label:
        for x, y, rung in named:
            side, up = (places or {}).get(rung, (1, 3))
            axes.annotate(rung, (x, y), xytext=(5 * side, up), textcoords="offset points", fontsize=5.5, color=style.QUIET,
                          ha="left" if side > 0 else "right")
    axes.set_xlabel(rows[0]["counted"] if counted else f"{rows[0]['seconds_of']} [s]", fontsize=7)


def ticks(axis, low, high):
    """Two or more labelled ticks, whatever the range: decades, thinned; else 1, 2, 5 of them."""
    decades = math.log10(high / low)
    if decades > 1.6:
        axis.set_major_locator(LogLocator(base=10, subs=(1,), numticks=6))
        return
    axis.set_major_locator(LogLocator(base=10, subs=(1, 2, 5), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def main(folder):
    folder = pathlib.Path(folder)
    ladders = {}
    with open(folder / "accuracy.csv", newline="") as text:
        for row in csv.DictReader(text):
            ladders.setdefault(row["ladder"], []).append(row)
    style.use()
    figure, panels = plt.subplots(5, 3, figsize=(9.2, 12.2))
    for axes, (title, names) in zip(panels.flat, PICTURES):
        for k, name in enumerate(names):
            label = name.split(", ", 1)[-1] if len(names) > 1 else ""
            draw(axes, name, ladders[name], style.SERIES[k], label)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.margins(x=0.2, y=0.1)
        axes.set_title(title, fontsize=8.5)
        axes.tick_params(labelsize=6.5)
        axes.minorticks_off()
        ticks(axes.xaxis, *axes.get_xlim())
        ticks(axes.yaxis, *axes.get_ylim())
        shown = len(axes.get_legend_handles_labels()[0])
        if shown:    # above the points, in room of its own
            low, high = (math.log10(limit) for limit in axes.get_ylim())
            axes.set_ylim(10 ** low, 10 ** (high + (high - low) * 0.1 * shown))
            axes.legend(fontsize=5.8, loc="upper right", borderpad=0, labelspacing=0.25, handletextpad=0.1)
    for axes in panels[:, 0]:
        axes.set_ylabel("error", fontsize=7.5)
    style.save(figure, folder / "accuracy.png")


if __name__ == "__main__":
    main(sys.argv[1])
