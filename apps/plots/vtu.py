"""Reads VTK's unstructured grids (.vtu) as deal.II writes them, and takes their outer faces.

Formats: ascii, inline base64 with or without zlib blocks, appended raw or base64. Cells: tetrahedra, hexahedra,
voxels, wedges are left out, triangles and quadrilaterals are kept as they are; of Lagrange hexahedra the corners
serve. Format reference: VTK User's Guide, "XML file formats".
"""
import base64
import glob
import os
import re
import struct
import xml.etree.ElementTree as xml
import zlib

import numpy as np

TYPES = {"Float32": "f4", "Float64": "f8", "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2",
         "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8"}
HEXAHEDRON_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
VOXEL_ORDER = (0, 1, 3, 2, 4, 5, 7, 6)


class Grid:
    """points (P,3) in the reference place, triangles of the outer surface, point data by name."""

    def __init__(self, points, triangles, data, edges):
        self.points, self.triangles, self.data, self.edges = points, triangles, data, edges

    def find(self, *names):
        """Point data under one of these names, whatever the case; None if there is none."""
        lower = {re.sub(r"_(m|pa|n)$", "", key.lower()): key for key in self.data}   # units may follow the name
        for name in names:
            if name in lower:
                return self.data[lower[name]]
        return None

    @property
    def displacement(self):
        found = self.find("displacement", "u", "displacements")
        return np.zeros_like(self.points) if found is None or found.ndim != 2 else found[:, :3]


def names(folder):
    """Names of the structures in a folder: structure_<name>.pvd or structure_<name>_0012.vtu."""
    found = []
    for path in sorted(glob.glob(os.path.join(folder, "structure_*.vtu"))):
        match = re.match(r"structure_(.+?)(?:_\d+)?\.vtu$", os.path.basename(path))
        if match and match.group(1) not in found:
            found.append(match.group(1))
    return found


def series(folder, name):
    """[(time or nan, path)] of one structure; times are those of its .pvd."""
    pvd = os.path.join(folder, f"structure_{name}.pvd")
    rows = []
    if os.path.exists(pvd):
        try:
            for item in xml.parse(pvd).iter("DataSet"):
                path = os.path.join(folder, item.get("file", ""))
                if os.path.exists(path) and path.endswith(".vtu"):
                    rows.append((float(item.get("timestep", "nan")), path))
        except (xml.ParseError, ValueError):
            rows = []
    if not rows:
        rows = [(float("nan"), path) for path in sorted(glob.glob(os.path.join(folder, f"structure_{name}*.vtu")))
                if re.fullmatch(rf"structure_{re.escape(name)}(_\d+)?\.vtu", os.path.basename(path))]
    return rows


