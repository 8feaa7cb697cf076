#!/usr/bin/env bash
# tests/hard/run.sh [DIR] [--slow] [--tests]: every hard case over shapes, laws, steps and exchange schedules,
# the stability map, and DIR/stability.html. Without DIR: results/stability. --tests: also builds and runs the
# tests that elsewhere.txt names; the page then says whether they passed.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/cmake/setup.sh"

folder=results/stability
options=()
tests=false
for word in "$@"; do
  case $word in
    --slow) options+=("$word") ;;
    --tests) tests=true ;;
    *) folder=$word ;;
  esac
done

install_packages
configure
build_targets hard_cases
status=0
OMP_WAIT_POLICY=passive "$build/tests/hard_cases" "$folder" "${options[@]}" || status=$?
if $tests; then
  build_targets
  names=$(sed -e '/^#/d' -e 's/.*|//' "$root/tests/hard/elsewhere.txt" | tr -s ' ' '\n' | sed -e '/^$/d' -e 's/\./[.]/')
  ctest --test-dir "$build" -R "/($(paste -sd'|' <<<"$names"))\$" --output-junit "$(realpath "$folder")/elsewhere.xml" ||
    status=1
fi
/usr/bin/python3 "$root/apps/plots/hard_cases.py" "$folder"
exit "$status"
