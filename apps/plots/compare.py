"""Rigid against elastic on the same packing: compare.py DIR. Writes DIR/compare.csv, DIR/compare.html and PNGs.

DIR holds rigid/ and elastic/; rigid_repeat/ and elastic_repeat/, which differ from them in the last bit, give the noise
floor; packing_2/, packing_3/ … with a rigid/ and an elastic/ each give the scatter.
"""
import argparse
import csv
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import figures  # noqa: E402
import measures  # noqa: E402
import page  # noqa: E402
import scatter  # noqa: E402
import style  # noqa: E402
from read_run import Missing, Run  # noqa: E402
from report import attempt  # noqa: E402
from style import number  # noqa: E402

# quantity, SI unit, measure, factor and unit for the eye
QUANTITIES = [
    ("settlement after the last cycle", "m", measures.settlement, 1e3, "mm"),
    ("mean elastic displacement per cycle", "m", measures.elastic_displacement, 1e3, "mm"),
    ("stiffness of the last cycle, unloading (K_e)", "N/m", measures.stiffness, 1e-6, "kN/mm"),
    ("stiffness of the last cycle, loading", "N/m", lambda run: measures.stiffness(run, "loading"), 1e-6, "kN/mm"),
    ("peak pressure under the sleeper (99th percentile)", "Pa", measures.pressure_peak, 1e-3, "kPa"),
    ("unevenness of that pressure (deviation over mean)", "1", measures.pressure_spread, 1, ""),
    ("largest bending moment of the sleeper", "N.m", measures.moment_largest, 1e-3, "kN·m"),
    ("bending of the sleeper (deflection range, tilt taken out)", "m", measures.deflection_range, 1e3, "mm"),
    ("force on a grain (95th percentile of the largest)", "N", measures.grain_force, 1e-3, "kN"),
    ("contacts a grain at the end", "1", measures.coordination, 1, ""),
]
COLOUR = {"rigid": style.BLUE, "elastic": style.RUST}


class Study:
    """The runs of a comparison; pairs[0] is the packing in DIR itself."""

    def __init__(self, folder):
        def run(*names):
            path = os.path.join(folder, *names)
            return Run(path) if os.path.isdir(path) else None

        self.folder = folder
        self.repeat = {kind: run(f"{kind}_repeat") for kind in COLOUR}
        self.pairs = [{kind: run(kind) for kind in COLOUR}]
        more = sorted((int(match.group(1)), name) for name in os.listdir(folder)
                      if (match := re.fullmatch(r"packing_(\d+)", name)))
        self.pairs += [{kind: run(name, kind) for kind in COLOUR} for _, name in more]


class Row:
    """One quantity compared; nan where there is nothing to say, verdict in words."""

    def __init__(self, quantity, unit, scale, shown_unit):
        self.quantity, self.unit, self.scale, self.shown_unit = quantity, unit, scale, shown_unit
        self.rigid = self.elastic = self.difference = self.floor = np.nan
        self.rigid_ci = self.elastic_ci = self.difference_ci = np.nan
        self.packings = 0
        self.verdict = ""


def _value(run, measure):
    if run is None:
        return np.nan, "the run is not in the folder"
    value, why = attempt(measure, run)
    return (np.nan, why) if value is None else (value, None)


def compare_one(study, quantity, unit, measure, scale, shown_unit):
    """Mean, difference, noise floor and verdict of one quantity."""
    row = Row(quantity, unit, scale, shown_unit)
    values = {kind: [_value(pair[kind], measure) for pair in study.pairs] for kind in COLOUR}
    both = [(r[0], e[0]) for r, e in zip(values["rigid"], values["elastic"]) if np.isfinite(r[0]) and np.isfinite(e[0])]
    if not both:
        for kind in COLOUR:
            found = [value for value, _ in values[kind] if np.isfinite(value)]
            setattr(row, kind, float(np.mean(found)) if found else np.nan)
        absent = [f"{kind}: {values[kind][0][1]}" for kind in COLOUR if not np.isfinite(getattr(row, kind))]
        row.verdict = "not compared (" + "; ".join(absent) + ")"
        return row
    rigid, elastic = np.array(both).T
    row.packings = len(both)
    row.rigid, row.elastic = float(rigid.mean()), float(elastic.mean())
    row.rigid_ci, row.elastic_ci = scatter.half_width(rigid), scatter.half_width(elastic)
    if row.rigid == 0:
        row.verdict = "no difference" if row.elastic == 0 else "only the elastic one has any"
        return row
    to_percent = 100 / abs(row.rigid)
    row.difference = (row.elastic - row.rigid) * to_percent
    row.difference_ci = scatter.half_width(elastic - rigid) * to_percent
    gaps = []
    for kind in COLOUR:
        first, again = values[kind][0][0], _value(study.repeat[kind], measure)[0]
        if np.isfinite(first) and np.isfinite(again):
            gaps.append(abs(first - again))
    if gaps:
        row.floor = max(gaps) * to_percent
    row.verdict = verdict(row)
    return row


