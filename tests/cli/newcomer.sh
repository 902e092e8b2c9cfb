#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# doc/tutorial.md: its script of gmsh and its model file are run as they stand
# there, and its numbers are compared with the run and with hand calculations.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

tutorial=$top/doc/tutorial.md

# Indented lines of a section, up to a list: block TITLE
block() {
  awk -v title="## $1" '$0 == title { inside = 1; next }
    inside && /^(- |## )/ { exit }
    inside && /^    / { print substr($0, 5) }' "$tutorial"
}

block 'The part' >lever.geo
block 'The model' >lever.prm
check "the model has $(wc -l <lever.prm) lines instead of 20 to 40" \
  [ "$(wc -l <lever.prm)" -le 40 -a "$(wc -l <lever.prm)" -ge 20 ]

# --- a STEP file in mm, the check, the run ---

gmsh -v 0 -0 lever.geo -o lever.step >/dev/null 2>&1
check 'gmsh writes no STEP file' [ -s lever.step ]
expect_status 0 --validate lever.prm
expect_text stdout 'the check of the tutorial' 'lever.prm is valid'
check 'the check writes results' [ ! -e lever-results ]
sed 's/surface 11/bore/' lever.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a surface without name'
expect_text stderr 'a surface without name' "wrong.prm:$(grep -n bore, wrong.prm | cut -d: -f1):" "'bore'" "'surface 11'"
expect_status 0 lever.prm
check 'the run writes to stderr' [ ! -s stderr ]

# --- the numbers ---

# Mass and centre of mass that the program prints, and the last line of the probes.
read -r mass radius < <(sed -n 's/.* mass \([0-9.e-]*\) kg, centre of mass in the mesh (\([0-9.e-]*\),.*/\1 \2/p' stdout)
column() {
  awk -F, -v name="$1" 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == name) c = k }
    END { print $c }' lever-results/probes.csv
}
time=$(column 'time [s]')
force=$(column 'bearing.force x [N]')
stress=$(column 'middle.xx [Pa]')
check "the end is at '$time'" [ "$time" = 0.11 ]

# near VALUE EXPECTED RELATIVE_TOLERANCE
near() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a != "" && b != 0 && (a / b - 1)^2 < t^2) }'
}

# The part has 0.76826 kg at 0.10134 m; the mesh loses 0.5 % and 0.7 % of them.
check "mass $mass" near "$mass" 0.768256 0.01
check "centre of mass $radius" near "$radius" 0.101336 0.01
# m omega^2 r of the mesh: the step of 0.0628 rad leaves 0.03 %
by_hand=$(awk -v m="$mass" -v r="$radius" 'BEGIN { w = 100 * atan2(0, -1); print -m * w^2 * r }')
check "reaction $force instead of $by_hand" near "$force" "$by_hand" 0.001
# the centrifugal force of the outer half of the part on its section; the mesh of
# the boss is lighter by 2 %
check "stress $stress" near "$stress" 21.9516e6 0.025

# What the page says, if this gmsh makes the mesh of the page.
if near "$mass" 0.764697 1e-5; then
  check "the page has another reaction than $force" \
    near "$(sed -n 's/^| `bearing.force x \[N\]` | \(.*\) |$/\1/p' "$tutorial")" "$force" 1e-4
  check "the page has another stress than $stress" \
    near "$(sed -n 's/^| `middle.xx \[Pa\]` | \(.*\) |$/\1/p' "$tutorial")" "$stress" 1e-3
fi

# --- the files for the picture ---

check 'no list of files for ParaView' [ -s lever-results/solution.pvd ]
last=$(find lever-results -name 'solution-*.vtu' | sort | tail -n 1)
expect_text "$last" 'the last file for ParaView' displacement von_mises_stress velocity

finish
