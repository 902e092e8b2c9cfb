#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Input that asks for too much, or is no input at all: one clear error, and soon.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

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
subsection Loads
  set Names = push
  subsection push
    set On    = block: x max
    set Value = 0; 0; t
  end
end
subsection Time integration
  set End time  = 0.1
  set Step size = 0.01
end
END

# No run may take longer than this; sanitizers make the program slower.
run() {
  timeout $((20 * ${ACF_TEST_SLOWNESS:-1})) "$acf" "$@" >stdout 2>stderr
  status=$?
}

# A file that is no model: expect_no_model WHAT FILE TEXT
expect_no_model() {
  expect_status 2 "$2"
  expect_one_line "$1"
  expect_text stderr "$1" "$3"
}

# --- model files ---

: >empty.prm
head -c 100000 "$acf" >binary.prm
printf 'set Title = x\0y\n' >zero.prm
mkfifo pipe.prm
expect_no_model 'an empty file' empty.prm 'empty.prm: found a file without any entry'
expect_no_model 'a program' binary.prm 'binary.prm:1: found bytes that are not text'
expect_no_model 'a byte of zero' zero.prm 'zero.prm:1: found bytes that are not text'
expect_no_model 'a folder' . '.: found a directory; allowed: a model file'
expect_no_model 'a device' /dev/zero '/dev/zero: found a device; allowed: a model file'
expect_no_model 'a pipe that nobody writes to' pipe.prm 'pipe.prm: found a pipe into which nothing is written'
truncate -s 100G huge.prm
expect_no_model 'a huge file' huge.prm 'huge.prm: found a file of more than 20 MB'
expect_status 0 --validate --quiet <(cat good.prm)

for n in $(seq 40); do echo "subsection $n"; done >deep.prm
expect_no_model 'deep subsections' deep.prm 'deep.prm:17:'
printf 'set Title = %01000000d\nset Titel = %01000000d\n' 1 2 >long.prm
expect_status 2 long.prm
expect_text stderr 'long lines' "long.prm:2: entry 'Titel': found an unknown entry"
check 'long lines: a long message' [ "$(wc -c <stderr)" -lt 3000 ]
seq -f 'set A%.0f = 1' 200000 >many.prm
expect_status 2 many.prm
check "many wrong lines: $(wc -l <stderr) lines of errors" [ "$(wc -l <stderr)" -eq 51 ]
expect_text stderr 'many wrong lines' 'acf-dealii: and 199953 more problems'
echo 'include loop.prm' >loop.prm
expect_no_model 'a file that includes itself' loop.prm "found 'include loop.prm', which includes this file"

# --- names ---

printf 'subsection Bodies\n  set Names = %s, end\nend\n' "$(seq -s ', ' 20000)" >names.prm
expect_status 2 names.prm
expect_text stderr 'many names' "names.prm:2: section 'Bodies', entry 'Names': found 20001 names; allowed: at most 10000"

for name in ../block block/block 'block.prm' '-block' ' '; do
  sed "s|block\$|$name|" good.prm >wrong.prm
  expect_status 2 --quiet wrong.prm
done

# --- sizes ---

expect_error 's/= 1, 1, 1$/= 1, 1, 1/; s/Cells .*/Cells = 100000, 100000, 100000/' 8 Bodies/block Cells \
  "'100000, 100000, 100000', which makes 1e+15 cells" 'at most 20 million cells in a body'
expect_error 's/Cells .*/Cells = 4294967297, 1, 1/' 8 Bodies/block Cells "'4294967297, 1, 1'" 'a list of 0 to 3 integers >= 1'
expect_error 's/Cells .*/&\n    set Cut = 2000000000 along x/' 9 Bodies/block Cut "'2000000000 along x'" nothing '2 to 10000'
expect_error 's/Box to .*/Box to = 1e-200, 1e-200, 1e-200/' 4 Bodies/block Mesh "'box': 1 degenerate cells" cells
expect_error "s/Box to .*/Box to = 1e-40, 1e-40, 1e-40/" 4 Bodies/block Mesh "'box', a body with a length of" \
  'bodies between 1e-30 and 1e30 m'
