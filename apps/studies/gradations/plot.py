"""Target and achieved sieve curves: FOLDER/gradations.png."""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402


def main(folder):
    folder = pathlib.Path(folder)
    curves = {}
    for row in csv.DictReader(open(folder / "gradations.csv")):
        curves.setdefault(row["gradation"], {}).setdefault(row["seed"], []).append(row)
    style.use()
    figure, axes = plt.subplots(figsize=(6.3, 3.7))
    for k, (name, seeds) in enumerate(curves.items()):
        for j, rows in enumerate(seeds.values()):
            sieve = [1e3 * float(r["sieve_m"]) for r in rows]
            if j == 0:
                axes.plot(sieve, [float(r["target_percent"]) for r in rows], "-",
                          color=style.SERIES[k], label="%s: %s grains" % (name, rows[0]["grains"]))
            axes.plot(sieve, [float(r["achieved_percent"]) for r in rows], "o",
                      color=style.SERIES[k], markerfacecolor="none")
    axes.plot([], [], "o", color=style.QUIET, markerfacecolor="none", label="achieved, all seeds")
    axes.set_xlabel("sieve [mm]")
    axes.set_ylabel("passing by mass [%]")
    axes.set_title("Shao's three gradations, 108.4 kg each")
    axes.legend()
    figure.savefig(folder / "gradations.png")


if __name__ == "__main__":
    main(sys.argv[1])
