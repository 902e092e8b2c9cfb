#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Scripts that show results: render, report and view.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"
export PYTHONDONTWRITEBYTECODE=1

# Starts a script: tool STATUS NAME ARGUMENTS ...
tool() {
  local expected=$1 name=$2
  shift 2
  "$top/scripts/$name" "$@" >stdout 2>stderr
  status=$?
  check "exit status $status instead of $expected: $name $*" [ "$status" -eq "$expected" ]
}

# The script fails with one line: tool_error STATUS TEXT NAME ARGUMENTS ...
tool_error() {
  local expected=$1 text=$2
  shift 2
  tool "$expected" "$@"
  check "$*: $(wc -l <stderr) lines on stderr instead of one" [ "$(wc -l <stderr)" -eq 1 ]
  expect_text stderr "$*" "$1: " "$text"
  check "$*: output on stdout" [ ! -s stdout ]
}

# A picture is as wanted: picture FILE CONDITION, in Python, of its width and
# height, the share of coloured pixels in its upper 80 %, where the bodies are,
# and the box around these in pixels (left, right, upper, lower).
picture() {
  check "$1 is not: $2" /usr/bin/python3 - "$1" "$2" <<'END'
import sys
import matplotlib.image
import numpy

image = matplotlib.image.imread(sys.argv[1])[:, :, :3]
height, width = image.shape[:2]
bodies = numpy.ptp(image[: int(0.8 * height)], axis=2) > 0.15
share = bodies.mean()
rows, columns = numpy.nonzero(bodies.any(axis=1))[0], numpy.nonzero(bodies.any(axis=0))[0]
ends = [columns[0], columns[-1], rows[0], rows[-1]] if share else [0, 0, 0, 0]
left, right, upper, lower = ends
aspect = (right - left + 1) / (lower - upper + 1)
colours = len(numpy.unique((image[: int(0.8 * height)][bodies] * 31).astype(int), axis=0))
if not eval(sys.argv[2]):
    sys.exit(f"width {width}, height {height}, share {share:.3f}, aspect {aspect:.3f}, "
             f"colours {colours}")
END
}

# How much two pictures differ, mean over the pixels: difference FILE FILE
difference() {
  /usr/bin/python3 -c 'import sys, matplotlib.image as m
a, b = (m.imread(name)[:, :, :3] for name in sys.argv[1:])
print(f"{abs(a - b).mean():.6f}" if a.shape == b.shape else "shapes")' "$1" "$2"
}

less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

# A beam of 4 cells that is clamped and bends, and a block that flies and turns.
cat >beam.prm <<'END'
set Title = Beam & <block>
subsection Bodies
  set Names = beam, block
  subsection beam
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.1, 0.1
    set Cells           = 4, 1, 1
    set Young's modulus = 1e7
    set Density         = 1000
  end
  subsection block
    set Mesh             = box
    set Box from         = 0, 0, 0
    set Box to           = 0.4, 0.2, 0.2
    set Cells            = 1, 1, 1
    set Position         = 0, 0, 0.4
    set Young's modulus  = 1e12
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
  set VTU interval = 0.05
  set VTU fields = velocity, von Mises stress, peak von Mises stress, stress, strain, joint forces
end
subsection Validity
  set Strain = 1e-5
end
subsection Probes
  set Names = tip, energy, hold
  subsection tip
    set Of = beam: x max
  end
  subsection energy
    set Type = energy
  end
  subsection hold
    set Type = reaction
    set Of   = clamp
  end
end
END
expect_status 0 --threads 1 beam.prm
cat stdout stderr >log

# --- render ---

tool 0 render beam-results -o stress.png --size 400x300
expect_text stdout render 'stress.png: von Mises stress from ' ' kPa'
picture stress.png '(width, height) == (400, 300)'
picture stress.png 'share > 0.05 and colours > 20'
tool 0 render beam-results -o body.png --size 400x300 --field body
picture body.png 'share > 0.05 and colours > 1'
check 'the field does not change the picture' less 0.01 "$(difference stress.png body.png)"
expect_text stdout 'render --field body' 'body from 0 to 1'
tool 0 render beam-results/solution.pvd -o component.png --size 400x300 --field velocity:z --time 0.05
expect_text stdout 'a component' 'velocity z from '
check 'the component has no sign' grep -q 'from -' stdout

