"""Pictures of the bed: the stones cut away in front, the force chains in the same view, the bent structures."""
import numpy as np

import raster
import style
from read_run import Missing

STONE = np.array([[0.74, 0.70, 0.64], [0.66, 0.62, 0.57], [0.70, 0.65, 0.57], [0.60, 0.57, 0.54],
                  [0.77, 0.74, 0.70], [0.67, 0.60, 0.53]])
CONCRETE = np.array([0.83, 0.82, 0.79])


class Picture:
    """An image with its scale, colour bars [(label, colour map, low, high)] and what the caption must say."""

    def __init__(self, image, metres_per_pixel, bars=(), caption=""):
        self.image, self.metres_per_pixel, self.bars, self.caption = image, metres_per_pixel, list(bars), caption


class Bed:
    """What is drawn: the grains behind the cut, the structures, and the common view direction."""

    def __init__(self, run):
        snapshot = run.loaded_snapshot()
        if snapshot.points is None or snapshot.triangles is None or not len(snapshot.triangles):
            raise Missing(f"snapshots.h5 has no grain surfaces (points and mesh) in {snapshot.name}")
        self.snapshot = snapshot
        points = snapshot.points.astype(float)
        if not np.isfinite(points).all():
            raise Missing(f"{snapshot.name} holds points that are not finite")
        triangles, owner = snapshot.triangles, snapshot.triangle_grain
        if triangles.max() >= len(points):
            raise Missing(f"the mesh of {snapshot.name} names more points than it holds")
        corners = points[triangles]
        self.grains = int(owner.max()) + 1
        count = np.maximum(np.bincount(owner, minlength=self.grains), 1)
        middle = corners.mean(axis=1)
        centre = np.stack([np.bincount(owner, middle[:, k], self.grains) / count for k in range(3)], axis=1)
        reach = np.zeros(self.grains)
        np.maximum.at(reach, owner, np.linalg.norm(corners - centre[owner][:, None], axis=2).max(axis=1))
        self.grain_size = float(np.median(reach[reach > 0])) * 1.6
        self.reach = reach
        self.centre, self.corners, self.owner = centre, corners, owner
        low, high = points.min(axis=0), points.max(axis=0)
        self.low, self.high = low, high
        # The long side of the bed lies across the picture; the front is the near end of the short side.
        self.across = 0 if high[0] - low[0] >= high[1] - low[1] else 1
        self.inward = 1 - self.across
        self.long = high[self.across] - low[self.across] > 3 * (high[self.inward] - low[self.inward])
        self.floor = low[2] - 0.32 * (high[2] - low[2])   # as much of the subgrade is drawn
        self.structures = self._structures(run, snapshot.time)
        self.cut = self._cut()
        self.shown = centre[:, self.inward] >= self.cut

    def _structures(self, run, time):
        found = {}
        for name in run.structure_names():
            try:
                found[name] = run.structure(name, time)
            except Missing:
                continue
        return found

    def _sleeper_points(self):
        for name, grid in self.structures.items():
            if "sleeper" in name:
                return grid.points + grid.displacement
        if self.snapshot.rigid_points is not None and len(self.snapshot.rigid_points):
            return self.snapshot.rigid_points.astype(float)
        return None

    def _cut(self):
        """A little inside the sleeper's near face, so that its seat on the stones is seen."""
        low, high = self.low[self.inward], self.high[self.inward]
        sleeper = self._sleeper_points()
        if sleeper is None:
            return low + 0.12 * (high - low)
        near, far = sleeper[:, self.inward].min(), sleeper[:, self.inward].max()
        cut = near + min(0.25 * (far - near), self.grain_size)
        return float(np.clip(cut, low, low + 0.5 * (high - low)))

    @property
    def toward(self):
        side = np.zeros(3)
        turn = 0.42 if not self.long else 0.16   # a long bed is seen more squarely, or it would run off the page
        side[self.inward], side[self.across] = -1.0, turn if self.across == 0 else -turn
        side[2] = 0.46
        return side

    @property
    def sun(self):
        side = np.zeros(3)
        side[self.inward], side[self.across] = -0.55, -0.75 if self.across == 0 else 0.75
        side[2] = 0.95
        return side

    def stones(self):
        draw = self.shown[self.owner]
        owner = self.owner[draw]
        shade = np.random.default_rng(7)
        paint = STONE[shade.integers(0, len(STONE), self.grains)] * shade.uniform(0.92, 1.08, (self.grains, 1))
        return raster.Mesh(self.corners[draw], np.clip(paint, 0, 1)[owner], owner)

    def rigid(self):
        points, triangles = self.snapshot.rigid_points, self.snapshot.rigid_triangles
        if points is None or triangles is None or not len(triangles):
            return None
        return raster.Mesh(points.astype(float)[triangles.astype(int)], CONCRETE, 0)

    def view(self, width):
        """Fits the drawn grains and the structures, of the subgrade only what lies near the bed."""
        low = self.low - 0.03 * (self.high - self.low)
        high = self.high + 0.03 * (self.high - self.low)
        low[2] = self.floor
        high[2] = np.inf
        places = [self.corners[self.shown[self.owner]].reshape(-1, 3)]
        places += [grid.points + grid.displacement for grid in self.structures.values()]
        if self.snapshot.rigid_points is not None and len(self.snapshot.rigid_points):
            places.append(self.snapshot.rigid_points.astype(float))
        points = np.concatenate([np.clip(place, low, high) for place in places])
        return raster.View(self.toward, points, width=width)

    def moment(self):
        text = f"{style.number(self.snapshot.time)} s"
        if self.snapshot.stage:
            text += f", stage {self.snapshot.stage}"
        if self.snapshot.load == self.snapshot.load:
            text += f", load {style.number(self.snapshot.load / 1e3)} kN"
        return text


