"""What a run left in its folder, read without trust: a missing file or column is named, never a crash."""
import csv
import os

import numpy as np

import vtu


class Missing(Exception):
    """What is not there and why the figure needs it; the page prints it in the figure's place."""


class Table:
    """Columns of a CSV file by name: floats where every cell is a number, text otherwise."""

    def __init__(self, name, columns):
        self.name = name
        self.columns = columns
        self.rows = len(next(iter(columns.values()))) if columns else 0

    def __contains__(self, column):
        return column in self.columns

    def __getitem__(self, column):
        if column not in self.columns:
            raise Missing(f"{self.name} has no column {column}")
        return self.columns[column]

    def get(self, column):
        return self.columns.get(column)

    def only(self, keep):
        return Table(self.name, {key: value[keep] for key, value in self.columns.items()})


def _column(cells):
    try:
        return np.array([float(cell) if cell.strip() else np.nan for cell in cells])
    except ValueError:
        return np.array([cell.strip() for cell in cells], dtype=object)


def read_table(path):
    """A CSV file as a Table; a line cut short (a run that was stopped while writing) is left out."""
    name = os.path.basename(path)
    if not os.path.exists(path):
        raise Missing(f"{name} is not in the folder")
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        lines = [line for line in csv.reader(file) if line and not line[0].lstrip().startswith("#")]
    if not lines:
        raise Missing(f"{name} is empty")
    header = [cell.strip() for cell in lines[0]]
    rows = [line for line in lines[1:] if len(line) == len(header)]
    if not rows:
        raise Missing(f"{name} has a header but no rows yet")
    return Table(name, {key: _column(cells) for key, cells in zip(header, zip(*rows))})


def read_prm(path):
    """Parameters of a .prm file as {'Section/Key': 'value'}."""
    values, sections = {}, []
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            line = line.split("#")[0].strip()
            if line.startswith("subsection"):
                sections.append(line[len("subsection"):].strip())
            elif line == "end" and sections:
                sections.pop()
            elif line.startswith("set") and "=" in line:
                key, value = line[3:].split("=", 1)
                values["/".join(sections + [key.strip()])] = value.strip()
    return values


class Snapshot:
    """One moment of the grains. Arrays that the file lacks are None."""

    def __init__(self, name, group, mesh):
        def read(key):
            return np.asarray(group[key]) if key in group else None

        attribute = {key: group.attrs[key] for key in group.attrs}
        stage = attribute.get("stage", "")
        self.name = name
        self.time = float(attribute.get("time_s", np.nan))
        self.load = float(attribute.get("load_N", np.nan))
        self.stage = stage.decode() if isinstance(stage, bytes) else str(stage)
        self.points = read("points")
        self.triangles = None if mesh is None else np.asarray(mesh["triangles"], dtype=np.int64)
        self.triangle_grain = None if mesh is None else np.asarray(mesh["triangle_grain"], dtype=np.int64)
        self.triangle_force = read("triangle_force")
        self.grain_position = read("grain_position")
        self.grain_force = read("grain_force")
        self.grain_coordination = read("grain_coordination")
        self.contact_point = read("contact_point")
        self.contact_force = read("contact_force")
        self.contact_grains = read("contact_grains")
        self.rigid_points = read("rigid_points")
        self.rigid_triangles = read("rigid_triangles")


class Run:
    """A folder of a run; every file is read when first asked for."""

    def __init__(self, folder):
        self.folder = folder
        self._tables = {}
        self._structures = {}

    def path(self, name):
        return os.path.join(self.folder, name)

    def table(self, name):
        if name not in self._tables:
            try:
                self._tables[name] = read_table(self.path(name))
            except (Missing, OSError) as why:
                self._tables[name] = why if isinstance(why, Missing) else Missing(f"{name} cannot be read: {why}")
        found = self._tables[name]
        if isinstance(found, Missing):
            raise Missing(str(found))
        return found

    def try_table(self, name):
        try:
            return self.table(name)
        except Missing:
            return None

    @property
    def parameters(self):
        path = self.path("scene.resolved.prm")
        return read_prm(path) if os.path.exists(path) else {}

    @property
    def title(self):
        try:
            with self._snapshots_file() as file:
                title = file.attrs.get("title", "")
                title = title.decode() if isinstance(title, bytes) else str(title)
        except (Missing, OSError):
            title = ""
        return title or os.path.basename(os.path.abspath(self.folder))

    def _snapshots_file(self):
        path = self.path("snapshots.h5")
        if not os.path.exists(path):
            raise Missing("snapshots.h5 is not in the folder")
        try:
            import h5py
        except ImportError as why:
            raise Missing("snapshots.h5 needs Python's h5py (Debian: python3-h5py)") from why
        try:
            return h5py.File(path, "r")
        except OSError as why:
            raise Missing(f"snapshots.h5 cannot be opened ({why})") from why

    def snapshot_list(self):
        """[(name, time, stage, load)] in the order of time."""
        with self._snapshots_file() as file:
            rows = []
            for name in file:
                if name.startswith("snapshot_"):
                    attrs = file[name].attrs
                    stage = attrs.get("stage", "")
                    rows.append((name, float(attrs.get("time_s", np.nan)),
                                 stage.decode() if isinstance(stage, bytes) else str(stage),
                                 float(attrs.get("load_N", np.nan))))
        if not rows:
            raise Missing("snapshots.h5 holds no snapshot yet")
        return sorted(rows, key=lambda row: (row[1], row[0]))

    def loaded_snapshot(self):
        """The last snapshot near the largest load, where chains and stresses show; else the last one."""
        rows = self.snapshot_list()
        stage = rows[-1][2]
        loads = [row[3] for row in rows if row[2] == stage and row[3] == row[3]]
        chosen = rows[-1]
        if loads and max(loads) > 0:
            near = [row for row in rows if row[2] == stage and row[3] >= 0.9 * max(loads)]
            chosen = near[-1]
        with self._snapshots_file() as file:
            group = file[chosen[0]]
            mesh_name = f"mesh_{int(group.attrs.get('mesh', 0))}"
            mesh = file[mesh_name] if mesh_name in file else None
            return Snapshot(chosen[0], group, mesh)

    def structure(self, name, time=None):
        """The VTU of structure_<name> nearest to a time (the last one without), with its exaggerable motion."""
        files = vtu.series(self.folder, name)
        if not files:
            raise Missing(f"no structure_{name}*.vtu in the folder")
        if time is None or time != time:
            path = files[-1][1]
        else:
            path = min(files, key=lambda pair: abs(pair[0] - time) if pair[0] == pair[0] else 1e300)[1]
        if path not in self._structures:
            try:
                self._structures[path] = vtu.read(path)
            except Exception as why:  # any damage of a foreign file ends here, as a sentence
                raise Missing(f"{os.path.basename(path)} cannot be read: {why}") from why
        return self._structures[path]

    def structure_names(self):
        return vtu.names(self.folder)
