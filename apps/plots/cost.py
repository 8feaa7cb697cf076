"""Error against time of a study: cost.py DIR. Reads DIR/runs.csv, knobs.csv, tolerance.csv and the runs they name;
writes DIR/cost.csv, cost.html, PNGs and, for a tolerance, recommended.txt (the overrides of the cheapest scene)."""
import csv
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np  # noqa: E402

import cost_page  # noqa: E402
import measures  # noqa: E402
import scatter  # noqa: E402
from read_run import Missing, Run  # noqa: E402
from report import attempt  # noqa: E402


def energy_drift(run):
    """Largest energy not accounted for, over the work put in (summary.csv)."""
    table = run.table("summary.csv")
    for name, value in zip(table["quantity"], table["value"]):
        if name == "closure":
            return float(value)
    raise Missing("summary.csv has no closure")


def porosity(run):
    return float(measures.finite(run.table("compaction.csv")["porosity"], "porosity")[-1])


# name on the command line: unit, measure, words. DRIFT is an error by itself: its exact value is zero.
QUANTITIES = {
    "settlement": ("m", measures.settlement, "settlement after the last cycle"),
    "stiffness": ("N/m", measures.stiffness, "stiffness of the last cycle, unloading (K_e)"),
    "bending_moment": ("N.m", measures.moment_largest, "largest bending moment of the sleeper"),
    "pressure": ("Pa", measures.pressure_peak, "peak pressure under the sleeper (99th percentile)"),
    "energy_drift": ("-", energy_drift, "energy not accounted for, over the work put in"),
    "porosity": ("-", porosity, "porosity of the packing after tamping"),
}
DRIFT = "energy_drift"


class Judgement:
    """One quantity of one variant: mean over the packings, error against the finest rung of its ladder."""

    def __init__(self):
        self.mean = self.mean_ci = self.error = self.error_ci = self.scale = np.nan
        self.seeds = 0
        self.reference = False   # the finest rung itself
        self.verdict = ""

    def percent(self, value):
        return 100 * value / self.scale if self.scale else np.nan

    def bound(self):
        """Upper end of the error's confidence interval, as a share."""
        return 0.0 if self.reference else (abs(self.error) + self.error_ci) / self.scale if self.scale else np.nan

    def told(self):
        """Is the error told from zero?"""
        return not self.reference and self.verdict.startswith("error")


class Variant:
    """A setting of the scene with the values of its finished runs, {quantity: {seed: value}}."""

    def __init__(self, row):
        self.knob, self.value, self.rung = row["knob"], row["value"], int(row["rung"])
        self.h = float(row["h"]) if row["h"] else np.nan
        self.own = row["own"] == "1"
        self.set = row["set"].split("\n") if row["set"] else []
        self.seconds, self.values, self.troubles = {}, {name: {} for name in QUANTITIES}, []
        self.judged = {}

    def add(self, row, folder):
        if row["status"] != "done":
            self.troubles.append((row["status"], row["message"]))
            return
        seed = int(row["seed"])
        self.seconds[seed] = float(row["packing_processor_s"]) + float(row["run_processor_s"])
        run = Run(os.path.join(folder, row["folder"]))
        for name, (_, measure, _) in QUANTITIES.items():
            value, _ = attempt(measure, run)
            if value is not None and np.isfinite(value):
                self.values[name][seed] = value

    def time(self):
        return float(np.mean(list(self.seconds.values()))) if self.seconds else np.nan