def verdict(row):
    size = abs(row.difference)
    if size == 0:
        return "none (equal)"
    if np.isfinite(row.floor) and size <= row.floor:
        return f"none (below the noise floor of {number(row.floor, 2)} %)"
    if np.isfinite(row.difference_ci) and size <= row.difference_ci:
        return f"none (lost in the scatter of {row.packings} packings, ±{number(row.difference_ci, 2)} %)"
    says = f"elastic {'larger' if row.difference > 0 else 'smaller'} by {number(size, 2)} %"
    if not np.isfinite(row.floor) and not np.isfinite(row.difference_ci):
        return says + ", not judged: no repeat and one packing"
    if row.packings < 2:
        return says + ", of this one packing"
    return says


def compare_all(study):
    return [compare_one(study, *quantity) for quantity in QUANTITIES]


def write_csv(rows, path):
    def plain(value):
        return "" if isinstance(value, float) and not np.isfinite(value) else value

    with open(path + ".part", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(["quantity", "unit", "rigid", "elastic", "difference_percent", "floor_percent", "verdict",
                      "rigid_ci95", "elastic_ci95", "difference_ci95_percent", "packings"])
        for row in rows:
            out.writerow([plain(value) for value in
                          (row.quantity, row.unit, row.rigid, row.elastic, row.difference, row.floor, row.verdict,
                           row.rigid_ci, row.elastic_ci, row.difference_ci, row.packings)])
    os.replace(path + ".part", path)


# ---- figures -------------------------------------------------------------------------------------------------

def _cycle_curves(study, column, scale, axes):
    """Curves of both kinds with the band between a run and its repeat; thin lines are other packings."""
    drawn, band = [], False
    for kind, colour in COLOUR.items():
        for k, pair in enumerate(study.pairs):
            table = pair[kind].try_table("cycles.csv") if pair[kind] else None
            if table is None or column not in table:
                continue
            n, values = table["cycle"], table[column] * scale
            if k:
                axes.plot(n, values, color=colour, lw=0.7, alpha=0.45, zorder=2)
                continue
            axes.plot(n, values, color=colour, lw=2, label=kind, zorder=4,
                      marker="o" if len(n) <= 60 else "", ms=3.5)
            drawn.append(kind)
            again = study.repeat[kind].try_table("cycles.csv") if study.repeat[kind] else None
            if again is not None and column in again:
                count = min(len(n), again.rows)
                gap = np.maximum.accumulate(np.nan_to_num(np.abs(values[:count] - again[column][:count] * scale)))
                axes.fill_between(n[:count], values[:count] - gap, values[:count] + gap, color=colour, alpha=0.2,
                                  linewidth=0, zorder=1)
                band = True
    if not drawn:
        raise Missing(f"neither rigid/ nor elastic/ has cycles.csv with {column}")
    note = "The band about a curve is its noise floor: the largest difference so far from a repeat that differs in " \
           "the last bit." if band else "No repeat was run, so the noise floor is not known."
    if len(study.pairs) > 1:
        note += f" Thin lines: {len(study.pairs) - 1} other packings."
    axes.set_xlabel("load cycle")
    figures._whole(axes.xaxis)
    axes.legend(loc="best")
    return note


def settlement(study):
    figure, axes = plt.subplots()
    note = _cycle_curves(study, "settlement_m", 1e3, axes)
    axes.set_ylabel("settlement (mm)")
    return figure, "Settlement (mm) at the load minima, rigid and elastic, from the same packing. " + note


def stiffness(study):
    figure, axes = plt.subplots()
    note = _cycle_curves(study, "stiffness_unloading_N_per_m", 1e-6, axes)
    axes.set_ylabel("K$_e$, unloading (kN/mm)")
    return figure, "Effective stiffness K_e (kN/mm) of each cycle's unloading branch. " + note


def _pressure_profile(run):
    """Mean pressure (kPa) in strips along the longer side of the sleeper."""
    table = run.table("pressure.csv")
    x, y, value = table["x_m"], table["y_m"], table["pressure_Pa"] / 1e3
    along = x if np.ptp(x) >= np.ptp(y) else y
    places = np.unique(np.round(along, 6))
    parts = int(np.clip(len(places), 1, 40))
    edges = np.linspace(along.min(), along.max() + 1e-12, parts + 1)
    at = np.clip(np.searchsorted(edges, along, side="right") - 1, 0, parts - 1)
    count = np.bincount(at, minlength=parts)
    mean = np.bincount(at, np.nan_to_num(value), parts) / np.maximum(count, 1)
    keep = count > 0
    middle = 0.5 * (edges[1:] + edges[:-1])
    return middle[keep] * 1e3, mean[keep], np.sort(value[np.isfinite(value)])


def _profile(run, column, scale):
    table = run.table("moment.csv")
    return table["x_m"] * 1e3, table[column] * scale


def _banded(axes, x, values, repeat, colour, kind):
    axes.plot(x, values, color=colour, label=kind, lw=1.8)
    if repeat is not None and len(repeat[0]) == len(x):
        gap = np.abs(values - repeat[1])
        axes.fill_between(x, values - gap, values + gap, color=colour, alpha=0.2, linewidth=0)


def pressure(study):
    figure, (left, right) = plt.subplots(1, 2, figsize=(style.COLUMN[0] * 1.55, style.COLUMN[1]),
                                         gridspec_kw=dict(width_ratios=[1.5, 1]))
    drawn, words = 0, []
    for kind, colour in COLOUR.items():
        run = study.pairs[0][kind]
        made, _ = attempt(_pressure_profile, run) if run else (None, "")
        if made is None:
            continue
        drawn += 1
        again, _ = attempt(_pressure_profile, study.repeat[kind]) if study.repeat[kind] else (None, "")
        _banded(left, made[0], made[1], again, colour, kind)
        value = made[2]
        right.plot(value, 100 * (1 - np.arange(len(value)) / len(value)), color=colour, label=kind)
        words.append(f"{kind} 99th percentile {number(float(np.percentile(value, 99)))} kPa")
    if not drawn:
        plt.close(figure)
        raise Missing("neither rigid/ nor elastic/ has pressure.csv")
    left.set_xlabel("along the sleeper's longer side (mm)")
    left.set_ylabel("mean contact pressure (kPa)")
    left.set_ylim(bottom=0)
    left.legend()
    right.set_xlabel("contact pressure (kPa)")
    right.set_ylabel("area above (%)")
    return figure, ("Contact pressure under the sleeper (kPa) at the load maxima. Left: mean over the width in strips "
                    "along the sleeper, bands are the difference from the last-bit repeat. Right: share of the sole "
                    "that bears more than a pressure. " + "; ".join(words) + ".")


def moment(study):
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(style.COLUMN[0], 4.4))
    drawn, absent = 0, []
    for kind, colour in COLOUR.items():
        run = study.pairs[0][kind]
        made, why = attempt(_profile, run, "moment_Nm", 1e-3) if run else (None, "the run is not in the folder")
        if made is None:
            absent.append(f"{kind}: {why}")
            continue
        drawn += 1
        for axes, column, scale in ((top, "deflection_m", 1e3), (bottom, "moment_Nm", 1e-3)):
            curve, _ = attempt(_profile, run, column, scale)
            again, _ = attempt(_profile, study.repeat[kind], column, scale) if study.repeat[kind] else (None, "")
            if curve is not None:
                _banded(axes, *curve, again, colour, kind)
    if not drawn:
        plt.close(figure)
        raise Missing("neither rigid/ nor elastic/ has moment.csv (" + "; ".join(absent) + ")")
    top.invert_yaxis()
    top.set_ylabel("deflection (mm, ↓)")
    bottom.axhline(0, color=style.QUIET, lw=0.6)
    bottom.set_ylabel("bending moment (kN·m)")
    bottom.set_xlabel("along the sleeper (mm)")
    bottom.legend()
    text = "Deflection (mm, drawn downwards) and bending moment (kN·m) along the sleeper at a load maximum."
    return figure, text + (" Not drawn: " + "; ".join(absent) + "." if absent else "")


