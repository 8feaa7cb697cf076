#!/usr/bin/env bash
# tests/run.sh [--slow] [options of ctest, such as -R dem or -L unit]
# Installs what is missing, builds everything and runs the tests; --slow also those labelled slow.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/setup.sh"

labels=(-LE slow)
arguments=()
for word in "$@"; do
  if [ "$word" = --slow ]; then labels=(); else arguments+=("$word"); fi
done

install_packages
configure
build_targets

exec ctest --test-dir "$build" --parallel 2 --output-on-failure "${labels[@]}" "${arguments[@]}"
