#!/usr/bin/env bash
# Builds the Debian packages from the build directory $1, and installs, uses, checks and removes them in a Debian of their own, which debootstrap
# makes from this machine's mirror. Needs root and the network.
set -euo pipefail
build=$(realpath "$1")
packages=$build/packages
root=$build/clean-root
((EUID == 0)) || { echo "this makes a Debian in $root, which only root may: run it as root" >&2; exit 1; }
rm -rf "$packages"
(cd "$build" && cpack -G DEB > cpack.log) || { tail "$build/cpack.log" >&2; exit 1; }
ls -sh "$packages"/*.deb

# Manual pages without a warning, shells that take the completions; as installed into a directory.
prefix=$build/prefix
rm -rf "$prefix"
cmake --install "$build" --prefix "$prefix" --component program > /dev/null
pages=0
for page in "$prefix"/share/man/man1/*.1; do
  said=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 > /dev/null)
  [[ -z $said ]] || { echo "$page: $said" >&2; exit 1; }
  pages=$((pages + 1))
done
echo "$pages manual pages without a warning"
((pages > 20))
# shellcheck disable=SC1090,SC2034
offered=$(source "$prefix/share/bash-completion/completions/pincer"
  COMP_WORDS=(pincer sim s4_pin) COMP_CWORD=2
  _pincer
  echo "${COMPREPLY[*]}")
[[ $offered == "s4_pinch s4_pinch_098 s4_pinch_102" ]] || { echo "bash completes pincer sim s4_pin as: $offered" >&2; exit 1; }
cmake --build "$build" --target uninstall > /dev/null
left=$(find "$prefix" -type f)
[[ -z $left ]] || { echo "uninstall left: $left" >&2; exit 1; }
echo "uninstall leaves no file"

mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | grep -m 1 '/debian$')
rm -rf "$root"
debootstrap --variant=minbase bookworm "$root" "$mirror" > "$build/debootstrap.log" || { tail "$build/debootstrap.log" >&2; exit 1; }
within() { chroot "$root" env LC_ALL=C DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"; }
before=$(cd "$root" && find usr etc lib -type f 2> /dev/null | grep -i pincer || true)
[[ -z $before ]]
cp "$packages"/*.deb "$root/tmp/"
within apt-get -qq update
within bash -c 'apt-get -qq install -y --no-install-recommends /tmp/pincer_*.deb' > "$build/apt.log" || { tail "$build/apt.log" >&2; exit 1; }
within pincer --version
within pincer sim s4_pinch --duration 1
within pincer sim /usr/share/pincer/scenes/files/star_knob.json --duration 0.1 > /dev/null
within pincer share pickup --duration 1 --out /tmp/page.html
within pincer run sphere-pickup --repetitions 1 --friction 0.9 --condition cld+force --seed 7 --out /tmp/first --no-report > /dev/null
within pincer replay /tmp/first/session.db
within test -f /usr/share/man/man1/pincer-sim.1 -a -f /lib/udev/rules.d/70-pincer.rules -o -f /usr/lib/udev/rules.d/70-pincer.rules
python=("$packages"/python3-pincer_*.deb)
if [[ -e ${python[0]} ]]; then
  within bash -c 'apt-get -qq install -y --no-install-recommends /tmp/python3-pincer_*.deb' >> "$build/apt.log"
  within python3 -c 'import pincer
model = pincer.load("s4_pinch")
state = pincer.State(model)
pincer.step(model, state, nstep=1000)
print("python", pincer.__file__, state.body("sphere").position)'
fi
# The library, as a program of somebody else's meets it.
within bash -c 'apt-get -qq install -y --no-install-recommends g++ cmake ninja-build /tmp/libpincer-dev_*.deb' >> "$build/apt.log"
cp -r "$(dirname "$0")/../../docs/examples" "$root/tmp/"
within bash -c 'cmake -S /tmp/examples -B /tmp/examples/build -G Ninja > /dev/null && cmake --build /tmp/examples/build > /dev/null && /tmp/examples/build/pinch_and_lift'
within bash -c 'apt-get -qq remove -y pincer libpincer-dev $(dpkg-query -W -f "\${Package} " python3-pincer 2> /dev/null)' >> "$build/apt.log"
left=$(cd "$root" && find usr etc lib -type f 2> /dev/null | grep -i pincer || true)
[[ -z $left ]] || { echo "removed, and left: $left" >&2; exit 1; }
echo "installed, used and removed; nothing is left"
rm -rf "$root"
