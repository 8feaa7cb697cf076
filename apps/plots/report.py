"""Figures and one self-contained page of a run: report.py DIR [--no-pictures]. Writes DIR/*.png and DIR/report.html."""
import argparse
import os
import sys
import traceback

sys.dont_write_bytecode = True   # the program's folder may not be ours to write in
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bed_picture  # noqa: E402
import figures  # noqa: E402
import measures  # noqa: E402
import page  # noqa: E402
import strength  # noqa: E402
import style  # noqa: E402
from read_run import Missing, Run  # noqa: E402
from style import number  # noqa: E402

CURVES = [   # section, [(file, title, function)]
    ("Settlement", [("settlement", "Settlement per cycle", figures.settlement),
                    ("loops", "Load–displacement loops", figures.hysteresis),
                    ("stiffness", "Stiffness per cycle", figures.stiffness)]),
    ("Under the sleeper", [("pressure", "Contact pressure", figures.pressure),
                           ("moment", "Bending", figures.moment),
                           ("subgrade_pressure", "Pressure on the subgrade", figures.subgrade_pressure)]),
    ("The bed", [("gradation", "Gradation", figures.gradation),
                 ("compaction", "Density per tamping cycle", figures.compaction),
                 ("porosity", "Porosity by layers", figures.porosity),
                 ("sections", "Virtual slices", figures.sections),
                 ("forces", "Force on the grains", figures.forces)]),
    ("Books and clock", [("energy", "Energy ledger", figures.energy),
                         ("history", "The run in time", figures.overview),
                         ("timing", "Where the time went", figures.timing)]),
]


def attempt(make, *arguments):
    """The result, or the reason why there is none: a figure that fails never takes the page with it."""
    try:
        return make(*arguments), None
    except Missing as why:
        return None, str(why)
    except Exception as why:  # noqa: BLE001
        if os.environ.get("TRACKBED_TRACE"):
            traceback.print_exc()
        return None, f"{type(why).__name__}: {why}"


def headline(run):
    cards = []

    def card(name, unit, make, scale=1.0, bad=lambda value: False, digits=3):
        value, why = attempt(make, run)
        if value is None:
            cards.append((f"{name}: {why}", "–", "", False))
        else:
            cards.append((name, number(value * scale, digits), unit, bad(value)))

    count = measures.cycle_count(run)
    card(f"settlement after {count} cycles" if count else "settlement", "mm", measures.settlement, 1e3)
    card("last effective stiffness K_e", "kN/mm", measures.stiffness, 1e-6)
    card("springs back per cycle, mean", "mm", measures.elastic_displacement, 1e3)
    card("density after tamping", "kg/m³", measures.density, 1, digits=4)

    def worst(run):
        import numpy as np
        return float(np.nanmax(np.abs(measures.closure(run)[1])))

    card(f"energy ledger: largest gap, of the work put in (tolerance {number(100 * measures.CLOSURE_TOLERANCE)} %)", "%",
         worst, 100, lambda value: not value <= measures.CLOSURE_TOLERANCE, 2)
    overlap = _summary_value(run, "overlap")
    if overlap is not None:
        name, value, unit = overlap
        cards.append((name, number(100 * value, 2) if unit in ("", "1", "-") else number(value),
                      "%" if unit in ("", "1", "-") else unit, False))
    wall, _ = attempt(measures.wall_time, run)
    if wall is not None:
        value, unit = style.duration(wall).split(" ", 1)
        cards.append(("wall-clock time", value, unit, False))
    return page.cards(cards)


def _summary_value(run, word):
    """The first row of summary.csv that names the word and has a number."""
    table = run.try_table("summary.csv")
    if table is None or "quantity" not in table or "value" not in table:
        return None
    for k, name in enumerate(table["quantity"]):
        if word in str(name).lower():
            try:
                unit = str(table["unit"][k]) if "unit" in table else ""
                return str(name), float(table["value"][k]), unit
            except ValueError:
                continue
    return None


