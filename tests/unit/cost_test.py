"""Tests of what accuracy costs: statistics against published values, and a synthetic study of known errors.

    /usr/bin/python3 -m unittest cost_test            (in tests/unit)
"""
import csv
import itertools
import os
import re
import shutil
import sys
import tempfile
import unittest

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "apps", "plots"))

import cost  # noqa: E402
import scatter  # noqa: E402


class Statistics(unittest.TestCase):
    def test_students_t(self):
        """NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2: upper points of t, three digits."""
        for freedom, two_sided_95, two_sided_99 in ((1, 12.706, 63.657), (2, 4.303, 9.925), (5, 2.571, 4.032),
                                                    (10, 2.228, 3.169), (30, 2.042, 2.750), (100, 1.984, 2.626)):
            self.assertAlmostEqual(scatter.student(freedom), two_sided_95, delta=6e-4)
            self.assertAlmostEqual(scatter.student(freedom, 0.99), two_sided_99, delta=6e-4)

    def test_interval_of_a_mean(self):
        """1, 2, 3: deviation 1, t = 4.303 at two degrees of freedom."""
        self.assertAlmostEqual(scatter.half_width([1, 2, 3]), 4.3027 / 3 ** 0.5, 4)
        self.assertTrue(np.isnan(scatter.half_width([1.0])))

    def test_intervals_cover_the_mean_as_often_as_they_say(self):
        rng = np.random.default_rng(4)
        samples = rng.normal(3.0, 2.0, (4000, 4))
        inside = sum(abs(s.mean() - 3.0) <= scatter.half_width(s) for s in samples)
        self.assertAlmostEqual(inside / 4000, 0.95, delta=3 * (0.95 * 0.05 / 4000) ** 0.5)

    def test_pairing_takes_the_packing_out(self):
        rng = np.random.default_rng(1)
        packing = {seed: rng.normal(0, 10) for seed in range(6)}
        coarse = {seed: value + 1.0 + rng.normal(0, 0.01) for seed, value in packing.items()}
        mean, ci, count = scatter.paired_difference(coarse, packing)
        self.assertAlmostEqual(mean, 1.0, delta=0.02)
        self.assertLess(ci, 0.05)
        self.assertEqual(count, 6)
        self.assertEqual(scatter.paired_difference({1: 5.0, 2: 6.0}, {2: 4.0, 3: 1.0})[::2], (2.0, 1))

    def test_seeds_needed(self):
        for deviation, room in ((1.0, 0.5), (3.0, 0.4)):
            n = scatter.seeds_needed(deviation, room)
            self.assertLessEqual(scatter.student(n - 1) * deviation / n ** 0.5, room)
            self.assertGreater(scatter.student(n - 2) * deviation / (n - 1) ** 0.5, room)
        self.assertIsNone(scatter.seeds_needed(1.0, 0.0))

    def test_orders(self):
        for p, finest in itertools.product((0.5, 1, 2, 4), (0.05, 0.25)):
            h = finest * np.array([16, 8, 4, 2, 1.0])
            error = -3.7 * (h ** p - finest ** p)
            self.assertAlmostEqual(scatter.fit_order(h, error, finest), p, 5)
            self.assertAlmostEqual(scatter.fit_order(h, 0.2 * h ** p), p, 9)
        self.assertTrue(np.isnan(scatter.fit_order([2, 1], [0.1, 0], 1)))
        # An error that does not depend on h has no order.
        self.assertTrue(np.isnan(scatter.fit_order([8, 4, 2], [1.0, 1.0, 1.0], 1.0)))

    def test_order_with_noise(self):
        rng = np.random.default_rng(2)
        h = np.array([16, 8, 4, 2.0])
        found = [scatter.fit_order(h, (h ** 2 - 1) * np.exp(rng.normal(0, 0.1, 4)), 1.0) for _ in range(50)]
        self.assertAlmostEqual(np.mean(found), 2, delta=0.1)

    def test_front_by_brute_force(self):
        rng = np.random.default_rng(3)
        for _ in range(50):
            time, error = rng.integers(1, 12, (2, 30)).astype(float)
            best = {(time[k], error[k]) for k in range(30)
                    if not any((time[m] <= time[k] and error[m] < error[k]) or
                               (time[m] < time[k] and error[m] <= error[k]) for m in range(30))}
            self.assertEqual({(time[k], error[k]) for k in scatter.front(time, error)}, best)

    def test_cheapest_by_brute_force(self):
        rng = np.random.default_rng(5)
        for _ in range(40):
            knobs = [[(float(rng.uniform(0.2, 3)), tuple(rng.uniform(0, 0.1, 2))) for _ in range(4)]
                     for _ in range(3)]
            allowed = (0.12, 0.15)
            fit = [np.prod([o[0] for o in combination]) for combination in itertools.product(*knobs)
                   if all(sum(o[1][q] for o in combination) <= allowed[q] for q in range(2))]
            best = scatter.cheapest(knobs, allowed)
            if not fit:
                self.assertIsNone(best)
                continue
            self.assertAlmostEqual(best[0], min(fit), 9)
            self.assertTrue(all(a <= b for a, b in zip(best[1], allowed)))


