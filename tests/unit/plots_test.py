"""Tests of the report: a synthetic run of random convex polyhedra, whole and damaged.

    /usr/bin/python3 -m unittest plots_test            (in tests/unit)
    /usr/bin/python3 plots_test.py --make DIR [GRAINS]   writes a synthetic run to look at
    /usr/bin/python3 plots_test.py --make-compare DIR    writes a synthetic comparison
"""
import base64
import csv
import itertools
import os
import shutil
import sys
import tempfile
import unittest
import zlib

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "apps", "plots"))

import h5py  # noqa: E402

import bed_picture  # noqa: E402
import compare  # noqa: E402
import figures  # noqa: E402
import picture  # noqa: E402
import raster  # noqa: E402
import read_run  # noqa: E402
import report  # noqa: E402
import slices  # noqa: E402
import style  # noqa: E402
import vtu  # noqa: E402


# ---- a synthetic run -----------------------------------------------------------------------------------------

def hull(points):
    """Triangles of a convex hull, anticlockwise from outside, by trying every triple: for a dozen points only."""
    middle = points.mean(axis=0)
    found = []
    for a, b, c in itertools.combinations(range(len(points)), 3):
        normal = np.cross(points[b] - points[a], points[c] - points[a])
        side = (points - points[a]) @ normal
        if (side <= 1e-12).all() or (side >= -1e-12).all():
            outward = normal @ (points[a] - middle) > 0
            found.append((a, b, c) if outward else (a, c, b))
    return np.array(found)


def shape(rng):
    points = rng.normal(size=(13, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    points *= rng.uniform(0.85, 1.0, (13, 1)) * np.array([1.15, 0.95, 0.8])
    triangles = hull(points)
    used = np.unique(triangles)
    return points[used], np.searchsorted(used, triangles)


def settle(rng, count, box, radius):
    """Soft spheres that have fallen into a box: places that look like a bed."""
    place = np.stack([rng.uniform(radius, box[k] - radius) for k in range(2)]
                     + [rng.uniform(0.02, 2.2 * box[2], count)], axis=1)
    speed = np.zeros_like(place)
    for step in range(260):
        speed[:, 2] -= 0.0006
        gap = place[:, None] - place[None]
        far = np.linalg.norm(gap, axis=2) + 1e-9
        near = np.clip(0.93 * (radius[:, None] + radius[None]) - far, 0, None)
        np.fill_diagonal(near, 0)
        speed += 0.35 * np.einsum("ij,ijk->ik", near / far, gap)
        speed *= 0.7
        place += speed
        for k in range(2):
            place[:, k] = np.clip(place[:, k], radius, box[k] - radius)
        place[:, 2] = np.maximum(place[:, 2], radius * 0.9)
    return place


def write_csv(path, header, rows):
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(header)
        out.writerows(rows)


def block(low, high, parts):
    """Points and hexahedra of a box."""
    axes = [np.linspace(low[k], high[k], parts[k] + 1) for k in range(3)]
    points = np.array([[x, y, z] for z in axes[2] for y in axes[1] for x in axes[0]])
    nx, ny = parts[0] + 1, parts[1] + 1

    def at(i, j, k):
        return i + nx * (j + ny * k)

    cells = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)]
             for k in range(parts[2]) for j in range(parts[1]) for i in range(parts[0])]
    return points, np.array(cells)


def write_vtu(path, points, cells, data, compressed=True):
    """As deal.II writes them: every cell with points of its own, base64 with zlib blocks."""
    own = points[cells].reshape(-1, 3)

    def blob(values):
        raw = np.ascontiguousarray(values).tobytes()
        if compressed:
            body = zlib.compress(raw)
            head = np.array([1, len(raw), len(raw), len(body)], dtype="<u4").tobytes()
            return base64.b64encode(head).decode() + base64.b64encode(body).decode()
        return base64.b64encode(np.array([len(raw)], dtype="<u4").tobytes() + raw).decode()

    def array(name, kind, values, width=1):
        return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" format="binary">\n'
                f'{blob(values)}\n</DataArray>')

    count = len(cells)
    fields = "".join(array(name, "Float64", np.asarray(values, float)[cells].reshape(count * 8, -1),
                           1 if np.ndim(values) == 1 else 3) for name, values in data.items())
    zip_name = ' compressor="vtkZLibDataCompressor"' if compressed else ""
    with open(path, "w") as file:
        file.write(f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1"{zip_name} '
                   f'byte_order="LittleEndian"><UnstructuredGrid>'
                   f'<Piece NumberOfPoints="{count * 8}" NumberOfCells="{count}"><Points>'
                   f'{array("Points", "Float64", own, 3)}</Points><Cells>'
                   f'{array("connectivity", "Int32", np.arange(count * 8, dtype="<i4"))}'
                   f'{array("offsets", "Int32", 8 * np.arange(1, count + 1, dtype="<i4"))}'
                   f'{array("types", "UInt8", np.full(count, 12, dtype="u1"))}</Cells>'
                   f'<PointData>{fields}</PointData></Piece></UnstructuredGrid></VTKFile>\n')


