"""Virtual slices through a bed, as a saw would show it (Jin, Zeng, Ye, Li 2017, Fig. 10).

    /usr/bin/python3 apps/plots/slices.py results/my_run/sections.csv slices.png
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap  # noqa: E402

import style  # noqa: E402
from read_run import Missing, read_table  # noqa: E402

STONE = LinearSegmentedColormap.from_list("stone", ["#cfc6b6", "#a89c89", "#84796b", "#5f574e"])
NAMES = {"x": ("y", "z"), "y": ("x", "z"), "z": ("x", "y")}


def cuts(path):
    """[(axis, position, polygons [mm], grain of each)], in the file's order."""
    table = read_table(path)
    found = []
    piece, axis, position = table["piece"], table["axis"], table["position_m"]
    starts = np.flatnonzero(np.r_[True, piece[1:] != piece[:-1]])
    corners = np.column_stack([table["a_m"], table["b_m"]]) * 1e3
    for begin, end in zip(starts, np.r_[starts[1:], len(piece)]):
        if not found or (axis[begin], position[begin]) != found[-1][:2]:
            found.append((axis[begin], position[begin], [], []))
        found[-1][2].append(corners[begin:end])
        found[-1][3].append(int(table["grain"][begin]))
    return found


def draw(path):
    """(figure, caption). Raises Missing."""
    found = cuts(path)
    if not found:
        raise Missing("no grain is cut")
    columns = min(3, len(found))
    lines = -(-len(found) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(style.COLUMN[0], 2.6 * lines), squeeze=False)
    for panel in axes.flat[len(found):]:
        panel.remove()
    for panel, (axis, position, polygons, grains) in zip(axes.flat, found):
        # A grain's grey is its own in every slice; neighbours differ.
        shade = STONE((np.array(grains) * 0.6180339887) % 1)
        panel.add_collection(PolyCollection(polygons, facecolors=shade, edgecolors="none"))
        panel.autoscale_view()
        panel.set_aspect("equal")
        panel.grid(False)
        panel.set_title(f"{axis} = {position * 1e3:.0f} mm")
        across, up = NAMES[axis]
        panel.set_xlabel(f"{across} (mm)")
        panel.set_ylabel(f"{up} (mm)")
    return figure, ("Cuts through the bed; every grain keeps its grey from slice to slice. A grain that looks small is "
                    "cut near its end.")


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    style.use()
    try:
        style.save(draw(sys.argv[1])[0], sys.argv[2])
    except (Missing, OSError) as why:
        print(f"slices: {why}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
