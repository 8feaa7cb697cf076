#!/usr/bin/env bash
# apps/run.sh [SCENE.prm] [options of `trackbed run`]
# Installs what is missing, builds what is out of date, runs the scene (the ballast box if none is
# named), makes the report, and ends by naming the page and the pictures to open.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/setup.sh"

scene="$root/apps/scenes/ballast_box.prm"
if [ $# -gt 0 ] && [ "${1#-}" = "$1" ]; then
  scene=$1
  shift
fi

# Where the results go, and whether the caller has said what to do with earlier ones.
output=
chosen=false
words=("$@")
for ((i = 0; i < ${#words[@]}; ++i)); do
  case ${words[i]} in
    --output) output=${words[i + 1]:-} chosen=true ;;
    --output=*) output=${words[i]#--output=} chosen=true ;;
    --resume | --overwrite) chosen=true ;;
    --help | -h) help=true ;;
  esac
done

install_packages
configure
build_targets trackbed

if [ "${help:-false}" = true ]; then exec "$build/trackbed" run --help; fi

if [ -z "$output" ]; then
  name=$(basename "$scene")
  output=results/${name%.*}
  if [ "$chosen" = false ]; then
    # An earlier run is never touched: this one goes beside it.
    free=$output
    for ((n = 2; ; ++n)); do
      [ -e "$free/history.csv" ] || [ -e "$free/checkpoint.h5" ] || [ -e "$free/scene.resolved.prm" ] || break
      free=$output-$n
    done
    [ "$free" = "$output" ] ||
      say "$output holds a run (--resume goes on with it, --overwrite replaces it); writing to $free"
    output=$free
  fi
  set -- "$@" --output "$output"
fi

"$build/trackbed" run "$scene" "$@"
"$build/trackbed" report "$output"

output=$(cd "$output" && pwd)
printf '\nOpen the report:\n  %s\nPictures:\n' "$output/report.html"
find "$output" -maxdepth 1 -name '*.png' | sort | sed 's/^/  /'