def make_run(folder, grains=70, elastic=True, seed=1, nudge=0.0, cycles=12):
    """A whole run: settlement like a·log(1+n), loops that tighten, a ledger that closes to 0.4 %."""
    os.makedirs(folder, exist_ok=True)
    rng = np.random.default_rng(seed)
    to = lambda name: os.path.join(folder, name)  # noqa: E731
    n = np.arange(1, cycles + 1)
    soft = 1.12 if elastic else 1.0
    wobble = rng.normal(0, 0.015, cycles).cumsum() * 0.2 + nudge
    u_min = 1e-3 * (1.5 * np.log1p(1.3 * (n - 1)) * (1 + wobble)) / soft
    swing = 1e-3 * soft * (1.9 - 0.55 * (1 - np.exp(-n / 4))) * (1 + rng.normal(0, 0.01, cycles) + nudge)
    u_max = u_min + swing
    k_up = 77e3 / swing * 0.93
    k_down = 77e3 / swing * 1.04
    write_csv(to("cycles.csv"), ["cycle", "time_s", "load_min_N", "load_max_N", "u_min_m", "u_max_m", "settlement_m",
                                 "stiffness_loading_N_per_m", "stiffness_unloading_N_per_m"],
              zip(n, 2.0 + 0.1 * n, [3e3] * cycles, [80e3] * cycles, u_min, u_max, u_min - u_min[0], k_up, k_down))
    tamp = np.arange(1, 11)
    density = 1400 + 120 * (1 - np.exp(-tamp / 3.5))
    write_csv(to("porosity.csv"), ["layer", "z_low_m", "z_high_m", "porosity", "void_ratio", "density_kg_per_m3",
                                   "grains", "coordination"],
              [[0, 0, 0.2, 0.4, 2 / 3, 1560, 100, 5], [1, 0, 0.1, 0.45, 0.82, 1430, 50, 4.5],
               [2, 0.1, 0.2, 0.35, 0.54, 1690, 50, 5.5]])
    write_csv(to("sections.csv"), ["axis", "position_m", "piece", "grain", "a_m", "b_m"],
              [["z", 0.1, 0, 7, 0, 0], ["z", 0.1, 0, 7, 0.1, 0], ["z", 0.1, 0, 7, 0, 0.1],
               ["z", 0.1, 1, 8, 0.2, 0], ["z", 0.1, 1, 8, 0.3, 0], ["z", 0.1, 1, 8, 0.2, 0.1],
               ["y", 0.0, 2, 7, 0, 0.1], ["y", 0.0, 2, 7, 0.1, 0.1], ["y", 0.0, 2, 7, 0, 0.2]])
    write_csv(to("compaction.csv"), ["cycle", "time_s", "height_m", "density_kg_per_m3", "porosity", "void_ratio"],
              [(c, 1 + 0.1 * c, 0.33 * 1400 / d, d, 1 - d / 2600, 2600 / d - 1) for c, d in zip(tamp, density)])
    rows = []
    for t in np.linspace(0, 1, 60):
        rows.append((t, "deposit", 0, "", 5 * np.exp(-4 * t), int(2500 * t), 5.5 * t))
    for t in np.linspace(1, 2, 120):
        rows.append((t, "compact", 2e4 * (1 - np.cos(2 * np.pi * 10 * t)), "", 0.05, 3000, 6.0))
    for t in np.arange(2.0, 2.0 + 0.1 * cycles + 1e-9, 0.002):
        c = (t - 2) / 0.1
        share = 0.5 * (1 - np.cos(2 * np.pi * c))
        at = 1 + min(c, cycles - 1)
        base = np.interp(at, n, u_min)
        lag = share ** (0.8 if c % 1 < 0.5 else 0.62)
        rows.append((t, "load", 3e3 + 77e3 * share, base + np.interp(at, n, swing) * lag, 1e-3, 3100, 6.3))
    write_csv(to("history.csv"), ["time_s", "stage", "load_N", "u_m", "kinetic_J", "contacts", "coordination"], rows)
    time = np.linspace(0, 2 + 0.1 * cycles, 200)
    friction = 55 * (1 - np.exp(-time / 1.2))
    gravity = 120 * np.exp(-4 * time)
    kinetic = 40 * time * np.exp(-5 * time)
    contact = 3 + 2 * np.sin(2 * np.pi * time) ** 2 * (time > 1)
    structure = 4 * np.sin(2 * np.pi * 10 * time) ** 2 * (time > 2) * elastic
    transfer = 1e-13 * time
    work = 60 * np.clip(time - 0.8, 0, None) / 2.4
    closure = 0.004 * np.sin(4 * time) * work
    local = work + 120 - gravity - kinetic - (contact - 3) - structure - friction - closure
    write_csv(to("energy.csv"), ["time_s", "kinetic_J", "gravity_J", "contact_J", "structure_J", "work_J",
                                 "dissipated_friction_J", "dissipated_local_damping_J", "transfer_error_J",
                                 "closure_J"],
              zip(time, kinetic, gravity, contact, structure, work, friction, local, transfer, closure))
    write_csv(to("gradation.csv"), ["sieve_m", "target_percent", "achieved_percent", "band_min_percent",
                                    "band_max_percent"],
              [(0.016, 0, 0, 0, 2), (0.025, 0, 0, 0, 5), (0.0355, 4, 3.6, 0, 12), (0.045, 33, 34.2, 22, 45),
               (0.056, 79, 78.1, 65, 90), (0.063, 95, 95.6, 88, 100), (0.08, 100, 100, 100, 100)])
    write_csv(to("timing.csv"), ["stage", "calls", "seconds", "share"],
              [("contact geometry", 42000, 171.2, 0.46), ("candidates", 3100, 44.0, 0.118),
               ("contact law", 42000, 38.9, 0.105), ("motion", 42000, 20.5, 0.055),
               ("surface contact", 42000, 31.0, 0.083), ("structures", 21000, 55.3, 0.149), ("output", 240, 11.0, 0.03)])
    write_csv(to("summary.csv"), ["quantity", "value", "unit", "meaning"],
              [("largest overlap over grain size", 0.0083, "1", "what the softened contact modulus costs"),
               ("time step over its limit", 0.21, "1", "below 1 the integration is stable"),
               ("grains", grains, "1", "drawn by mass from the library"),
               ("contact modulus", 2e9, "Pa", "knob; rock has 4e10"),
               ("effects on", "friction; local damping (packing only)", "", "passes in the list of this run"),
               ("effects off", "rolling resistance; absorbing boundary", "", "cost nothing")])
    x = np.linspace(-0.13, 0.13, 27)
    y = np.linspace(-0.15, 0.15, 31)
    press = [(a, b, max(0, 9e5 * (1 + (0.35 if elastic else 0.75) * (a / 0.13) ** 2 * 1.2) * (0.6 + 0.4 * np.cos(9 * b))
                        * rng.gamma(2.0, 0.5))) for a in x for b in y]
    write_csv(to("pressure.csv"), ["x_m", "y_m", "pressure_Pa"], press)
    write_csv(to("subgrade_pressure.csv"), ["x_m", "y_m", "pressure_Pa"], press)
    write_csv(to("subgrade_pressure_profile.csv"), ["x_m", "pressure_Pa"],
              [(a, np.mean([p for b, _, p in press if b == a])) for a in x])
    s = np.linspace(-0.15, 0.15, 41)
    if elastic:
        write_csv(to("moment.csv"), ["x_m", "deflection_m", "moment_Nm"],
                  zip(s, 2e-5 * np.cos(np.pi * s / 0.3), 900 * np.cos(np.pi * s / 0.3) ** 2 * (1 + nudge)))
    with open(to("scene.resolved.prm"), "w") as file:
        file.write("subsection Scene\n  set Title = Ballast box\nend\nsubsection Contact\n"
                   "  set Modulus = 2e9 # Pa\nend\n")
    make_snapshots(to("snapshots.h5"), rng, grains)
    if elastic:
        make_structures(folder)
    write_csv(to("grains.csv"), ["grain", "shape", "sieve_m", "volume_m3", "mass_kg", "largest_force_N"],
              [(g, g % 24, 0.045, 5e-5, 0.13, 900 * rng.gamma(1.5)) for g in range(grains)])