# The start, seen across: beam and block are 1 m wide and 0.6 m high.
tool 0 render beam-results -o start.png --time first --view -y --no-edges --field body --size 500x500
picture start.png 'abs(aspect - 1 / 0.6) < 0.02'
tool 0 render beam-results/solution-000000.vtu -o file.png --view -y --no-edges --field body --size 500x500
picture file.png 'abs(aspect - 1 / 0.6) < 0.02'
# All times in one picture: the block moves by 0.1 m to the right.
tool 0 render beam-results -o all.png --time all --view -y --no-edges --field body --size 500x500
picture all.png 'aspect < 1.5'

# Magnification leaves rigid motion alone, but not the bending of the beam.
tool 0 render beam-results -o one.png --size 400x300 --field body --no-edges
tool 0 render beam-results -o bent.png --size 400x300 --field body --no-edges --warp 5
check 'the magnification does nothing' less 0.005 "$(difference one.png bent.png)"
cat >flight.sed <<'END'
s/Names = beam, block/Names = block/
/subsection beam/,/^  end/d
/subsection Joints/,/^end/d
/subsection Probes/,/^end/d
END
sed -f flight.sed beam.prm >flight.prm
expect_status 0 --quiet --threads 1 flight.prm
tool 0 render flight-results -o rigid.png --size 400x300 --field displacement --no-edges
tool 0 render flight-results -o same.png --size 400x300 --field displacement --no-edges --warp 100
check "a rigid body is deformed by the magnification: $(difference rigid.png same.png)" \
  less "$(difference rigid.png same.png)" 0.01

tool 0 render beam-results --film frames --size 200x150 --ghost
check "pictures of the film: $(ls frames)" \
  [ "$(echo frames/*)" = 'frames/film-000000.png frames/film-000001.png frames/film-000002.png' ]
check 'the film does not move' less 0.005 "$(difference frames/film-000000.png frames/film-000002.png)"

mkdir empty
tool_error 2 'there is no such file' render nowhere
tool_error 2 'has no solution.pvd' render empty
for field in peak_von_mises_stress cell_stress:xz joint_force; do
  rm -f field.png
  tool 0 render beam-results -o field.png --size 200x150 --field $field
  picture field.png 'share > 0.02 and colours > 5'
done
tool_error 2 'allowed, as these are in the files: body, cell_stress, displacement, joint_force' \
  render beam-results --field temperature
tool_error 2 "found component 'xx'; allowed for velocity: x, y, z" render beam-results --field velocity:xx
tool_error 2 "--size: found '10x10'" render beam-results --size 10x10
tool_error 2 'found time 7; allowed: 0 to 0.1 s' render beam-results --time 7
tool_error 2 'ends in .png' render beam-results -o picture.jpg
tool_error 2 "direction: found 'up'" render beam-results --view up
tool_error 2 "--range: found '2,1'" render beam-results --range 2,1
tool_error 2 '--unknown' render beam-results --unknown
cp -r beam-results damaged
head -c 3000 beam-results/solution-000001.vtu >damaged/solution-000001.vtu
tool_error 2 'damaged/solution-000001.vtu: it is no file of VTK' render damaged --time all
rm damaged/solution-000001.vtu
tool_error 2 'names solution-000001.vtu, which is not there' render damaged
check 'a failed script left a picture' [ ! -e damaged.png ]

# --- report ---

tool 0 report beam-results -o page.html --log log
cat >well_formed.py <<'END'
import base64, sys, xml.etree.ElementTree as tree
html = "{http://www.w3.org/1999/xhtml}"
page = tree.parse(sys.argv[1]).getroot()
print("heading:", page.find(f".//{html}h1").text)
for image in page.iter(f"{html}img"):
    kind, data = image.get("src").split(";base64,")
    data = base64.b64decode(data, validate=True)
    if kind == "data:image/svg+xml":
        tree.fromstring(data)
    assert kind == "data:image/svg+xml" or data.startswith(b"\x89PNG"), kind
    print(kind, image.get("alt"))
for element in page.iter():
    print("text:", " ".join(filter(None, [element.text, element.tail])))
    names = {"src", "href"} & set(element.attrib)
    assert all(element.get(name).startswith("data:") for name in names), element.attrib
END
check 'the page is not well-formed, or needs other files' \
  eval '/usr/bin/python3 well_formed.py page.html >contents'
expect_text contents 'the page' 'heading: Beam & <block>' 'data:image/png t = 0 s, von Mises stress' \
  'data:image/png t = 0.1 s' "passed a limit of its strain: strain" 'acf-dealii: warning:' \
  'set Title = Beam & <block>' 'peak memory [B]' 'Change of the sum' 'Step sizes' 'clamp'