def _scalar(values, unit_steps):
    """Scale and unit that keep numbers between 1 and 1000."""
    top = float(np.nanmax(np.abs(values))) if len(values) else 0.0
    for factor, unit in unit_steps:
        if top >= factor:
            return factor, unit
    return unit_steps[-1]


STRESS_UNITS = [(1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")]
LENGTH_UNITS = [(1e-3, "mm"), (1e-6, "µm")]


def _field(grid, name):
    """(values per point in shown unit, label, colour map, low, high) of a structure, or None."""
    stress = grid.find("sigma_zz", "stress_zz", "szz")
    if stress is not None and np.nanmax(np.abs(stress)) > 0:
        factor, unit = _scalar(stress, STRESS_UNITS)
        values = -stress / factor
        low, high = np.nanpercentile(values, [2, 98])
        if low < -0.25 * high:   # tension too: both signs about a pale middle
            bound = max(-low, high)
            return values, f"{name}: vertical compression ({unit})", style.SIGNED, -bound, bound
        return values, f"{name}: vertical compression ({unit})", style.STRESS, max(low, 0.0) if low > 0 else 0.0, high
    moved = grid.displacement[:, 2]
    if np.nanmax(np.abs(moved)) > 0:
        factor, unit = _scalar(moved, LENGTH_UNITS)
        values = -moved / factor
        low, high = float(values.min()), float(values.max())
        return values, f"{name}: downward displacement ({unit})", style.STRESS, low, high
    return None


def _painted(grid, values, cmap, low, high):
    share = np.clip((values - low) / max(high - low, 1e-30), 0, 1)
    return cmap(share)[:, :3]


def _structure_meshes(bed):
    meshes, bars = [], []
    for name, grid in bed.structures.items():
        corners = (grid.points + grid.displacement)[grid.triangles]
        field = _field(grid, name)
        if field is None or "sleeper" in name:
            meshes.append(raster.Mesh(corners, CONCRETE, 0))
        else:
            values, label, cmap, low, high = field
            mesh = raster.Mesh(corners, _painted(grid, values, cmap, low, high)[grid.triangles], 0)
            meshes.append(raster.above(mesh, bed.floor))
            bars.append((label, cmap, low, high))
    return meshes, bars


def _effort(triangles):
    """Directions of the sky: fewer where the bed is large, so that a picture stays within a minute."""
    return int(np.clip(8e5 / max(triangles, 1), 12, 28))


def _width(bed):
    return 2000 if bed.long else 1300


def stones(run, width=None, directions=None, bed=None):
    """The bed at true scale: stones cut away in front, sleeper, subgrade by its vertical stress."""
    bed = bed or Bed(run)
    width = width or _width(bed)
    extra, bars = _structure_meshes(bed)
    mesh = raster.join([bed.stones(), bed.rigid()] + extra)
    view = bed.view(2 * width)
    image, _ = raster.render(mesh, view, directions or _effort(len(mesh.corners)), sun=bed.sun,
                             grain_size=bed.grain_size)
    caption = (f"The bed at {bed.moment()}: {bed.grains} grains, those in front of the sleeper's near edge taken "
               f"away ({int(bed.shown.sum())} drawn). Parallel projection, true scale; displacements are not "
               "exaggerated.")
    if bars:
        caption += " Colour of the " + " and ".join(f"{label}" for label, *_ in bars) + "."
    return Picture(image, 2 / view.scale, bars, caption)


def chains(run, width=None, directions=None, bed=None, backdrop=None):
    """Contact forces as rods from the grains' centres through the contact; thickness and colour by force."""
    bed = bed or Bed(run)
    width = width or _width(bed)
    snapshot = bed.snapshot
    if snapshot.contact_force is None or snapshot.contact_point is None or snapshot.contact_grains is None:
        raise Missing(f"{snapshot.name} has no contacts (contact_point, contact_force, contact_grains)")
    size = np.linalg.norm(snapshot.contact_force.astype(float), axis=1)
    if not len(size) or not np.nanmax(size) > 0:
        raise Missing(f"no contact carries force in {snapshot.name}")
    centre = bed.centre if snapshot.grain_position is None else snapshot.grain_position
    pair, point = snapshot.contact_grains.astype(int), snapshot.contact_point.astype(float)
    full = float(np.percentile(size[size > 0], 99))
    starts, ends, force = [], [], []
    for side in (0, 1):
        grain = pair[:, side]
        real = (grain >= 0) & (grain < len(centre)) & np.isfinite(point).all(axis=1) & (size > 0.03 * full)
        real[real] &= centre[grain[real]][:, bed.inward] >= bed.cut
        # A contact across a periodic border lies a bay away from one of its two grains: that half is left out.
        real[real] &= np.linalg.norm(point[real] - centre[grain[real]], axis=1) <= 1.3 * bed.reach[
            np.minimum(grain[real], len(bed.reach) - 1)] + 1e-12
        starts.append(centre[grain[real]])
        ends.append(point[real])
        force.append(size[real])
    starts, ends, force = (np.concatenate(part) for part in (starts, ends, force))
    if not len(force):
        raise Missing("no loaded contact lies behind the cut")
    share = np.clip(force / full, 0, 1)
    radii = 0.15 * bed.grain_size * share + 0.004 * bed.grain_size
    paint = style.FORCE(share ** 0.7)[:, :3]
    rods = raster.tubes(starts, ends, radii, paint, sides=10)
    view = bed.view(2 * width)
    image, mask = raster.render(rods, view, directions or _effort(2 * len(rods.corners)), sun=bed.sun, outline=0.25,
                                grain_size=bed.grain_size, shading=0.65)
    if backdrop is not None and backdrop.shape == image.shape:
        grey = backdrop.mean(axis=2, keepdims=True) * 0.6 + backdrop * 0.4
        pale = 1 - 0.26 * (1 - grey)
        free = 1 - mask[..., None]
        image = image - free + pale * free
        image = np.clip(image, 0, 1)
    mean = float(size[size > 0].mean())
    strong = float((size > mean).sum() / (size > 0).sum())
    caption = (f"Force chains at {bed.moment()}, same view and cut. Each rod joins a grain's centre to a contact; its "
               f"thickness is proportional to the contact force (N). Mean force {style.number(mean)} N, largest "
               f"{style.number(float(size.max()))} N; {style.number(100 * strong, 2)} % of the loaded contacts carry "
               f"more than the mean. Forces under 3 % of the 99th percentile are not drawn.")
    factor, unit = (1e3, "kN") if full >= 1e3 else (1.0, "N")
    bar = (f"contact force ({unit}); thickness ∝ force", style.FORCE, 0.0, full / factor)
    return Picture(image, 2 / view.scale, [bar], caption)


def _bending(grid):
    """Displacement without its best-fitting small rigid motion: what is left is deformation."""
    arm = grid.points - grid.points.mean(axis=0)
    count = len(arm)
    columns = np.zeros((3 * count, 6))
    for k in range(3):
        columns[k::3, k] = 1
    columns[1::3, 3], columns[2::3, 3] = -arm[:, 2], arm[:, 1]
    columns[0::3, 4], columns[2::3, 4] = arm[:, 2], -arm[:, 0]
    columns[0::3, 5], columns[1::3, 5] = -arm[:, 1], arm[:, 0]
    moved = grid.displacement.reshape(-1)
    rigid, *_ = np.linalg.lstsq(columns, moved, rcond=None)
    return (moved - columns @ rigid).reshape(-1, 3)


def _nice(value):
    """The largest of 1, 2, 5 times a power of ten that is not above the value."""
    if not value > 0:
        return 1.0
    power = 10 ** np.floor(np.log10(value))
    return float(max(step for step in (1, 2, 5) if step * power <= value * 1.0000001) * power)


def structures(run, width=1100, directions=0, bed=None):
    """Sleeper and subgrade without the grains, their deformation enlarged by a stated factor."""
    grids = {}
    time = None
    try:
        bed = bed or Bed(run)
        time = bed.snapshot.time
        grids = bed.structures
    except Missing:
        for name in run.structure_names():
            grids[name] = run.structure(name)
    if not grids:
        raise Missing("no structure_*.vtu in the folder: no elastic structure was in this scene")
    meshes, bars, notes, everything = [], [], [], []
    for name, grid in grids.items():
        moved = _bending(grid) if "sleeper" in name else grid.displacement
        size = float(np.linalg.norm(moved, axis=1).max())
        span = float(np.ptp(grid.points, axis=0).max())
        factor = _nice(0.06 * span / size) if size > 1e-12 else 1.0
        place = grid.points + moved * factor
        rigid = grid.displacement - moved if "sleeper" in name else 0.0
        place = place + rigid
        shown = -moved[:, 2]
        step, unit = _scalar(shown, LENGTH_UNITS)
        values = shown / step
        low, high = float(values.min()), float(values.max())
        what = f"{name}: downward bending ({unit})" if "sleeper" in name else f"{name}: downward displacement ({unit})"
        if high - low < 1e-12:
            paint, low, high = np.broadcast_to(CONCRETE, (len(values), 3)), 0.0, 1.0
        else:
            cmap = style.SIGNED if "sleeper" in name else style.STRESS
            if "sleeper" in name:
                high = max(abs(low), abs(high))
                low = -high
            paint = _painted(grid, values, cmap, low, high)
            bars.append((what, cmap, low, high))
        meshes.append(raster.Mesh(place[grid.triangles], paint[grid.triangles], 0))
        thin = 0.0011 * span
        used = np.unique(grid.triangles)
        edges = grid.edges[np.isin(grid.edges[:, 0], used) & np.isin(grid.edges[:, 1], used)]
        if 0 < len(edges) <= 40000:
            meshes.append(raster.tubes(place[edges[:, 0]], place[edges[:, 1]], np.full(len(edges), thin),
                                       np.broadcast_to(np.array([0.25, 0.26, 0.28]), (len(edges), 3)), sides=5))
        everything.append(place)
        kind = "bending, without its rigid motion," if "sleeper" in name else "displacement"
        notes.append(f"{name}: {kind} at most {style.number(size * 1e3)} mm, enlarged {style.number(factor)} times")
    points = np.concatenate(everything)
    wide = np.ptp(points, axis=0)
    if bed is not None:
        toward, sun = bed.toward, bed.sun
    else:
        toward, sun = (np.array([0.42, -1, 0.46]), np.array([-0.75, -0.55, 0.95])) if wide[0] >= wide[1] else (
            np.array([-1, -0.42, 0.46]), np.array([-0.55, 0.75, 0.95]))
    view = raster.View(toward, points, width=2 * width, margin=0.03)
    image, _ = raster.render(raster.join(meshes), view, directions, sun=sun, outline=0.0,
                             grain_size=0.06 * float(wide.max()), shading=0.55)
    at = "" if time is None else f" at {bed.moment()}"
    return Picture(image, 2 / view.scale, bars, f"The elastic structures{at}. " + "; ".join(notes) + ".")


def circles(run):
    """Side view of the grains' centres, for runs whose snapshots hold no surfaces."""
    snapshot = run.loaded_snapshot()
    if snapshot.grain_position is None:
        raise Missing(f"{snapshot.name} has no grain positions")
    import matplotlib.pyplot as plt
    place = snapshot.grain_position
    across = 0 if np.ptp(place[:, 0]) >= np.ptp(place[:, 1]) else 1
    figure, axes = plt.subplots()
    force = snapshot.grain_force if snapshot.grain_force is not None else np.zeros(len(place))
    order = np.argsort(-place[:, 1 - across])
    shown = axes.scatter(place[order, across], place[order, 2], c=np.asarray(force)[order], cmap=style.FORCE, s=60,
                         edgecolor="white", linewidth=0.4)
    figure.colorbar(shown, ax=axes, label="force on the grain (N)")
    axes.set_aspect("equal")
    axes.set_xlabel("across (m)")
    axes.set_ylabel("height (m)")
    return figure


def cropped(picture):
    """Without the white rows and columns around what is drawn."""
    ink = (picture.image < 0.995).any(axis=2)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    if not len(rows):
        return picture
    pad = 12
    image = picture.image[max(rows[0] - pad, 0):rows[-1] + pad, max(columns[0] - pad, 0):columns[-1] + pad]
    return Picture(image, picture.metres_per_pixel, picture.bars, picture.caption)


def compose(picture):
    """The image with a scale bar and its colour bars, as a matplotlib figure at the image's own resolution."""
    import matplotlib.pyplot as plt
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    picture = cropped(picture)
    height, width = picture.image.shape[:2]
    inches = 8.5
    tall = inches * height / width
    foot = 0.62
    figure = plt.figure(figsize=(inches, tall + foot), layout="none", dpi=max(width / inches, 110))
    axes = figure.add_axes([0, foot / (tall + foot), 1, tall / (tall + foot)])
    axes.imshow(picture.image, interpolation="lanczos")
    axes.set_axis_off()
    length = _nice(0.22 * width * picture.metres_per_pixel)
    share = length / picture.metres_per_pixel / width
    strip = figure.add_axes([0, 0, 1, foot / (tall + foot)])
    strip.set_axis_off()
    strip.set_xlim(0, 1)
    strip.set_ylim(0, 1)
    strip.plot([0.02, 0.02 + share], [0.70, 0.70], color=style.INK, lw=2.2, solid_capstyle="butt")
    label = f"{style.number(length)} m" if length >= 0.1 else f"{style.number(length * 1e3)} mm"
    strip.text(0.02, 0.52, f"{label} (across the picture)", fontsize=7.5, va="top", color=style.INK)
    count = len(picture.bars)
    for k, (text, cmap, low, high) in enumerate(picture.bars):
        span = min(0.30, 0.64 / count - 0.03)
        left = 0.98 - (count - k) * span - (count - 1 - k) * 0.03
        bar = figure.add_axes([left, 0.60 * foot / (tall + foot), span, 0.16 * foot / (tall + foot)])
        scale = figure.colorbar(ScalarMappable(Normalize(low, high), cmap), cax=bar, orientation="horizontal")
        scale.outline.set_linewidth(0.4)
        scale.ax.tick_params(labelsize=6.5, length=2, width=0.5, pad=1.5)
        scale.ax.locator_params(nbins=5)
        scale.set_label(text, fontsize=7.2, labelpad=1)
    return figure