def make_snapshots(path, rng, grains):
    box = np.array([0.6, 0.3, 0.33 * grains / 620])
    box[2] = max(box[2], 0.05)
    if grains < 400:
        box[:2] *= np.sqrt(grains / 620 * 0.33 / 0.12)
        box[2] = 0.12
    library = [shape(rng) for _ in range(24)]
    radius = np.clip(rng.normal(0.0265, 0.004, grains), 0.017, 0.035)
    place = settle(rng, grains, box, radius)
    # Stones under and beside the sleeper only: none where the block stands.
    points, triangles, owner, offset = [], [], [], 0
    top = np.quantile(place[:, 2], 0.97)
    for g in range(grains):
        p, t = library[g % len(library)]
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        turn *= np.sign(np.linalg.det(turn))
        points.append(p @ turn.T * radius[g] * 1.12 + place[g])
        triangles.append(t + offset)
        owner += [g] * len(t)
        offset += len(p)
    points, triangles, owner = np.concatenate(points), np.concatenate(triangles), np.array(owner)
    gap = np.linalg.norm(place[:, None] - place[None], axis=2)
    first, second = np.nonzero(np.triu(gap < 0.99 * (radius[:, None] + radius[None]), 1))
    middle = 0.5 * (place[first] + place[second])
    way = place[second] - place[first]
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    spread = 0.06 + 0.5 * (top - middle[:, 2]).clip(0)
    focus = np.exp(-((middle[:, 0] - box[0] / 2) / (0.15 * box[0] / 0.6 + spread * 0.5)) ** 2)
    size = 900 * rng.gamma(0.9, 1.0, len(first)) * (0.05 + focus * (0.15 + np.abs(way[:, 2]) ** 2))
    force = -way * size[:, None]
    floor = np.flatnonzero(place[:, 2] < 1.1 * radius)
    floor_point = place[floor] - np.stack([0 * floor, 0 * floor, radius[floor]], axis=1)
    total = np.zeros(grains)
    np.add.at(total, first, size)
    np.add.at(total, second, size)
    with h5py.File(path, "w") as file:
        file.attrs["title"] = "Ballast box, synthetic"
        mesh = file.create_group("mesh_0")
        mesh["triangles"] = triangles.astype(np.int32)
        mesh["triangle_grain"] = owner.astype(np.int32)
        for k, (time, stage, load) in enumerate([(1.0, "deposit", 0.0), (3.15, "load", 80e3), (3.2, "load", 3e3)]):
            group = file.create_group(f"snapshot_{k:04d}")
            group.attrs["time_s"], group.attrs["stage"] = time, stage
            group.attrs["mesh"], group.attrs["load_N"] = 0, load
            group["points"] = points.astype(np.float32)
            group["triangle_force"] = total[owner].astype(np.float32)
            group["grain_position"], group["grain_velocity"] = place, np.zeros_like(place)
            group["grain_coordination"] = np.bincount(np.r_[first, second], minlength=grains).astype(np.int32)
            group["grain_force"] = total.astype(np.float32)
            group["contact_point"] = np.r_[middle, floor_point].astype(np.float32)
            group["contact_force"] = np.r_[force, np.tile([0, 0, 300.0], (len(floor), 1))].astype(np.float32)
            group["contact_grains"] = np.r_[np.stack([first, second], axis=1),
                                            np.stack([floor, np.full(len(floor), -1)], axis=1)].astype(np.int32)
        file.attrs["box"] = np.r_[box, top]


