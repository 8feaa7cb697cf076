"""Porosity against friction, and the specimen cut open: plot.py RUN FOLDER copies friction_path.csv of the run to FOLDER
and writes FOLDER/soil_rock.png and slices.png."""
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
import style  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
import slices  # noqa: E402
from read_run import read_table  # noqa: E402

PAPER = (0.8, 0.4), (0.4160, 0.3844)   # Jin 2017: friction, porosity
N_MIN = 0.3492                         # its friction is not given


def main(run, folder):
    run, folder = pathlib.Path(run), pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(run / "friction_path.csv", folder / "friction_path.csv")
    path = read_table(folder / "friction_path.csv")
    style.use()
    figure, axes = plt.subplots()
    mu, n = path["friction"], path["porosity"]
    order = mu.argsort()
    axes.plot(mu[order], n[order], "o-", color=style.BLUE, label="here: rock, polyhedra")
    axes.plot(*PAPER, "s--", color=style.RUST, label="Jin 2017: soil spheres and rock clumps")
    axes.axhline(N_MIN, color=style.RUST, lw=0.8, ls=":", label="its densest")
    axes.set_xlabel("friction coefficient of the grains (-)")
    axes.set_ylabel("porosity (-)")
    axes.legend()
    axes.set_title(f"n$_{{max}}$/n$_{{min}}$ = {n.max() / n.min():.3f} (paper {PAPER[1][0] / N_MIN:.3f})")
    style.save(figure, folder / "soil_rock.png")
    style.save(slices.draw(run / "sections.csv")[0], folder / "slices.png")


if __name__ == "__main__":
    main(*sys.argv[1:3])
