"""Statistics of runs that scatter: confidence intervals, orders, the efficient front, the cheapest combination."""
import itertools

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import stdtrit


def student(freedom, level=0.95):
    """Two-sided quantile of Student's t: 12.706 at one degree of freedom and 95 %."""
    return float(stdtrit(freedom, 0.5 * (1 + level)))


def half_width(values, level=0.95):
    """Half width of the mean's confidence interval; nan for fewer than two values."""
    values = np.asarray(values, float)
    if len(values) < 2:
        return np.nan
    return student(len(values) - 1, level) * float(values.std(ddof=1)) / len(values) ** 0.5


def paired_difference(values, reference):
    """(mean, half width, count) of value less reference over the seeds that both have; both {seed: value}."""
    seeds = sorted(set(values) & set(reference))
    differences = [values[seed] - reference[seed] for seed in seeds]
    if not differences:
        return np.nan, np.nan, 0
    return float(np.mean(differences)), half_width(differences), len(differences)


def seeds_needed(deviation, room):
    """Seeds after which a mean difference of this standard deviation is known to within `room`."""
    if not room > 0:
        return None
    for count in itertools.count(2):
        if student(count - 1) * deviation <= room * count ** 0.5 or count > 100000:
            return count


ORDERS = 0.05, 8.0   # what lies beyond is not an order


def fit_order(h, error, finest=None):
    """p of error = C |h^p - finest^p|: errors against the finest rung, which has one of its own; of C h^p without it
    (errors against the truth). Least squares in the logarithm; nan for fewer than two errors above zero and where the
    best p is at an end of ORDERS."""
    h, error = np.asarray(h, float), np.abs(np.asarray(error, float))
    keep = np.isfinite(error) & (error > 0) & (h != finest)
    h, error = h[keep] / (finest or 1.0), np.log(error[keep])
    if len(h) < 2:
        return np.nan
    if finest is None:
        return float(np.polyfit(np.log(h), error, 1)[0])

    def misfit(p):
        gap = error - np.log(np.abs(h ** p - 1))
        return float(((gap - gap.mean()) ** 2).sum())

    grid = np.linspace(*ORDERS, 160)
    best = int(np.argmin([misfit(p) for p in grid]))
    if best in (0, len(grid) - 1):
        return np.nan
    return float(minimize_scalar(misfit, bounds=grid[[best - 1, best + 1]], method="bounded",
                                 options={"xatol": 1e-9}).x)


def front(time, error):
    """Indices of the points that no other beats in time without being worse in error, by rising time."""
    order = np.lexsort((error, time))
    kept, least = [], np.inf
    for k in order:
        if error[k] < least:
            kept.append(int(k))
            least = error[k]
    return kept


def _undominated(states):
    """States (log time, bounds, picks) that no other beats in all of time and bounds."""
    kept = []
    for state in sorted(states, key=lambda s: (s[0], s[1])):
        if not any(all(a <= b for a, b in zip(other[1], state[1])) for other in kept):
            kept.append(state)
    return kept


def cheapest(knobs, allowed):
    """The combination of one option a knob with the least product of times whose bounds add up to no more than
    allowed. knobs: for each a list of (time ratio, bounds); bounds and allowed: one number a quantity. Returns
    (time ratio, bounds, picks) or None. Exact: only combinations that another beats throughout are dropped."""
    states = [(0.0, tuple(0.0 for _ in allowed), ())]
    for options in knobs:
        states = _undominated(
            (time + np.log(ratio), tuple(a + b for a, b in zip(bounds, more)), picks + (k,))
            for time, bounds, picks in states for k, (ratio, more) in enumerate(options)
            if np.isfinite(ratio) and all(np.isfinite(more)))
    fit = [s for s in states if all(a <= b for a, b in zip(s[1], allowed))]
    if not fit:
        return None
    time, bounds, picks = min(fit)
    return float(np.exp(time)), bounds, picks
