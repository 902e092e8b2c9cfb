#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Stresses in probes and files: a bar that is placed along y, held at one end
# and pulled by 1 MPa at the other one.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

cat >bar.prm <<'END'
subsection Bodies
  set Names = bar
  subsection bar
    set Mesh            = box
    set Element         = tetrahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.1, 0.1
    set Cells           = 6, 1, 1
    set Rotation        = 0, 0, 1.5707963267948966
    set Young's modulus = 2e11
    set Poisson's ratio = 0
    set Density         = 7800
  end
end
subsection Joints
  set Names = root
  subsection root
    set Type    = fixed
    set Between = bar: x min, ground
  end
end
subsection Loads
  set Names = pull
  subsection pull
    set Type  = traction
    set On    = bar: x max
    set Value = 0; 1e6; 0
  end
end
subsection Start
  set Equilibrium = true
end
subsection Time integration
  set End time  = 0
  set Step size = 1e-3
end
subsection Output
  set VTU interval = 1
  set VTU fields   = von Mises stress, peak von Mises stress, stress, strain, joint forces
end
subsection Probes
  set Names = middle, along, all
  subsection middle
    set Type  = stress
    set Of    = bar
    set Point = 0.52, 0.03, 0.04
  end
  subsection along
    set Type       = stress
    set Of         = bar
    set Point      = 0.5, 0.05, 0.05
    set Axes       = body
    set Components = xx, xy
  end
  subsection all
    set Type = largest stress
    set Of   = bar
  end
end
END
expect_status 0 bar.prm
header='time [s],middle.xx [Pa],middle.yy [Pa],middle.zz [Pa],middle.xy [Pa],middle.yz [Pa],middle.xz [Pa]'
header+=',along.xx [Pa],along.xy [Pa],all.von Mises [Pa]'
check "header: $(head -n 1 bar-results/probes.csv)" [ "$(head -n 1 bar-results/probes.csv)" = "$header" ]
# The joint holds the mean of the end only, so that it may contract and the
# stress is uniform: 1 MPa along the world's y, up to the equilibrium's error.
check "stresses: $(tail -n 1 bar-results/probes.csv)" awk -F, '
  function is(value, expected) { return (value - expected)^2 < 1 }
  NR == 2 { right = is($2, 0) && is($3, 1e6) && is($4, 0) && is($5, 0) && is($6, 0) && is($7, 0) &&
            is($8, 1e6) && is($9, 0) && is($10, 1e6) }
  END { exit !right || NR != 2 }' bar-results/probes.csv
# 3 probes, a file, and the peaks
check 'number of evaluations of stresses' grep -q '"stress evaluations": 5,' bar-results/statistics.json
for field in von_mises_stress peak_von_mises_stress largest_von_mises_stress stress cell_stress \
  strain joint_force; do
  check "$field is not in the file" grep -q "Name=\"$field\"" bar-results/solution-000000.vtu
done
check 'velocity is in the file' [ -z "$(grep -o 'Name="velocity"' bar-results/solution-000000.vtu)" ]

# --- what a scene does not ask for costs nothing ---

sed '/^subsection Probes/,$d' bar.prm >bare.prm
expect_status 0 --set 'Output/VTU fields=' bare.prm
check 'stresses that nobody asked for' grep -q '"stress evaluations": 0,' bare-results/statistics.json

# --- peaks of a run are kept over a restart ---

swing=(--quiet --set 'Start/Equilibrium=false' --set 'Time integration/Step size=1e-5'
  --set 'Output/VTU interval=1e-4' --set 'Output/Checkpoint interval=1e-4')
expect_status 0 "${swing[@]}" --set 'Time integration/End time=4e-4' --output-directory whole bare.prm
expect_status 0 "${swing[@]}" --set 'Time integration/End time=2e-4' --output-directory halves bare.prm
expect_status 0 "${swing[@]}" --set 'Time integration/End time=4e-4' --output-directory halves \
  --restart halves/checkpoint.h5 bare.prm
check 'peaks after a restart differ' cmp whole/solution-000004.vtu halves/solution-000004.vtu

# --- wrong entries ---

# expect_wrong SUBSTITUTION ENTRY TEXT ...
expect_wrong() {
  local substitution=$1 entry=$2
  shift 2
  sed "$substitution" bar.prm >wrong.prm
  expect_status 2 --validate wrong.prm
  expect_one_line "$entry"
  expect_text stderr "$entry" "entry '$entry'" "$@"
}
expect_wrong 's/strain, joint/pressure, joint/' 'VTU fields' pressure
expect_wrong 's/= xx, xy/= x/' Components "'x'" 'xx, yy, zz, xy, yz, xz' "'stress'"
expect_wrong 's/= body$/= joint/' Axes "'joint'" 'world, body'
expect_wrong 's/0.5, 0.05, 0.05/2, 0, 0/' Point 'outside the body' "body 'bar'"
expect_wrong '/set Point      =/d' Point "'stress'"
expect_wrong 's/set Of   = bar/set Of   = rod/' Of "'rod'" 'bar'

finish
