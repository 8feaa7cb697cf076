"""Error against time, one small picture a ladder, with its fitted order: FOLDER/accuracy.png."""
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402

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
    ("Matched boundary: reflected energy", ["reflection, matched"]),
    ("Size of the domain", ["size of the domain"]),
    ("Exchange schedule: growth", ["exchange schedule"]),
    ("Sub-cycling: growth", ["sub-cycling"]),
    ("Step of the exchange: growth", ["step, predicted", "step, lagged"]),
]
BY_COUNT = {"spheres of a clump", "step, predicted", "step, lagged", "sub-cycling", "exchange schedule"}
NAMED = {"sieve size", "exchange schedule", "sub-cycling"}     # rungs that are words or few


def draw(axes, ladder, rows, colour, label):
    counted = ladder in BY_COUNT
    least = min(float(r["error"]) for r in rows if float(r["error"]) > 0)
    points = [(float(r["count"] if counted else r["seconds"]), float(r["error"]) or 0.1 * least, r["rung"]) for r in rows]
    ladder_points = [p for p, r in zip(points, rows) if float(r["size"]) > 0]
    order = float(rows[0]["fitted_order"])
    text = f"{label}{', ' if label else ''}order {order:.2f}" if math.isfinite(order) else label
    if len(ladder_points) > 1:
        axes.plot([p[0] for p in ladder_points], [p[1] for p in ladder_points], color=colour, lw=0.9)
    for (x, y, _), row in zip(points, rows):    # hollow: exact, drawn a decade below the others
        axes.plot([x], [y], "o", color=colour, markerfacecolor=colour if float(row["error"]) > 0 else "white")
    axes.plot([], [], "o", color=colour, label=text or None)
    ends = points if ladder in NAMED else [points[0], points[-1]]
    if not label:
        for x, y, rung in ends:
            axes.annotate(rung, (x, y), xytext=(4, 3), textcoords="offset points", fontsize=5.5, color=style.QUIET)
    axes.set_xlabel(rows[0]["counted"] if counted else f"{rows[0]['seconds_of']} [s]", fontsize=7)


def main(folder):
    folder = pathlib.Path(folder)
    ladders = {}
    with open(folder / "accuracy.csv", newline="") as text:
        for row in csv.DictReader(text):
            ladders.setdefault(row["ladder"], []).append(row)
    style.use()
    figure, panels = plt.subplots(5, 3, figsize=(7.8, 10.4))
    for axes, (title, names) in zip(panels.flat, PICTURES):
        for k, name in enumerate(names):
            label = name.split(", ", 1)[-1] if len(names) > 1 else ""
            draw(axes, name, ladders[name], style.SERIES[k], label)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.margins(x=0.18)
        axes.set_title(title, fontsize=8.5)
        axes.tick_params(labelsize=6.5)
        axes.minorticks_off()
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=5.5)
    for axes in panels[:, 0]:
        axes.set_ylabel("error", fontsize=7.5)
    style.save(figure, folder / "accuracy.png")


if __name__ == "__main__":
    main(sys.argv[1])
