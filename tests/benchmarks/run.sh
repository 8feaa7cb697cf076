#!/usr/bin/env bash
# tests/benchmarks/run.sh [SCENE.prm]
# Builds what is out of date and prints every benchmark: the contact kernel, making grains, grain motion, surfaces,
# a structure's step, and the settled bed of a scene (the ballast box if none is named).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/cmake/setup.sh"
install_packages
configure
build_targets
printf '\n# Contact kernel\n' && "$build/tests/contact_benchmark"
printf '\n# Making and sizing grains\n' && "$build/tests/grains_benchmark"
printf '\n# Grains in motion\n' && "$build/tests/motion_benchmark" 1000 300 "$build/tests"
printf '\n# Grains of other shapes\n' && "$build/tests/shapes_benchmark"
printf '\n# Other codes on the same boxes (YADE and LIGGGHTS where their Debian packages are installed)\n'
/usr/bin/python3 "$root/tests/benchmarks/peers.py" "$build/tests/shapes_benchmark"
printf '\n# Growth from 1000 to 100 000 grains\n' && "$build/tests/bed_benchmark" growth "$build/tests"
printf '\n# Cost of each effect\n' && "$build/tests/bed_benchmark" effects "$build/tests"
printf '\n# A structure'\''s step\n' && "$build/tests/fem_step_benchmark"
printf '\n# Grains on a deforming surface\n' && "$build/tests/surface_benchmark"
printf '\n# A structure shared by ranks\n'
for n in 1 2 4; do
  OMP_NUM_THREADS=1 mpirun --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -n $n "$build/tests/distributed_benchmark" 20
done
printf '\n# The settled bed\n'
/usr/bin/python3 "$root/tests/benchmarks/bed.py" "$build/trackbed" "${1:-$root/apps/scenes/ballast_box.prm}"