def pictures(run, folder, width=None):
    """The three renderings; each its own reason when it is not there."""
    parts, options = [], {} if width is None else {"width": width}
    bed, why = attempt(bed_picture.Bed, run)
    backdrop = None
    made = []
    if bed is None:
        figure, also = attempt(bed_picture.circles, run)
        if figure is not None:
            path = os.path.join(folder, "bed.png")
            style.save(figure, path)
            parts.append(page.figure(path, "Side view of the grains' centres, coloured by force (N); the stones "
                                           f"themselves are not drawn: {why}.", "portrait"))
        else:
            parts.append(page.missing("The bed", why if also is None else also))
    else:
        made.append(("bed", "The bed", lambda: bed_picture.stones(run, bed=bed, **options)))
        made.append(("chains", "Force chains", lambda: bed_picture.chains(run, bed=bed, backdrop=backdrop, **options)))
    made.append(("structures", "A picture of the structures", lambda: bed_picture.structures(run, bed=bed, **options)))
    for name, title, make in made:
        picture, why = attempt(make)
        if picture is None:
            parts.append(page.missing(title, why))
            continue
        if name == "bed":
            backdrop = picture.image
        path = os.path.join(folder, f"{name}.png")
        figure, why = attempt(bed_picture.compose, picture)
        if figure is None:
            parts.append(page.missing(title, why))
            continue
        style.save(figure, path)
        wide = picture.image.shape[1] > 1.5 * picture.image.shape[0]
        kind = "wide" if wide else "narrow" if name == "structures" else ""
        parts.append(page.figure(path, picture.caption, kind))
    return page.section("The bed at a load maximum", page.grid(*parts))


# summary.csv: how near a quantity came to its limit, and where the limit stands.
LIMITS = [("time step share", None, 1.0, "time step, of the measured stability limit"),
          ("largest overlap", "Contact/Largest overlap", None, "depth over the smaller grain's size"),
          ("closure", "Numerics/Closure", None, "energy not accounted for, over the work put in")]


def limits(run):
    """How near the run came to its limits, and which tolerance or aim was not met."""
    table, why = attempt(run.table, "summary.csv")
    if table is None:
        return page.section("How near to the limits", page.missing("The table of limits", why))
    values = {str(name): value for name, value in zip(table["quantity"], table["value"])}
    given, rows = run.parameters, []

    def number_of(text):
        try:
            return float(text)
        except (TypeError, ValueError):
            return float("nan")

    def row(words, value, limit):
        share = value / limit if limit else float("nan")
        says = "–" if share != share else "EXCEEDED" if share > 1 else f"{number(100 * share, 2)} % of it"
        rows.append((words, number(value), number(limit), says))

    for name, path, fixed, words in LIMITS:
        row(words, number_of(values.get(name)), fixed if fixed else number_of(given.get(path)))
    for name in values:
        if name.startswith("unrest of "):
            row(f"rest at the end of {name[len('unrest of '):]}: what moves, over what is allowed", number_of(values[name]), 1)
    deviation, _ = attempt(measures.class_deviation, run)
    if deviation is not None:
        row("gradation: deviation of a class, of the mass", deviation, number_of(given.get("Gradation/Tolerance")))
    target = number_of(given.get("Packing/Target density"))
    density, _ = attempt(measures.density, run)
    if density is not None and given.get("Packing/Method") == "tamping" and target > 0:
        rows.append(("density after tamping (kg/m³), to be reached", number(density, 4), number(target, 4),
                     "reached" if density >= target else f"NOT REACHED, {number(100 * density / target, 3)} % of it"))
    created, _ = attempt(lambda: max(0.0, float(measures.finite(measures.closure(run)[1], "closure").max())))
    if created is not None:
        row("of that, energy created", created, number_of(given.get("Numerics/Closure")))
    return page.section("How near to the limits",
                        page.table(["", "reached", "limit", "how near"], rows, numeric=(1, 2)))


def effects(run):
    table, why = attempt(run.table, "summary.csv")
    if table is None:
        return page.section("Effects and accuracy", page.missing("The table of effects and knobs", why))
    rows = []
    for k in range(table.rows):
        cells = []
        for column in ("quantity", "value", "unit", "meaning"):
            value = table[column][k] if column in table else ""
            if isinstance(value, str):
                try:
                    value = float(value) if column == "value" and value else value
                except ValueError:
                    pass
            if not isinstance(value, str):
                value = "" if value != value else number(float(value), 4)
            cells.append("" if column == "unit" and value == "1" else value)
        rows.append(cells)
    listed = run.try_table("effects.csv")
    shown = "" if listed is None else page.table(
        ["effect", "", "cost, or what switches it on"],
        [(name, "on" if on == 1 else "off", words) for name, on, words in
         zip(listed["effect"], listed["on"], listed["cost_or_switch"])])
    return page.section("Effects and accuracy",
                        page.paragraph("What was computed, and what each approximation costs."), shown,
                        page.table(["quantity", "value", "unit", "meaning"], rows, numeric=(1,)))


