"""The stability page: hard_cases.py DIR. Reads DIR/hard_cases.csv, curves.csv and map.csv (tests/hard/run.sh), and
elsewhere.xml where the tests named in tests/hard/elsewhere.txt were run; writes DIR/stability.html and PNGs."""
import os
import sys
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import page  # noqa: E402
import style  # noqa: E402
from read_run import read_table  # noqa: E402
from report import attempt  # noqa: E402
from style import number  # noqa: E402

COLOUR = {"holds": style.MOSS, "BROKEN": style.RUST, "reported": style.QUIET}


def setting(table, k):
    words = [str(table[name][k]) for name in ("shape", "law") if table["schedule"][k] == "" and table[name][k]]
    if table["schedule"][k] != "":
        words = [str(table["schedule"][k]) + (f" {int(table['grain_steps'][k])}" if table["grain_steps"][k] > 1 else "")]
    return ", ".join(words)


def margin(value, bound):
    """Bound over what was measured; infinite where nothing was measured above zero."""
    return np.inf if value <= 0 else bound / value


def place(table, k):
    """Where a figure was measured: setting and step share, in brackets; nothing where there is but one setting."""
    words = setting(table, k)
    return f" ({words}, {number(table['step_share'][k])})" if words else ""


def case_rows(table, group):
    """A line a case of a group: judged settings, the worst of them, what was reported besides."""
    rows = []
    names = [name for name, heading in zip(table["case"], table["group"]) if heading == group]
    for name in dict.fromkeys(names):
        at = [k for k in range(table.rows) if table["case"][k] == name]
        judged = [k for k in at if table["verdict"][k] != "reported"]
        worst = max(judged, key=lambda k: table["measured"][k], default=None)
        told = max((k for k in at if k not in judged), key=lambda k: table["measured"][k], default=None)
        broken = sum(table["verdict"][k] == "BROKEN" for k in at)
        cells = [name, table["must_hold"][at[0]], table["damping"][at[0]], f"{len(judged) - broken} of {len(judged)}"]
        if worst is None:
            cells += ["–", "–", "–"]
        else:
            value, bound, unit = table["measured"][worst], table["bound"][worst], table["unit"][worst]
            if unit.startswith("1 = "):    # yes or no
                cells += ["no" if value <= bound else f"yes{place(table, worst)}", unit[4:] + "?", "–"]
            else:
                cells += [f"{number(value, 2)}{place(table, worst)}", f"{number(bound, 2)} {unit}",
                          number(margin(value, bound), 2)]
        cells.append("–" if told is None else f"{number(table['measured'][told], 2)}{place(table, told)}")
        rows.append(cells)
    return rows