def _decode_inline(text, header, compressed):
    width = struct.calcsize(header)
    text = "".join(text.split())
    if not compressed:
        raw = base64.b64decode(text)
        return raw[width:width + struct.unpack_from("<" + header, raw)[0]]
    first = base64.b64decode(text[:4 * ((3 * width + 2) // 3)])
    blocks = struct.unpack_from("<" + header, first)[0]
    size = (3 + blocks) * width
    head = base64.b64decode(text[:4 * ((size + 2) // 3)])
    lengths = struct.unpack_from(f"<{blocks}{header}", head, 3 * width)
    body = base64.b64decode(text[4 * ((size + 2) // 3):])
    parts, at = [], 0
    for length in lengths:
        parts.append(zlib.decompress(body[at:at + length]))
        at += length
    return b"".join(parts)


def _decode_appended(blob, offset, header, compressed):
    width = struct.calcsize(header)
    count = struct.unpack_from("<" + header, blob, offset)[0]
    if not compressed:
        return blob[offset + width:offset + width + count]
    lengths = struct.unpack_from(f"<{count}{header}", blob, offset + 3 * width)
    at, parts = offset + (3 + count) * width, []
    for length in lengths:
        parts.append(zlib.decompress(blob[at:at + length]))
        at += length
    return b"".join(parts)


def read(path):
    """The first piece of a .vtu file as a Grid."""
    with open(path, "rb") as file:
        content = file.read()
    blob, encoding = b"", "raw"
    appended = re.search(rb"<AppendedData[^>]*encoding=\"(\w+)\"[^>]*>\s*_", content)
    if appended:
        encoding = appended.group(1).decode()
        end = content.rfind(b"</AppendedData>")
        blob = content[appended.end():end]
        content = content[:appended.start()] + b"</VTKFile>"
    root = xml.fromstring(content)
    if root.get("byte_order", "LittleEndian") != "LittleEndian":
        raise ValueError("big-endian files are not read")
    header = "Q" if root.get("header_type") == "UInt64" else "I"
    compressed = "zlib" in root.get("compressor", "").lower()
    piece = root.find(".//Piece")

    def array(element):
        kind = np.dtype("<" + TYPES[element.get("type")])
        if element.get("format") == "ascii":
            values = np.array((element.text or "").split(), dtype=float).astype(kind)
        elif element.get("format") == "appended":
            offset = int(element.get("offset"))
            if encoding == "raw":
                values = np.frombuffer(_decode_appended(blob, offset, header, compressed), dtype=kind)
            else:
                values = np.frombuffer(_decode_inline(blob[offset:].split(b"=")[0].decode() + "==", header,
                                                      compressed), dtype=kind)
        else:
            values = np.frombuffer(_decode_inline(element.text or "", header, compressed), dtype=kind)
        width = int(element.get("NumberOfComponents", "1"))
        return values.reshape(-1, width) if width > 1 else values

    points = array(piece.find("Points/DataArray")).astype(float).reshape(-1, 3)
    cells = {item.get("Name"): array(item) for item in piece.findall("Cells/DataArray")}
    point_data = {item.get("Name"): array(item).astype(float) for item in piece.findall("PointData/DataArray")}
    cell_data = {item.get("Name"): array(item).astype(float) for item in piece.findall("CellData/DataArray")}
    return _surface(points, cells, point_data, cell_data)


def _surface(points, cells, point_data, cell_data):
    connectivity = cells["connectivity"].astype(np.int64)
    offsets = cells["offsets"].astype(np.int64)
    types = cells["types"].astype(int)
    # deal.II writes each cell's points anew: points at one place become one.
    span = float(np.ptp(points, axis=0).max()) or 1.0
    keys = np.round((points - points.min(axis=0)) / (span * 1e-7)).astype(np.int64)
    _, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    place = place.reshape(-1)
    count = len(first)
    share = np.bincount(place, minlength=count).astype(float)

    def average(values):
        values = values.reshape(len(points), -1)
        mean = np.stack([np.bincount(place, values[:, k], count) / share for k in range(values.shape[1])], axis=1)
        return mean[:, 0] if mean.shape[1] == 1 else mean

    data = {name: average(values) for name, values in point_data.items()}
    starts = np.concatenate([[0], offsets[:-1]])
    sums = {name: np.zeros(count) for name, values in cell_data.items() if values.ndim == 1}
    visits = np.zeros(count)
    faces = []
    for cell, (kind, start, end) in enumerate(zip(types, starts, offsets)):
        nodes = place[connectivity[start:end]]
        if kind in (12, 72, 25, 29):
            nodes = nodes[:8]
            faces.extend(tuple(nodes[list(face)]) for face in HEXAHEDRON_FACES)
        elif kind == 11:
            nodes = nodes[list(VOXEL_ORDER)]
            faces.extend(tuple(nodes[list(face)]) for face in HEXAHEDRON_FACES)
        elif kind in (10, 24, 71):
            nodes = nodes[:4]
            faces.extend(tuple(nodes[list(face)]) for face in TETRAHEDRON_FACES)
        elif kind in (5, 9):
            faces.append(tuple(nodes))
        visits[nodes] += 1
        for name in sums:
            sums[name][nodes] += cell_data[name][cell]
    for name in sums:
        data.setdefault(name, sums[name] / np.maximum(visits, 1))
    seen = {}
    for face in faces:
        key = tuple(sorted(face))
        seen[key] = None if key in seen else face
    outer = [face for face in seen.values() if face is not None]
    triangles, edges = [], set()
    for face in outer:
        triangles.append(face[:3])
        if len(face) == 4:
            triangles.append((face[0], face[2], face[3]))
        for a, b in zip(face, face[1:] + face[:1]):
            edges.add((min(a, b), max(a, b)))
    if not triangles:
        raise ValueError("it holds no cell whose faces can be drawn")
    return Grid(points[first], np.array(triangles, dtype=np.int64), data,
                np.array(sorted(edges), dtype=np.int64).reshape(-1, 2))
