#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# The script that runs a model with several values of entries.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"
export PYTHONDONTWRITEBYTECODE=1

# Starts the script: sweep STATUS ARGUMENTS ...
sweep() {
  local expected=$1
  shift
  "$top/scripts/sweep" --program "$acf" "$@" >stdout 2>stderr
  status=$?
  check "exit status $status instead of $expected: $*" [ "$status" -eq "$expected" ]
}

# The script fails with one line: sweep_error TEXT ARGUMENTS ...
sweep_error() {
  local text=$1
  shift
  sweep 2 "$@"
  check "$*: $(wc -l <stderr) lines on stderr instead of one" [ "$(wc -l <stderr)" -eq 1 ]
  expect_text stderr "$*" 'sweep: ' "$text"
}

# A value of the table: value TABLE RUN COLUMN
value() {
  python3 -c 'import csv, sys
print(next(row for row in csv.DictReader(open(sys.argv[1])) if row["run"] == sys.argv[2])[sys.argv[3]])' "$@"
}

# expect_value TABLE RUN COLUMN VALUE
expect_value() {
  local found
  found=$(value "$1" "$2" "$3")
  check "$1, $2, $3: '$found' instead of '$4'" [ "$found" = "$4" ]
}

# A value of the table to 1e-9: expect_near TABLE RUN COLUMN VALUE
expect_near() {
  check "$1, $2, $3: '$(value "$1" "$2" "$3")' instead of '$4'" awk -v a="$(value "$1" "$2" "$3")" -v b="$4" \
    'BEGIN { exit !(a != "" && (a - b)^2 < 1e-18) }'
}

# A block that falls: -g t^2 / 2, exactly.
cat >fall.prm <<'END'
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
  set Gravity = 0, 0, -10
end
subsection Time integration
  set End time  = 0.2
  set Step size = 0.05
end
subsection Probes
  set Names = bottom
  subsection bottom
    set Of = block: z min
  end
end
END

# --- a grid of values, one of which is wrong ---

sweep 1 fall.prm --vary 'Time integration/Step size=0.05, 0.1, heavy' \
  --vary 'Loads/Gravity=0,0,-10|0,0,-2' --set 'Time integration/End time=0.4' -j 2 -o grid
check 'errors of the runs end up on stderr' [ ! -s stderr ]
expect_text stdout 'a sweep' '6 runs, 2 at the same time' 'grid/sweep.csv: 6 runs, 2 failed' \
  "found 'heavy'"
check "rows: $(wc -l <grid/sweep.csv)" [ "$(wc -l <grid/sweep.csv)" -eq 7 ]
check "header: $(head -n 1 grid/sweep.csv)" eval \
  "head -n 1 grid/sweep.csv | grep -q '^run,Time integration/Step size,Loads/Gravity,status,message,'"
while read -r run step gravity steps z; do
  expect_value grid/sweep.csv "$run" 'Time integration/Step size' "$step"
  expect_value grid/sweep.csv "$run" 'Loads/Gravity' "$gravity"
  expect_value grid/sweep.csv "$run" status 0
  expect_value grid/sweep.csv "$run" message ''
  expect_value grid/sweep.csv "$run" finished true
  expect_value grid/sweep.csv "$run" steps "$steps"
  expect_value grid/sweep.csv "$run" 'time [s] last' 0.4
  expect_near grid/sweep.csv "$run" 'bottom.z [m] last' "$z"
  expect_near grid/sweep.csv "$run" 'bottom.z [m] min' "$z"
  expect_near grid/sweep.csv "$run" 'bottom.z [m] max' 0
  check "files of $run" [ -s "grid/$run/probes.csv" ] && check "log of $run" [ -s "grid/$run.log" ]
done <<'END'
run-001 0.05 0,0,-10 8 -0.8
run-002 0.05 0,0,-2 8 -0.16
run-003 0.1 0,0,-10 4 -0.8
run-004 0.1 0,0,-2 4 -0.16
END
for run in run-005 run-006; do
  expect_value grid/sweep.csv $run status 2
  expect_value grid/sweep.csv $run steps ''
  expect_value grid/sweep.csv $run 'bottom.z [m] last' ''
  check "message of $run" eval "value grid/sweep.csv $run message | grep -q \"found 'heavy'\""
done

# --- the folder ---

sweep_error "the folder 'grid' is not empty" fall.prm --vary 'Time integration/Step size=0.1' -o grid
sweep 0 fall.prm --vary 'Time integration/Step size=0.1,0.2' -o grid --overwrite
check "an earlier sweep is left: $(ls grid)" [ "$(cd grid && echo *)" = 'run-001 run-001.log run-002 run-002.log sweep.csv' ]
expect_near grid/sweep.csv run-002 'bottom.z [m] last' -0.2
mkdir precious
touch precious/file
sweep_error 'has no sweep.csv' fall.prm --vary 'Time integration/Step size=0.1' -o precious --overwrite
check 'a file was deleted' [ -e precious/file ]

# --- what is wrong before any run ---

sweep_error 'found no option --vary' fall.prm -o new
sweep_error "allowed: 'Section/Entry=...'" fall.prm --vary 'Step size' -o new
sweep_error 'with an empty value' fall.prm --vary 'Time integration/Step size=0.1,' -o new
sweep_error 'with a value twice' fall.prm --vary 'Time integration/Step size=0.1,0.1' -o new
sweep_error 'allowed: different entries' fall.prm --vary 'Time integration/Step size=0.1' \
  --set 'Time integration/Step size=0.2' -o new
sweep_error 'there is no such model file' nowhere.prm --vary 'Time integration/Step size=0.1' -o new
sweep_error "--jobs: found '0'" fall.prm --vary 'Time integration/Step size=0.1' -o new -j 0
sweep_error 'the following arguments are required' fall.prm --vary 'Time integration/Step size=0.1'
check 'a folder of a sweep that never ran' [ ! -e new ]
"$top/scripts/sweep" --program nothing fall.prm --vary 'Time integration/Step size=0.1' -o new >stdout 2>stderr
check "exit status $? without the program" [ $? -eq 2 ]
expect_text stderr 'a sweep without the program' "--program: found 'nothing'"

finish