def make_structures(folder):
    with h5py.File(os.path.join(folder, "snapshots.h5")) as file:
        lx, ly, _, top = file.attrs["box"]
    points, cells = block((0, 0, -0.25), (lx, ly, 0), (14, 7, 5))
    far = ((points[:, 0] - lx / 2) / (0.3 * lx)) ** 2 + ((points[:, 1] - ly / 2) / (0.6 * ly)) ** 2
    depth = (points[:, 2] + 0.25) / 0.25
    down = -4e-4 * np.exp(-far) * depth
    stress = -2.6e5 * np.exp(-far / (1.4 - 0.4 * depth)) * (0.45 + 0.55 * depth)
    zero = np.zeros(len(points))
    subgrade = dict(displacement_m=np.stack([zero, zero, down], axis=1), stress_zz_Pa=stress, von_mises_Pa=-0.8 * stress)
    s_points, s_cells = block((0.28 * lx, 0.05 * ly, top + 0.008), (0.72 * lx, 0.95 * ly, top + 0.13), (10, 8, 4))
    arm = (s_points[:, 0] - lx / 2) / (0.22 * lx)
    zero = np.zeros(len(s_points))
    sleeper = dict(displacement_m=np.stack([zero, zero, -4e-3 - 3e-5 * (1 - arm ** 2)], axis=1),
                   stress_zz_Pa=-1.5e6 * (1 - arm ** 2), von_mises_Pa=2e6 * (1 - arm ** 2))
    for name, (p, c, data) in dict(sleeper=(s_points, s_cells, sleeper), subgrade=(points, cells, subgrade)).items():
        lines = []
        for k, time in enumerate((3.15, 3.2)):
            file = f"structure_{name}_{k:04d}.vtu"
            write_vtu(os.path.join(folder, file), p, c, data, compressed=k == 0)
            lines.append(f'<DataSet timestep="{time}" group="" part="0" file="{file}"/>')
        with open(os.path.join(folder, f"structure_{name}.pvd"), "w") as file:
            file.write('<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>'
                       + "".join(lines) + "</Collection></VTKFile>")


def make_compare(folder, grains=60, packings=3):
    make_run(os.path.join(folder, "rigid"), grains, False)
    make_run(os.path.join(folder, "elastic"), grains, True)
    make_run(os.path.join(folder, "rigid_repeat"), grains, False, nudge=0.012)
    make_run(os.path.join(folder, "elastic_repeat"), grains, True, nudge=-0.008)
    for p in range(2, packings + 1):
        make_run(os.path.join(folder, f"packing_{p}", "rigid"), grains, False, seed=p)
        make_run(os.path.join(folder, f"packing_{p}", "elastic"), grains, True, seed=p)


if __name__ == "__main__" and len(sys.argv) > 2 and sys.argv[1].startswith("--make"):
    if sys.argv[1] == "--make":
        make_run(sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 70)
    else:
        make_compare(sys.argv[2])
    sys.exit(0)


style.DPI = 50   # what is tested does not depend on it


# ---- tests ---------------------------------------------------------------------------------------------------

class Folder(unittest.TestCase):
    """A small synthetic run, made once; each test works on a copy."""

    @classmethod
    def setUpClass(cls):
        cls.base = tempfile.mkdtemp(prefix="plots_test_")
        cls.whole = os.path.join(cls.base, "whole")
        make_run(cls.whole, grains=36, cycles=6)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.base)

    def copy(self, *without):
        folder = tempfile.mkdtemp(dir=self.base)
        for name in os.listdir(self.whole):
            if name not in without:
                shutil.copy(os.path.join(self.whole, name), folder)
        return folder


