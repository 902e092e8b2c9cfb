#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# An installation in a new folder: its files, its program, and the example of
# the library, built against it.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"
build=$(dirname "$acf")

# Runs a command quietly and shows the end of its output if it fails.
expect_success() {
  check "$*" "$@" >log 2>&1
  if grep -q '^FAILED' log; then tail -n 20 log; fi
}

# --- files ---

expect_success cmake --install "$build" --prefix "$work/first"
# it can be moved
mv first prefix
prefix=$work/prefix
library=$(echo "$prefix"/lib*/libacf.a "$prefix"/lib/*/libacf.a | tr ' ' '\n' | grep -v '\*')
check "no library" [ -f "$library" ]
for file in bin/acf-dealii{,-render,-report,-sweep,-view} share/acf-dealii/acf_tools/scene.py include/acf/{model,simulation,version}.h include/acf/time/time_loop.h \
  share/acf-dealii/prm/{pendulum/{pendulum.prm,README.md,plot.py},door/door.geo} share/man/man1/acf-dealii.1.gz \
  share/bash-completion/completions/acf-dealii \
  share/doc/acf-dealii/{README.md,LICENSE,CHANGELOG.md,CITATION.cff,doc/model-file.md,doc/library/main.cc}; do
  check "not installed: $file" [ -s "$prefix/$file" ]
done
check 'a script is not executable' [ -x "$prefix/share/acf-dealii/prm/pendulum/plot.py" ]
check "headers: $(diff <(cd "$top/include" && find acf -name '*.h') <(cd "$prefix/include" && find acf -name '*.h' ! -name version.h))" \
  cmp -s <(cd "$top/include" && find acf -name '*.h' | sort) \
  <(cd "$prefix/include" && find acf -name '*.h' ! -name version.h | sort)
check 'files of runs or tools are installed' \
  [ -z "$(find "$prefix" -name '*-results' -o -name __pycache__ -o -name '*.in')" ]
check "the sources or the build folder are named in $(grep -lrF -e "$top" -e "$build" "$prefix/lib"*/cmake)" \
  [ -z "$(grep -lrF -e "$top" -e "$build" "$prefix/lib"*/cmake)" ]
gzip -dc "$prefix/share/man/man1/acf-dealii.1.gz" >man_page
version=$(sed -n 's/^project(acf-dealii VERSION \([0-9.]*\).*/\1/p' "$top/CMakeLists.txt")
expect_text man_page 'the man page' "acf\\-dealii $version"

# Links of the documentation to files; those to tests are of the sources only.
while IFS=: read -r file link; do
  target=${link#](}
  target=${target%%[)#]*}
  check "$file: no file for the link $target" [ -e "$(dirname "$file")/$target" ]
done < <(grep -oE '\]\([^)#]+' -r --include='*.md' "$prefix/share" | grep -vE '\]\((https?:|.*tests/)')

# --- program ---

acf=$prefix/bin/acf-dealii
model=$prefix/share/acf-dealii/prm/pendulum/pendulum.prm
expect_status 0 --version
expect_text stdout version "acf-dealii $version"
expect_status 0 --quiet --output-directory results --set 'Time integration/End time=1' \
  --set 'Time integration/Step size=2e-3' --set 'Output/VTU interval=0' "$model"

# --- scripts for results ---

for name in render report sweep view; do
  script=$prefix/bin/acf-dealii-$name
  "$script" --help >stdout 2>stderr
  status=$?
  check "exit status $status of acf-dealii-$name --help" [ $status -eq 0 ]
  "$script" nowhere >stdout 2>stderr
  status=$?
  check "exit status $status of acf-dealii-$name nowhere" [ $status -eq 2 ]
  expect_text stderr "acf-dealii-$name nowhere" "acf-dealii-$name: "
done
"$prefix/bin/acf-dealii-report" results -o page.html >stdout 2>stderr
check 'the installed report fails' grep -q 'chord.deflection' page.html
"$prefix/bin/acf-dealii-sweep" "$model" --set 'Time integration/End time=0.01' \
  --set 'Output/VTU interval=0' --vary 'Time integration/Step size=1e-3,2e-3' -o sweep >stdout 2>stderr
check 'the installed sweep fails' [ "$(wc -l <sweep/sweep.csv)" -eq 3 ]

# --- library ---

example=$prefix/share/doc/acf-dealii/doc/library
check "main.cc has $(wc -l <"$example/main.cc") lines instead of at most 40" [ "$(wc -l <"$example/main.cc")" -le 40 ]
expect_success cmake -S "$example" -B example -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH="$prefix"
expect_text example/CMakeCache.txt 'the package' "acf_DIR:PATH=$prefix/lib"
expect_success cmake --build example
check "warnings: $(grep -m 1 warning: log)" [ -z "$(grep warning: log)" ]
example/greatest-energy results/used_parameters.prm >stdout 2>stderr
status=$?
check "exit status $status of the example" [ $status -eq 0 ]
# the same as that of the program's probe, to the digits that are printed
expected=$(awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "energy.kinetic [J]") column = i; next }
  $column > greatest { greatest = $column; time = $1 }
  END { printf "%.6g J at %.6g s", greatest, time }' results/probes.csv)
check "the example prints '$(cat stdout)' instead of '$expected'" [ "$(cat stdout)" = "$expected" ]

# A program cannot have both libraries of deal.II.
mkdir mixture
cat >mixture/CMakeLists.txt <<'END_OF_FILE'
cmake_minimum_required(VERSION 3.21)
project(mixture LANGUAGES CXX)
find_package(acf REQUIRED)
add_executable(mixture main.cc)
deal_ii_setup_target(mixture ${FLAVOUR})
target_link_libraries(mixture acf::acf)
END_OF_FILE
touch mixture/main.cc
expect_success cmake -S mixture -B same -D FLAVOUR=RELEASE -D CMAKE_PREFIX_PATH="$prefix"
cmake -S mixture -B other -D FLAVOUR=DEBUG -D CMAKE_PREFIX_PATH="$prefix" >log 2>&1
status=$?
check 'both libraries of deal.II in one program' [ $status -ne 0 ]
expect_text log 'both libraries of deal.II in one program' DEAL_II_BUILD_TYPE

finish