sed 's/= 1000/= 1e-300/; s/Box to .*/Box to = 1e-10, 1e-10, 1e-10/' good.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_text stderr 'a body without mass' "the body 'block' is lighter than any solid" \
  "wrong.prm:10: section 'Bodies/block', entry 'Density': found a body with a mass of 0 kg"
expect_error 's/= 0.01/= 1e-300/' 22 'Time integration' 'Step size' "'1e-300', which makes" 'steps'
expect_error 's/= 0.01/= 1e300/' 22 'Time integration' 'Step size' "'1e300'" 'a number >= 0, none larger than 1e100'
expect_error "\$a subsection Output\n  set VTU interval = 1e-9\nend" 25 Output 'VTU interval' \
  "'1e-09', which makes 1e+08 files" '0 or an interval that makes at most 1e+06'
expect_error "\$a subsection Modes\n  set Number = 4000000000\nend" 25 Modes Number "'4000000000'" 'an integer in [0, 1000]'

# --- functions ---

parentheses=$(printf '(%.0s' $(seq 3000))
expect_error "s/0; 0; t/0; 0; ${parentheses}t/" 17 Loads/push Value "'((((" 'an expression of the time t'
parentheses+=t$(printf ')%.0s' $(seq 3000))
sed "s/0; 0; t/0; 0; $parentheses/" good.prm >deep.prm
expect_status 0 --validate --quiet deep.prm
sed "s/0; 0; t/0; 0; $(printf 't+%.0s' $(seq 30000))t/" good.prm >long.prm
expect_status 2 --validate --quiet long.prm
expect_one_line 'a long expression'
expect_error 's/0; 0; t/0; 0; t+*t/' 17 Loads/push Value "'t+*t' (Unexpected operator \"*\" found at position 2" 'an expression'

# --- meshes ---

# Changes the mesh: expect_no_mesh FILE TEXT
expect_no_mesh() {
  expect_error "s|= box\$|= $1|; /Box /d; /Cells/d; s/hexahedron/tetrahedron/" 4 Bodies/block Mesh "'$1': $2" ''
}
mkfifo pipe.msh pipe.geo
mkdir folder.step
: >empty.msh
ln -s /dev/zero device.msh
(printf "\$MeshFormat\n4.1 0 8\n"; head -c 1000 /dev/zero) >cut.msh
echo 'Exit;' >exit.geo
truncate -s 100G huge.msh
expect_no_mesh pipe.msh 'a pipe'
expect_no_mesh pipe.geo 'a pipe'
expect_no_mesh folder.step 'a directory'
expect_no_mesh empty.msh 'an empty file'
expect_no_mesh device.msh 'a device'
expect_no_mesh cut.msh "line 3: no line \$EndMeshFormat"
expect_no_mesh huge.msh "line 1: no line \$MeshFormat at the start"
sed "s|= box\$|= exit.geo|; /Box /d; /Cells/d; s/hexahedron/tetrahedron/" good.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a script that ends the program'
expect_text stderr 'a script that ends the program' "'exit.geo'" "the command 'Exit'"
# gmsh's own reader of mesh files crashes; sanitizers would end the process otherwise
export ASAN_OPTIONS=handle_segv=0
cp "$top/tests/fuzz/corpus/mesh/crashed_gmsh_binary_2.2.msh" crash.msh
echo 'Merge "crash.msh";' >crash.geo
expect_no_mesh crash.geo 'gmsh was ended by signal 11'
for size in 1e-9 1e-6; do
  for geometry in box.igs cylinder.geo; do
    expect_error "s|= box\$|= $top/tests/data/$geometry\n set Mesh size = $size|; /Box /d; /Cells/d; s/hexahedron/tetrahedron/" \
      5 Bodies/block 'Mesh size' "'${size/e-/e-0}', which makes" 'at most 20 million cells'
  done
done

check 'files were written' [ -z "$(find . -name '*-results*' -o -name '*.csv')" ]

finish
