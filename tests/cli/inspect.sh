#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# What --inspect says of a part, its pictures, and errors.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

# A plate with a bore along y, round at one end.
cat >plate.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.06, 0.01, 0.04};
Cylinder(2) = {0.06, 0, 0.02, 0, 0.01, 0, 0.02};
Cylinder(3) = {0.06, -1, 0.02, 0, 2, 0, 0.008};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
BooleanDifference(5) = { Volume{4}; Delete; }{ Volume{3}; Delete; };
Mesh.MeshSizeMax = 0.008;
bore() = Surface In BoundingBox {0.05, -0.001, 0.01, 0.07, 0.011, 0.03};
foot() = Surface In BoundingBox {-0.001, -0.001, -0.001, 0.001, 0.011, 0.041};
Physical Volume("plate") = {5};
Physical Surface("bore") = {bore()};
Physical Surface("foot") = {foot()};
Physical Surface("bore and foot") = {bore(), foot()};
END

# --- tables ---

expect_status 0 --inspect plate.geo --density 2700
check 'warnings about a plate' [ ! -s stderr ]
expect_text stdout 'a plate' 'quadratic tetrahedra' 'extent   0.08 x 0.01 x 0.04 m, from (0, 0, 0)' \
  'plate: foot ' 'plane, normal (-1, 0, 0)' 'cylinder hole, radius 0.008, axis (0, 1, 0) through (0.06, 0.005, 0.02)' \
  'other; 2 pieces' '(without a name)' 'cells below 0.1'
cp stdout plate.txt

# The lines at the end are those of a model file, and the model agrees: cells,
# unknowns, volume, mass, centre and inertia.
awk '/^Lines for a model file/ { inside = 1; next } /^$/ { inside = 0 } inside' plate.txt >lines.prm
sed "s/^\( *set Young's modulus =\)/\1 7e10/" lines.prm >plate.prm
printf 'subsection Time integration\n  set End time = 1\n  set Step size = 0.1\nend\n' >>plate.prm
expect_status 0 --validate plate.prm
check "the lines give warnings" [ ! -s stderr ]
sed -n '/^Body/,/kg m^2/p' stdout | sed 's/^Body [^:]*: //' >model.txt
# All numbers of these lines: numbers FILE
numbers() { grep -oE '[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?' "$1"; }
sed -n '1p; /^  volume/p; /^  mass/p; /^  inertia/p' plate.txt |
  sed 's/^plate.geo: //; s/, [0-9]* nodes//; s/, centre.*//; s/(density.*//' >part.txt
sed -n 's/.*, centre\(.*\)/\1/p' plate.txt | head -n 1 >centre.txt
{ sed -n 1,3p part.txt; cat centre.txt; sed -n 4p part.txt; } >inspected.txt
paste <(numbers inspected.txt) <(numbers model.txt) >pairs
# cells, unknowns, volume, 3 of m^3, mass, centre, inertia, 2 of m^2
check "15 numbers of the part and of the model: $(wc -l <pairs)" [ "$(wc -l <pairs)" -eq 15 ]
check "the part differs from the model: $(paste -sd ' ' pairs)" awk '
  { d = $1 - $2; if (d < 0) d = -d; m = $1 < 0 ? -$1 : $1
    if (NF != 2 || d > 1e-5 * m + 1e-12) bad = 1 }
  END { exit bad }' pairs

# A whole cylinder, and a half of one.
printf '%s\n' 'SetFactory("OpenCASCADE");' 'Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5};' 'Mesh.MeshSizeMax = 0.4;' >round.geo
expect_status 0 --inspect round.geo
expect_text stdout 'a cylinder' 'round: surface 1' 'cylinder, radius 0.5, axis (0, 0, 1)'
check 'mass without a density' [ -z "$(grep -E '^  (mass|inertia) ' stdout)" ]
check 'a whole cylinder is a part of one' [ -z "$(grep 'a part of it' stdout)" ]
printf '%s\n' 'SetFactory("OpenCASCADE");' 'Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5, Pi};' 'Mesh.MeshSizeMax = 0.4;' >half.geo
expect_status 0 --inspect half.geo
expect_text stdout 'a half of a cylinder' 'cylinder, radius 0.5' '; a part of it, mean position 0.3'

# Hexahedra are found without being asked for.
expect_status 0 --inspect "$top/tests/data/bar_hexahedra.geo"
expect_text stdout 'hexahedra' '24 quadratic hexahedra' 'set Element         = hexahedron' \
  'quality  mean 1, worst 1 at' 'scaled Jacobian'

# --- scale and size ---

expect_status 0 --inspect round.geo --scale 0.001 --mesh-size 0.0002
expect_text stdout 'scaled' 'volume   7.' 'e-10 m^3' 'radius 0.0005' 'set Mesh size       = 0.0002'
n=$(sed -n '1s/.*: \([0-9]*\) quadratic.*/\1/p' stdout)
expect_status 0 --inspect round.geo --mesh-size 0.2
check "a scaled part has $n cells instead of those in: $(head -n 1 stdout)" \
  grep -q "^round.geo: $n quadratic" stdout