def write(path, rows):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="") as file:
        csv.writer(file).writerows(rows)


class Synthetic:
    """A study whose settlement is 1 mm + packing + error(h) + jitter: everything about it is known."""

    def __init__(self, seeds=5, jitter=1e-6):
        self.folder = tempfile.mkdtemp(prefix="cost_test_")
        self.rng = np.random.default_rng(7)
        self.packing = {seed: self.rng.normal(0, 2e-4) for seed in range(1, seeds + 1)}
        self.jitter = jitter
        self.rows = [["knob", "value", "rung", "h", "own", "seed", "folder", "status", "packing_processor_s",
                      "run_processor_s", "message", "set"]]

    def run(self, knob, value, rung, h, own, error, seconds, drift=1e-4):
        for seed, base in self.packing.items():
            folder = f"runs/{knob}_{value}/{seed}".replace(" ", "")
            settled = 1e-3 + base + error + self.rng.normal(0, self.jitter)
            write(os.path.join(self.folder, folder, "cycles.csv"),
                  [["cycle", "settlement_m", "stiffness_unloading_N_per_m"], [1, settled, 1e7]])
            write(os.path.join(self.folder, folder, "summary.csv"),
                  [["quantity", "value", "unit", "meaning"], ["closure", drift, "-", ""]])
            self.rows.append([knob, value, rung, h, int(own), seed, folder, "done", 1, seconds - 1, "",
                              "" if knob in ("own", "repeat") else f"{knob}={value}"])

    def build(self, knobs, tolerance=()):
        write(os.path.join(self.folder, "runs.csv"), self.rows)
        write(os.path.join(self.folder, "knobs.csv"),
              [["knob", "path", "quantity", "order", "meaning"],
               *([name, "A/B", "settlement", order, ""] for name, order in knobs)])
        write(os.path.join(self.folder, "tolerance.csv"), [["quantity", "share"], *tolerance])
        cost.build(self.folder)
        with open(os.path.join(self.folder, "cost.csv"), newline="") as file:
            table = {(r["knob"], r["value"], r["quantity"]): r for r in csv.DictReader(file)}
        with open(os.path.join(self.folder, "cost.html"), encoding="utf-8") as file:
            return table, re.sub(r"<[^>]*>", " ", file.read())


