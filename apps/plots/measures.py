"""Numbers taken from a run's files, each by one definition that report and comparison share. SI units."""
import numpy as np

from read_run import Missing

CLOSURE_TOLERANCE = 0.01   # of the work put in; what a default run promises


def finite(values, what):
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    if not len(values):
        raise Missing(f"{what} holds no finite number")
    return values


def cycle_count(run):
    """Number of the last load cycle; 0 where cycles.csv does not say."""
    cycles = run.try_table("cycles.csv")
    try:
        return int(finite(cycles["cycle"], "cycle")[-1]) if cycles is not None else 0
    except (Missing, ValueError):
        return 0


def settlement(run):
    """u_min of the last cycle less u_min of the first (m)."""
    return float(finite(run.table("cycles.csv")["settlement_m"], "settlement_m")[-1])


def elastic_displacement(run):
    """Mean over the cycles of u_max - u_min (m)."""
    cycles = run.table("cycles.csv")
    return float(finite(cycles["u_max_m"] - cycles["u_min_m"], "u_max_m - u_min_m").mean())


def stiffness(run, branch="unloading"):
    """Secant stiffness of the last cycle's branch (N/m); unloading is K_e."""
    column = f"stiffness_{branch}_N_per_m"
    return float(finite(run.table("cycles.csv")[column], column)[-1])


def pressure_peak(run):
    """99th percentile of the mean pressure under the sleeper at load maxima: one stone's tip does not decide (Pa)."""
    return float(np.percentile(finite(run.table("pressure.csv")["pressure_Pa"], "pressure_Pa"), 99))


def pressure_mean(run):
    return float(finite(run.table("pressure.csv")["pressure_Pa"], "pressure_Pa").mean())


def pressure_spread(run):
    """Standard deviation of the pressure over its mean (1): how unevenly the sleeper is carried."""
    values = finite(run.table("pressure.csv")["pressure_Pa"], "pressure_Pa")
    if values.mean() == 0:
        raise Missing("the pressure under the sleeper is zero")
    return float(values.std() / values.mean())


def moment_largest(run):
    """Largest magnitude of the sleeper's bending moment at a load maximum (N·m)."""
    return float(np.abs(finite(run.table("moment.csv")["moment_Nm"], "moment_Nm")).max())


def deflection_range(run):
    """Highest less lowest deflection along the sleeper at a load maximum, its tilt taken out (m)."""
    table = run.table("moment.csv")
    moved = finite(table["deflection_m"], "deflection_m")
    if len(moved) != table.rows or len(moved) < 3:
        raise Missing("moment.csv has fewer than three finite deflections")
    x = table["x_m"] - table["x_m"].mean()
    tilt = np.polyfit(x, moved, 1)
    bent = float(np.ptp(moved - np.polyval(tilt, x)))
    return bent if bent > 1e-9 * max(float(np.abs(moved).max()), 1e-30) else 0.0   # a rigid one: rounding


def grain_force(run):
    """95th percentile over the grains of the largest force each has borne (N)."""
    return float(np.percentile(finite(run.table("grains.csv")["largest_force_N"], "largest_force_N"), 95))


def coordination(run):
    return float(finite(run.table("history.csv")["coordination"], "coordination")[-1])


def density(run):
    return float(finite(run.table("compaction.csv")["density_kg_per_m3"], "density_kg_per_m3")[-1])


def class_deviation(run):
    """Largest difference of a sieve class from its target, as a share of the mass."""
    table = run.table("classes.csv")
    gap = np.abs(finite(table["achieved_percent"], "achieved_percent") - finite(table["target_percent"], "target_percent"))
    return float(gap.max()) / 100


def dissipations(energy):
    """Names of the dissipation columns and what they are called on the page."""
    return [(name, name[len("dissipated_"):-len("_J")].replace("_", " ")) for name in energy.columns
            if name.startswith("dissipated_") and name.endswith("_J")]


def work_put_in(energy):
    """Work done so far, J: the sum of the rises of work_J; where no load works, of the height given up."""
    def rises(values):
        return np.concatenate([[0.0], np.cumsum(np.clip(np.nan_to_num(np.diff(values)), 0, None))])

    work = rises(energy["work_J"])
    if work[-1] == 0 and "gravity_J" in energy:
        work = rises(-energy["gravity_J"])
    return work


def closure(run):
    """(time, closure over the work put in so far) of the ledger."""
    energy = run.table("energy.csv")
    scale = work_put_in(energy)
    if not scale[-1] > 0:
        raise Missing("no work has been done yet (work_J does not rise)")
    # Before a hundredth of the work has come in, a ratio to it would be noise.
    return energy["time_s"], energy["closure_J"] / np.maximum(scale, 0.01 * scale[-1])


def wall_time(run):
    timing = run.table("timing.csv")
    seconds = timing["seconds"]
    stages = [str(stage).lower() for stage in timing["stage"]]
    for k, stage in enumerate(stages):
        if stage in ("total", "whole run", "all", "run"):
            return float(seconds[k])
    return float(np.nansum(seconds))


def loops(run):
    """[(load, displacement)] of every load cycle, cut at the load minima of the stage in which cycles were counted."""
    history = run.table("history.csv")
    load, moved, time = history["load_N"], history["u_m"], history["time_s"]
    cycles = run.try_table("cycles.csv")
    keep = np.isfinite(np.asarray(moved, float)) & np.isfinite(np.asarray(load, float))
    if "stage" in history and cycles is not None and cycles.rows:
        at = int(np.argmin(np.abs(time - cycles["time_s"][-1])))
        keep &= history["stage"] == history["stage"][at]
    load, moved = load[keep], moved[keep]
    if len(load) < 8:
        raise Missing("history.csv has fewer than 8 rows with load and displacement in the cyclic stage")
    level = 0.5 * (np.nanmin(load) + np.nanmax(load))
    above = load > level
    rises = np.flatnonzero(~above[:-1] & above[1:]) + 1
    if not len(rises):
        raise Missing("the load of history.csv never rises past its middle: no cycle to show")
    cuts = [int(np.argmin(load[:rises[0] + 1]))]
    cuts += [int(a + np.argmin(load[a:b])) for a, b in zip(rises[:-1], rises[1:])]
    falls = np.flatnonzero(above[:-1] & ~above[1:]) + 1
    after = falls[falls > rises[-1]]
    if len(after):
        cuts.append(int(after[0] + np.argmin(load[after[0]:])))
    return [(load[a:b + 1], moved[a:b + 1]) for a, b in zip(cuts[:-1], cuts[1:]) if b - a >= 3]
