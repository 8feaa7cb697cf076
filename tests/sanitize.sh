#!/usr/bin/env bash
# tests/sanitize.sh [address|thread]... [-- TEST[:FILTER]...]
# Builds the grain engine and its tests with sanitizers and runs them; both kinds if none is named.
#   address   address and undefined behaviour, g++,     build-address/
#   thread    data races, clang++ with its own OpenMP,  build-thread/
# Tests of its own choice, if none is named: under `address` all of grains, contact, motion, surfaces
# and packing that take seconds; under `thread` those that run on several threads, the others cannot
# race. FILTER is GoogleTest's. A finding stops the test that made it; exit 1 if there was one.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/setup.sh"

kinds=() tests=()
while [ $# -gt 0 ]; do
  case $1 in
    address | thread) kinds+=("$1") ;;
    --) shift && tests=("$@") && break ;;
    *) echo "tests/sanitize.sh: '$1' is neither address nor thread (tests follow --)" >&2 && exit 2 ;;
  esac
  shift
done
[ ${#kinds[@]} -gt 0 ] || kinds=(address thread)
named=("${tests[@]}")
# Left out: what solves with CGAL's exact numbers, whose memory is not ours, and the longest.
of_address=(contact_overlap contact_feature contact_separation contact_law pairs_friction
  pairs_resistance pairs_candidates pairs_shares clump_contact ball_features flat_contact dilated_contact
  union_contact motion_rotation motion_together sphere_impact
  motion_damping motion_pile surface_facet surface_patch surface_energy surface_round surface_flat packing_file packing_duplicate
  grain_files grain_polyhedron)
of_thread=(bed_threads pairs_shares surface_threads 'clump_contact:*threads*')

export OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=0
# The OpenMP runtime itself is not instrumented; libarcher tells the sanitizer of its barriers.
export TSAN_OPTIONS=ignore_noninstrumented_modules=1
failed=0
for kind in "${kinds[@]}"; do
  if [ "$kind" = address ]; then
    compiler=g++ flags='-fsanitize=address,undefined -fno-sanitize-recover=all'
  else
    compiler=clang++ flags='-fsanitize=thread'
    if ! echo 'int main() {}' | clang++ -x c++ -fopenmp $flags -o /dev/null - 2>/dev/null; then
      echo "thread: skipped, clang++ with OpenMP is not installed (apt-get install clang libomp-dev)"
      continue
    fi
  fi
  build="$root/build-$kind"
  [ -f "$build/build.ninja" ] ||
    cmake -S "$root" -B "$build" -G Ninja -DTRACKBED_FEM=OFF -DCMAKE_BUILD_TYPE=None \
      -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags -O1 -g1 -fno-omit-frame-pointer" >/dev/null
  tests=("${named[@]}")
  if [ ${#tests[@]} -eq 0 ]; then
    [ "$kind" = address ] && tests=("${of_address[@]}") || tests=("${of_thread[@]}")
  fi
  targets=("${tests[@]%%:*}")
  build_targets "${targets[@]/%/_test}"
  for entry in "${tests[@]}"; do
    test=${entry%%:*} filter='*'
    [ "$test" = "$entry" ] || filter=${entry#*:}
    begun=$SECONDS
    if "$build/tests/${test}_test" --gtest_brief=1 --gtest_filter="$filter" \
      >"$build/$test.log" 2>&1; then
      echo "$kind: $test clean, $((SECONDS - begun)) s"
    else
      echo "$kind: $test FAILED, see $build/$test.log" && failed=1
    fi
  done
done
exit $failed
