"""The figures of a run's page. Each takes a Run and returns (figure, caption), or raises Missing with the reason."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator, NullLocator, ScalarFormatter

import measures
import slices
import style
from read_run import Missing
from style import number


def _whole(axis):
    axis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))


def _mark(cycles):
    """Dots while the cycles can be told apart."""
    return "o" if cycles <= 60 else ""


def settlement(run):
    cycles = run.table("cycles.csv")
    n, low, high = cycles["cycle"], cycles["u_min_m"] * 1e3, cycles["u_max_m"] * 1e3
    measures.finite(low, "u_min_m")
    measures.finite(high, "u_max_m")
    figure, axes = plt.subplots()
    axes.fill_between(n, low, high, color=style.BLUE, alpha=0.08, linewidth=0)
    axes.plot(n, high, color=style.RUST, marker=_mark(len(n)), label="at the load maximum, u$_{max}$")
    axes.plot(n, low, color=style.BLUE, marker=_mark(len(n)), label="at the load minimum, u$_{min}$")
    axes.set_xlabel("load cycle")
    axes.set_ylabel("downward displacement (mm)")
    _whole(axes.xaxis)
    axes.set_ylim(bottom=min(0.0, np.nanmin(low)))
    axes.legend(loc="lower right")
    total = measures.settlement(run) * 1e3
    text = (f"Displacement of the sleeper (mm, positive downwards, zero at the first load minimum). The lower curve is "
            f"what stays: {number(total)} mm after {int(n[-1])} cycles. The shaded width is what springs back, "
            f"{number(high[-1] - low[-1])} mm in the last cycle.")
    if len(n) >= 6:
        half = len(n) // 2
        settled = cycles["settlement_m"]
        early, late = settled[half - 1], settled[-1] - settled[half - 1]
        if early > 0 and total > 0:
            text += f" The first half of the cycles made {number(100 * early / (early + late), 2)} % of the settlement."
    return figure, text


def hysteresis(run):
    loops = measures.loops(run)
    figure, axes = plt.subplots()
    last = len(loops) - 1
    for k, (load, moved) in enumerate(loops):
        ends = k in (0, last)
        axes.plot(moved * 1e3, load / 1e3, color=style.CYCLES(k / max(last, 1)), lw=2.0 if ends else 0.8,
                  alpha=1.0 if ends else 0.75, zorder=3 if ends else 2)
    for k, name in ((0, "first"), (last, "last")):
        load, moved = loops[k]
        top = int(np.argmax(load))
        axes.annotate(name, (moved[top] * 1e3, load[top] / 1e3), xytext=(0, 4), textcoords="offset points",
                      ha="center", fontsize=8, color=style.INK)
        if last == 0:
            break
    axes.set_xlabel("downward displacement (mm)")
    axes.set_ylabel("load on the sleeper (kN)")
    axes.margins(y=0.09)
    if last > 0:
        bar = figure.colorbar(ScalarMappable(Normalize(1, last + 1), style.CYCLES), ax=axes, pad=0.02, aspect=30)
        bar.set_label("load cycle")
        bar.outline.set_visible(False)
        _whole(bar.ax.yaxis)

    def area(loop):
        load, moved = loop
        return abs(float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(moved))))

    return figure, (f"Load (kN) against displacement (mm) of {last + 1} cycles; the area of a loop is the energy lost "
                    f"in it: {number(area(loops[0]))} J in the first, {number(area(loops[-1]))} J in the last.")


def stiffness(run):
    cycles = run.table("cycles.csv")
    figure, axes = plt.subplots()
    n = cycles["cycle"]
    for branch, colour, name in (("loading", style.OCHRE, "loading"),
                                 ("unloading", style.BLUE, "unloading, K$_e$")):
        axes.plot(n, cycles[f"stiffness_{branch}_N_per_m"] / 1e6, color=colour, marker=_mark(len(n)), label=name)
    axes.set_xlabel("load cycle")
    axes.set_ylabel("secant stiffness ΔF/Δu (kN/mm)")
    _whole(axes.xaxis)
    axes.legend(loc="lower right")
    first, last = measures.finite(cycles["stiffness_unloading_N_per_m"], "stiffness_unloading_N_per_m")[[0, -1]] / 1e6
    return figure, (f"Secant stiffness of each branch of a cycle (kN/mm). K_e, the unloading one, goes from "
                    f"{number(first)} to {number(last)} kN/mm.")


def gradation(run):
    table = run.table("gradation.csv")
    size = table["sieve_m"] * 1e3
    measures.finite(table["achieved_percent"] - table["target_percent"], "achieved_percent")
    figure, axes = plt.subplots()
    low, high = table.get("band_min_percent"), table.get("band_max_percent")
    banded = low is not None and high is not None and np.isfinite(low.astype(float)).any()
    if banded:
        axes.fill_between(size, low, high, color=style.OCHRE, alpha=0.18, linewidth=0, label="band of the standard")
    axes.plot(size, table["target_percent"], color=style.INK, ls=(0, (4, 2)), lw=1.2, marker="o", mfc="white",
              label="target")
    axes.plot(size, table["achieved_percent"], color=style.RUST, marker="o", label="achieved")
    axes.set_xscale("log")
    axes.set_xticks(size)
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticklabels([f"{number(s)}" for s in size])
    axes.set_ylim(-2, 104)
    axes.set_xlabel("sieve size (mm, log scale)")
    axes.set_ylabel("passing by mass (%)")
    axes.legend(loc="upper left")
    worst = np.nanmax(np.abs(table["achieved_percent"] - table["target_percent"]))
    text = (f"Mass passing each square-hole sieve (%). Drawn from the library: largest departure from the target "
            f"{number(float(worst), 2)} percentage points.")
    if banded:
        out = (table["achieved_percent"] < low - 1e-9) | (table["achieved_percent"] > high + 1e-9)
        text += (" The curve lies within the band." if not out.any() else
                 f" It leaves the band at {', '.join(number(s) for s in size[out])} mm.")
    return figure, text


def compaction(run):
    table = run.table("compaction.csv")
    measures.finite(table["density_kg_per_m3"], "density_kg_per_m3")
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(style.COLUMN[0], 4.3))
    n = table["cycle"]
    top.plot(n, table["density_kg_per_m3"], color=style.MOSS, marker=_mark(len(n)))
    top.set_ylabel("density (kg/m³)")
    bottom.plot(n, table["porosity"], color=style.BLUE, marker=_mark(len(n)), label="porosity, n")
    bottom.plot(n, table["void_ratio"], color=style.PLUM, marker=_mark(len(n)), label="void ratio, e = n/(1−n)")
    bottom.set_ylabel("porosity, void ratio (1)")
    bottom.set_xlabel("tamping cycle")
    bottom.legend(loc="best")
    _whole(bottom.xaxis)
    return figure, (f"Bulk density (kg/m³), porosity and void ratio of the bed between base and plate after each "
                    f"tamping cycle: {number(table['density_kg_per_m3'][0], 4)} → "
                    f"{number(table['density_kg_per_m3'][-1], 4)} kg/m³, porosity {number(table['porosity'][0])} → "
                    f"{number(table['porosity'][-1])}.")


def porosity(run):
    table = run.table("porosity.csv")
    whole, layers = table["layer"] == 0, table["layer"] > 0
    n = measures.finite(table["porosity"], "porosity")
    figure, axes = plt.subplots()
    low, high = table["z_low_m"][layers] * 1e3, table["z_high_m"][layers] * 1e3
    edges = np.append(low, high[-1])
    axes.stairs(n[layers], edges, orientation="horizontal", color=style.BLUE, lw=2, baseline=None)
    axes.axvline(n[whole][0], color=style.RUST, lw=1, label=f"all layers: {number(n[whole][0])}")
    axes.set_xlabel("porosity (-)")
    axes.set_ylabel("height above the subgrade (mm)")
    axes.legend(loc="best")
    return figure, (f"Porosity by layers at the end; {number(n[whole][0])} over all of them, coordination number "
                    f"{number(table['coordination'][whole][0])}. Walls and the sleeper's base keep grains apart, so "
                    "the outer layers are looser.")


def sections(run):
    return slices.draw(run.path("sections.csv"))


def friction_path(run):
    """n over mu of quasi-vibration: rungs as a line, the search's beds as marks."""
    table = run.table("friction_path.csv")
    mu, n = table["friction"], measures.finite(table["porosity"], "porosity")
    source, trial = table["from_trial"], table["trial"]
    rungs = [0]
    while rungs[-1] + 1 < table.rows and source[rungs[-1] + 1] == trial[rungs[-1]] and mu[rungs[-1] + 1] < mu[rungs[-1]]:
        rungs.append(rungs[-1] + 1)
    figure, axes = plt.subplots()
    axes.plot(mu[rungs], n[rungs], color=style.MOSS, marker="o", label="friction lowered step by step")
    others = [k for k in range(table.rows) if k not in rungs]
    if others:
        axes.plot(mu[others], n[others], color=style.RUST, ls="", marker="x", label="search for the wanted porosity")
        axes.legend(loc="best")
    axes.set_xlabel("friction between grains, μ (1)")
    axes.set_ylabel("porosity, n (1)")
    dense, loose = float(n[rungs].min()), float(n[rungs].max())
    return figure, (f"Quasi-vibration: porosity of the bed at rest over the friction between its grains, "
                    f"{number(loose)} at μ = {number(float(mu[0]))} to {number(dense)} at μ = "
                    f"{number(float(mu[rungs[-1]]))} (ratio {number(loose / dense)}). The last bed made has "
                    f"n = {number(float(n[-1]))}.")


