"""One look for all figures: colours, type sizes, units for the eye."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LinearSegmentedColormap, to_rgb

INK = "#2b2a28"
QUIET = "#77726b"
RULE = "#d9d4cc"
BLUE = "#1f5a85"
RUST = "#b5502a"
OCHRE = "#c9952b"
MOSS = "#5c7a48"
PLUM = "#74507a"
TEAL = "#2f8582"
SERIES = [BLUE, RUST, MOSS, OCHRE, PLUM, TEAL, "#8c8479", "#93364a"]
RIGID = QUIET
ELASTIC = RUST

# Early cycles sand, late cycles dark blue: readable in grey too.
CYCLES = LinearSegmentedColormap.from_list("cycles", ["#e0c79a", "#c99a5b", "#8f7f78", "#4a7294", "#163f63"])
FORCE = LinearSegmentedColormap.from_list("force", ["#c9bfae", "#d7a556", "#c65f2b", "#8c1c24", "#4a0d1f"])
STRESS = LinearSegmentedColormap.from_list("stress", ["#f1ece2", "#b9d0d3", "#6fa3b8", "#2f6c98", "#123a66"])
SIGNED = LinearSegmentedColormap.from_list("signed", ["#123a66", "#4f8fb3", "#f1ece2", "#cf7f4c", "#8c2a1c"])

COLUMN = (6.3, 3.7)   # inches; one figure of a page column
DPI = 200


def use():
    """Set matplotlib's defaults for every figure of a page."""
    matplotlib.rcParams.update({
        "figure.figsize": COLUMN, "figure.dpi": 100, "savefig.dpi": DPI,
        "figure.constrained_layout.use": True,
        "font.family": "DejaVu Sans", "font.size": 9, "axes.labelsize": 9,
        "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
        "legend.fontsize": 8, "legend.frameon": False, "xtick.labelsize": 8, "ytick.labelsize": 8,
        "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": QUIET,
        "xtick.color": QUIET, "ytick.color": QUIET, "xtick.labelcolor": INK, "ytick.labelcolor": INK,
        "axes.linewidth": 0.7, "axes.spines.top": False, "axes.spines.right": False,
        "axes.grid": True, "grid.color": RULE, "grid.linewidth": 0.5, "axes.axisbelow": True,
        "lines.linewidth": 1.5, "lines.markersize": 4, "lines.solid_capstyle": "round",
        "axes.prop_cycle": matplotlib.cycler(color=SERIES),
        "axes.formatter.useoffset": False,
    })


def rgb(colour):
    return to_rgb(colour)


def number(value, digits=3):
    """A number for the eye: `digits` significant, no needless exponent, a true minus sign."""
    if value is None or value != value:
        return "–"
    if value in (float("inf"), float("-inf")):
        return "∞"
    size = abs(value)
    if size and (size < 1e-4 or size >= 1e6):
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        power = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa}·10{power}".replace("-", "−")
    if size >= 1000:
        return f"{value:,.0f}".replace(",", " ").replace("-", "−")
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{value:.0f}"
    return text.replace("-", "−")


def duration(seconds):
    if seconds is None or seconds != seconds:
        return "–"
    if seconds < 1:
        return f"{number(seconds * 1e3, 2)} ms"
    if seconds < 120:
        return f"{number(seconds)} s"
    if seconds < 7200:
        return f"{int(seconds // 60)} min {int(seconds % 60):02d} s"
    return f"{int(seconds // 3600)} h {int(seconds % 3600 // 60):02d} min"


def save(figure, path):
    own = figure.dpi != matplotlib.rcParams["figure.dpi"]   # a rendering keeps its own pixels
    figure.savefig(path, facecolor="white", metadata={"Software": None}, dpi=figure.dpi if own else DPI)
    plt.close(figure)
