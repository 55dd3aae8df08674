# Shared by tasks/demo and tests/run (sourced): installs what is missing, configures and builds.
# shellcheck shell=bash

# ensure_packages USE...   installs the packages that .ci/packages lists for these uses and this machine lacks; does nothing otherwise.
ensure_packages() {
  local missing=() name use
  while read -r name use; do
    [[ -z $name || $name == \#* || " $* " != *" $use "* ]] && continue
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done < .ci/packages
  ((${#missing[@]})) || return 0
  echo "pincer needs these Debian packages, which are not installed: ${missing[*]}"
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo > /dev/null; then
      echo "You are not root and there is no sudo. Run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 1
    fi
    as_root=(sudo)
  fi
  if ! { "${as_root[@]}" apt-get update -qq && DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"; } > build-packages.log 2>&1; then
    tail -n 5 build-packages.log >&2
    echo "The packages could not be installed (whole log: build-packages.log). They need root and the network, once." >&2
    exit 1
  fi
}

# build DIRECTORY [CMAKE_OPTION...]   configures, and builds the targets that $targets names, all if there is none.
build() {
  local directory=$1
  shift
  cmake -S . -B "$directory" -G Ninja "$@" > "$directory-configure.log" 2>&1 || { cat "$directory-configure.log" >&2; exit 1; }
  mv "$directory-configure.log" "$directory/configure.log"
  cmake --build "$directory" ${targets:+--target $targets}
}
