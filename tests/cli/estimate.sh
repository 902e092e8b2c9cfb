#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# What --estimate says of a run, against the statistics of the run.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

# Two bodies of one kind, one of them damped, and one of another kind.
cat >good.prm <<'END'
subsection Bodies
  set Names = first, second, third
  subsection first
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.1, 0.1
    set Cells           = 8, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
  end
  subsection second
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.1, 0.1
    set Cells           = 8, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
    set Position        = 1, 0, 0
  end
  subsection third
    set Mesh            = box
    set Box from        = 2, 0, 0
    set Box to          = 3, 0.1, 0.1
    set Cells           = 6, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
  end
end
subsection Joints
  set Names = wall, middle, end
  subsection wall
    set Type    = fixed
    set Between = first: x min, ground
  end
  subsection middle
    set Type    = revolute
    set Between = first: x max, second: x min
    set Axis    = 0, 1, 0
  end
  subsection end
    set Type    = spherical
    set Between = second: x max, third: x min
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 0.0105
  set Step size = 1e-3
end
END

# number NAME [SEPARATOR]: the first number of a line of the estimate
number() { sed -n "s/^  $1  *\([0-9]*\).*/\1/p" stdout | head -n 1; }
# in_bytes NAME: bytes in the parentheses of such a line
in_bytes() { sed -n "s/^  $1 .*(\([0-9]*\) B).*/\1/p" stdout; }
# of_run ENTRY [ENTRY]: from statistics.json
of_run() {
  python3 -c 'import json, sys
value = json.load(open("run/statistics.json"))
for name in sys.argv[1:]: value = value[name]
print(value)' "$@"
}
# compare WHAT ESTIMATE RUN
compare() {
  check "$options: $1: estimated '$2', a run has '$3'" [ -n "$2" -a "$2" = "$3" ]
}

# expect_agreement OPTION ...: sizes of the estimate and of the run
expect_agreement() {
  options="$*"
  expect_status 0 --estimate "$@" good.prm
  check "$*: the estimate gives warnings" [ ! -s stderr ]
  local unknowns constraints complex real entries memory columns steps
  unknowns=$(number unknowns)
  constraints=$(number constraints)
  complex=$(sed -n 's/^  factorisations  *\([0-9]*\) complex.*/\1/p' stdout)
  real=$(sed -n 's/^  factorisations .* complex, \([0-9]*\) real.*/\1/p' stdout)
  entries=$(number 'factor entries')
  memory=$(in_bytes 'factor memory')
  columns=$(in_bytes 'joint columns')
  steps=$(number steps)
  expect_status 0 --quiet --overwrite --output-directory run "$@" good.prm
  compare unknowns "$unknowns" "$(($(of_run bodies first unknowns) + $(of_run bodies second unknowns) + $(of_run bodies third unknowns)))"
  compare constraints "$constraints" "$(of_run constraints)"
  compare 'complex factorisations' "$complex" "$(of_run factorisations complex)"
  compare 'real factorisations' "$real" "$(of_run factorisations real)"
  compare entries "$entries" "$(of_run 'factor entries')"
  compare memory "$memory" "$(of_run 'factor memory [B]')"
  compare columns "$columns" "$(of_run 'joint column memory [B]')"
  compare steps "$steps" "$(of_run steps)"
}

expect_agreement
check 'ten and a half steps are not eleven' [ "$(of_run steps)" -eq 11 ]
check 'bodies of one kind do not share a factorisation' [ "$(of_run factorisations complex)" -eq 2 ]
expect_agreement --set 'Time integration/Stages=3' --set 'Time integration/Factor precision=double'
check 'three stages without a real factorisation' [ "$(of_run factorisations real)" -eq 2 ]
expect_agreement --set 'Time integration/Stages=1' --set 'Time integration/End time=0.01'
expect_agreement --set 'Time integration/Stage matrices=one-step' --set 'Time integration/Factor precision=single'
expect_agreement --set 'Bodies/second/Stiffness damping=1e-4'
check 'damping shares a factorisation' [ "$(of_run factorisations complex)" -eq 3 ]
expect_agreement --set 'Start/Projection=velocities' --set 'Bodies/third/Velocity=0, 0, 0.1'

# --- the rest of the table ---

expect_status 0 --estimate good.prm
expect_text stdout 'times' '(measured)' 'factorisations      about ' 'a step              about ' ' iterations' \
  'the run             about ' 'peak memory         about ' 'Gflop/s' "Body 'third'"
check '--estimate writes files' [ -z "$(find . -name '*-results')" ]
expect_status 0 --estimate --set 'Time integration/Tolerance=1e-4' --set 'Time integration/Maximal step size=2e-3' good.prm
expect_text stdout 'a tolerance' 'steps               at least 6 of at most 0.002 s' 'again for each step size' \
  'the run             at least '
expect_status 0 --estimate --quiet good.prm
check '--quiet prints something' [ ! -s stdout -a ! -s stderr ]

# --- errors ---

# The errors of a model are those of --validate.
expect_estimate_error() {
  local text=$1
  shift
  expect_status 2 --estimate "$@"
  expect_one_line "$*"
  check "$*: output on stdout" [ ! -s stdout ]
  expect_text stderr "$*" "$text"
}
expect_estimate_error "section 'Joints/wall', entry 'Type': found 'welded'" --set 'Joints/wall/Type=welded' good.prm
expect_estimate_error "surface 'left'" --set 'Joints/wall/Between=first: left, ground' good.prm
expect_estimate_error 'found no model file'
expect_estimate_error 'found --validate with --estimate; allowed: one of them' --validate good.prm
expect_estimate_error 'found --restart with --estimate' --restart checkpoint.h5 good.prm
expect_estimate_error 'found --overwrite with --estimate' --overwrite good.prm

finish