def curves(table):
    """What a case runs through, a panel each: the first shape under every law."""
    names = list(dict.fromkeys(table["case"]))
    figure, axes = plt.subplots((len(names) + 1) // 2, 2, squeeze=False,
                                figsize=(style.COLUMN[0] * 1.5, 2.4 * ((len(names) + 1) // 2)))
    for panel, name in zip(axes.flat, names):
        at = np.flatnonzero(np.array(table["case"]) == name)
        lines = {}    # by shape, law, schedule; what does not apply is left out
        for k in at:
            words = (table[column][k] for column in ("shape", "law", "schedule"))
            lines.setdefault(", ".join(word for word in words if isinstance(word, str) and word), []).append(k)
        for line, keep in lines.items():
            panel.plot([table["x"][k] for k in keep], [table["y"][k] for k in keep], marker=".", ms=3, lw=1,
                       label=line)
        if table["log_x"][at[0]]:
            panel.set_xscale("log")
        if table["log_y"][at[0]]:
            panel.set_yscale("log")
        panel.set_xlabel(table["x_name"][at[0]], fontsize=7.5)
        panel.set_ylabel(table["y_name"][at[0]], fontsize=7.5)
        panel.set_title(name, fontsize=8)
        panel.tick_params(labelsize=7)
        if any(lines):
            panel.legend(fontsize=6)
    for panel in list(axes.flat)[len(names):]:
        panel.axis("off")
    return figure, ("What cases run through, by the first shape under each law. shao2017 is not the gradient of an energy "
                    "and has kinks; its figures are reported, not judged.")


def elsewhere(folder):
    """Rows of tests/hard/elsewhere.txt: case, must hold, tests, passed where DIR/elsewhere.xml tells."""
    here = os.path.dirname(os.path.abspath(__file__))
    passed = {}
    results = os.path.join(folder, "elsewhere.xml")
    if os.path.exists(results):
        for case in xml.parse(results).getroot().iter("testcase"):
            passed[case.get("name").split("/")[-1]] = case.get("status") == "run"
    rows = []
    with open(os.path.join(here, "..", "..", "tests", "hard", "elsewhere.txt"), encoding="utf-8") as text:
        for line in text:
            if line.startswith("#") or not line.strip():
                continue
            case, must, names = (cell.strip() for cell in line.split("|"))
            names = names.split()
            known = [passed[name] for name in names if name in passed]
            told = "not run here" if not known else f"{sum(known)} of {len(names)}"
            rows.append((case, must, ", ".join(names), told))
    return rows


def margins(table):
    """Every setting of every case: what was measured over its bound."""
    names = list(dict.fromkeys(table["case"]))
    figure, axes = plt.subplots(figsize=(style.COLUMN[0] * 1.5, 0.8 + 0.3 * len(names)))
    for kind, colour in COLOUR.items():
        keep = [k for k in range(table.rows) if table["verdict"][k] == kind]
        ratio = [np.clip(min(table["measured"][k], 1e200) / table["bound"][k], 1e-9, 1e9) if table["bound"][k] > 0
                 else (1e-9 if table["measured"][k] <= 0 else 1e9) for k in keep]
        place = [len(names) - 1 - names.index(table["case"][k]) for k in keep]
        axes.plot(ratio, place, "o", ms=4, color=colour, alpha=0.6, label=kind.lower(), lw=0)
    axes.axvline(1, color=style.INK, lw=1)
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), list(reversed(names)))
    axes.set_ylim(-1, len(names))
    axes.set_xlabel("measured over its bound")
    axes.legend(loc="lower right")
    return figure, ("What was measured over its bound, every setting; left of the line holds. Grey: reported only, the "
                    "bound is not promised there (a law that is not conservative, a step above 0.05 of the limit, a "
                    "lagged exchange). Values beyond the axis stand at its ends.")


def theory(schedule, share, ratio, mass, steps=1, ground=3.0):
    """Growth per grain step of the linear system by the schedule's own recurrence, written here anew: grain x, v, F and
    structure u, w, a (Newmark 1/4, 1/2 or Verlet), for several steps also the force that it was given last and the
    impulse that it is owed; F = -c (x - u*), u* the surface that the grain feels."""
    c = ratio * ground
    k = np.array([[c, -c / mass ** 0.5], [-c / mass ** 0.5, (c + ground) / mass]])
    dt = 2 * share / np.linalg.eigvalsh(k).max() ** 0.5
    whole = steps * dt
    columns = []
    for x, v, f, u, w, a, given, owed in np.eye(8 if steps > 1 else 6, 8):
        end, owed_before = u + whole * w + 0.5 * whole ** 2 * a, owed
        for n in range(1, steps + 1):
            x += dt * v + 0.5 * dt * dt * f
            surface = u if schedule == "lagged" else u + n * dt * w + 0.5 * (n * dt) ** 2 * a
            after = -c * (x - surface)
            owed -= 0.5 * dt * (f + after)      # the structure bears -F
            v, f = v + 0.5 * dt * (f + after), after
        load = -f
        if steps > 1:       # half of what is owed is paid
            load += 0.5 / whole * owed_before
            owed -= 0.5 * whole * (given + load)
        if schedule == "explicit":
            u1, a1 = end, (load - ground * end) / mass
        else:
            a1 = (load - ground * (u + whole * w + 0.25 * whole ** 2 * a)) / (mass + ground * whole ** 2 / 4)
            u1 = u + whole * w + 0.25 * whole ** 2 * (a + a1)
        columns.append([x, v, f, u1, w + 0.5 * whole * (a + a1), a1, load, owed][:8 if steps > 1 else 6])
    return float(np.abs(np.linalg.eigvals(np.array(columns).T)).max()) ** (1 / steps) - 1


def stability_map(table):
    """Growth per step over step and stiffness ratio, a panel for each schedule."""
    kinds = list(dict.fromkeys(zip(table["schedule"], table["grain_steps"])))
    figure, axes = plt.subplots(2, (len(kinds) + 1) // 2, figsize=(style.COLUMN[0] * 1.7, 5.4), sharex=True, sharey=True)
    shares, ratios = np.unique(table["step_share"]), np.unique(table["stiffness_ratio"])
    picture = None
    for panel, (schedule, n) in zip(axes.flat, kinds):
        keep = (table["schedule"] == schedule) & (table["grain_steps"] == n)
        grid = np.full((len(ratios), len(shares)), np.nan)
        for share, ratio, growth in zip(*(table[c][keep] for c in ("step_share", "stiffness_ratio", "growth"))):
            grid[np.searchsorted(ratios, ratio), np.searchsorted(shares, share)] = growth
        shown = np.log10(np.clip(grid, 1e-9, 1))
        # Cells of the same size in logarithms: pcolormesh halves gaps linearly on a log axis.
        picture = panel.pcolormesh(np.log10(shares), np.log10(ratios), shown, cmap=style.STRESS, vmin=-9, vmax=0,
                                   shading="nearest")
        refused = np.argwhere(grid >= 1e200)
        panel.plot(np.log10(shares[refused[:, 1]]), np.log10(ratios[refused[:, 0]]), "x", color=style.INK, ms=4)
        panel.set_xticks(np.log10([0.01, 0.1, 0.5]), ["0.01", "0.1", "0.5"])
        panel.set_yticks(np.log10(ratios), [f"10{int(round(e)):d}".replace("10", "1e") for e in np.log10(ratios)])
        panel.grid(False)
        panel.set_title(f"{schedule}{f', {int(n)} steps' if n > 1 else ''}")
        if n > 1:
            panel.axvline(np.log10(1 / n), color=style.RUST, lw=1.2)
    for panel in list(axes.flat)[len(kinds):]:
        panel.axis("off")
    figure.supxlabel("step over the coupled limit, ω Δt / 2", fontsize=9)
    figure.supylabel("contact stiffness over ground stiffness", fontsize=9)
    figure.colorbar(picture, ax=axes, label="log10 of the growth per step")
    return figure, ("Growth of the amplitude per grain step of a grain (mass 1) pressed on a column of finite elements "
                    "(of mass 2 at its top, 3 N/m to the ground), by the program's own code; crosses: refused. Rust line: "
                    "n ω Δt = 2, beyond which several grain steps an exchange are unstable in theory; the table below "
                    "compares every point. At the stiffest contacts and smallest steps what is shown is rounding.")


def theory_rows(table):
    """Measured growth against the recurrence, for each schedule and number of grain steps an exchange."""
    rows = []
    for schedule, steps in dict.fromkeys(zip(table["schedule"], table["grain_steps"])):
        keep = np.flatnonzero((table["schedule"] == schedule) & (table["grain_steps"] == steps) &
                              (table["growth"] < 1e200))
        told = [theory(schedule, table["step_share"][k], table["stiffness_ratio"][k], table["mass"][k], int(steps))
                for k in keep]
        gaps = [abs(table["growth"][k] - growth) for k, growth in zip(keep, told)]
        # Told apart from rounding only beyond 1e-4 at the stiffest contacts.
        same = sum((table["growth"][k] > 1e-4) == (growth > 1e-4) for k, growth in zip(keep, told))
        if gaps:
            name = schedule + (f", {int(steps)} steps" if steps > 1 else "")
            rows.append((name, len(gaps), number(max(gaps), 2), f"{same} of {len(gaps)}",
                         number(float(table["growth"][keep].max()), 2)))
    return rows


def build(folder):
    style.use()
    cases = read_table(os.path.join(folder, "hard_cases.csv"))
    grid = read_table(os.path.join(folder, "map.csv"))
    broken = int((cases["verdict"] == "BROKEN").sum())
    parts = [page.paragraph(f"{cases.rows} settings of {len(set(cases['case']))} cases; "
                            f"{broken} promise{'s' if broken != 1 else ''} broken.", "note")]
    parts.append(page.paragraph(
        "Each case runs over the shapes and laws it applies to and, where the step matters, at .05, .2, .5 and .9 of the "
        "limit (the step share), or over the exchange schedules. Holds: settings that keep their promise, of those that "
        "carry one. Worst: the largest measured of these. Margin: bound over it. Reported: what carries no promise - "
        "energy at larger steps, shao2017 (no stored energy), lagged exchange."))
    for group in dict.fromkeys(cases["group"]):
        parts.append(page.section(group, page.table(
            ["case", "must hold", "damping", "holds", "worst (shape, law, step share)", "bound", "margin",
             "largest of those only reported"], case_rows(cases, group), numeric=(3, 6))))
    parts.append(page.section("Held by other tests", page.table(
        ["case", "must hold", "tests", "passed"], elsewhere(folder))))
    shown = []
    drawn = read_table(os.path.join(folder, "curves.csv"))
    for name, title, make, table in (("stability_curves", "Curves", curves, drawn),
                                     ("stability_margins", "Margins", margins, cases),
                                     ("stability_map", "Stability map", stability_map, grid)):
        made, why = attempt(make, table)
        if made is None:
            shown.append(page.missing(title, why))
            continue
        path = os.path.join(folder, name + ".png")
        style.save(made[0], path)
        shown.append(page.figure(path, made[1], "wide"))
    parts.append(page.section("Pictures", *shown))
    parts.append(page.section("Map against theory", page.table(
        ["schedule", "points", "largest difference of the growth from the linear recurrence",
         "same answer: grows by more than 1e-4 a step", "largest growth"], theory_rows(grid), numeric=(1, 2, 4))))
    out = os.path.join(folder, "stability.html")
    page.write(out, "What stability means", "Trackbed: hard cases and limits", parts,
               "hard_cases.csv holds every setting, curves.csv the curves, map.csv the map.")
    return out


if __name__ == "__main__":
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        print("hard_cases: the folder of tests/hard/run.sh is needed", file=sys.stderr)
        sys.exit(2)
    print(build(sys.argv[1]))