def differences(rows):
    """All differences on one axis, each against its own floor."""
    shown = [row for row in rows if np.isfinite(row.difference)]
    if not shown:
        raise Missing("no quantity is there for both rigid and elastic")
    figure, axes = plt.subplots(figsize=(style.COLUMN[0] * 1.55, 0.9 + 0.36 * len(shown)))
    for k, row in enumerate(reversed(shown)):
        if np.isfinite(row.floor):
            axes.barh(k, 2 * row.floor, left=-row.floor, height=0.7, color=style.RULE, linewidth=0, zorder=1)
        colour = style.QUIET if row.verdict.startswith("none") else style.RUST
        bar = row.difference_ci if np.isfinite(row.difference_ci) else 0
        axes.errorbar(row.difference, k, xerr=bar or None, fmt="o", ms=6, color=colour, capsize=3, lw=1.2, zorder=3,
                      mfc="white" if row.verdict.startswith("none") else colour)
    axes.axvline(0, color=style.INK, lw=0.8)
    axes.set_yticks(range(len(shown)), [row.quantity for row in reversed(shown)])
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("elastic against rigid (%)")
    return figure, ("Difference of elastic against rigid (%). Grey bar: noise floor, what a change in the last bit "
                    "does. Whisker: 95 % confidence interval over the packings. Hollow dots are not told from noise.")


