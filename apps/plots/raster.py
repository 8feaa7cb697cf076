"""A small renderer of triangles in numpy: depth buffer, sky-dome light, smooth scalars. It needs no display and no GL.

Parallel projection throughout, so a length in the picture is a length in the bed. Light is the mean visibility of
many directions of the sky (each one depth map seen from there), plus one sun with its shadow: grains sit in the
pores of the bed instead of floating on a page.
"""
import numpy as np

CHUNK = 1_500_000   # fragments handled at a time: bounds the memory


class View:
    """Parallel projection. Axes right, up and away from the eye; pixels per metre; the picture's size."""

    def __init__(self, toward, points, width=None, height=None, margin=0.02, up=(0, 0, 1)):
        toward = np.asarray(toward, float)
        self.away = -toward / np.linalg.norm(toward)
        right = np.cross(self.away, up)
        if np.linalg.norm(right) < 1e-9:
            right = np.array([1.0, 0, 0])
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.away)
        self.axes = np.stack([self.right, -self.up, self.away])
        flat = points @ self.axes.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        extent = np.maximum(high - low, 1e-9)
        if height is None:
            height = max(16, int(round(width * extent[1] / extent[0] * (1 + 2 * margin) / (1 + 2 * margin))))
        self.width, self.height = int(width), int(height)
        self.scale = min(self.width / extent[0], self.height / extent[1]) / (1 + 2 * margin)
        middle = 0.5 * (low + high)
        self.shift = np.array([self.width / 2, self.height / 2]) - self.scale * middle[:2]
        self.depth_low = low[2]

    def project(self, points):
        """Pixels x (right), y (down) and depth in metres away from the eye."""
        flat = points.reshape(-1, 3) @ self.axes.T
        flat[:, :2] *= self.scale
        flat[:, :2] += self.shift
        flat[:, 2] -= self.depth_low
        return flat.reshape(points.shape)

    def place(self, x, y, depth):
        """Inverse of project."""
        flat = np.stack([(x - self.shift[0]) / self.scale, (y - self.shift[1]) / self.scale,
                         depth + self.depth_low], axis=-1)
        return flat @ self.axes


def _hidden(corners_depth, x0, y0, x1, y1, depth):
    """Triangles that lie wholly behind what is drawn already: a two-level depth pyramid is asked."""
    tile = 16
    height, width = depth.shape
    rows, columns = -(-height // tile), -(-width // tile)
    padded = np.full((rows * tile, columns * tile), np.inf, dtype=np.float32)
    padded[:height, :width] = depth
    padded[height:, :width] = -np.inf
    padded[:, width:] = -np.inf
    far = padded.reshape(rows, tile, columns, tile).max(axis=(1, 3))
    tx0, ty0, tx1, ty1 = x0 // tile, y0 // tile, x1 // tile, y1 // tile
    small = (tx1 - tx0 <= 2) & (ty1 - ty0 <= 2)
    worst = np.full(len(x0), -np.inf, dtype=np.float32)
    for j in range(3):
        for i in range(3):
            worst = np.maximum(worst, far[np.minimum(ty0 + j, ty1), np.minimum(tx0 + i, tx1)])
    return small & (corners_depth > worst)


def rasterise(corners, width, height, cull=True):
    """Nearest triangle and its depth in every pixel.

    corners (T,3,3): pixel x, pixel y, depth. Returns id (H,W) int32 with -1 for nothing, depth (H,W) float32.
    With cull, triangles that face away (closed bodies, anticlockwise seen from outside) are skipped.
    """
    ids = np.full(height * width, -1, dtype=np.int32)
    depth = np.full(height * width, np.inf, dtype=np.float32)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    x0 = np.maximum(np.ceil(corners[:, :, 0].min(axis=1) - 0.5), 0)
    x1 = np.minimum(np.floor(corners[:, :, 0].max(axis=1) - 0.5), width - 1)
    y0 = np.maximum(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), 0)
    y1 = np.minimum(np.floor(corners[:, :, 1].max(axis=1) - 0.5), height - 1)
    keep = (x1 >= x0) & (y1 >= y0) & (np.abs(area) > 1e-12) & np.isfinite(corners).all(axis=(1, 2))
    if cull:
        keep &= area < 0   # y runs down: outward faces turn clockwise in pixels
    chosen = np.flatnonzero(keep)
    chosen = chosen[np.argsort(corners[chosen, :, 2].min(axis=1), kind="stable")]
    x0, x1, y0, y1 = (v[chosen].astype(np.int64) for v in (x0, x1, y0, y1))
    nearest = corners[chosen, :, 2].min(axis=1).astype(np.float32)
    pending = np.arange(len(chosen))
    while len(pending):
        sizes = (x1[pending] - x0[pending] + 1) * (y1[pending] - y0[pending] + 1)
        take = max(1, int(np.searchsorted(np.cumsum(sizes), CHUNK)))
        batch, pending = pending[:take], pending[take:]
        _draw(corners, chosen, batch, area, x0, x1, y0, y1, sizes[:take], width, ids, depth)
        if len(pending):
            gone = _hidden(nearest[pending], x0[pending], y0[pending], x1[pending], y1[pending],
                           depth.reshape(height, width))
            pending = pending[~gone]
    return ids.reshape(height, width), depth.reshape(height, width)