class Study(unittest.TestCase):
    def setUp(self):
        self.study = Synthetic()
        self.addCleanup(shutil.rmtree, self.study.folder)
        s = self.study
        s.run("own", "", 0, "", True, 4e-5, 20)
        s.run("repeat", "", 0, "", False, 4e-5, 20)
        # Second order in h, seconds ~ 1/h; the scene's own rung has its own error.
        for rung, (h, seconds) in enumerate(((0.8, 5), (0.4, 10), (0.2, 20), (0.1, 40))):
            s.run("time_step", str(h), rung, h, h == 0.2, 1e-3 * h ** 2, seconds)
        for rung, (word, seconds) in enumerate((("equal_cube", 19), ("exact", 20))):
            s.run("sieve_method", word, rung, "", word == "exact", 4e-5, seconds)

    def recommended(self):
        path = os.path.join(self.study.folder, "recommended.txt")
        if not os.path.exists(path):
            return None
        with open(path) as file:
            return file.read().split()

    def test_errors_order_and_verdicts(self):
        table, text = self.study.build([("time_step", 2), ("sieve_method", "")])
        row = table["time_step", "0.8", "settlement"]
        self.assertAlmostEqual(float(row["error"]), 1e-3 * (0.64 - 0.01), delta=3e-6)
        self.assertLess(float(row["error_ci95"]), 5e-6)
        self.assertGreater(float(row["mean_ci95"]), 5e-5)   # unpaired it would be lost
        self.assertAlmostEqual(float(row["fitted_order"]), 2, delta=0.1)
        self.assertEqual(float(row["processor_s"]), 5)
        self.assertEqual(float(row["time_over_own"]), 0.25)
        self.assertEqual(row["verdict"], "error")
        self.assertEqual(table["time_step", "0.1", "settlement"]["verdict"], "reference")
        self.assertIn(table["sieve_method", "equal_cube", "settlement"]["verdict"][:4], ("lost", "none"))
        self.assertEqual(table["time_step", "0.8", "stiffness"]["verdict"], "none (equal)")
        self.assertEqual(table["time_step", "0.8", "porosity"]["verdict"], "not measured")
        self.assertEqual(table["time_step", "0.4", "settlement"]["on_front"], "1")
        self.assertIn("lost in the packings", text)
        self.assertRegex(text, r"2 \(expected 2\)")
        self.assertIsNone(self.recommended())

    def test_recommendation(self):
        # Errors over 1 mm: 63 % at 0.8, 15 % at 0.4, 3 % at 0.2.
        _, text = self.study.build([("time_step", 2)], [["settlement", 0.25]])
        self.assertEqual(self.recommended(), ["time_step=0.4", "sieve_method=equal_cube"])
        self.assertIn("times as fast", text)
        self.study.build([("time_step", 2)], [["settlement", 0.02]])
        self.assertIn("time_step=0.1", self.recommended())   # the scene itself is not good enough

    def test_recommendation_keeps_the_ledger(self):
        s = self.study
        s.run("law", "open", 0, "", False, 4e-5, 2, drift=0.3)
        s.run("law", "closed", 1, "", True, 4e-5, 20)
        s.build([("law", "")], [["settlement", 0.5], ["energy_drift", 0.01]])
        self.assertFalse(any("law" in change for change in self.recommended()))
        s.build([("law", "")], [["settlement", 0.5], ["energy_drift", 0.5]])
        self.assertIn("law=open", self.recommended())

    def test_lost_in_scatter(self):
        noisy = Synthetic(seeds=3, jitter=5e-4)
        self.addCleanup(shutil.rmtree, noisy.folder)
        noisy.run("own", "", 0, "", True, 0, 20)
        for rung, h in enumerate((0.4, 0.2)):
            noisy.run("time_step", str(h), rung, h, h == 0.2, 1e-5 * h, 4 / h)
        table, text = noisy.build([("time_step", 2)], [["settlement", 0.05]])
        self.assertEqual(table["time_step", "0.4", "settlement"]["verdict"], "lost in the scatter of 3 packings")
        self.assertIn("packings that would decide", text)
        path = os.path.join(noisy.folder, "recommended.txt")
        self.assertFalse(os.path.exists(path))

    def test_a_failed_run_is_told(self):
        self.study.rows.append(["law", "bad", 0, "", 0, 1, "", "failed", "", "", "grain 3 left the box", "law=bad"])
        _, text = self.study.build([("law", "")])
        self.assertIn("grain 3 left the box", text)


if __name__ == "__main__":
    unittest.main()
