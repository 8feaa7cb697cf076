#!/usr/bin/env bash
# tests/benchmarks/run.sh [--short] [SCENE.prm]
# Builds what is out of date and prints every benchmark: the contact kernel, making grains, grain motion, surfaces,
# a structure's step, and the settled bed of a scene (the ballast box if none is named). --short: small beds and few
# steps, minutes; no settled bed of a scene unless one is named.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/cmake/setup.sh"
install_packages
configure
build_targets
grains=1000 bed=1000 steps=300 shape_steps=1000 tiles=10 rounds=12 contact=() ranks=20
if [ "${1:-}" = --short ]; then
  shift
  grains=216 bed=600 steps=100 shape_steps=200 tiles=3 rounds=2 contact=(--benchmark_min_time=0.05) ranks=2
  scene="${1:-}"
else
  scene="${1:-$root/apps/scenes/ballast_box.prm}"
fi
printf '\n# Contact kernel\n' && "$build/tests/contact_benchmark" "${contact[@]}"
printf '\n# Making and sizing grains\n' && "$build/tests/grains_benchmark"
printf '\n# Grains in motion\n' && "$build/tests/motion_benchmark" $bed $steps "$build/tests"
printf '\n# Grains of other shapes\n' && "$build/tests/shapes_benchmark" $grains $shape_steps
printf '\n# Other codes on the same boxes (YADE and LIGGGHTS where their Debian packages are installed)\n'
/usr/bin/python3 "$root/tests/benchmarks/peers.py" "$build/tests/shapes_benchmark" --grains $grains --steps $shape_steps
printf '\n# Growth, polyhedra\n' && "$build/tests/bed_benchmark" growth "$build/tests" $tiles polyhedra $bed
printf '\n# Growth, spheres\n' && "$build/tests/bed_benchmark" growth "" $tiles spheres $bed
printf '\n# Cost of each effect\n' && "$build/tests/bed_benchmark" effects "$build/tests" $rounds $bed
printf '\n# A structure'\''s step\n' && "$build/tests/fem_step_benchmark"
printf '\n# Grains on a deforming surface\n' && "$build/tests/surface_benchmark"
printf '\n# A structure shared by ranks\n'
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1  # it writes nothing
for n in 1 2 4; do
  OMP_NUM_THREADS=1 mpirun --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -n $n "$build/tests/distributed_benchmark" $ranks
done
if [ -n "$scene" ]; then
  printf '\n# The settled bed\n'
  /usr/bin/python3 "$root/tests/benchmarks/bed.py" "$build/trackbed" "$scene"
fi
