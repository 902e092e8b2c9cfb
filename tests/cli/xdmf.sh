#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# XDMF and HDF5 in place of VTU files: the same results, whatever happens to the run.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"
export PYTHONDONTWRITEBYTECODE=1

# A hexahedral beam that is clamped, and a tetrahedral block that flies and turns.
cat >beam.prm <<'END'
subsection Bodies
  set Names = beam, block
  subsection beam
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.1, 0.1
    set Cells           = 4, 2, 1
    set Young's modulus = 1e7
    set Density         = 1000
  end
  subsection block
    set Mesh             = cylinder
    set Element          = tetrahedron
    set Cylinder from    = 0, 0, 0
    set Cylinder to      = 0.4, 0, 0
    set Cylinder radius  = 0.1
    set Cells            = 3, 2
    set Geometry         = quadratic
    set Position         = 0, 0, 0.4
    set Young's modulus  = 1e9
    set Density          = 1000
    set Velocity         = 1, 0, 1
    set Angular velocity = 0, 5, 0
  end
end
subsection Joints
  set Names = clamp
  subsection clamp
    set Type    = fixed
    set Between = beam: x min, ground
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 0.1
  set Step size = 0.01
end
subsection Output
  set Format = XDMF
  set VTU interval = 0.02
  set VTU fields = velocity, von Mises stress, peak von Mises stress, stress, strain, joint forces
end
END
expect_status 0 --quiet --threads 1 --output-directory xdmf beam.prm
expect_status 0 --quiet --threads 1 --output-directory vtu --set 'Output/Format=VTU' beam.prm
xdmf_files() { echo solution-00000{0..5}.h5 solution-mesh.h5 solution.xdmf; }
check "files: $(cd xdmf && echo solution*)" [ "$(cd xdmf && echo solution*)" = "$(xdmf_files)" ]
check 'files of the other format' [ "$(cd vtu && echo solution*)" = \
  "$(echo solution-00000{0..5}.vtu solution.pvd)" ]
statistic() { sed -n "s/^ *\"$2\": \\([^,]*\\),\\?\$/\\1/p" "$1/statistics.json"; }
check 'the counters of XDMF' [ "$(statistic xdmf 'hdf5 files') $(statistic xdmf 'vtu files')" = '6 0' ]
check 'the counters of VTU' [ "$(statistic vtu 'hdf5 files') $(statistic vtu 'vtu files')" = '0 6' ]

# --- the list, and the scripts ---

# Times and files of a list, and whether all files that it names are there:
# list FILE
list() {
  python3 - "$1" <<'END'
import pathlib, sys, xml.etree.ElementTree
path = pathlib.Path(sys.argv[1])
root = xml.etree.ElementTree.parse(path).getroot()
steps = root.findall("Domain/Grid[@CollectionType='Temporal']/Grid[@CollectionType='Spatial']")
for step in steps:
    items = [item.text.split(":")[0] for item in step.iter("DataItem")]
    missing = [name for name in items if not (path.parent / name).is_file()]
    files = [name for name in dict.fromkeys(items) if name != "solution-mesh.h5"]
    print(step.find("Time").attrib["Value"], *files, *(f"MISSING {name}" for name in missing))
END
}
list xdmf/solution.xdmf >listed
expected=$(for k in 0 1 2 3 4 5; do echo "$k solution-00000$k.h5"; done)
check "the list: $(cat listed)" \
  [ "$(awk '{ printf "%.6g %s\n", $1 / 0.02, $2; if (NF > 2) print "more" }' listed)" = "$expected" ]