def _rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class Study:
    def __init__(self, folder):
        self.folder = folder
        self.knobs = {row["knob"]: row for row in _rows(os.path.join(folder, "knobs.csv"))}
        self.tolerance = {row["quantity"]: float(row["share"])
                          for row in _rows(os.path.join(folder, "tolerance.csv"))}
        found = {}
        for row in _rows(os.path.join(folder, "runs.csv")):
            key = row["knob"], row["rung"]
            found.setdefault(key, Variant(row)).add(row, folder)
        self.variants = list(found.values())
        self.own = found["own", "0"]
        self.repeat = found.get(("repeat", "0"))
        self.recommended = found.get(("recommended", "0"))
        self.ladders = {}
        for v in self.variants:
            if v.knob not in ("own", "repeat", "recommended"):
                self.ladders.setdefault(v.knob, []).append(v)
        for rungs in self.ladders.values():
            rungs.sort(key=lambda v: v.rung)
        self.floor = {name: self._floor(name) for name in QUANTITIES}
        self.orders = {}
        for knob, rungs in self.ladders.items():
            for name in QUANTITIES:
                self._judge(knob, rungs, name)

    def _floor(self, name):
        """Root mean square difference of a run from its repeat that differs in the last bit."""
        if self.repeat is None:
            return np.nan
        a, b = self.own.values[name], self.repeat.values[name]
        gaps = [a[seed] - b[seed] for seed in a if seed in b]
        return float(np.sqrt(np.mean(np.square(gaps)))) if gaps else np.nan

    def _judge(self, knob, rungs, name):
        done = [v for v in rungs if v.values[name]]
        finest = done[-1] if done else None
        for v in rungs:
            j = v.judged[name] = Judgement()
            if not v.values[name]:
                j.verdict = "not measured"
                continue
            values = list(v.values[name].values())
            j.mean, j.mean_ci, j.seeds = float(np.mean(values)), scatter.half_width(values), len(values)
            if name == DRIFT:
                j.error, j.error_ci, j.scale = j.mean, j.mean_ci, 1.0
                j.verdict = "error"
                continue
            j.reference = v is finest
            j.scale = abs(float(np.mean(list(finest.values[name].values()))))
            j.error, j.error_ci, j.seeds = scatter.paired_difference(v.values[name], finest.values[name])
            j.verdict = self._verdict(j, self.floor[name])
        told = [v for v in done if v.judged[name].told() and np.isfinite(v.h)]
        if len(done) > 2 and len(told) > 1:
            order = scatter.fit_order([v.h for v in told], [v.judged[name].error for v in told],
                                      None if name == DRIFT else finest.h)
            if np.isfinite(order):
                self.orders[knob, name] = order

    @staticmethod
    def _verdict(j, floor):
        if j.reference:
            return "reference"
        if j.error == 0:
            return "none (equal)"
        if not np.isfinite(j.error):
            return "no packing in common with the finest rung"
        if np.isfinite(floor) and abs(j.error) <= floor / j.seeds ** 0.5:
            return "none (below the noise floor)"
        if np.isfinite(j.error_ci) and abs(j.error) <= j.error_ci:
            return f"lost in the scatter of {j.seeds} packings"
        return "error" if j.seeds > 1 else "error of one packing, not judged"

    def front(self, name):
        """Variants on the efficient front of a quantity, by rising time."""
        points = [v for rungs in self.ladders.values() for v in rungs
                  if np.isfinite(v.time()) and np.isfinite(v.judged[name].error) and not v.judged[name].reference]
        kept = scatter.front(np.array([v.time() for v in points]),
                             np.array([abs(v.judged[name].error) for v in points]))
        return [points[k] for k in kept]

    def ratio(self, v):
        return v.time() / self.own.time()

    def groups(self):
        """Ladders to choose from: a pair's grid stands for both of its knobs."""
        paired = {name for knob in self.ladders if ":" in knob for name in knob.split(":")}
        return {knob: rungs for knob, rungs in self.ladders.items() if knob not in paired}

    def _bounds(self, v):
        """What a rung adds to each error that has a tolerance, at most."""
        bounds = []
        for name in self.tolerance:
            if name == DRIFT:   # counted from the scene's own drift
                gap, ci, _ = scatter.paired_difference(v.values[name], self.own.values[name])
                bounds.append(0.0 if v.own else gap + ci)
            else:
                bounds.append(v.judged[name].bound())
        return tuple(bounds)

    def recommend(self):
        """(time ratio, {quantity: bound}, [variants]) of the cheapest combination, or None."""
        groups = self.groups()
        drift = list(self.own.values[DRIFT].values())
        spent = {name: np.mean(drift) + scatter.half_width(drift) if name == DRIFT and drift else 0.0
                 for name in self.tolerance}
        options = [[(self.ratio(v), self._bounds(v)) for v in rungs] for rungs in groups.values()]
        best = scatter.cheapest(options, [share - spent[name] for name, share in self.tolerance.items()])
        if best is None:
            return None
        picks = [rungs[k] for rungs, k in zip(groups.values(), best[2])]
        return best[0], {name: b + spent[name] for name, b in zip(self.tolerance, best[1])}, picks

    def check(self):
        """{quantity: (change against the scene's own in percent, half width)} of the recommended scene as run."""
        result = {}
        for name in QUANTITIES:
            change, ci, count = scatter.paired_difference(self.recommended.values[name], self.own.values[name])
            scale = abs(np.mean(list(self.own.values[name].values()))) if count else np.nan
            if count and (scale or name == DRIFT):
                to_percent = 100 if name == DRIFT else 100 / scale
                result[name] = change * to_percent, ci * to_percent
        return result


def write_csv(study, path):
    """One row for each variant and quantity; the README of apps/plots lists the columns."""
    def plain(value):
        return "" if isinstance(value, float) and not np.isfinite(value) else value

    fronts = {name: {id(v) for v in study.front(name)} for name in QUANTITIES}
    with open(path + ".part", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(["knob", "value", "own", "h", "packings", "processor_s", "time_over_own", "quantity", "unit",
                      "mean", "mean_ci95", "error", "error_ci95", "error_percent", "error_ci95_percent",
                      "floor_percent", "fitted_order", "expected_order", "on_front", "verdict"])
        for knob, rungs in study.ladders.items():
            for v in rungs:
                for name, (unit, _, _) in QUANTITIES.items():
                    j = v.judged[name]
                    out.writerow([plain(cell) for cell in (
                        knob, v.value, int(v.own), v.h, j.seeds, v.time(), study.ratio(v), name, unit, j.mean,
                        j.mean_ci, j.error, j.error_ci, j.percent(j.error), j.percent(j.error_ci),
                        j.percent(study.floor[name]), study.orders.get((knob, name), np.nan),
                        study.knobs.get(knob, {}).get("order", ""), int(id(v) in fronts[name]), j.verdict)])
    os.replace(path + ".part", path)


def write_recommendation(study, path):
    """The overrides that differ from the scene's own; no file where there is nothing to recommend."""
    best = study.recommend() if study.tolerance else None
    changes = [change for v in best[2] if not v.own for change in v.set] if best else []
    if os.path.exists(path):
        os.remove(path)
    if changes:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(changes) + "\n")
    return best


def build(folder):
    study = Study(folder)
    write_csv(study, os.path.join(folder, "cost.csv"))
    best = write_recommendation(study, os.path.join(folder, "recommended.txt"))
    return cost_page.build(study, best, QUANTITIES)


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        print("cost: the folder of a study is needed", file=sys.stderr)
        return 2
    print(build(sys.argv[1]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
