#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Short simulations: what they print and write, and how they fail.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

pendulum=$top/prm/pendulum/pendulum.prm
no_vtu=(--set 'Output/VTU interval=0')

until_time() { printf '%s\n' "Time integration/End time=$1"; }

# The files of a folder are these: expect_files FOLDER NAME ...
expect_files() {
  local folder=$1 found expected
  shift
  found=$(ls -A "$folder" 2>&1 | LC_ALL=C sort | tr '\n' ' ')
  expected=$(printf '%s\n' "$@" | LC_ALL=C sort | tr '\n' ' ')
  check "files in $folder: $found instead of $expected" [ "$found" = "$expected" ]
}

# A line of statistics.json: expect_statistic FOLDER NAME VALUE
expect_statistic() {
  check "$1/statistics.json: $2 is not $3" \
    grep -Eq "^ *\"$2\": $3,?\$" "$1/statistics.json"
}

# --- the results of a run, at times that are no ends of steps ---

# The end is 10.5 steps, the probes' interval 1.5 steps.
expect_status 0 --threads 2 --output-directory every "${no_vtu[@]}" \
  --set "$(until_time 0.01)" "$pendulum"
expect_status 0 --threads 2 --output-directory dense --set "$(until_time 0.0105)" \
  --set 'Output/Probe interval=0.0015' --set 'Output/VTU interval=0.004' "$pendulum"
check 'a run writes to stderr' [ ! -s stderr ]
expect_text stdout 'a run' 'Pendulum of Gerstmayr' "Body 'pendulum'" '11 steps (0 rejected)' \
  'Results are in dense'
check 'stdout has control characters' [ -z "$(tr -d '\n[:print:]' <stdout)" ]
expect_files dense probes.csv statistics.json used_parameters.prm solution.pvd \
  solution-000000.vtu solution-000001.vtu solution-000002.vtu
expect_statistic dense finished true
expect_statistic dense steps 11
expect_statistic dense 'vtu files' 3
expect_statistic dense 'probe rows' 8
expect_statistic dense complex 1
if command -v python3 >/dev/null; then
  check 'statistics.json is no JSON' eval 'python3 -m json.tool dense/statistics.json >/dev/null'
  check 'solution.pvd is no XML' python3 -c \
    'import xml.etree.ElementTree as e; e.parse("dense/solution.pvd")'
fi
expect_text dense/solution.pvd solution.pvd 'timestep="0"' 'timestep="0.004"' \
  'timestep="0.008"' 'solution-000002.vtu'

# --- on a terminal ---

on_terminal() {
  script -qec "TERM=xterm $*" /dev/null </dev/null | tr '\r' '\n'
}
command=("'$acf'" --output-directory terminal --set "'Output/VTU interval=0'" \
  --set "'Time integration/End time=0.01'" "'$pendulum'")
on_terminal "${command[@]}" >terminal.txt
expect_text terminal.txt 'progress on a terminal' '[####################] 0.01 of 0.01 s, step 10' ' per s'
on_terminal "'$acf'" missing.prm >terminal.txt
expect_text terminal.txt 'an error on a terminal' $'\033[31macf-dealii:\033[0m'
on_terminal NO_COLOR=1 "'$acf'" missing.prm >terminal.txt
check 'colours in spite of NO_COLOR' [ -z "$(grep $'\033' terminal.txt)" ]
expect_text terminal.txt 'an error without colours' 'acf-dealii: missing.prm'
rm -r terminal terminal.txt

header='time [s],chord.angle [rad],chord.deflection [m],tip.x [m],tip.y [m],tip.z [m]'
header+=',energy.kinetic [J],energy.elastic [J],energy.potential [J]'
check "header: $(head -n 1 dense/probes.csv)" [ "$(head -n 1 dense/probes.csv)" = "$header" ]
check 'times of the probes' awk -F, '
  NR > 1 { if (($1 - 0.0015 * (NR - 2))^2 > 1e-24) wrong = 1 }
  END    { exit wrong || NR != 9 }' dense/probes.csv

# At ends of steps (3, 6, 9 ms) the values are those of the steps, to the
# rounding of the times; between them, those of a run with half the step size up
# to the error of the method. A straight line over the step would be wrong by
# 9.81 m/s^2 (1 ms)^2 / 8 = 1.2e-6 m.
compare() {
  awk -F, -v tolerance="$1" '
    FNR == 1 { next }
    NR == FNR { for (i = 2; i <= NF; ++i) value[sprintf("%.9f", $1), i] = $i; next }
    { key = sprintf("%.9f", $1) }
    (key, 2) in value {
      ++n
      for (i = 2; i <= 6; ++i) {
        difference = $i - value[key, i]
        if (difference^2 > tolerance^2) { print key, i, difference; wrong = 1 }
      }
    }
    END { exit wrong || n < 4 }' "$2" "$3"
}
check 'probes at ends of steps' compare 1e-11 every/probes.csv dense/probes.csv
expect_status 0 --output-directory half "${no_vtu[@]}" --set 'Time integration/Step size=5e-4' \
  --set "$(until_time 0.0105)" "$pendulum"