def zones(run):
    """Grains by zone, and what an all-fine bed of that mass would have."""
    table, why = attempt(run.table, "zones.csv")
    if table is None:
        return page.section("Zones", page.missing("The table of zones", why))
    rows = [[table["zone"][k], *(number(float(table[name][k]), 4) for name in table.columns if name != "zone")]
            for k in range(table.rows)]
    have, fine = float(table["grains"].sum()), float(table["grains_if_all_fine"].sum())
    return page.section(
        "Zones",
        page.paragraph(f"{number(have, 4)} grains where a bed of fine ones alone would have {number(fine, 4)}: "
                       f"{number(100 * (1 - have / fine), 2)} % fewer to compute in every step."),
        page.table(["zone", "grains", "fine", "coarse", "mass (kg)", "faces, mean", "if all were fine"], rows,
                   numeric=tuple(range(1, 7))))


def caution(run):
    cycles = measures.cycle_count(run)
    count = "One load cycle is" if cycles == 1 else f"{cycles or 'A few'} load cycles are"
    return page.section(
        "What this does not say",
        page.paragraph(f"{count} not a track's life. A main line carries some 10⁵ to 10⁶ axles a year (20 million "
                       "gross tonnes on 25 t axles are 800 000), and between two tampings a sleeper sees as many. What "
                       "is seen here is the beginning: the first rearrangement after tamping, fast and then slower. "
                       "Breakage, attrition, fouling and weather, which rule later, are not in it.", "note"),
        page.paragraph("So compare variants by these curves (a grading, a pad, a subgrade, an elastic sleeper against "
                       "a rigid one), and do not extend them to a maintenance interval. Granular settlement is chaotic: "
                       "one packing is one sample. A difference means something when it passes what several packings "
                       "and a repeat that differs in the last bit scatter by: trackbed compare SCENE --packings N "
                       "says when."))


def build(folder, with_pictures=True, width=None):
    """Writes every figure and the page; returns the page's path."""
    style.use()
    run = Run(folder)
    tested = strength.figures(run)   # then there are no load cycles
    if tested:
        found, why = attempt(strength.table, run)
        parts = [found if why is None else page.missing("The table of strengths", why)]
    else:
        parts = [headline(run)]
    if with_pictures:
        parts.append(pictures(run, folder, width))
    cyclic = ("Settlement", "Under the sleeper")
    for title, curves in [("Curves", tested), *(c for c in CURVES if c[0] not in cyclic)] if tested else CURVES:
        shown = []
        if title == "The bed" and os.path.exists(os.path.join(folder, "friction_path.csv")):
            curves = [*curves, ("friction_path", "Quasi-vibration", figures.friction_path)]
        for name, label, make in curves:
            made, why = attempt(make, run)
            if made is None:
                shown.append(page.missing(label, why))
                continue
            path = os.path.join(folder, f"{name}.png")
            _, why = attempt(style.save, made[0], path)
            shown.append(page.figure(path, made[1]) if why is None else page.missing(label, why))
        parts.append(page.section(title, page.grid(*shown)))
    if os.path.exists(os.path.join(folder, "zones.csv")):
        parts.append(zones(run))
    parts.append(limits(run))
    parts.append(effects(run))
    if not tested:
        parts.append(caution(run))
    out = os.path.join(folder, "report.html")
    subject = "a test of the grains" if tested else "settlement of a ballast bed under cyclic load"
    page.write(out, run.title, f"Trackbed: {subject}", parts,
               "Files beside this page: cycles.csv, history.csv, energy.csv and the others hold every number shown; "
               "snapshots.xdmf and structure_*.pvd open in ParaView; scene.resolved.prm repeats the run. SI units "
               "in the files.")
    return out


def main():
    parser = argparse.ArgumentParser(description="Figures and one self-contained page of a run.")
    parser.add_argument("folder", help="folder of a run")
    parser.add_argument("--no-pictures", action="store_true", help="curves only, a few seconds")
    parser.add_argument("--width", type=int, help="width of the renderings in pixels")
    options = parser.parse_args()
    if not os.path.isdir(options.folder):
        print(f"report: {options.folder} is not a folder", file=sys.stderr)
        return 2
    try:
        print(build(options.folder, not options.no_pictures, options.width))
    except OSError as why:
        print(f"report: {options.folder} cannot be written: {why}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
