#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Faults of simulations: the message says what failed, in which body, joint or
# entry, and when; the results up to this time are kept.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

cat >good.prm <<'END'
subsection Bodies
  set Names = block, tail
  subsection block
    set Mesh               = box
    set Element            = hexahedron
    set Box from           = 0, 0, 0
    set Box to             = 4, 1, 1
    set Cells              = 4, 1, 1
    set Young's modulus    = 1e9
    set Density            = 1000
    set Displacement field = 0; 0; 0
  end
  subsection tail
    set Mesh               = box
    set Element            = hexahedron
    set Box from           = 4, 0, 0
    set Box to             = 5, 1, 1
    set Cells              = 1, 1, 1
    set Young's modulus    = 1e9
    set Density            = 1000
  end
end
subsection Joints
  set Names = motor, weld
  subsection motor
    set Type    = revolute
    set Between = block: x min, ground
    set Axis    = 0, 1, 0
    set Angle   = 0
  end
  subsection weld
    set Type    = fixed
    set Between = block: x max, tail: x min
  end
end
subsection Force elements
  set Names = piston
  subsection piston
    set Between      = tail: x max, ground
    set Ground point = 5, 0.5, 9
    set Actuation    = 0
  end
end
subsection Loads
  set Gravity        = 0, 0, -9.81
  set Gravity factor = 1
  set Names          = push
  subsection push
    set On    = tail: x max
    set Value = 0; 0; 0
  end
end
subsection Time integration
  set End time  = 0.04
  set Step size = 0.01
end
subsection Probes
  set Names = end
  subsection end
    set Of = tail: x max
  end
end
END
expect_status 0 --quiet good.prm

# Changes good.prm and expects a failure after the first steps:
# expect_fault SED_SCRIPT N_ROWS TEXT ...; without an output folder N_ROWS is 'none'
expect_fault() {
  local script=$1 n_rows=$2
  shift 2
  sed "$script" good.prm >fault.prm
  check "the sed script changes nothing: $script" [ -n "$(diff good.prm fault.prm)" ]
  rm -rf fault-results
  expect_status 1 --quiet fault.prm
  expect_one_line "$script"
  expect_text stderr "$script" "$@"
  if [ "$n_rows" != none ]; then
    expect_text fault-results/statistics.json "$script" '"finished": false'
    # the header comes with the first row
    local n_lines=0
    [ ! -e fault-results/probes.csv ] || n_lines=$(wc -l <fault-results/probes.csv)
    check "$script: $n_lines lines for $n_rows rows" \
      [ "$n_lines" -eq $((n_rows > 0 ? n_rows + 1 : 0)) ]
  fi
}

# --- functions: defined up to 0.025 s, in the third step ---

expect_fault 's/Value = 0; 0; 0/Value = 0; 0; sqrt(0.025 - t)/' 3 \
  "The function 'Value' in section 'Loads/push' is not finite at time 0.0"
expect_fault 's/factor = 1/factor = sqrt(0.025 - t)/' 3 "The function 'Gravity factor' in section 'Loads' is not finite at time 0.0"
expect_fault 's/Angle   = 0/Angle = t < 0.025 ? 0 : log(0.02 - t)/' 3 \
  "The function 'Angle' in section 'Joints/motor' is not finite at time 0.0"
expect_fault 's/Actuation    = 0/Actuation = 1\/(t < 0.025)/' 3 \
  "The function 'Actuation' in section 'Force elements/piston' is not finite at time 0.0"
expect_fault 's/field = 0; 0; 0/field = 0; log(x - 1); 0/' none \
  "The field 'Displacement field' in section 'Bodies/block' is not finite at the point ("

# --- bodies and cells that are turned inside out ---

project='s/^subsection Time/subsection Start\n  set Projection = positions and velocities\nend\n&/'
free='s/, motor, weld/,/; /^subsection Joints/,/^end/d'
expect_fault "$free; s/field = 0; 0; 0/field = -2*x; 0; 0/" 0 "Body 'block' is turned inside out at time 0 s"
expect_fault "$project; s/field = 0; 0; 0/field = -2*x; 0; 0/" none "Body 'block' is turned inside out at the start"
# the last quarter of the body alone
quarter='s/field = 0; 0; 0/field = x < 3 ? 0 : -3*(x - 3); 0; 0/'
expect_fault "$free; $quarter; 10a set Strain = Green-Lagrange" 0 'The step of' 'at time 0 s failed after 8 halvings' \
  "body 'block' is turned inside out"
modes='s/^subsection Time/subsection Modes\n  set Number = 1\nend\n&/'
expect_fault "$free; $modes; s/field = 0; 0; 0/field = -2*x; 0; 0/" 0 \
  "The modes at time 0 s cannot be computed: body 'block' is turned inside out"
equilibrium='s/^subsection Time/subsection Start\n  set Equilibrium = true\nend\n&/'
expect_fault "$free; $equilibrium; $quarter; 10a set Strain = Green-Lagrange" none 'No static equilibrium was found at time 0 s' \
  "'block': it is turned inside out"

# --- equations without a solution ---

expect_fault "$free; $equilibrium" none 'No static equilibrium was found at time 0 s' "moves most is 'tail'" 'without end'

finish
