"""The page of a study of costs: diagrams of error against time, tables, recommendation in words."""
import os

import matplotlib.pyplot as plt
import numpy as np

import page
import scatter
import style
from style import duration, number


def signed(value):
    return f"{'+' if value > 0 else ''}{number(value, 2)}"


def error_text(j):
    if j.reference:
        return "reference"
    if not np.isfinite(j.error):
        return "–"
    text = f"{signed(j.percent(j.error))} %"
    if np.isfinite(j.error_ci):
        text = f"{text[:-2]} ± {number(j.percent(j.error_ci), 2)} %"
    return text if j.told() else f"({text})"


def diagram(study, name, words):
    """Error (%) against processor time, log-log; None where nothing was measured."""
    figure, axes = plt.subplots(figsize=(style.COLUMN[0] * 1.25, style.COLUMN[1] * 1.25))
    drawn = equal = 0
    for colour, (knob, rungs) in zip(style.SERIES * 4, study.ladders.items()):
        points = [(v.time(), abs(v.judged[name].percent(v.judged[name].error)), v) for v in rungs
                  if np.isfinite(v.judged[name].error) and np.isfinite(v.time()) and not v.judged[name].reference]
        equal += sum(1 for _, error, _ in points if error == 0)
        points = [point for point in points if point[1] > 0]
        if not points:
            continue
        order = study.orders.get((knob, name))
        label = knob.replace("_", " ") + (f", order {number(order, 2)}" if order else "")
        if ":" not in knob:
            axes.plot([p[0] for p in points], [p[1] for p in points], color=colour, lw=0.8, alpha=0.7, zorder=2)
        for k, (time, error, v) in enumerate(points):
            j = v.judged[name]
            ci = j.percent(j.error_ci)
            low = min(ci, 0.67 * error) if np.isfinite(ci) else 0   # the axis has no zero
            axes.errorbar(time, error, yerr=[[low], [ci if np.isfinite(ci) else 0]], fmt="s" if v.own else "o", ms=5,
                          color=colour, mfc=colour if j.told() else "white", capsize=2, lw=0.8, zorder=3,
                          label=label if k == 0 else None)
            drawn += 1
    if not drawn:
        plt.close(figure)
        return None
    best = [v for v in study.front(name) if v.judged[name].error != 0]
    axes.step([v.time() for v in best], [abs(v.judged[name].percent(v.judged[name].error)) for v in best],
              where="post", color=style.INK, lw=2, alpha=0.35, zorder=1, label="efficient front")
    scale = next((v.judged[name].scale for r in study.ladders.values() for v in r if v.judged[name].scale), np.nan)
    floor = 100 * study.floor[name] / scale if np.isfinite(scale) else np.nan
    if np.isfinite(floor) and floor > 0 and name != "energy_drift":
        axes.axhspan(axes.get_ylim()[0] * 1e-3, floor, color=style.RULE, alpha=0.6, zorder=0, lw=0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("processor time of a run with its packing (s)")
    axes.set_ylabel("error (%)")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    text = (f"Error of the {words} (%) against processor time, each knob's ladder with the other settings as in the "
            "scene. Errors are against the finest rung of the same ladder; whiskers: 95 % confidence interval over the "
            "packings (Student, paired by seed); hollow: not told from zero; square: the scene's own setting. ")
    if name == "energy_drift":
        text = "Energy that the ledger does not account for, over the work put in (%), against processor time. "
    if np.isfinite(floor) and floor > 0 and name != "energy_drift":
        text += f"Grey: below {number(floor, 2)} %, what a change in the last bit does to one run. "
    return figure, text + (f"{equal} settings change nothing and are not drawn." if equal else "")


def knob_rows(study):
    rows = []
    for knob, about in study.knobs.items():
        rungs = study.ladders.get(knob, [])
        name = about["quantity"]
        done = [v for v in rungs if np.isfinite(v.judged[name].mean)]
        if not done:
            rows.append((knob, name, "–", "–", "–", "not measured"))
            continue
        own = next((v for v in done if v.own), None)
        worst = max((v for v in done if np.isfinite(v.judged[name].error)), default=None,
                    key=lambda v: abs(v.judged[name].error))
        order, expected = study.orders.get((knob, name)), about["order"]
        orders = (number(order, 2) if order else "not fitted") + (f" (expected {expected})" if expected else "")
        if name == "energy_drift":
            says = f"{number(100 * max(v.judged[name].mean for v in done), 2)} % at most"
        elif any(v.judged[name].told() for v in done):
            says = f"shows: {error_text(worst.judged[name])} at {worst.value}"
        elif all(v.judged[name].error == 0 for v in done):
            says = "changes nothing"
        else:
            widest = max(v.judged[name].percent(v.judged[name].error_ci) for v in done if not v.judged[name].reference)
            says = f"its error is lost in the packings' scatter (± {number(widest, 2)} %)" if np.isfinite(widest) \
                else "one packing: not judged"
        rows.append((knob, name, error_text(own.judged[name]) if own else "–",
                     f"{number(study.ratio(done[0]), 2)} … {number(study.ratio(done[-1]), 2)}", orders, says))
    return rows


def variant_rows(study, quantities):
    rows = []
    for knob, rungs in study.ladders.items():
        for v in rungs:
            value = v.value + (" (scene)" if v.own else "")
            if not v.seconds:
                why = v.troubles[0] if v.troubles else ("waiting", "")
                rows.append((knob, value, "–", "–", f"{why[0]}: {why[1]}") + ("",) * (len(quantities) - 1))
                continue
            failed = [message for status, message in v.troubles if status == "failed"]
            rows.append((knob, value + (f", {len(failed)} failed" if failed else ""), duration(v.time()),
                         number(study.ratio(v), 2)) + tuple(error_text(v.judged[name]) for name in quantities))
    return rows


def undecided(study):
    """What more packings would decide: (setting, quantity, seeds)."""
    rows = []
    for rungs in study.groups().values():
        for v in rungs:
            for name, share in study.tolerance.items():
                j = v.judged[name]
                if name == "energy_drift" or j.reference or not j.scale or j.seeds < 2:
                    continue
                room = abs(share - abs(j.error) / j.scale)
                if not room < j.error_ci / j.scale:
                    continue   # decided, one way or the other
                deviation = j.error_ci / scatter.student(j.seeds - 1) * j.seeds ** 0.5 / j.scale
                rows.append((f"{v.knob} = {v.value}", name, scatter.seeds_needed(deviation, room)))
    return rows


def recommendation(study, best):
    if not study.tolerance:
        return ""
    asked = ", ".join(f"{name} within {number(100 * share)} %" for name, share in study.tolerance.items())
    parts = []
    if best is None:
        parts.append(page.paragraph(
            f"Asked: {asked}. No combination of the rungs that were run is shown to keep that: the ledger of the "
            "scene itself is wider, or the packings scatter too much.", "note"))
    else:
        ratio, bounds, picks = best
        changes = [f"{v.knob} = {v.value}" for v in picks if not v.own]
        held = "; ".join(f"{name} {number(100 * bound, 2)} %" for name, bound in bounds.items())
        gained = (f"{number(1 / ratio, 2)} times as fast as the scene" if ratio < 1 else
                  f"{number(ratio, 2)} times the scene's time: the scene's own settings are not shown to keep the "
                  "tolerance")
        parts.append(page.paragraph(
            f"Asked: {asked}. " + (f"Cheapest: {', '.join(changes)} (recommended.prm); expected {gained}. "
                                   if changes else "The scene as it is is the cheapest. ")
            + f"Upper bounds of the summed errors: {held}.", "note"))
    if study.recommended is not None and study.recommended.seconds:
        told = "; ".join(f"{name} {signed(change)} ± {number(ci, 2)} %"
                         for name, (change, ci) in study.check().items())
        speed = study.own.time() / study.recommended.time()
        parts.append(page.paragraph(
            f"Run as recommended: {number(speed, 2)} times as fast as the scene "
            f"({duration(study.recommended.time())} for {duration(study.own.time())}); change against the scene: "
            f"{told}."))
    rows = undecided(study)
    if rows:
        parts.append(page.paragraph("Settings whose error is not told from the tolerance; packings that would decide:"))
        parts.append(page.table(["setting", "quantity", "packings"], rows, numeric=(2,)))
    return page.section("Recommendation", *parts)


def build(study, best, quantities):
    style.use()
    count = len(study.own.seconds)
    parts = [page.paragraph(
        f"The ladder of each knob around the scene's own settings, {count} packing{'s' if count > 1 else ''}. Times are "
        "processor time on one thread, packing included. A bracket marks an error that is not told from zero.")]
    parts.append(recommendation(study, best))
    parts.append(page.section("Knobs", page.table(
        ["knob", "is about", "error of the scene's setting", "time, cheap … exact (scene = 1)", "order", "verdict"],
        knob_rows(study))))
    shown = []
    for name, (_, _, words) in quantities.items():
        made = diagram(study, name, words)
        if made is None:
            shown.append(page.missing(words, "no error above zero was measured"))
            continue
        path = os.path.join(study.folder, f"cost_{name}.png")
        style.save(made[0], path)
        shown.append(page.figure(path, made[1], "wide"))
    parts.append(page.section("Error against time", page.grid(*shown)))
    parts.append(page.section("Every setting", page.table(
        ["knob", "value", "time", "over scene"] + list(quantities), variant_rows(study, quantities),
        numeric=(2, 3))))
    parts.append(page.paragraph(
        "Granular settlement is chaotic: two packings, and two runs of one packing that differ in the last bit, settle "
        "differently. Errors of several knobs are added up for a recommendation, which holds where knobs do not "
        "interact; --pairs A:B measures a pair together.", "note"))
    out = os.path.join(study.folder, "cost.html")
    page.write(out, "What accuracy costs", os.path.basename(os.path.abspath(study.folder)), parts,
               "cost.csv holds every number in SI units; runs.csv names the run behind each.")
    return out