head -n 1 beam-results/probes.csv | tr , '\n' | tail -n +2 >columns
check 'no probes' [ "$(wc -l <columns)" -eq 12 ]
while read -r column; do
  check "no curve of $column" grep -qF "data:image/svg+xml $column" <(
    sed -n 's|^\(data:image/svg+xml\) \(.*\)|\2|p' contents | sed 's/, /\n/g' |
      sed 's|^|data:image/svg+xml |')
  check "no values of $column" grep -qF "text: $column" contents
done <columns
last=$(tail -n 1 beam-results/probes.csv | awk -F, '{ printf "%.6g", $4 }')
expect_text contents 'the last value of tip.z' "text: $last"

expect_status 0 --threads 1 --quiet --output-directory plain --set 'Output/VTU interval=0' \
  --set 'Output/Probe interval=0.05' --set 'Validity/Action=ignore' --set 'Bodies/beam/Cut=2 along x' beam.prm
tool 0 report plain
check 'a page without pictures' eval '/usr/bin/python3 well_formed.py report.html >contents'
check 'parts and cells of the beam' grep -q '^<tr><td>beam</td>.*<td class="number">2</td><td class="number">4</td>' report.html
check 'pictures from nowhere' [ -z "$(grep 'data:image/png' contents)" ]
expect_text contents 'a page without pictures' 'None in the files of the run' 'no row per step'

# Modes of the free block, of which six are rigid.
expect_status 0 --threads 1 --quiet --output-directory modes --set 'Output/VTU interval=0' \
  --set 'Modes/Number=7' --set 'Bodies/block/Angular velocity=0,0,0' flight.prm
tool 0 render modes/modes.pvd -o mode.png --size 200x150
picture mode.png 'share > 0.02 and colours > 5'
tool 0 report modes
check 'a page with modes' eval '/usr/bin/python3 well_formed.py report.html >contents'
check "modes with pictures: $(grep -c 'data:image/png' contents)" \
  [ "$(grep 'data:image/png' contents)" = 'data:image/png mode 7, displacement' ]

tool_error 2 'there is no such folder' report nowhere
tool_error 2 'the folder has no results of acf-dealii' report empty
tool_error 2 "--pictures: found '1.5'" report beam-results --pictures 1.5
tool_error 2 "--log: found 'nowhere'" report beam-results --log nowhere
echo '{' >damaged/statistics.json
tool_error 2 'damaged/statistics.json: it is no JSON' report damaged

# --- view ---

tool 0 view beam-results --no-start -o view.py
expect_text stdout view 'paraview --script=view.py'
# Without ParaView: what its functions are called with.
mkdir paraview
touch paraview/__init__.py
cat >paraview/simple.py <<'END'
class Proxy:
    def __init__(self, name):
        object.__setattr__(self, "name", name)
    def __setattr__(self, name, value):
        print(f"{self.name}.{name} = {value!r}")
    def __getattr__(self, name):
        special = {"TimestepValues": [0.0, 0.05, 0.1],
                   "GetBounds": lambda: (0, 1, 0, 0.1, -0.1, 0.5),
                   "GetRange": lambda component: (1.0, 5.0)}
        return special.get(name) or Proxy(f"{self.name}.{name}")
    def __getitem__(self, name):
        return Proxy(f"{self.name}[{name!r}]")
    def __call__(self, *values, **names):
        print(f"{self.name}{values!r} {names!r}")
        return Proxy(self.name + "()")
    def __repr__(self):
        return self.name
for name in ("PVDReader", "WarpByVector", "GetActiveViewOrCreate", "Show", "ColorBy",
             "GetColorTransferFunction", "GetScalarBar", "GetAnimationScene", "Render"):
    globals()[name] = Proxy(name)
END
check 'the script for ParaView fails' eval 'PYTHONPATH=. /usr/bin/python3 view.py >calls'
expect_text calls 'the script for ParaView' "beam-results/solution.pvd" \
  "WarpByVector().Vectors = ['POINTS', 'displacement']" "WarpByVector().ScaleFactor = 1.0" \
  "ColorBy(Show(), ('POINTS', 'von_mises_stress'))" 'RescaleTransferFunction(1.0, 5.0)' \
  'NonlinearSubdivisionLevel = 2' 'GetAnimationScene().GoToLast()'
check 'times of the script' [ "$(grep -c 'UpdatePipeline(' calls)" -eq 3 ]
# a ParaView that says how it was started
printf '#!/bin/sh\necho "started $1"\n' >paraview/paraview
chmod +x paraview/paraview
PATH=$work/paraview:$PATH tool 0 view beam-results -o view.py
expect_text stdout 'view with ParaView' "started --script=$work/view.py"
tool_error 2 'has no solution.pvd' view empty
tool_error 2 'allowed, as these are in the files' view beam-results --field temperature

finish
