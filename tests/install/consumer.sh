#!/usr/bin/env bash
# Installs the library from the build directory $1 and builds the example of docs/ against it, out of tree: with CMake, and with pkg-config.
set -euo pipefail
build=$1
cd "$(dirname "$0")/../.."
work=$build/consumer
rm -rf "$work"
cmake --install "$build" --prefix "$work/prefix" --component library > /dev/null
cmake -S docs/examples -B "$work/cmake" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=None > /dev/null
cmake --build "$work/cmake" > "$work/log" || { cat "$work/log"; exit 1; }
"$work/cmake/pinch_and_lift"
"$work/cmake/run_scene_file" tasks/scenes/s4_pinch.json "$work/s4_pinch.csv" | tee "$work/scene_log"
grep -q "sphere.p_z" "$work/s4_pinch.csv"
# The same object, linked as pkg-config says; and a page that compiles as it says.
export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
# shellcheck disable=SC2046
{
  echo '#include "pincer/contact/math.h"' | ${CXX:-c++} -std=c++20 -fsyntax-only $(pkg-config --cflags pincer) -x c++ -
  ${CXX:-c++} "$work"/cmake/CMakeFiles/pinch_and_lift.dir/pinch_and_lift.cpp.o $(pkg-config --libs pincer) -o "$work/by_pkg_config"
}
"$work/by_pkg_config" > /dev/null
cd "$work/prefix/include/pincer"
# The headers stand in any order.
for order in sort 'sort -r'; do
  # shellcheck disable=SC2046
  find . -name '*.h' | $order | sed 's|^\./\(.*\)|#include "pincer/\1"|' | ${CXX:-c++} -std=c++20 -fsyntax-only $(pkg-config --cflags pincer) -x c++ -
done
# What is installed includes nothing that isn't.
cd ..
grep -rhoE '#include "[^"]+"' pincer | sort -u | cut -d'"' -f2 | while read -r header; do
  [[ -f $header ]] || { echo "an installed header includes $header, which isn't installed"; exit 1; }
done
