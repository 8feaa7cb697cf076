"""Misclassification against time, and the spread of each method's size: FOLDER/sieve_methods.png."""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


def main(folder):
    folder = pathlib.Path(folder)
    methods = list(csv.DictReader(open(folder / "methods.csv")))
    ratios = {}
    for row in csv.DictReader(open(folder / "grains.csv")):
        ratios.setdefault(row["method"], []).append(float(row["ratio"]))
    style.use()
    colour = {m["method"]: style.SERIES[k] for k, m in enumerate(methods)}
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.7))
    for m in methods:
        seconds, wrong = float(m["seconds_per_grain"]), float(m["wrong_class_percent"])
        left.plot(seconds, wrong, "o", color=colour[m["method"]], markersize=7)
        shift = {"exact": (-42, 7), "equal_sphere": (-4, 8)}.get(m["method"], (9, -3))
        left.annotate(m["method"], (seconds, wrong), xytext=shift, textcoords="offset points",
                      fontsize=8)
    left.set_xscale("log")
    left.set_ylim(-4, 100)
    left.set_xlabel("time per grain [s], one core")
    left.set_ylabel("grains in the wrong sieve class [%]")
    left.set_title("Accuracy against time")
    names = [m["method"] for m in methods if m["method"] != "exact"]
    parts = right.violinplot([ratios[n] for n in names], showextrema=False, widths=0.85, vert=False)
    for body, name in zip(parts["bodies"], names):
        body.set_facecolor(colour[name])
        body.set_alpha(0.75)
    for k, name in enumerate(names):
        mean = sum(ratios[name]) / len(ratios[name])
        right.plot([mean], [k + 1], "|", color=style.INK, markersize=9)
    right.axvline(1, color=style.INK, linewidth=0.8)
    right.set_yticks(range(1, len(names) + 1), names)
    right.set_xlabel("size by the method / exact size")
    right.set_title("Spread over %s grains" % methods[0]["grains"])
    figure.savefig(folder / "sieve_methods.png")


if __name__ == "__main__":
    main(sys.argv[1])