check 'probes between ends of steps' compare 5e-7 half/probes.csv dense/probes.csv

# An end in the first half of a step: one row per step, and one at the end.
expect_status 0 --output-directory early "${no_vtu[@]}" --set "$(until_time 0.0032)" "$pendulum"
check "times with an end within a step: $(cut -d, -f1 early/probes.csv | tr '\n' ' ')" \
  [ "$(cut -d, -f1 early/probes.csv | tail -n +2 | tr '\n' ' ')" = '0 0.001 0.002 0.003 0.0032 ' ]

# --- the same again ---

expect_status 0 --threads 2 --quiet --output-directory again dense/used_parameters.prm
check '--quiet prints something' [ ! -s stdout ]
check '--quiet prints errors' [ ! -s stderr ]
check 'used_parameters.prm gives other probes' cmp dense/probes.csv again/probes.csv
check 'used_parameters.prm does not reproduce itself' \
  cmp dense/used_parameters.prm again/used_parameters.prm
expect_status 0 --threads 1 --quiet --output-directory one "${no_vtu[@]}" \
  --set "$(until_time 0.01)" "$pendulum"
check 'one thread gives other results than two' compare 1e-11 every/probes.csv one/probes.csv

# --- what nobody asks for is not done ---

cat >drop.prm <<'END'
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
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 0.1
  set Step size = 0.01
end
END
expect_status 0 --set 'Validity/Action=ignore' drop.prm
check 'nobody watches the validity, but something is said of it' [ -z "$(grep Validity stdout)" ]
check 'figures of the validity that nobody has watched' \
  [ -z "$(grep '"validity"' drop-results/statistics.json)" ]
expect_files drop-results statistics.json used_parameters.prm
for counter in 'vtu files' 'probe rows' 'stress evaluations' 'validity checks' 'constraint factorisations' 'marker factorisations' constraints real \
  'rejected steps' 'joint column memory \[B\]'; do
  expect_statistic drop-results "$counter" 0
done
expect_statistic drop-results steps 10

# --- the validity of the strain ---

# 11 states, as ten steps are fewer than the hundred checks of a run
expect_status 0 drop.prm
expect_text stdout 'a rigid fall' 'Validity: all bodies stayed within the limits'
expect_statistic drop-results 'validity checks' 11

# The pendulum bends from the first step on; its first check is at the start.
soft=(--quiet "${no_vtu[@]}" --set "$(until_time 0.01)" --set 'Validity/Strain=1e-6')
expect_status 0 --output-directory warns "${soft[@]}" "$pendulum"
check '--quiet prints more than warnings' [ ! -s stdout ]
expect_one_line 'a body beyond its limits'
expect_text stderr 'a body beyond its limits' "acf-dealii: warning: the body 'pendulum' at time 0.001 s" \
  '(limit 1e-06)'
expect_statistic warns finished true
expect_statistic warns 'validity checks' 11
expect_status 1 --output-directory stops "${soft[@]}" --set 'Validity/Action=stop' "$pendulum"
expect_one_line 'a body beyond its limits, and stop'
expect_text stderr 'a body beyond its limits, and stop' "'Validity/Action'" "body 'pendulum' at time 0.001 s" \
  '(limit 1e-06)' 'results up to time'
expect_statistic stops finished false
expect_statistic stops steps 1
check 'rows of a run that was stopped' [ "$(wc -l <stops/probes.csv)" -eq 3 ]

# --- failures ---

# Two iterations do not reach a tolerance at the limit of the arithmetic once the
# pendulum moves.
expect_status 1 --output-directory fails "${no_vtu[@]}" --set 'Validity/Action=ignore' --set 'Time integration/Step size=5e-3' \
  --set 'Time integration/Maximal Newton iterations=2' \
  --set 'Time integration/Newton tolerance=1e-14' \
  --set 'Time integration/Maximal halvings=1' "$pendulum"
expect_one_line 'a step that fails'
expect_text stderr 'a step that fails' 'The step of' 's at time' 'failed after' 'halving' iteration "(worst for body 'pendulum'"
expect_files fails checkpoint.h5 probes.csv statistics.json used_parameters.prm
expect_statistic fails finished false
expect_statistic fails halvings '[1-9][0-9]*'
steps=$(sed -n 's/^ *"steps": \([0-9]*\),$/\1/p' fails/statistics.json)
check "rows of a failed run: $(wc -l <fails/probes.csv) for $steps steps" \
  [ "$(wc -l <fails/probes.csv)" -eq $((steps + 2)) ]
check "a failed run without steps" [ "$steps" -gt 0 ]

touch file
expect_status 1 --quiet --output-directory file/results drop.prm
expect_one_line 'a folder that cannot be made'
expect_text stderr 'a folder that cannot be made' 'output directory file/results'

# Nothing half-written is left.
check 'temporary files are left' [ -z "$(find . -name '*.tmp')" ]

finish