class Numbers(unittest.TestCase):
    def test_numbers_for_the_eye(self):
        self.assertEqual(style.number(0.0), "0")
        self.assertEqual(style.number(-1.234), "−1.23")
        self.assertEqual(style.number(12345), "12 345")
        self.assertEqual(style.number(999.7), "1000")
        self.assertEqual(style.number(2e9), "2.00·10⁹")
        self.assertEqual(style.number(3e-7, 2), "3.0·10⁻⁷")
        self.assertEqual(style.number(float("nan")), "–")
        self.assertEqual(style.duration(3725), "62 min 05 s")


class Rendering(unittest.TestCase):
    def test_nearest_triangle_wins_and_areas_are_exact(self):
        far = [[0, 0, 5.0], [20, 0, 5.0], [0, 20, 5.0]]
        near = [[0, 0, 2.0], [10, 0, 2.0], [0, 10, 2.0]]
        for order in ([far, near], [near, far]):
            ids, depth = raster.rasterise(np.array(order), 20, 20, cull=False)
            which = order.index(near)
            self.assertEqual(ids[1, 1], which)
            self.assertEqual(depth[1, 1], 2.0)
            self.assertEqual(ids[12, 2], 1 - which)
            self.assertEqual(ids[19, 19], -1)
            self.assertTrue(np.isinf(depth[19, 19]))
            self.assertAlmostEqual((ids >= 0).sum(), 200, delta=11)

    def test_pictures_do_not_depend_on_the_order_or_size_of_batches(self):
        rng = np.random.default_rng(3)
        corners = rng.uniform(0, 60, (300, 3, 3))
        _, depth = raster.rasterise(corners, 64, 64, cull=False)
        whole = raster.CHUNK
        try:
            raster.CHUNK = 500   # many batches: the hidden ones are skipped by the depth pyramid
            _, again = raster.rasterise(corners, 64, 64, cull=False)
        finally:
            raster.CHUNK = whole
        np.testing.assert_array_equal(depth, again)

    def test_a_sphere_shows_its_disc_and_only_its_front(self):
        rng = np.random.default_rng(1)
        points = rng.normal(size=(60, 3))
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        triangles = hull(points)
        view = raster.View((0, -1, 0), points, width=200)
        ids, depth = raster.rasterise(view.project(points[triangles]), view.width, view.height)
        area = np.isfinite(depth).sum() / view.scale ** 2
        self.assertAlmostEqual(area, np.pi, delta=0.4)
        outward = raster.Mesh(points[triangles], [1, 1, 1], 0).face
        self.assertLess((outward[np.unique(ids[ids >= 0])] @ view.away).max(), 0)   # the far half is skipped
        _, uncut = raster.rasterise(view.project(points[triangles]), view.width, view.height, cull=False)
        self.assertGreater(np.isclose(depth, uncut).mean(), 0.99)   # and was not seen anyhow

    def test_view_and_place_are_inverse(self):
        points = np.random.default_rng(2).normal(size=(40, 3))
        view = raster.View((0.4, -1, 0.5), points, width=300)
        flat = view.project(points)
        np.testing.assert_allclose(view.place(*flat.T), points, atol=1e-12)

    def test_light_stays_between_black_and_white(self):
        points, triangles = shape(np.random.default_rng(5))
        mesh = raster.Mesh(points[triangles], [0.7, 0.7, 0.7], 0)
        image, mask = raster.render(mesh, raster.View((0.3, -1, 0.4), points, width=80), directions=6, grain_size=2)
        self.assertTrue(np.isfinite(image).all())
        self.assertTrue(0 <= image.min() and image.max() <= 1)
        inner = image[mask == 1]
        self.assertGreater(np.ptp(inner.mean(axis=1)), 0.05)   # faces differ

    def test_a_cut_keeps_area_and_colour(self):
        points, triangles = shape(np.random.default_rng(4))
        mesh = raster.Mesh(points[triangles], np.repeat(points[triangles][:, :, 2:], 3, axis=2), 0)   # colour = z
        upper = raster.above(mesh, 0.1)
        self.assertGreaterEqual(upper.corners[:, :, 2].min(), 0.1 - 1e-12)
        np.testing.assert_allclose(upper.colour[:, :, 0], upper.corners[:, :, 2], atol=1e-6)
        lower = raster.above(raster.Mesh(mesh.corners * [1, -1, -1], mesh.colour, 0), -0.1)

        def area(part):
            sides = part.corners[:, 1:] - part.corners[:, :1]
            return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2

        self.assertAlmostEqual(area(upper) + area(lower), area(mesh), 12)
        self.assertTrue((np.einsum("ij,ij->i", upper.face, upper.corners.mean(axis=1)) > 0).all())   # still outward

    def test_tubes_are_closed(self):
        mesh = raster.tubes([[0, 0, 0]], [[0, 0, 2.0]], [0.5], [[1, 0, 0]], sides=64)
        volume = np.einsum("ij,ij->i", mesh.corners[:, 0], np.cross(mesh.corners[:, 1], mesh.corners[:, 2])).sum() / 6
        self.assertAlmostEqual(volume, np.pi * 0.25 * 2, delta=0.01)


