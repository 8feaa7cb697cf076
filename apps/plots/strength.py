"""Figures of a test of grains: curves of direct_shear.csv, triaxial.csv, repose.csv, and Mohr's plane."""
import matplotlib.pyplot as plt
import numpy as np

import page
import style
from read_run import Missing
from style import number


def _stresses(table):
    return [(stress, table.only(table["stress_Pa"] == stress)) for stress in np.unique(table["stress_Pa"])]


def _fit(run, state):
    """Angle [degree] and cohesion [Pa] of a Mohr-Coulomb line, None where there are too few specimens."""
    table = run.table("strength.csv")
    found = [k for k, name in enumerate(table["state"]) if name == f"{state} fit"]
    if not found or not np.isfinite(table["friction_angle_deg"][found[0]]):
        return None
    return float(table["friction_angle_deg"][found[0]]), float(table["cohesion_Pa"][found[0]])


def _against(run, file, x, y, labels, scales, what):
    table = run.table(file)
    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6.3, 5.2))
    for k, (stress, curve) in enumerate(_stresses(table)):
        for axis, column, scale in zip(axes, y, scales[1:]):
            axis.plot(curve[x] * scales[0], curve[column] * scale, color=style.SERIES[k % len(style.SERIES)],
                      label=f"{number(stress / 1e3)} kPa")
    axes[1].set_xlabel(labels[0])
    axes[0].set_ylabel(labels[1])
    axes[1].set_ylabel(labels[2])
    axes[0].legend(title=what)
    return figure


def shear(run):
    figure = _against(run, "direct_shear.csv", "displacement_m", ("stress_ratio", "dilation_m"),
                      ("shear displacement (mm)", "shear over normal stress", "rise of the lid (mm)"), (1e3, 1, 1e3),
                      "normal stress")
    return figure, ("Shear stress over the normal stress on the shear plane, and how far the lid rises as the grains "
                    "climb over each other (mm). Each point is the mean over its part of the travel.")


def triaxial(run):
    figure = _against(run, "triaxial.csv", "axial_strain", ("deviator_Pa", "volumetric_strain"),
                      ("axial strain (%)", "deviator s1 − s3 (kPa)", "volumetric strain (%)"), (100, 1e-3, 100),
                      "confining stress")
    figure.axes[1].invert_yaxis()
    return figure, ("Deviator stress (kPa) and volumetric strain (%, positive when the specimen shrinks, drawn "
                    "downwards) against the axial strain.")


def mohr_plane(run):
    """Points of direct shear, or circles of triaxial tests, with the fitted lines."""
    table = run.table("strength.csv")
    figure, axes = plt.subplots(figsize=(6.3, 4))
    text, far = [], 0.0
    for state, colour in (("peak", style.RUST), ("residual", style.BLUE)):
        mine = [k for k, name in enumerate(table["state"]) if name == state]
        for k in mine:
            stress, ratio = table["stress_Pa"][k] / 1e3, table["ratio"][k]
            if str(table["test"][k]) == "triaxial":
                major = stress * (1 + ratio) / (1 - ratio)
                turn = np.linspace(0, np.pi, 120)
                axes.plot((major + stress) / 2 + (major - stress) / 2 * np.cos(turn), (major - stress) / 2 * np.sin(turn),
                          color=colour, lw=1)
                far = max(far, major)
            else:
                axes.plot([stress], [stress * ratio], "o", color=colour)
                far = max(far, 1.1 * stress)
        fit = _fit(run, state)
        if fit:
            angle, cohesion = fit
            normal = np.array([0, far])
            axes.plot(normal, cohesion / 1e3 + normal * np.tan(np.radians(angle)), color=colour, ls=(0, (4, 2)),
                      label=f"{state}: {number(angle)}°, {number(cohesion / 1e3)} kPa")
            text.append(f"{state} {number(angle)}° with {number(cohesion / 1e3)} kPa")
    if not far:
        raise Missing("strength.csv has no peak yet")
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("normal stress (kPa)")
    axes.set_ylabel("shear stress (kPa)")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    if text:
        axes.legend()
    lines = "Lines by least squares: " + "; ".join(text) + " (apparent cohesion)." if text else \
        "One stress alone gives no line."
    return figure, "Mohr's plane. " + lines


def profile(run):
    table = run.table("repose.csv")
    x, height = table["distance_m"] * 1e3, table["height_m"] * 1e3
    figure, axes = plt.subplots(figsize=(6.3, 3.2))
    axes.fill_between(x, height - table["height_deviation_m"] * 1e3, height + table["height_deviation_m"] * 1e3,
                      color=style.OCHRE, alpha=0.25, linewidth=0, label="from cut to cut")
    axes.plot(x, height, color=style.INK, marker=".", label="surface")
    on = table["fitted"] == 1
    text = "No slope could be fitted."
    if on.sum() >= 3:
        slope, start = np.polyfit(x[on], height[on], 1)
        axes.plot(x[on], start + slope * x[on], color=style.RUST, lw=2.2, label="fitted slope")
        text = f"The slope between 20 % and 80 % of the height stands at {number(np.degrees(np.arctan(-slope)))}°."
    axes.set_aspect("equal", adjustable="box")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("distance from the back wall (mm)")
    axes.set_ylabel("height (mm)")
    axes.legend()
    return figure, "Surface of the heap by slices half a grain wide. " + text


FIGURES = {"direct_shear": [("direct_shear", "Shear curves", shear), ("mohr", "Mohr's plane", mohr_plane)],
           "triaxial": [("triaxial", "Compression curves", triaxial), ("mohr", "Mohr's plane", mohr_plane)],
           "angle_of_repose": [("repose", "Profile of the heap", profile)]}


def figures(run):
    """Figures of the test that the folder holds; [] where it holds none."""
    return FIGURES.get(run.parameters.get("Test/Type", "none"), [])


def table(run):
    """strength.csv for the eye."""
    found, rows = run.table("strength.csv"), []

    def cell(name, k, scale=1.0):
        value = found[name][k]
        return "" if isinstance(value, str) or value != value else number(float(value) * scale)

    for k in range(found.rows):
        rows.append([found["state"][k], cell("stress_Pa", k, 1e-3), cell("ratio", k), cell("friction_angle_deg", k),
                     cell("angle_error_deg", k), cell("angle_ci95_deg", k), cell("cohesion_Pa", k, 1e-3),
                     cell("cohesion_error_Pa", k, 1e-3), cell("cohesion_ci95_Pa", k, 1e-3), cell("held_within", k, 100)])
    header = ["", "stress (kPa)", "ratio", "friction angle (°)", "standard error (°)", "95 % (±°)",
              "apparent cohesion (kPa)", "standard error (kPa)", "95 % (±kPa)", "stress held within (%)"]
    inertial = found["inertial_number"][0]
    words = ("Ratio: shear over normal stress, (s1 − s3)/(s1 + s3), or the slope. Errors are those of the fit: how well the "
             "points lie on a line, not how much another packing would differ; run several seeds for that.")
    if not isinstance(inertial, str) and inertial == inertial:
        words += (f" Inertial number {number(float(inertial), 2)}: "
                  + ("quasi-static (below 1e-3)." if inertial <= 1e-3 else "NOT quasi-static (above 1e-3)."))
    return page.section("Strength", page.table(header, rows, numeric=tuple(range(1, 10))), page.paragraph(words))