def energy(run):
    table = run.table("energy.csv")
    time = table["time_s"]
    _, share = measures.closure(run)
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(style.COLUMN[0], 5.0),
                                         gridspec_kw=dict(height_ratios=[2.4, 1]))
    base = np.zeros(table.rows)
    palette = [style.RUST, style.OCHRE, style.PLUM, "#93364a", "#8c8479"]
    drawn = 0
    for column, name in measures.dissipations(table):
        lost = np.nan_to_num(table[column] - table[column][0])
        if np.abs(lost).max() > 0:
            top.fill_between(time, base, base + lost, color=palette[drawn % len(palette)], alpha=0.8, linewidth=0,
                             label="lost: " + name)
            base = base + lost
            drawn += 1
    stored = np.zeros(table.rows)
    for column in ("kinetic_J", "contact_J", "structure_J"):
        if column in table:
            stored = stored + np.nan_to_num(table[column] - table[column][0])
    top.fill_between(time, base, base + stored, color=style.BLUE, alpha=0.35, linewidth=0,
                     label="stored in contacts, structures, motion (change)")
    work = table["work_J"] - table["work_J"][0]
    released = table["gravity_J"][0] - table["gravity_J"] if "gravity_J" in table else 0 * work
    balance = work + released
    top.plot(time, balance, color=style.INK, lw=1.0, label="entered: work of loads + height given up")
    top.set_ylabel("energy (J)")
    handles, labels = top.get_legend_handles_labels()
    order = np.argsort([label.startswith("lost") for label in labels], kind="stable")
    top.legend([handles[k] for k in order], [labels[k] for k in order], loc="upper left", fontsize=7, ncols=2)
    high = float(np.nanmax(np.r_[balance, base, base + stored]))
    low = float(np.nanmin(np.r_[balance, base + stored, 0.0]))
    if high > low:
        top.set_ylim(low - 0.02 * (high - low), high + 0.42 * (high - low))
    bound = 100 * measures.CLOSURE_TOLERANCE
    percent = 100 * share
    bottom.axhspan(-bound, bound, color=style.MOSS, alpha=0.13, linewidth=0)
    bottom.text(0.995, 0.97, f"tolerance ±{number(bound)} %", transform=bottom.transAxes, ha="right", va="top",
                fontsize=7.5, color=style.MOSS)
    bottom.axhline(0, color=style.QUIET, lw=0.6)
    bottom.plot(time, percent, color=style.INK, lw=1.1)
    reach = max(1.6 * bound, 1.15 * float(np.nanmax(np.abs(percent))))
    bottom.set_ylim(-reach, reach)
    bottom.set_ylabel("closure (%)")
    bottom.set_xlabel("time (s)")
    worst = float(np.nanmax(np.abs(percent)))
    text = (f"Energy ledger (J) since its first entry. Above: the areas are where energy went or is kept, the line is "
            f"what entered; they meet when the books are right. Below: what is missing, as a share of the work put in "
            f"so far (the sum of the work's rises, {number(float(measures.work_put_in(table)[-1]))} J in all); at most "
            f"{number(worst, 2)} %, {'within' if worst <= bound else 'OUTSIDE'} the tolerance of {number(bound)} %.")
    if high > 0:
        # Said, not hidden: bodies that come and go between stages are in closure_J, not in the line.
        apart = float(np.nanmax(np.abs(balance - base - stored))) / high
        if apart > 0.02:
            text += f" Areas and line lie up to {number(100 * apart, 2)} % of the largest entry apart."
    if "transfer_error_J" in table:
        text += (" Error of the exchange between grains and structures: "
                 f"{number(float(np.nanmax(np.abs(table['transfer_error_J']))), 2)} J.")
    return figure, text