class Grids(Folder):
    def test_vtu_of_both_kinds(self):
        for k in (0, 1):   # zlib blocks, then plain base64
            grid = vtu.read(os.path.join(self.whole, f"structure_subgrade_{k:04d}.vtu"))
            self.assertEqual(len(grid.points), 15 * 8 * 6)
            self.assertEqual(len(grid.triangles), 2 * 2 * (14 * 7 + 14 * 5 + 7 * 5))
            corners = grid.points[grid.triangles]
            volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
            self.assertAlmostEqual(volume, np.ptp(grid.points, axis=0).prod(), 9)   # all faces look outwards
            self.assertLess(grid.displacement[:, 2].min(), -1e-4)
            self.assertIsNotNone(grid.find("sigma_zz", "stress_zz"))

    def test_rigid_motion_is_not_bending(self):
        grid = vtu.read(os.path.join(self.whole, "structure_sleeper_0000.vtu"))
        turn = np.cross([1e-4, -2e-4, 3e-4], grid.points)
        grid.data["displacement_m"] = turn + [1e-3, 2e-3, -3e-3]
        self.assertLess(np.abs(bed_picture._bending(grid)).max(), 1e-12)

    def test_the_series_follows_the_pvd(self):
        self.assertEqual([time for time, _ in vtu.series(self.whole, "sleeper")], [3.15, 3.2])
        self.assertEqual(vtu.names(self.whole), ["sleeper", "subgrade"])

    def test_a_damaged_file_is_named(self):
        folder = self.copy()
        for name in os.listdir(folder):
            if name.endswith(".vtu"):
                with open(os.path.join(folder, name), "r+") as file:
                    file.truncate(700)
        with self.assertRaisesRegex(read_run.Missing, "structure_sleeper_.*cannot be read"):
            read_run.Run(folder).structure("sleeper")


class Reading(Folder):
    def test_a_line_cut_short_is_left_out(self):
        folder = self.copy()
        with open(os.path.join(folder, "cycles.csv"), "a") as file:
            file.write("7,3.1,3000")
        self.assertEqual(read_run.Run(folder).table("cycles.csv").rows, 6)

    def test_empty_cells_are_not_numbers(self):
        history = read_run.Run(self.whole).table("history.csv")
        self.assertTrue(np.isnan(history["u_m"][0]))
        self.assertEqual(history["stage"][0], "deposit")

    def test_missing_things_are_named(self):
        run = read_run.Run(self.copy("cycles.csv"))
        with self.assertRaisesRegex(read_run.Missing, "cycles.csv is not in the folder"):
            run.table("cycles.csv")
        with self.assertRaisesRegex(read_run.Missing, "no column nonsense"):
            read_run.Run(self.whole).table("history.csv")["nonsense"]

    def test_the_loaded_snapshot_is_taken(self):
        self.assertEqual(read_run.Run(self.whole).loaded_snapshot().load, 80e3)

    def test_parameters(self):
        self.assertEqual(read_run.Run(self.whole).parameters, {"Scene/Title": "Ballast box", "Contact/Modulus": "2e9"})


class Measures(Folder):
    def test_loops_are_cut_at_the_load_minima(self):
        import measures
        loops = measures.loops(read_run.Run(self.whole))
        self.assertEqual(len(loops), 6)
        for load, _ in loops:
            self.assertLess(max(load[0], load[-1]), 4e3)
            self.assertGreater(load.max(), 79e3)

    def test_closure_is_of_the_work_put_in(self):
        import measures
        table = read_run.Table("energy.csv", dict(time_s=np.arange(4.0), work_J=np.array([0, 10.0, 4.0, 10.0]),
                                                  closure_J=np.array([0, 0.1, 0.1, -0.32])))
        np.testing.assert_allclose(measures.work_put_in(table), [0, 10, 10, 16])

    def test_a_tilted_rigid_sleeper_is_not_bent(self):
        import measures
        folder = self.copy()
        x = np.linspace(-1.3, 1.3, 27)
        write_csv(os.path.join(folder, "moment.csv"), ["x_m", "deflection_m", "moment_Nm"],
                  zip(x, 2e-3 + 1e-3 * x, 0 * x))
        self.assertEqual(measures.deflection_range(read_run.Run(folder)), 0.0)


class Slices(Folder):
    def test_pieces_go_to_their_cut(self):
        found = slices.cuts(os.path.join(self.whole, "sections.csv"))
        self.assertEqual([(axis, at, grains) for axis, at, _, grains in found], [("z", 0.1, [7, 8]), ("y", 0.0, [7])])
        np.testing.assert_allclose(found[0][2][1], [[200, 0], [300, 0], [200, 100]])   # mm