def _draw(corners, chosen, batch, area, x0, x1, y0, y1, sizes, width, ids, depth):
    which = np.repeat(np.arange(len(batch)), sizes)
    local = np.arange(len(which)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    wide = (x1[batch] - x0[batch] + 1)[which]
    px = x0[batch][which] + local % wide
    py = y0[batch][which] + local // wide
    triangle = chosen[batch]
    a, b, c = corners[triangle, 0], corners[triangle, 1], corners[triangle, 2]
    inverse = 1.0 / area[triangle]
    # Barycentric coordinates and depth are linear in the pixel: one gradient per triangle.
    gu = np.stack([(c[:, 1] - a[:, 1]) * inverse, -(c[:, 0] - a[:, 0]) * inverse], axis=1)
    gv = np.stack([-(b[:, 1] - a[:, 1]) * inverse, (b[:, 0] - a[:, 0]) * inverse], axis=1)
    dx = px + 0.5 - a[which, 0]
    dy = py + 0.5 - a[which, 1]
    u = gu[which, 0] * dx + gu[which, 1] * dy
    v = gv[which, 0] * dx + gv[which, 1] * dy
    inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
    which, u, v = which[inside], u[inside], v[inside]
    pixel = py[inside] * width + px[inside]
    z = (a[which, 2] + u * (b[which, 2] - a[which, 2]) + v * (c[which, 2] - a[which, 2])).astype(np.float32)
    nearer = z < depth[pixel]
    which, pixel, z = which[nearer], pixel[nearer], z[nearer]
    order = np.argsort(-z, kind="stable")   # the last written, the nearest, stays
    pixel, z, which = pixel[order], z[order], which[order]
    depth[pixel] = z
    ids[pixel] = triangle[which]


class Mesh:
    """Triangles with a colour per triangle or a scalar colour per vertex, and a body number for outlines."""

    def __init__(self, corners, colour, body, normals=None, matte=1.0):
        self.corners = np.asarray(corners, float)            # (T,3,3)
        count = len(self.corners)
        colour = np.asarray(colour, np.float32)
        if colour.ndim == 1:
            colour = np.broadcast_to(colour, (count, 3))
        if colour.ndim == 2:
            colour = np.broadcast_to(colour[:, None, :], (count, 3, 3))
        self.colour = colour                                  # (T,3 vertices,3)
        self.body = np.broadcast_to(np.asarray(body, np.int64), (count,))
        face = np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        face /= np.maximum(np.linalg.norm(face, axis=1, keepdims=True), 1e-30)
        self.face = face
        self.normals = np.broadcast_to(face[:, None, :], (count, 3, 3)) if normals is None else normals


def join(meshes):
    """One Mesh of several; body numbers are made distinct."""
    meshes = [mesh for mesh in meshes if mesh is not None and len(mesh.corners)]
    if not meshes:
        raise ValueError("nothing to draw")
    offset, bodies = 0, []
    for mesh in meshes:
        bodies.append(mesh.body - mesh.body.min() + offset)
        offset = bodies[-1].max() + 1
    joined = Mesh(np.concatenate([mesh.corners for mesh in meshes]),
                  np.concatenate([mesh.colour for mesh in meshes]), np.concatenate(bodies),
                  np.concatenate([mesh.normals for mesh in meshes]))
    return joined


def above(mesh, level):
    """The part of a mesh over the level z, its triangles cut there; the cut is left open."""
    parts = []
    up = mesh.corners[:, :, 2] >= level
    count = up.sum(axis=1)
    parts.append(tuple(v[count == 3] for v in (mesh.corners, mesh.colour, mesh.normals, mesh.body)))
    for inside in (1, 2):
        cut = np.flatnonzero(count == inside)
        if not len(cut):
            continue
        # The corner that is alone on its side comes first; the turning sense stays.
        lone = np.argmax(up[cut] == (inside == 1), axis=1)
        turn = (lone[:, None] + np.arange(3)) % 3
        fields = [np.take_along_axis(v[cut], turn[:, :, None], axis=1) for v in (mesh.corners, mesh.colour, mesh.normals)]
        z = fields[0][:, :, 2]
        share = [(level - z[:, 0]) / (z[:, k] - z[:, 0]) for k in (1, 2)]
        ab, ac = ([v[:, 0] + s[:, None] * (v[:, k] - v[:, 0]) for v in fields] for k, s in zip((1, 2), share))
        a, b, c = ([v[:, k] for v in fields] for k in range(3))
        for corners in ([(a, ab, ac)] if inside == 1 else [(ab, b, c), (ab, c, ac)]):
            parts.append(tuple(np.stack([corner[f] for corner in corners], axis=1) for f in range(3))
                         + (mesh.body[cut],))
    corners, colour, normals, body = (np.concatenate(field) for field in zip(*parts))
    return Mesh(corners, colour, body, normals)


def sky(count):
    """Directions over the upper hemisphere, evenly spread (golden spiral), denser towards the zenith."""
    k = np.arange(count) + 0.5
    z = 0.08 + 0.92 * (k / count) ** 0.7
    angle = k * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def _visibility(corners, points, normals, direction, pixels):
    """1 where a direction of the sky is seen from a point, 0 where something is in between."""
    view = View(direction, corners.reshape(-1, 3), width=pixels, height=pixels, margin=0.01)
    _, depth = rasterise(view.project(corners), view.width, view.height)
    bias = 1.1 / view.scale   # one texel off the surface, or a face seen at a grazing angle would shade itself
    flat = view.project(points + normals * bias)
    x, y = flat[:, 0] - 0.5, flat[:, 1] - 0.5
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = x - left, y - top
    seen = np.zeros(len(points), dtype=np.float32)
    for j in (0, 1):
        for i in (0, 1):
            at = depth[np.clip(top + j, 0, view.height - 1), np.clip(left + i, 0, view.width - 1)]
            share = (fx if i else 1 - fx) * (fy if j else 1 - fy)
            seen += share * (flat[:, 2] <= at + bias)
    return seen


def render(mesh, view, directions=40, sun=(-0.45, -0.75, 0.9), outline=0.45, background=(1, 1, 1), shading=1.0,
           grain_size=0.04):
    """Picture (H,W,3) float in 0…1 of a mesh, at half the view's resolution (2x2 samples a pixel), and its mask."""
    width, height = view.width - view.width % 2, view.height - view.height % 2
    pixels = view.project(mesh.corners)
    ids, depth = rasterise(pixels, view.width, view.height)
    ids, depth = ids[:height, :width], depth[:height, :width]
    covered = ids >= 0
    colour, normal = _attributes(mesh, pixels, ids, covered)
    if shading:
        light = _light(mesh, view, ids, depth, normal, covered, directions, np.asarray(sun, float), grain_size)
        colour = colour * ((1 - shading) + shading * light)[:, None]
    picture = np.empty((height, width, 3), dtype=np.float32)
    picture[:] = background
    picture[covered] = colour
    if outline:
        _outline(picture, np.where(covered, mesh.body[np.maximum(ids, 0)], -1), depth, outline, grain_size)
    mask = covered.astype(np.float32)
    half = picture.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))
    mask = mask.reshape(height // 2, 2, width // 2, 2).mean(axis=(1, 3))
    return np.clip(half, 0, 1), mask


def _attributes(mesh, pixels, ids, covered):
    """Colour and normal of every covered sample, from its triangle's corners."""
    py, px = np.nonzero(covered)
    triangle = ids[covered]
    colours, normals = mesh.colour.astype(np.float32), mesh.normals.astype(np.float32)
    a, b, c = (pixels[:, k, :2] for k in range(3))
    inverse = 1 / np.where(np.abs(area := (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
                                  - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])) > 1e-12, area, 1)
    gu = (np.stack([c[:, 1] - a[:, 1], a[:, 0] - c[:, 0]], axis=1) * inverse[:, None]).astype(np.float32)
    gv = (np.stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0]], axis=1) * inverse[:, None]).astype(np.float32)
    origin = a.astype(np.float32)
    colour = np.empty((len(triangle), 3), np.float32)
    normal = np.empty((len(triangle), 3), np.float32)
    for low in range(0, len(triangle), CHUNK):
        part = slice(low, low + CHUNK)
        t = triangle[part]
        dx, dy = px[part] + np.float32(0.5) - origin[t, 0], py[part] + np.float32(0.5) - origin[t, 1]
        u = (gu[t, 0] * dx + gu[t, 1] * dy)[:, None].astype(np.float32)
        v = (gv[t, 0] * dx + gv[t, 1] * dy)[:, None].astype(np.float32)
        w = 1 - u - v
        colour[part] = w * colours[t, 0] + u * colours[t, 1] + v * colours[t, 2]
        normal[part] = w * normals[t, 0] + u * normals[t, 1] + v * normals[t, 2]
    normal /= np.maximum(np.sqrt(np.einsum("ij,ij->i", normal, normal))[:, None], 1e-12)
    return colour, normal