def _shown(row, kind):
    value, ci = getattr(row, kind), getattr(row, f"{kind}_ci")
    if not np.isfinite(value):
        return "–"
    text = number(value * row.scale)
    if np.isfinite(ci):
        text += f" ± {number(ci * row.scale, 2)}"
    return f"{text} {row.shown_unit}".strip()


def _difference(row):
    if not np.isfinite(row.difference):
        return "–"
    if row.verdict.startswith("none"):
        return "none"
    return f"{'+' if row.difference > 0 else ''}{number(row.difference, 2)} %"


def build(folder):
    style.use()
    study = Study(folder)
    rows = compare_all(study)
    write_csv(rows, os.path.join(folder, "compare.csv"))
    count = len(study.pairs)
    repeats = [kind for kind in COLOUR if study.repeat[kind]]
    parts = [page.paragraph(
        f"The same packing under a rigid and an elastic sleeper and subgrade; {count} packing{'s' if count > 1 else ''}"
        f", {'repeat of ' + ' and '.join(repeats) + ' that differs in the last bit' if repeats else 'no repeat'}.")]
    parts.append(page.table(
        ["quantity", "rigid", "elastic", "difference", "noise floor", "verdict"],
        [(row.quantity, _shown(row, "rigid"), _shown(row, "elastic"), _difference(row),
          "–" if not np.isfinite(row.floor) else f"{number(row.floor, 2)} %", row.verdict) for row in rows],
        numeric=(1, 2, 3, 4)))
    if count > 1:
        parts.append(page.paragraph(f"Values are means of {count} packings with their 95 % confidence interval "
                                    "(Student); the difference is judged pair by pair, packing by packing."))
    parts.append(page.paragraph(
        "Granular settlement is chaotic: two runs that differ in the last bit settle differently. That difference is "
        "the noise floor; a difference below it is none. A floor from one repeat is itself a rough estimate. A few "
        "cycles are not a track's life: read the sign and size of what bending changes, not a settlement to come.",
        "note"))
    shown = []
    for name, title, make, argument in (
            ("compare_differences", "Differences", differences, rows),
            ("compare_settlement", "Settlement", settlement, study),
            ("compare_stiffness", "Stiffness", stiffness, study),
            ("compare_pressure", "Pressure under the sleeper", pressure, study),
            ("compare_moment", "Bending", moment, study)):
        made, why = attempt(make, argument)
        if made is None:
            shown.append(page.missing(title, why))
            continue
        path = os.path.join(folder, name + ".png")
        style.save(made[0], path)
        shown.append(page.figure(path, made[1], "wide" if name.endswith(("differences", "pressure")) else ""))
    parts.append(page.section("Side by side", page.grid(*shown)))
    title = next((run.title for pair in study.pairs for run in pair.values() if run), os.path.basename(folder))
    if title in COLOUR:
        title = os.path.basename(os.path.abspath(folder))
    out = os.path.join(folder, "compare.html")
    page.write(out, f"{title}: rigid and elastic", "Trackbed: what bending changes", parts,
               "compare.csv holds the table in SI units; the folders rigid/ and elastic/ hold the runs.")
    return out


def main():
    parser = argparse.ArgumentParser(description="Rigid against elastic: table and overlaid plots.")
    parser.add_argument("folder", help="folder that holds rigid/ and elastic/")
    options = parser.parse_args()
    if not os.path.isdir(options.folder):
        print(f"compare: {options.folder} is not a folder", file=sys.stderr)
        return 2
    try:
        print(build(options.folder))
    except OSError as why:
        print(f"compare: {options.folder} cannot be written: {why}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