class Report(Folder):
    def page(self, folder, pictures=False):
        path = report.build(folder, with_pictures=pictures, width=160)
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_a_whole_run(self):
        folder = self.copy()
        text = self.page(folder, pictures=True)
        self.assertNotIn("is not shown", text)
        for name in ("bed", "chains", "structures", "settlement", "loops", "stiffness", "gradation", "compaction",
                     "energy", "timing", "pressure", "moment", "subgrade_pressure", "history", "forces", "porosity", "sections"):
            self.assertTrue(os.path.exists(os.path.join(folder, name + ".png")), name)
        self.assertIn("not a track's life".replace("'", "&#x27;"), text)
        self.assertEqual(text.count("<img"), 17)
        for resource in ("http://", "https://", "src=\"/", "<script", "<link"):
            self.assertNotIn(resource, text)

    def test_a_test_of_grains(self):
        """Its strengths and curves take the place of what load cycles leave."""
        strength = ("test,state,stress_Pa,ratio,friction_angle_deg,angle_error_deg,angle_ci95_deg,cohesion_Pa,"
                    "cohesion_error_Pa,cohesion_ci95_Pa,inertial_number,held_within,position\n")
        rows = {"direct_shear": "peak,25e3,0.8,38.66,,,,,,2e-3,0.01,0.02\ndirect_shear,peak fit,,,38.26,1,12.7,300,2,25,2e-3,,\n",
                "triaxial": "peak,5e4,0.5,30,,,,,,5e-4,0.01,0.1\n", "angle_of_repose": "repose,,0.7,35,1.5,3.5,,,,,,\n"}
        curves = {"direct_shear": "stress_Pa,displacement_m,stress_ratio,dilation_m\n25e3,0.01,0.5,0\n25e3,0.02,0.8,1e-3\n",
                  "triaxial": "stress_Pa,axial_strain,deviator_Pa,volumetric_strain\n5e4,0.05,8e4,0.01\n5e4,0.1,1e5,0\n",
                  "angle_of_repose": "distance_m,height_m,height_deviation_m,fitted\n" +
                                     "".join(f"{x},{0.4 - 0.7 * x},0.01,1\n" for x in (0.1, 0.2, 0.3, 0.4))}
        says = {"direct_shear": ("38.3°", "NOT quasi-static"), "triaxial": ("Mohr&#x27;s plane", "quasi-static (below"),
                "angle_of_repose": ("35°", "Surface of the heap")}
        for name, row in rows.items():
            folder = self.copy("cycles.csv", "pressure.csv", "moment.csv")
            with open(os.path.join(folder, "scene.resolved.prm"), "w") as file:
                file.write(f"subsection Test\n  set Type = {name}\nend\n")
            with open(os.path.join(folder, "strength.csv"), "w") as file:
                file.write(strength + f"{name},{row}")
            with open(os.path.join(folder, "repose.csv" if name == "angle_of_repose" else f"{name}.csv"), "w") as file:
                file.write(curves[name])
            text = self.page(folder)
            self.assertNotIn("is not shown", text, name)
            self.assertNotIn("Settlement per cycle", text)
            for words in says[name]:
                self.assertTrue(words in text, words)

    def test_every_file_may_be_missing(self):
        names = [name for name in os.listdir(self.whole) if name.endswith((".csv", ".h5", ".prm"))]
        for name in names:
            with self.subTest(name):
                run = read_run.Run(self.copy(name))
                reasons = [report.headline(run), report.effects(run), report.caution(run), run.title]
                for _, curves in report.CURVES:
                    for _, _, make in curves:
                        made, why = report.attempt(make, run)
                        reasons.append(why or "")
                        if made:
                            style.plt.close(made[0])
                if name not in ("snapshots.h5", "scene.resolved.prm"):
                    self.assertIn(name, " ".join(reasons))
                self.assertNotIn("Error", " ".join(reasons))   # reasons are sentences, not exceptions

    def test_an_empty_folder_gives_a_page_of_reasons(self):
        text = self.page(tempfile.mkdtemp(dir=self.base), pictures=True)
        self.assertIn("cycles.csv is not in the folder", text)
        self.assertEqual(text.count("<img"), 0)

    def test_nonsense_never_takes_the_page_with_it(self):
        folder = self.copy()
        for name in os.listdir(folder):
            if name.endswith(".csv"):
                with open(os.path.join(folder, name)) as file:
                    header = file.readline()
                with open(os.path.join(folder, name), "w") as file:
                    file.write(header + ",".join(["nan"] * len(header.split(","))) + "\n")
        with open(os.path.join(folder, "snapshots.h5"), "wb") as file:
            file.write(b"not a file of that kind")
        self.assertIn("snapshots.h5 cannot be opened", self.page(folder, pictures=True))

    def test_grains_without_surfaces_are_circles(self):
        folder = self.copy()
        with h5py.File(os.path.join(folder, "snapshots.h5"), "a") as file:
            for name in file:
                if name.startswith("snapshot_"):
                    del file[name]["points"]
        text = self.page(folder, pictures=True)
        self.assertIn("Side view of the grains", text)

    def test_a_rigid_run_draws_its_block(self):
        folder = self.copy(*[name for name in os.listdir(self.whole) if name.startswith("structure_")])
        points, cells = block((0.1, 0.05, 0.13), (0.2, 0.1, 0.2), (1, 1, 1))
        triangles = [t for f in vtu.HEXAHEDRON_FACES for t in ((f[0], f[1], f[2]), (f[0], f[2], f[3]))]
        with h5py.File(os.path.join(folder, "snapshots.h5"), "a") as file:
            for name in file:
                if name.startswith("snapshot_"):
                    file[name]["rigid_points"] = points.astype(np.float32)
                    file[name]["rigid_triangles"] = cells[0][np.array(triangles)].astype(np.int32)
        text = self.page(folder, pictures=True)
        self.assertIn("no elastic structure was in this scene", text)
        self.assertTrue(os.path.exists(os.path.join(folder, "chains.png")))

    def test_an_open_ledger_is_marked(self):
        folder = self.copy()
        path = os.path.join(folder, "energy.csv")
        with open(path) as file:
            rows = list(csv.reader(file))
        at = rows[0].index("closure_J")
        for row in rows[1:]:
            row[at] = str(50 * float(row[at]) + 3)
        write_csv(path, rows[0], rows[1:])
        text = self.page(folder)
        self.assertIn('class="card bad"', text)
        self.assertIn("OUTSIDE the tolerance", text)

    def test_limits_say_how_near_and_what_was_passed(self):
        folder = self.copy()
        write_csv(os.path.join(folder, "summary.csv"), ["quantity", "value", "unit", "meaning"],
                  [("time step share", "0.4", "-", ""), ("largest overlap", "0.3", "-", ""),
                   ("closure", "0.001", "-", ""), ("unrest of deposit", "0.9", "-", ""),
                   ("unrest of hardening", "2.5", "-", "")])
        write_csv(os.path.join(folder, "classes.csv"),
                  ["low_m", "high_m", "target_percent", "achieved_percent", "grains"],
                  [(0.02, 0.03, 40, 43, 9), (0.03, 0.04, 60, 57, 7)])
        write_csv(os.path.join(folder, "compaction.csv"), ["cycle", "time_s", "height_m", "density_kg_per_m3"],
                  [(1, 0.1, 0.3, 1200.0), (2, 0.2, 0.28, 1240.0)])
        with open(os.path.join(folder, "scene.resolved.prm"), "w") as file:
            file.write("subsection Contact\n set Largest overlap = 0.2\nend\n"
                       "subsection Gradation\n set Tolerance = 0.1\nend\n"
                       "subsection Packing\n set Method = tamping\n set Target density = 1550\nend\n"
                       "subsection Numerics\n set Closure = 0.01\nend\n")
        text = report.limits(read_run.Run(folder))
        self.assertIn("40 % of it", text)
        self.assertIn("10 % of it", text)
        self.assertEqual(text.count("EXCEEDED"), 2)      # overlap, rest of the hardening
        self.assertIn("30 % of it", text)                # 3 of 10 % in a class
        self.assertIn("NOT REACHED, 80 % of it", text)

    def test_text_is_escaped(self):
        folder = self.copy()
        write_csv(os.path.join(folder, "summary.csv"), ["quantity", "value", "unit", "meaning"],
                  [("<b>overlap</b>", "a & b", "", "\"x\"")])
        self.assertIn("&lt;b&gt;overlap&lt;/b&gt;", self.page(folder))

    def test_readme_picture(self):
        out = os.path.join(self.base, "out.png")
        picture.build(self.whole, out, width=120)
        self.assertGreater(os.path.getsize(out), 2000)


