#!/usr/bin/env bash
# tests/hard/run.sh [DIR] [--slow]: every hard case over shapes, laws, steps and exchange schedules, the
# stability map, and DIR/stability.html. Without DIR: results/stability.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/cmake/setup.sh"

folder=results/stability
options=()
for word in "$@"; do
  if [ "$word" = --slow ]; then options+=("$word"); else folder=$word; fi
done

install_packages
configure
build_targets hard_cases
status=0
OMP_WAIT_POLICY=passive "$build/tests/hard_cases" "$folder" "${options[@]}" || status=$?
/usr/bin/python3 "$root/apps/plots/hard_cases.py" "$folder"
exit "$status"
