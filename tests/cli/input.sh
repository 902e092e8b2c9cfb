#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Options that need no run, the models of the project, and errors in the input.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

# --- options without a model ---

expect_status 0 --help
expect_text stdout help Usage: --validate --set --output-directory --threads --quiet 'Exit status'
expect_status 0 --version
version=$(sed -n 's/^project(acf-dealii VERSION \([0-9.]*\).*/\1/p' "$top/CMakeLists.txt")
check "version: $(cat stdout)" [ "$(cat stdout)" = "acf-dealii $version" ]
expect_status 0 --print-parameters
cp stdout default.prm

# Every entry follows a comment with its unit.
check 'an entry without "Units:"' awk '
  /^ *#/   { comment = comment " " substr($0, index($0, "#") + 1); next }
  /^ *set/ { ++n; if (comment !~ /Units: +[^ ].*\.$/) { print; wrong = 1 } }
           { comment = "" }
  END      { exit wrong || n < 30 }' default.prm

# The default file is a valid model but for what every model must say; what that
# is depends on other entries for some.
set_default() { sed -i "s|^\( *set $1 *=\).*|\1 $2|" default.prm; }
# expect_missing SECTION ENTRY SECTION ENTRY ...
expect_missing() {
  expect_status 2 --validate default.prm
  check "default file: $(wc -l <stderr) instead of $(($# / 2)) problems" [ "$(wc -l <stderr)" -eq $(($# / 2)) ]
  while [ $# -gt 0 ]; do
    check "default file: nothing of the entry '$2' in '$1'" \
      grep -q "^acf-dealii: default.prm:[0-9]*: section '$1', entry '$2': found \(no\|''\)" stderr
    shift 2
  done
}
expect_missing Bodies/body Mesh Bodies/body "Young's modulus" Bodies/body Density Joints/joint Between \
  'Force elements/spring' Between 'Force elements/spring' Stiffness Masses/mass On Masses/mass Mass \
  Loads/load On Loads/load Value 'Time integration' 'End time' 'Time integration' 'Step size' Probes/probe Of
set_default Mesh box
set_default Element hexahedron
set_default "Young's modulus" 1e9
set_default Density 1000
set_default Between 'body: x min, ground'
set_default Stiffness 1e3
set_default On 'body: x max'
set_default Of 'body: x max'
set_default Mass 1
set_default Value '0; 0; 1'
set_default 'End time' 1
set_default 'Step size' 0.1
expect_missing Bodies/body 'Box from' Bodies/body 'Box to' Bodies/body Cells
set_default 'Box from' '0, 0, 0'
set_default 'Box to' '1, 1, 1'
set_default Cells '1, 1, 1'
expect_missing 'Force elements/spring' 'Ground point'
set_default 'Ground point' '2, 0, 0'
expect_status 0 --validate default.prm
expect_text stdout 'default file' 'default.prm is valid'

# --- the models of the project ---

while read -r model; do
  expect_status 0 --validate --quiet "$model"
  check "--validate --quiet writes something for $model" [ ! -s stdout ]
  check "a warning about $model" [ ! -s stderr ]
done < <(find "$top/prm" -name '*.prm' | sort)

# The example in the README, the indented block that begins with a title.
awk '/^    set Title/ { inside = 1 }
     inside && /^[^ ]/ { exit }
     inside { print substr($0, 5) }' "$top/README.md" >readme.prm
expect_status 0 --validate --quiet readme.prm
check '--validate writes no files' [ -z "$(find . -name '*-results')" ]

# --- errors in a model file ---

cat >good.prm <<'END'
subsection Bodies
  set Names = block
  subsection block
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 1, 1
    set Cells           = 1, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
  end
end
subsection Joints
  set Names = wall
  subsection wall
    set Type    = fixed
    set Between = block: x min, ground
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 0.1
  set Step size = 0.01
end
subsection Probes
  set Names = end, wall
  subsection end
    set Of = block: x max
  end
  subsection wall
    set Type = reaction
    set Of   = wall
  end
end
END
expect_status 0 --validate --quiet good.prm
expect_error 's/1000/heavy/' 10 Bodies/block Density "'heavy'" 'a number'
expect_error 's/1e9/-1/' 9 Bodies/block "Young's modulus" "'-1'" 'a number >= 0'
expect_error 's/0, 0, -9.81/0, -9.81/' 21 Loads Gravity "'0, -9.81'" "a list of 3 numbers separated by ','"
expect_error 's/Box to .*/Box to = 1, 1/' 7 Bodies/block 'Box to' "'1, 1'" 'a point of three coordinates'
expect_error 's/Gravity/Gravitation/' 21 Loads Gravitation 'an unknown entry' "'Gravity'"
expect_error 's/subsection Loads/subsection Load/' 20 '' '' "the unknown subsection 'Load'" "'Bodies'" "did you mean 'Loads'"
expect_error '24p' 25 'Time integration' 'End time' 'the entry a second time (first in line 24)' 'each entry once'
expect_error '/Density/d' 3 Bodies/block Density 'nothing or zero' 'a positive number'
expect_error '/Mesh/d' 3 Bodies/block Mesh 'no value' 'box, cylinder, or a file'
expect_error '/End time/d' 23 'Time integration' 'End time' 'nothing or zero' 'a positive number'
expect_error '/Step size/d' 23 'Time integration' 'Step size' 'nothing or zero' 'a positive number'
expect_error 's/Step size = 0.01/Step size = 0.2/' 25 'Time integration' 'Step size' 'a step larger' 'a positive number'
expect_error 's/block: x min/brick: x min/' 17 Joints/wall Between "the body 'brick'" block
expect_error 's/block: x min/block: left/' 17 Joints/wall Between "surface 'left'" \
  "'x max', 'x min', 'y max', 'y min', 'z max', 'z min'"
expect_error 's/block: x min, ground/block: x min/' 17 Joints/wall Between "'block: x min'" "two surfaces, 'BODY: SURFACE, BODY: SURFACE'"
expect_error 's/fixed/welded/' 16 Joints/wall Type "'welded'" 'one of spherical, revolute, cylindrical, prismatic, fixed, universal, point on line'
expect_error 's/= fixed/= revolute/' 15 Joints/wall Axis 'nothing or the zero vector' 'the direction of the axis'
expect_error 's/block: x max/block: right/' 30 Probes/end Of "surface 'right'" "'x max', 'x min'"
expect_error 's/Of   = wall/Of = door/' 34 Probes/wall Of "the joint 'door'" wall
expect_error 's/= box$/= nowhere.geo/;/Box /d;/Cells/d' 4 Bodies/block Mesh "'nowhere.geo': no such file" 'the name of a file that exists'
expect_error "s|= box$|= $top/tests/data/flat_square.geo|;/Box /d;/Cells/d" 4 Bodies/block Mesh \
  "'$top/tests/data/flat_square.geo': a mesh without volume elements" 'three-dimensional meshes'
expect_error "s|= box$|= $top/tests/data/cylinder.geo|;/Box /d;/Cells/d" 5 Bodies/block Element hexahedron 'tetrahedron for this mesh'
expect_error 's/^ *set Cells .*/&\n    set Cut = 4 along r/' 9 Bodies/block Cut "'4 along r'" "nothing, planes across an axis" "'volumes'"
expect_error 's/^ *set Cells .*/&\n    set Cut = 4 along x/' 9 Bodies/block Cut 'the part 1 to x = 0.25 m, in which no cell' 'planes between 0 and 1 m'

sed 's/^ *set Cells .*/    set Cells = 2, 1, 1\n    set Cut = 2 along x/' good.prm >cut.prm
expect_status 0 --validate cut.prm
expect_text stdout 'a body in parts' "Body 'block': 2 parts, volume 1 m^3" "Body 'block 1': 1 quadratic" \
  "Body 'block 2': 1 quadratic" '2 joints with 12 constraints'
sed "s|= box$|= $top/tests/data/three_volumes.geo|; /Box /d; /Element/d; s/^ *set Cells .*/    set Cut = volumes/
  s/block: x min/block: start/; s/block: x max/block nose: bottom/; s/Of   = wall/Of   = block disk + block nose/" \
  good.prm >cut.prm
expect_status 0 --validate cut.prm
expect_text stdout 'a body in volumes' "Body 'block': 3 parts, volume 4 m^3" "Body 'block shaft'" \
  '3 joints with 18 constraints'

# A file in mm that is the first one of the CAD kernel.
sed "s|= box$|= $top/tests/data/box.igs|; /Box /d; /Cells/d; s/hexahedron/tetrahedron/
  s/block: x m../block: surface 1/" good.prm >iges.prm
expect_status 0 --validate iges.prm
expect_text stdout 'an IGES file' 'volume 2e-09 m^3'

# Bodies for which accuracy was not measured, or is known to be lost.
sed "s/Box to .*/Box to = 10, 1, 1/; s/^ *set Density/    set Poisson's ratio = 0.49\n&/" good.prm >doubtful.prm
expect_status 0 --validate --quiet doubtful.prm
expect_one_line 'long cells, hardly compressible'
expect_text stderr 'long cells, hardly compressible' "warning: the body 'block' may be too stiff in bending" \
  '10 times as long as thin' "Poisson's ratio of 0.49"
sed 's/Box to .*/Box to = 10, 0.01, 0.01/' good.prm >doubtful.prm
expect_status 0 --validate --quiet doubtful.prm
expect_one_line 'a very slender body'
expect_text stderr 'a very slender body' "warning: the body 'block' is so slender"

# --- values that are likely to have other units ---

expect_warning "s/1e9/210000/; s/= 1000/= 7850/" "the body 'block' is as heavy as a metal but softer than rubber" \
  'Young'"'"'s modulus 210000 Pa'
expect_warning 's/1e9/210/; s/= 1000/= 7850/' "the body 'block' is too soft for its density"
expect_warning 's/1e9/2.1e11/; s/= 1000/= 7.85e-9/' "the body 'block' is lighter than any solid" 'density 7.85e-09 kg/m^3'
expect_warning 's/= 1000/= 1e6/' "the body 'block' is heavier than any solid"
expect_warning 's/1e9/1e15/' "the body 'block' is too stiff for its density"
expect_warning 's/9.81/9810/' 'the gravity of 9810 m/s^2'
expect_warning 's/Box to .*/Box to = 200, 200, 200/' "the body 'block' is 346.41 m long"
expect_warning "\$a subsection Output\n  set VTU interval = 0.5\nend" 'the VTU interval of 0.5 s is longer than the End time of 0.1 s'
sed 's/1e9/2e5/; s/= 1000/= 30/' good.prm >foam.prm
expect_status 0 --validate --quiet foam.prm
check 'a warning about foam' [ ! -s stderr ]

# --- several errors ---

sed 's/= 1000/= heavy/; s/= fixed/= revolt/; s/Gravity/Gravitiy/; s/= 0.01/= 1e-300/
  s/block: x max/brick: x max/; s/= wall$/= door/; 2s/$/ # wall, door/' good.prm >several.prm
sed -i '13,14s/= door/= wall/' several.prm
expect_status 2 --validate --set 'Loads/Gravity=down' --set Title several.prm
expect_lines 'several errors' several.prm 10 16 21 25 30 34
expect_text stderr 'several errors' "'1e-300', which makes 1e+299 steps" "the body 'brick'" "the joint 'door'" \
  "acf-dealii: command line: --set 'Loads/Gravity=down'" "acf-dealii: command line: found --set 'Title'"
check "several errors: $(wc -l <stderr) instead of 8" [ "$(wc -l <stderr)" -eq 8 ]

# What follows from another error is left out.
sed 's/subsection Bodies/subsection Bodis/; s/revolute/fixed/' good.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a misspelt section'
expect_text stderr 'a misspelt section' "wrong.prm:1: found the unknown subsection 'Bodis'"
sed 's/= fixed/= revolt/; s/^ *set Between.*/&\n    set Axis = 0, 0, 1/' good.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a wrong type'

# --- included files ---

mkdir parts
sed -n '9,10p' good.prm >parts/material.prm
sed '9s/.*/    include material.prm/; 10d' good.prm >parts/model.prm
expect_status 0 --validate --quiet parts/model.prm
check 'an included file gives warnings' [ ! -s stderr ]
sed -i 's/1000/heavy/' parts/material.prm
expect_status 2 --validate parts/model.prm
expect_one_line 'an error in an included file'
expect_text stderr 'an error in an included file' "acf-dealii: parts/material.prm:2: section 'Bodies/block', entry 'Density'"
expect_status 2 --validate --set 'Bodies/block/Density=0' parts/model.prm
expect_lines 'a wrong override of a wrong entry' parts/material.prm 2

# --- other errors ---

sed 's/subsection block/subsection brick/' good.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a subsection without a name'
expect_text stderr 'a subsection without a name' 'wrong.prm:3:' "'Bodies'" "'brick'" block

expect_status 2 --validate missing.prm
expect_one_line 'no file'
expect_text stderr 'no file' 'missing.prm: found no such file' 'allowed: a model file'

# --- errors on the command line ---

# expect_usage_error FOUND ALLOWED ARGUMENTS ...
expect_usage_error() {
  local found=$1 allowed=$2
  shift 2
  expect_status 2 "$@"
  expect_one_line "$*"
  expect_text stderr "$*" 'acf-dealii: command line: ' "$found" "allowed: $allowed"
}

expect_usage_error 'found no model file' 'one model file'
expect_usage_error "found --threads '0'" 'an integer >= 1' --threads 0 good.prm
expect_usage_error "found the unknown option '--validat'" --help --validat good.prm
expect_usage_error "found --set 'Density'" "--set 'Section/Entry=value'" --set Density good.prm
expect_usage_error "section 'Bodies/block', entry 'Density': found 'heavy'" 'a number' \
  --set 'Bodies/block/Density=heavy' good.prm
expect_usage_error "section 'Bodies/block', entry 'Densities': found an unknown entry" "'Mesh'" \
  --set 'Bodies/block/Densities=1' good.prm

finish
