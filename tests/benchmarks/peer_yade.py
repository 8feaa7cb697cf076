# Run by yade (peers.py does): yade -n -x peer_yade.py BED STEPS. The bed's grains in YADE, at rest
# under its own laws, then STEPS steps timed. Prints RESULT seconds_per_step touching_pairs.
import math
import pathlib
import sys
import time

from peers import FRICTION, POISSON, YOUNG, read_bed
from yade import O, polyhedra_utils, utils

bed, steps = pathlib.Path(sys.argv[1]), int(sys.argv[2])
box, grains = read_bed(bed)
solid = grains[0][0][0] == 0
if solid:
    material = polyhedra_utils.PolyhedraMat(young=YOUNG, poisson=POISSON, frictionAngle=math.atan(FRICTION), density=2600)
else:
    material = FrictMat(young=YOUNG, poisson=POISSON, frictionAngle=math.atan(FRICTION), density=2600)
O.materials.append(material)
for axis, at, sense in ((0, 0, 1), (0, box[0], -1), (1, 0, 1), (1, box[1], -1), (2, 0, 1)):
    O.bodies.append(utils.wall(at, axis=axis, sense=sense, material=material))
for parts in grains:
    if solid:
        corners = parts[0][1]
        # yade moves a polyhedron's corners to its centroid and keeps where that was.
        body = polyhedra_utils.polyhedra(material, v=corners, fixed=False)
        O.bodies.append(body)
    else:
        spheres = [utils.sphere(c[0], r, material=material) for r, c in parts]
        if len(spheres) == 1:
            O.bodies.append(spheres[0])
        else:
            O.bodies.appendClumped(spheres)
if solid:
    loop = InteractionLoop([Ig2_Polyhedra_Polyhedra_PolyhedraGeom(), Ig2_Wall_Polyhedra_PolyhedraGeom()],
                           [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
                           [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()])
    bounds = [Bo1_Polyhedra_Aabb(), Bo1_Wall_Aabb()]
else:
    loop = InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                           [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])
    bounds = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]
O.engines = [ForceResetter(), InsertionSortCollider(bounds, verletDist=0.1 * 0.0225), loop,
             NewtonIntegrator(damping=0.7, gravity=(0, 0, -9.81))]
O.dt = 2e-5 if solid else 0.3 * utils.PWaveTimeStep()


def touching():
    if not solid:
        return sum(1 for i in O.interactions if i.isReal)
    return sum(1 for i in O.interactions if i.isReal and i.geom.penetrationVolume > 0)


O.run(50 if solid else 5000, True)  # its own springs take the weight
before, pairs_before = time.process_time(), touching()
wall = time.perf_counter()
O.run(steps, True)
used = time.perf_counter() - wall if O.numThreads > 1 else time.process_time() - before
print("RESULT", used / steps, (pairs_before + touching()) / 2, flush=True)