def _light(mesh, view, ids, depth, normal, covered, directions, sun, grain_size):
    """Sky and sun at one sample of each 2x2 block, spread to its four."""
    height, width = ids.shape
    index = np.full((height, width), -1, dtype=np.int64)
    index[covered] = np.arange(len(normal))
    blocks = index.reshape(height // 2, 2, width // 2, 2).max(axis=(1, 3))
    some = blocks >= 0
    sample = blocks[some]
    py, px = np.nonzero(covered)
    points = view.place(px[sample] + 0.5, py[sample] + 0.5, depth[covered][sample].astype(float))
    normals = normal[sample]
    extent = float(np.ptp(mesh.corners.reshape(-1, 3), axis=0).max())
    size = int(np.clip(extent / grain_size * 28, 160, 900))
    received, all_sky, zenith = np.zeros(len(points)), np.zeros(len(points)), 0.0
    for direction in sky(directions):
        facing = np.clip(normals @ direction, 0, None)
        seen = np.zeros(len(points))
        lit = facing > 0.02
        seen[lit] = _visibility(mesh.corners, points[lit], normals[lit], direction, size)
        received += facing * seen
        all_sky += facing
        zenith += direction[2]
    if directions:
        ambient = received / zenith                             # 1 on a free level face
        openness = received / np.maximum(all_sky, 1e-9)         # 1 in the open, 0 deep in a pore
    else:                                                       # no shadows: form alone
        ambient, openness = 0.5 + 0.5 * normals[:, 2], 1.0
    sun = sun / np.linalg.norm(sun)
    direct = np.clip(normals @ sun, 0, None)
    lit = direct > (0.02 if directions else 2)
    direct[lit] *= _visibility(mesh.corners, points[lit], normals[lit], sun, min(2 * size, 1400))
    towards_eye = np.clip(normals @ -view.away, 0, None)
    value = 0.14 + openness * (0.16 + 0.34 * towards_eye) + 0.34 * ambient + 0.42 * direct
    value = np.where(value > 0.9, 0.9 + 0.18 * np.tanh((value - 0.9) / 0.18), value)   # soft shoulder
    coarse = np.zeros(blocks.shape, dtype=np.float32)
    coarse[some] = value
    # Each sample takes its block's light.
    fine = coarse.repeat(2, axis=0).repeat(2, axis=1)
    return fine[covered]


def _outline(picture, body, depth, strength, grain_size):
    """Darkens the rim where one body ends before another: the eye separates the stones."""
    rim = np.zeros(body.shape, dtype=bool)
    for axis in (0, 1):
        near = [slice(None), slice(None)]
        far = [slice(None), slice(None)]
        near[axis], far[axis] = slice(None, -1), slice(1, None)
        differ = body[tuple(near)] != body[tuple(far)]
        rim[tuple(near)] |= differ & (depth[tuple(near)] >= depth[tuple(far)])
        rim[tuple(far)] |= differ & (depth[tuple(far)] > depth[tuple(near)])
    rim &= body >= 0
    picture[rim] *= 1 - strength


def tubes(starts, ends, radii, colour, sides=8):
    """Closed cylinders with smooth sides, one a pair of points; colour one a tube."""
    starts, ends = np.asarray(starts, float), np.asarray(ends, float)
    axis = ends - starts
    length = np.linalg.norm(axis, axis=1, keepdims=True)
    axis = axis / np.maximum(length, 1e-12)
    helper = np.where(np.abs(axis[:, 2:3]) < 0.9, [[0, 0, 1.0]], [[1.0, 0, 0]])
    side = np.cross(axis, helper)
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-12)
    other = np.cross(axis, side)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.cos(angle)[None, :, None] * side[:, None] + np.sin(angle)[None, :, None] * other[:, None]
    low = starts[:, None] + ring * np.asarray(radii)[:, None, None]
    high = ends[:, None] + ring * np.asarray(radii)[:, None, None]
    nxt = np.roll(np.arange(sides), -1)
    walls = np.concatenate([np.stack([low, low[:, nxt], high[:, nxt]], axis=2),
                            np.stack([low, high[:, nxt], high], axis=2)], axis=1)
    normals = np.concatenate([np.stack([ring, ring[:, nxt], ring[:, nxt]], axis=2),
                              np.stack([ring, ring[:, nxt], ring], axis=2)], axis=1)
    tip_low = np.broadcast_to(starts[:, None], low.shape)
    tip_high = np.broadcast_to(ends[:, None], high.shape)
    caps = np.concatenate([np.stack([tip_low, low[:, nxt], low], axis=2),
                           np.stack([tip_high, high, high[:, nxt]], axis=2)], axis=1)
    cap_normals = np.concatenate([np.broadcast_to(-axis[:, None, None], (len(axis), sides, 3, 3)),
                                  np.broadcast_to(axis[:, None, None], (len(axis), sides, 3, 3))], axis=1)
    corners = np.concatenate([walls, caps], axis=1)
    normals = np.concatenate([normals, cap_normals], axis=1)
    count = 4 * sides
    body = np.repeat(np.arange(len(starts)), count)
    paint = np.repeat(np.asarray(colour, np.float32), count, axis=0)
    return Mesh(corners.reshape(-1, 3, 3), paint, body, normals.reshape(-1, 3, 3))
