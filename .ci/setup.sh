# Shared by tasks/demo and tests/run (sourced): installs what is missing, configures and builds.
# shellcheck shell=bash

# waiting_for_apt ARGUMENT...   runs apt-get. While another program holds one of the package system's locks, says which, and waits.
# apt's own DPkg::Lock::Timeout knows nothing of the locks on the lists and on the archive, and waits without a word.
# PINCER_APT_WAIT [s]: how long at most (default: half an hour; a fresh machine's unattended upgrades take minutes).
waiting_for_apt() {
  local limit=${PINCER_APT_WAIT:-1800} begin=$SECONDS told='' holder
  until "${as_root[@]}" env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get -qq "$@" > "$packages_log" 2>&1; do
    holder=$(grep -m 1 -E 'Could not get lock|Unable to (acquire|lock)|is another process using it' "$packages_log") || return 1
    if ((SECONDS - begin >= limit)); then
      echo "Another program has held the package system for ${limit} s; this gave up waiting. Wait for it to end, then give the same command again." >&2
      return 1
    fi
    if [[ $holder != "$told" ]]; then
      echo "Waiting for another program to leave the package system, which a fresh machine does after some minutes of upgrading itself: ${holder#E: }"
      told=$holder
    fi
    sleep "${PINCER_APT_LOOK:-5}"
  done
  [[ -z $told ]] || echo "The package system is free; going on."
}

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
  local packages_log=build/packages.log
  mkdir -p build
  waiting_for_apt update && waiting_for_apt install -y --no-install-recommends "${missing[@]}" && return 0
  tail -n 5 "$packages_log" >&2
  if grep -q 'dpkg was interrupted' "$packages_log"; then
    echo "An earlier installation was cut off in its middle. Let it finish, then give the same command again: ${as_root[*]} dpkg --configure -a" >&2
  else
    echo "The packages could not be installed (whole log: $packages_log). They need root and the network, once." >&2
  fi
  exit 1
}

# build DIRECTORY [CMAKE_OPTION...]   configures, and builds the targets that $targets names, all if there is none.
build() {
  local directory=$1
  shift
  mkdir -p "$directory"
  cmake -S . -B "$directory" -G Ninja "$@" > "$directory/configure.log" 2>&1 || { cat "$directory/configure.log" >&2; exit 1; }
  cmake --build "$directory" ${targets:+--target $targets}
}
