"""The two boxes in their least holes, and their sizes by every method: FOLDER/shao_boxes.png."""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


def main(folder):
    folder = pathlib.Path(folder)
    sizes = list(csv.DictReader(open(folder / "sizes.csv")))
    outlines = {}
    for row in csv.DictReader(open(folder / "outlines.csv")):
        hole, x, y = outlines.setdefault(row["grain"], (float(row["hole_mm"]), [], []))
        x.append(float(row["x_mm"]))
        y.append(float(row["y_mm"]))
    style.use()
    figure, axes = plt.subplots(1, 3, figsize=(9.2, 3.2), width_ratios=(1, 1, 1.4))
    for panel, (grain, (hole, x, y)) in zip(axes, outlines.items()):
        x = [a - 0.5 * (min(x) + max(x)) for a in x]
        y = [b - 0.5 * (min(y) + max(y)) for b in y]
        for side, colour in ((63, style.QUIET), (hole, style.RUST)):
            half = side / 2
            panel.plot([-half, half, half, -half, -half], [-half, -half, half, half, -half], color=colour,
                       lw=1, label=f"hole of {side:.2f} mm")
        panel.fill(x, y, color=style.BLUE, alpha=0.6, lw=0, label="shadow")
        panel.set_aspect("equal")
        panel.set_title(grain + " mm")
        panel.set_xlim(-48, 48)
        panel.set_ylim(-48, 62)
        panel.legend(loc="upper center", fontsize=7)
    names = list(dict.fromkeys(row["method"] for row in sizes))
    for k, grain in enumerate(outlines):
        values = [float(row["size_mm"]) for row in sizes if row["grain"] == grain]
        axes[2].barh([i + 0.2 - 0.4 * k for i in range(len(names))], values, 0.38, color=(style.BLUE, style.OCHRE)[k],
                     label=grain)
    axes[2].axvline(63, color=style.INK, lw=0.8)
    axes[2].set_yticks(range(len(names)), names)
    axes[2].invert_yaxis()
    axes[2].set_xlabel("size (mm); line: the 63 mm sieve")
    axes[2].set_xlim(0, 130)
    axes[2].legend(loc="right", fontsize=7)
    figure.savefig(folder / "shao_boxes.png")


if __name__ == "__main__":
    main(sys.argv[1])
