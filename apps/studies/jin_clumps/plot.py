"""Spheres and volume left out, each stone against the paper's values: FOLDER/jin_clumps.png."""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


def main(folder):
    folder = pathlib.Path(folder)
    groups = {}
    for row in csv.DictReader(open(folder / "table2.csv")):
        groups.setdefault((row["least_radius_m"], row["space_factor"]), []).append(row)
    style.use()
    figure, axes = plt.subplots(figsize=(6.3, 3.7))
    for k, ((least, factor), rows) in enumerate(groups.items()):
        spheres = [float(r["spheres"]) for r in rows]
        missing = [float(r["left_out_percent"]) for r in rows]
        axes.plot(spheres, missing, "o", color=style.SERIES[k], alpha=0.4, markeredgewidth=0,
                  label="R_lim %g mm, K %s: mean %.0f spheres, %.1f %%" % (
                      1e3 * float(least), factor, sum(spheres) / len(rows), sum(missing) / len(rows)))
        axes.plot(float(rows[0]["paper_spheres"]), float(rows[0]["paper_left_out_percent"]), "X",
                  color=style.SERIES[k], markersize=11, markeredgecolor="white")
    axes.plot([], [], "X", color=style.QUIET, markersize=10, label="the paper's stone")
    axes.set_xscale("log")
    ticks = [30, 50, 100, 200, 300, 500]
    axes.set_xticks(ticks, [str(t) for t in ticks])
    axes.minorticks_off()
    axes.set_xlabel("spheres in the clump")
    axes.set_ylabel("volume of the stone left out [%]")
    axes.set_title("Filling %d stones of Jin's parameters" % len(rows))
    axes.legend()
    figure.savefig(folder / "jin_clumps.png")


if __name__ == "__main__":
    main(sys.argv[1])