def timing(run):
    table = run.table("timing.csv")
    seconds = table["seconds"].astype(float)
    stages = np.array([str(stage) for stage in table["stage"]])
    part = ~np.isin(np.char.lower(stages.astype(str)), ["total", "whole run", "all", "run"]) & np.isfinite(seconds)
    seconds, stages = seconds[part], stages[part]
    if not len(seconds) or not seconds.sum() > 0:
        raise Missing("timing.csv records no time")
    order = np.argsort(seconds)
    seconds, stages = seconds[order], stages[order]
    whole = measures.wall_time(run)
    figure, axes = plt.subplots(figsize=(style.COLUMN[0], 0.7 + 0.28 * len(stages)))
    axes.barh(range(len(stages)), seconds, height=0.66, color=style.BLUE, alpha=0.85)
    for k, value in enumerate(seconds):
        axes.text(value + 0.012 * seconds.max(), k, f"{style.duration(float(value))} · {number(100 * value / whole, 2)} %",
                  va="center", fontsize=7.5, color=style.INK)
    axes.set_yticks(range(len(stages)), stages)
    axes.grid(axis="y", visible=False)
    axes.set_xlim(0, 1.28 * seconds.max())
    axes.set_xlabel("wall-clock time (s)")
    return figure, f"Where the {style.duration(whole)} went: wall-clock seconds of each part and its share."