class Comparison(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="plots_test_")
        make_compare(cls.folder, grains=24, packings=3)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_page_and_table(self):
        path = compare.build(self.folder)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        self.assertEqual(text.count("<img"), 5)
        table = read_run.read_table(os.path.join(self.folder, "compare.csv"))
        self.assertEqual(list(table.columns)[:7], ["quantity", "unit", "rigid", "elastic", "difference_percent",
                                                   "floor_percent", "verdict"])
        k = list(table["quantity"]).index("settlement after the last cycle")
        self.assertAlmostEqual(table["difference_percent"][k], 100 * (1 / 1.12 - 1), 6)
        self.assertEqual(table["packings"][k], 3)
        self.assertIn("smaller by 11 %", table["verdict"][k])
        k = list(table["quantity"]).index("largest bending moment of the sleeper")
        self.assertIn("moment.csv is not in the folder", table["verdict"][k])

    def row(self, difference, floor=np.nan, ci=np.nan, packings=1):
        row = compare.Row("q", "m", 1, "m")
        row.difference, row.floor, row.difference_ci, row.packings = difference, floor, ci, packings
        return compare.verdict(row)

    def test_verdicts(self):
        self.assertEqual(self.row(2.0, floor=3.0), "none (below the noise floor of 3 %)")
        self.assertEqual(self.row(5.0, floor=3.0), "elastic larger by 5 %, of this one packing")
        self.assertEqual(self.row(-5.0, 3.0, 7.0, 4), "none (lost in the scatter of 4 packings, ±7 %)")
        self.assertEqual(self.row(-9.0, 3.0, 7.0, 4), "elastic smaller by 9 %")
        self.assertIn("not judged", self.row(9.0))

    def test_half_a_comparison(self):
        folder = tempfile.mkdtemp(dir=self.folder)
        shutil.copytree(os.path.join(self.folder, "rigid"), os.path.join(folder, "rigid"))
        with open(compare.build(folder), encoding="utf-8") as file:
            self.assertIn("elastic: the run is not in the folder", file.read())


if __name__ == "__main__":
    unittest.main()