expect_status 0 --inspect "$top/tests/data/box.igs" --quiet
check '--quiet prints something' [ ! -s stdout -a ! -s stderr ]
expect_status 0 --inspect round.geo --scale 1000 --quiet --overwrite
expect_one_line 'a long part'
expect_text stderr 'a long part' "warning: 'round.geo' is 17" 'as if it were in mm; then use --scale 0.001'

# --- pictures ---

expect_status 0 --inspect plate.geo --output-directory pictures
expect_text stdout 'pictures' 'pictures/inspection-surfaces.vtu' 'pictures/inspection-mesh.vtu'
python3 - pictures/inspection-surfaces.vtu plate.txt >compared 2>&1 <<'END'
# Cells of each name in the picture, against the faces in the table.
import base64, collections, re, sys, xml.etree.ElementTree as xml, zlib
piece = next(xml.parse(sys.argv[1]).iter("Piece"))
def values(name):
    text = next(a for a in piece.iter("DataArray") if a.get("Name") == name).text
    # the header: 32 bytes are 44 characters
    return zlib.decompress(base64.b64decode(text[44:]))
names = values("surface_name").decode().split("\0")[:-1]
assert len(names) == int(piece.get("NumberOfCells")), len(names)
faces = collections.Counter(n for name in names for n in (name.split(", ") if name else ["(without a name)"]))
table = {m[1].removeprefix("plate: "): int(m[2]) for m in
         re.finditer(r"^  \d+  (\S.*?)  +(\d+)  +[\d.]+e?\S*  ", open(sys.argv[2]).read(), re.M)}
table = {name: table[name] for name in faces}
assert len(table) == 4 and table == faces, (table, faces)
types = set(values("types"))
assert types == {5}, types
END
status=$?
check "faces of the picture: $(tail -n 1 compared)" [ $status -eq 0 -a ! -s compared ]

# Earlier pictures are moved, other files stay.
touch pictures/solution.pvd
cp pictures/inspection-mesh.vtu mesh.vtu
expect_status 0 --inspect round.geo --quiet --output-directory pictures
expect_one_line 'earlier pictures'
expect_text stderr 'earlier pictures' 'were moved to pictures/earlier-1'
check 'the earlier picture is not kept' cmp -s mesh.vtu pictures/earlier-1/inspection-mesh.vtu
check 'a file of a run was moved' [ -f pictures/solution.pvd ]
expect_status 0 --inspect round.geo --quiet --overwrite --output-directory pictures
check '--overwrite moves pictures' [ ! -e pictures/earlier-2 -a ! -s stderr ]

# --- errors ---

# expect_part_error STATUS TEXT ARGUMENTS ...
expect_part_error() {
  local expected=$1 text=$2
  shift 2
  expect_status "$expected" "$@"
  expect_one_line "$*"
  check "$*: output on stdout" [ ! -s stdout ]
  expect_text stderr "$*" "$text"
}

mkdir empty
expect_part_error 2 "--inspect: found 'nowhere.step': no such file; allowed: the name of a file that exists" \
  --inspect nowhere.step
expect_part_error 2 "--inspect: found './plate.stl'; allowed: a file .msh" --inspect plate.stl
expect_part_error 2 "--inspect: found '$top/tests/data/flat_square.geo': a mesh without volume elements" \
  --inspect "$top/tests/data/flat_square.geo" --output-directory empty
expect_part_error 2 "--mesh-size: found '1e-09', which makes" --inspect round.geo --mesh-size 1e-9
expect_part_error 2 "found --scale '0'; allowed: a positive number" --inspect round.geo --scale 0
expect_part_error 2 "found --density '-1'; allowed: a positive number" --inspect round.geo --density=-1
expect_part_error 2 "found --mesh-size 'fine'; allowed: a positive number" --inspect round.geo --mesh-size fine
expect_part_error 2 'found --density without --inspect' --density 1 plate.prm
expect_part_error 2 'found --validate with --inspect; allowed: one of them' --validate --inspect round.geo
expect_part_error 2 'found --set with --inspect; allowed: one of them' --set Title=x --inspect round.geo
expect_part_error 2 "found 'plate.prm' beside --inspect" --inspect round.geo plate.prm
expect_part_error 2 'found --inspect without a value; allowed: --inspect PART' --inspect --quiet
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n' >cut.msh
expect_part_error 2 "--inspect: found 'cut.msh'" --inspect cut.msh
expect_part_error 2 '--mesh-size: found 0.5; allowed: no value for Mesh = cut.msh, only geometries are meshed' \
  --inspect cut.msh --mesh-size 0.5
expect_part_error 2 "--inspect: found './box'; allowed: a file .msh" --inspect box
expect_part_error 1 'round.geo' --inspect round.geo --output-directory round.geo
check 'errors leave files' [ -z "$(ls empty)" ]

finish