def overview(run):
    """The run in time: load, kinetic energy, coordination, with its stages."""
    table = run.table("history.csv")
    time = table["time_s"]
    measures.finite(time, "time_s")
    shown = [(column, label, log) for column, label, log in
             (("load_N", "load (kN)", False), ("kinetic_J", "kinetic (J)", True),
              ("coordination", "contacts a grain", False)) if column in table]
    if not shown:
        raise Missing("history.csv has none of load_N, kinetic_J, coordination")
    figure, all_axes = plt.subplots(len(shown), 1, sharex=True, squeeze=False,
                                    figsize=(style.COLUMN[0], 1.0 + 1.15 * len(shown)))
    for axes, (column, label, log) in zip(all_axes[:, 0], shown):
        values = table[column].astype(float) / (1e3 if column == "load_N" else 1)
        axes.plot(time, values, color=style.BLUE, lw=0.9)
        axes.set_ylabel(label)
        if log and (values > 0).any():
            axes.set_yscale("log")
            top = np.nanmax(values)
            axes.set_ylim(max(np.nanmin(values[values > 0]), 1e-8 * top) * 0.5, 2 * top)
    all_axes[-1, 0].set_xlabel("time (s)")
    if "stage" in table:
        stage = table["stage"].astype(str)
        starts = np.r_[0, np.flatnonzero(stage[1:] != stage[:-1]) + 1]
        ends = np.r_[starts[1:], len(stage) - 1]
        span = max(time[-1] - time[0], 1e-30)
        for k, (a, b) in enumerate(zip(starts, ends)):
            for axes in all_axes[:, 0]:
                if k % 2:
                    axes.axvspan(time[a], time[b], color=style.INK, alpha=0.045, linewidth=0)
            if (time[b] - time[a]) / span > 0.06:
                all_axes[0, 0].text(0.5 * (time[a] + time[b]), 1.04, stage[a], ha="center", fontsize=7.5,
                                    color=style.QUIET, transform=all_axes[0, 0].get_xaxis_transform())
    return figure, ("The run in time: load (kN), kinetic energy of the grains (J, log scale) and mean number of "
                    "contacts a grain; stages are named above.")