check 'names of the bodies' grep -q '<Grid Name="block"' xdmf/solution.xdmf
check 'elements' [ "$(grep -o 'TopologyType="[^"]*"' xdmf/solution.xdmf | sort | uniq -c | xargs)" = \
  '6 TopologyType=Hexahedron_27 6 TopologyType=Tetrahedron_10' ]

"$top/scripts/render" xdmf -o no.png >stdout 2>stderr
status=$?
check "render: exit status $status" [ "$status" -eq 2 ]
check 'render: not one line' [ "$(wc -l <stderr)" -eq 1 ]
expect_text stderr render 'xdmf/solution.xdmf: found results in XDMF' "allowed: VTU files" 'Output/Format = VTU'
check 'report' eval '"$top/scripts/report" xdmf -o page.html >stdout 2>stderr'
expect_text page.html report 'The results are in XDMF'
check 'view' eval '"$top/scripts/view" xdmf -o view.py --no-start >stdout 2>stderr'
expect_text view.py view 'XDMFReader(FileNames=[results])' "/xdmf/solution.xdmf'" "'von_mises_stress'"
view_error() {
  "$top/scripts/view" damaged -o no.py --no-start >stdout 2>stderr
  status=$?
  check "exit status $status instead of 2: $1" [ "$status" -eq 2 ]
  expect_text stderr view "$1"
}
cp -r xdmf damaged
rm damaged/solution-mesh.h5
view_error 'names solution-mesh.h5, which is not there'
echo '<Xdmf><Domain/></Xdmf>' >damaged/solution.xdmf
view_error 'it names no file'
head -c 300 xdmf/solution.xdmf >damaged/solution.xdmf
view_error 'it is no list of acf-dealii in XDMF'

# --- restarts ---

parts=(--quiet --threads 1 --output-directory parts)
expect_status 0 "${parts[@]}" --set 'Time integration/End time=0.06' --set 'Output/Checkpoint interval=0.03' beam.prm
expect_status 0 "${parts[@]}" --restart parts/checkpoint-previous.h5 beam.prm
same_as() {
  local file
  [ "$(cd "$1" && echo solution*)" = "$(cd "$2" && echo solution*)" ] || return 1
  for file in "$1"/solution*; do
    cmp -s "$file" "$2/$(basename "$file")" || { echo "$file differs"; return 1; }
  done
}
check 'a restart writes other files' same_as xdmf parts
check 'the counter after a restart' [ "$(statistic parts 'hdf5 files')" -eq 6 ]
expect_status 0 --quiet --threads 1 --output-directory parts beam.prm
check 'earlier results are not set aside' same_as xdmf parts/earlier-1
check 'the new results' same_as xdmf parts
# with the other format: a list that begins at the restart, at 0.06 s
expect_status 0 --quiet --threads 1 --output-directory changed --set 'Time integration/End time=0.06' \
  --set 'Output/Checkpoint interval=0.03' --set 'Output/Format=VTU' beam.prm
expect_status 0 --quiet --threads 1 --output-directory changed --restart changed/checkpoint.h5 beam.prm
check 'the list after a change of the format' [ "$(grep -c '<Time' changed/solution.xdmf)" -eq 3 ]
check 'the list before it' [ "$(grep -c '<DataSet' changed/solution.pvd)" -eq 4 ]

# --- killed ---

# Wherever it is killed: the list can be read, and every file under its name is
# that of a run that was not killed.
dense=(--quiet --threads 1 --set 'Output/VTU interval=0.001')
expect_status 0 "${dense[@]}" --output-directory whole --set 'Time integration/End time=1' beam.prm
list whole/solution.xdmf >whole.list
n_kills=0
for delay in 0 0.05 0.1 0.15; do
  rm -rf killed
  "$acf" "${dense[@]}" --output-directory killed --set 'Time integration/End time=1' beam.prm >/dev/null 2>&1 &
  while [ ! -e killed/solution.xdmf ] && kill -0 $! 2>/dev/null; do sleep 0.01; done
  sleep $delay
  kill -9 $!
  wait $! 2>/dev/null
  check 'the run ended' [ ! -e killed/statistics.json ]
  list killed/solution.xdmf >listed
  n_times=$(wc -l <listed)
  check "the list of $n_times times" [ "$n_times" -ge 1 ]
  check 'a listed file is missing' eval '! grep -q MISSING listed'
  for file in killed/solution*.h5; do
    check "$file after a kill" cmp -s "$file" "whole/$(basename "$file")"
  done
  check "the list of $n_times times is another" cmp -s listed <(head -n "$n_times" whole.list)
  n_kills=$((n_kills + 1))
done
check 'kills' [ "$n_kills" -eq 4 ]

# --- wrong input, and a full disk ---

sed 's/Format = XDMF/Format = HDF5/' beam.prm >wrong.prm
expect_status 2 --validate wrong.prm
expect_one_line 'a format that does not exist'
expect_text stderr 'a format that does not exist' "section 'Output'" "entry 'Format'" "'HDF5'" 'one of VTU, XDMF'
# A limit of the size of files stands for a full disk: here in the list, which
# becomes longer than the other files.
largest=$(stat -c %s xdmf/solution*.h5 | sort -n | tail -n 1)
(ulimit -f $((largest / 1024 + 1)) && exec "$acf" "${dense[@]}" --output-directory full beam.prm) >stdout 2>stderr
status=$?
check "exit status $status with a full disk" [ "$status" -eq 1 ]
check 'a full disk: not one line' [ "$(wc -l <stderr)" -eq 1 ]
expect_text stderr 'a full disk' "The file 'full/solution.xdmf' cannot be written: File too large."
list full/solution.xdmf >listed
check "the list of $(wc -l <listed) times with a full disk" [ "$(wc -l <listed)" -ge 1 ]
check 'a listed file is missing' eval '! grep -q MISSING listed'
check 'temporary files are left' [ -z "$(find full -name '*.tmp')" ]

# --- sizes ---

size() { cat "$1"/solution* | wc -c; }
check 'XDMF takes more space' [ "$(size xdmf)" -lt "$(size vtu)" ]
echo "sizes of 6 times: VTU $(size vtu) bytes, XDMF $(size xdmf) bytes"

finish
