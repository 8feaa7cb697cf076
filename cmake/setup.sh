# Sourced by apps/run.sh and tests/run.sh with `root` set to the source folder: installs what is
# missing and configures the one build folder, build/.

build="$root/build"

say() { printf '== %s\n' "$*" >&2; }

# Names of packages.txt that dpkg does not hold as installed.
missing_packages() {
  local package
  while read -r package; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      printf '%s\n' "$package"
  done < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/packages.txt")
}

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system: see packages.txt for what must be installed"
    return
  fi
  local missing as_root=()
  mapfile -t missing < <(missing_packages)
  [ ${#missing[@]} -gt 0 ] || return 0
  say "installing ${missing[*]}"
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      say "these packages are missing; as root: apt-get install ${missing[*]}"
      exit 1
    fi
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
    "${missing[@]}"
}

# Configures once; later changes of CMake files are seen by ninja itself.
configure() {
  if [ ! -f "$build/build.ninja" ]; then
    say "configuring $build"
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release
  fi
}

# Builds the named targets, all without names. A process of this code base may take 2 GB: no more
# of them at a time than fit.
build_targets() {
  local jobs memory
  jobs=$(nproc)
  memory=$(awk '/MemAvailable/ { print int($2 / 2000000) }' /proc/meminfo)
  [ "$memory" -ge "$jobs" ] || jobs=$((memory > 1 ? memory : 1))
  say "building ${*:-everything}"
  ninja -C "$build" -j "$jobs" "$@"
}