def _pressure_map(axes, table):
    """Draws a map of pressure (kPa) with its longer side across; what is drawn, and whether it was turned."""
    x, y, value = table["x_m"] * 1e3, table["y_m"] * 1e3, table["pressure_Pa"] / 1e3
    swap = np.ptp(y) > 1.2 * max(np.ptp(x), 1e-9)
    if swap:
        x, y = y, x
    across, along = np.unique(np.round(x, 6)), np.unique(np.round(y, 6))
    top = float(np.nanpercentile(value, 99.5)) or 1.0
    if len(across) * len(along) == len(value):
        grid = np.full((len(along), len(across)), np.nan)
        grid[np.searchsorted(along, np.round(y, 6)), np.searchsorted(across, np.round(x, 6))] = value
        shown = axes.pcolormesh(across, along, grid, cmap=style.STRESS, vmin=0, vmax=top, shading="nearest",
                                rasterized=True)
    else:
        shown = axes.scatter(x, y, c=value, cmap=style.STRESS, vmin=0, vmax=top, s=14)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel("y (mm)" if swap else "x (mm)")
    axes.set_ylabel("x (mm)" if swap else "y (mm)")
    return shown


def _height_for(table):
    x, y = np.ptp(table["x_m"]), np.ptp(table["y_m"])
    ratio = min(x, y) / max(x, y, 1e-9) if max(x, y) > 1.2 * min(x, y) else y / max(x, 1e-9)
    return float(np.clip(5.2 * ratio + 0.9, 2.2, 4.6))


def pressure(run):
    table = run.table("pressure.csv")
    figure, axes = plt.subplots(figsize=(style.COLUMN[0], _height_for(table)))
    bar = figure.colorbar(_pressure_map(axes, table), ax=axes, label="contact pressure (kPa)", pad=0.02)
    bar.outline.set_visible(False)
    return figure, (f"Contact pressure under the sleeper (kPa), averaged over the load maxima: mean "
                    f"{number(measures.pressure_mean(run) / 1e3)} kPa, 99th percentile "
                    f"{number(measures.pressure_peak(run) / 1e3)} kPa. A few stones carry it, not a smooth bed.")


def subgrade_pressure(run):
    """Map and profile of what the ballast gives to the subgrade."""
    table, profile = run.table("subgrade_pressure.csv"), run.table("subgrade_pressure_profile.csv")
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(style.COLUMN[0], _height_for(table) + 1.8),
                                         height_ratios=(_height_for(table), 1.6))
    bar = figure.colorbar(_pressure_map(top, table), ax=top, label="pressure (kPa)", pad=0.02)
    bar.outline.set_visible(False)
    bottom.plot(profile["x_m"] * 1e3, profile["pressure_Pa"] / 1e3, color=style.RUST)
    bottom.set_xlabel("x (mm)")
    bottom.set_ylabel("mean over y (kPa)")
    value = table["pressure_Pa"] / 1e3
    return figure, (f"Pressure on the subgrade (kPa) at the last load maximum, in cells of 50 mm, and its mean along the "
                    f"track: mean {number(float(np.mean(value)))} kPa, largest cell {number(float(np.max(value)))} kPa.")


def moment(run):
    table = run.table("moment.csv")
    x = table["x_m"] * 1e3
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(style.COLUMN[0], 4.2))
    top.plot(x, table["deflection_m"] * 1e3, color=style.BLUE)
    top.invert_yaxis()
    top.set_ylabel("deflection (mm, ↓)")
    bottom.axhline(0, color=style.QUIET, lw=0.6)
    bottom.plot(x, table["moment_Nm"] / 1e3, color=style.RUST)
    bottom.set_ylabel("bending moment (kN·m)")
    bottom.set_xlabel("along the sleeper (mm)")
    return figure, (f"Deflection (mm, drawn downwards) and bending moment (kN·m) along the sleeper at a load maximum; "
                    f"largest moment {number(measures.moment_largest(run) / 1e3)} kN·m (sagging positive); bent, "
                    f"tilt taken out, by {number(measures.deflection_range(run) * 1e3)} mm.")


def forces(run):
    """How the largest force that each grain has borne is spread."""
    table = run.table("grains.csv")
    force = measures.finite(table["largest_force_N"], "largest_force_N")
    force = np.sort(force[force > 0])
    if len(force) < 5:
        raise Missing("fewer than five grains of grains.csv have borne a force")
    figure, axes = plt.subplots()
    axes.plot(force / 1e3, 1 - np.arange(len(force)) / len(force), color=style.RUST, drawstyle="steps-post")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("largest force on a grain during the run (kN)")
    axes.set_ylabel("share of grains above (1)")
    return figure, (f"Share of grains whose largest contact force passed a value (kN): half have borne more than "
                    f"{number(float(np.median(force)) / 1e3)} kN, one in twenty more than "
                    f"{number(float(np.percentile(force, 95)) / 1e3)} kN; the tail is what breaks stones.")
