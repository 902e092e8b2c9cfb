#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Runs that are interrupted, fail or are done again: nothing is lost.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

pendulum=$top/prm/pendulum/pendulum.prm
short=(--quiet --threads 1 --set 'Bodies/pendulum/Cells=1, 4, 1' --set 'Output/VTU interval=0.005'
       --set 'Output/Probe interval=0.0015')
until_time() { printf '%s\n' "Time integration/End time=$1"; }

# Waits until there are some lines: wait_for_lines NUMBER FILE
wait_for_lines() {
  while [ ! -e "$2" ] || [ "$(wc -l <"$2")" -lt "$1" ]; do sleep 0.05; done
}

# An entry of a statistics.json: statistic FOLDER NAME
statistic() { sed -n "s/^ *\"$2\": \\([^,]*\\),\\?\$/\\1/p" "$1/statistics.json"; }

same_results() {
  local file
  # solution.pvd names the date
  for file in "$1"/probes.csv "$1"/solution*; do
    cmp -s <(grep -av '^#' "$file") <(grep -av '^#' "$2/$(basename "$file")") ||
      { echo "$file differs"; return 1; }
  done
  [ "$(ls "$1"/solution* | wc -l)" -eq "$(ls "$2"/solution* | wc -l)" ]
}

# --- in two parts as in one ---

expect_status 0 "${short[@]}" --output-directory whole --set "$(until_time 0.04)" "$pendulum"
check 'a checkpoint that nobody asked for' [ ! -e whole/checkpoint.h5 ]
expect_status 0 "${short[@]}" --output-directory parts --set "$(until_time 0.02)" \
  --set 'Output/Checkpoint interval=0.008' "$pendulum"
check 'the checkpoint is missing' [ -s parts/checkpoint.h5 ]
check 'the checkpoint before it is missing' [ -s parts/checkpoint-previous.h5 ]
check 'more checkpoints than two' [ "$(ls parts/*.h5 | wc -l)" -eq 2 ]
check 'checkpoints are not counted' [ "$(statistic parts checkpoints)" -eq 3 ]
cp -r parts other
cp -r parts moved
expect_status 0 "${short[@]}" --output-directory parts --set "$(until_time 0.04)" \
  --restart parts/checkpoint.h5 "$pendulum"
check 'a restart writes to stderr' [ ! -s stderr ]
check 'a restart from the end' same_results whole parts
check 'steps of both parts' [ "$(statistic parts steps)" -eq 40 ]
check 'restarts are not counted' [ "$(statistic parts restarts)" -eq 1 ]
# rows and files after the older checkpoint are written again
expect_status 0 "${short[@]}" --output-directory other --set "$(until_time 0.04)" \
  --restart other/checkpoint-previous.h5 "$pendulum"
check 'a restart from the older checkpoint' same_results whole other
# in another folder: only what comes later
expect_status 0 "${short[@]}" --output-directory elsewhere --set "$(until_time 0.04)" \
  --restart moved/checkpoint.h5 "$pendulum"
check 'rows in another folder' [ "$(tail -n +2 elsewhere/probes.csv)" = \
  "$(awk -F, 'NR > 1 && $1 > 0.02' whole/probes.csv)" ]
check 'files in another folder' [ "$(ls elsewhere/*.vtu | wc -l)" -eq 4 ]
check 'entries of the list in another folder' [ "$(grep -c DataSet elsewhere/solution.pvd)" -eq 4 ]
expect_status 0 --threads 1 --set 'Bodies/pendulum/Cells=1, 4, 1' --set "$(until_time 0.04)" \
  --output-directory said --restart moved/checkpoint.h5 "$pendulum"
expect_text stdout 'a restart' 'Continues at time 0.02 s from moved/checkpoint.h5'

# --- interrupted ---

long=("${short[@]}" --set "$(until_time 100)" --output-directory stopped "$pendulum")
for signal in TERM INT HUP; do
  rm -rf stopped
  # a script's background processes ignore SIGINT otherwise
  env --default-signal=INT "$acf" "${long[@]}" >stdout 2>stderr &
  process=$!
  wait_for_lines 20 stopped/probes.csv
  kill -$signal $process
  wait $process
  status=$?
  check "exit status $status of a run interrupted by SIG$signal" [ $status -eq 1 ]
  expect_one_line 'an interrupted run'
  expect_text stderr 'an interrupted run' "interrupted by SIG$signal at time" 'are kept' \
    '--restart stopped/checkpoint.h5'
  check 'an interrupted run is finished' [ "$(statistic stopped finished)" = false ]
  check 'no checkpoint of an interrupted run' [ -s stopped/checkpoint.h5 ]
done
rm -rf stopped
"$acf" "${long[@]}" >stdout 2>stderr &
process=$!
wait_for_lines 5 stopped/probes.csv
kill -INT $process
sleep 0.1
check 'an ignored signal ends the program' kill -0 $process
kill -KILL $process
wait $process 2>/dev/null
# nothing goes on there that would remove a file that was being written
rm -rf stopped

# --- killed ---

expect_status 0 "${short[@]}" --output-directory long --set "$(until_time 0.5)" "$pendulum"
"$acf" "${short[@]}" --set "$(until_time 0.5)" --set 'Output/Checkpoint interval=0.01' \
  --output-directory killed "$pendulum" >stdout 2>stderr &
process=$!
while [ ! -e killed/checkpoint-previous.h5 ] && kill -0 $process 2>/dev/null; do :; done
kill -KILL $process
wait $process 2>/dev/null
check 'the run was over before it was killed' [ ! -e killed/statistics.json ]
expect_status 0 "${short[@]}" --set "$(until_time 0.5)" --output-directory killed \
  --restart killed/checkpoint.h5 "$pendulum"
check 'a restart after kill -9' same_results long killed

# --- what is no checkpoint of the model ---

# A restart is refused and touches nothing: expect_refused TEXT END_TIME ARGUMENTS ...
expect_refused() {
  local text=$1 end=$2 before
  shift 2
  before=$(cat moved/probes.csv moved/statistics.json | cksum)
  expect_status 2 "${short[@]}" --output-directory moved --set "$(until_time "$end")" "$@" "$pendulum"
  expect_one_line "$text"
  expect_text stderr "$*" "$text"
  check "$*: results are touched" [ "$(cat moved/probes.csv moved/statistics.json | cksum)" = "$before" ]
}
expect_refused 'nothing.h5: cannot be read: it does not exist' 0.04 --restart nothing.h5
expect_refused 'found something else; allowed: a checkpoint' 0.04 --restart moved/probes.csv
head -c 20000 moved/checkpoint.h5 >truncated.h5
expect_refused 'found an incomplete checkpoint of 20000 bytes' 0.04 --restart truncated.h5
expect_refused "entry 'Density': found '1'; allowed: '7800' as in the checkpoint" 0.04 \
  --restart moved/checkpoint.h5 --set 'Bodies/pendulum/Density=1'
expect_refused "entry 'End time': found 0.01; allowed: at least" 0.01 \
  --restart moved/checkpoint.h5
sed -i '2s/$/ /' moved/probes.csv
expect_refused 'moved/probes.csv: found other values' 0.04 --restart moved/checkpoint.h5
expect_status 2 --restart moved/checkpoint.h5 --overwrite "$pendulum"
expect_status 2 --restart moved/checkpoint.h5 --validate "$pendulum"

# --- failed, and continued with other settings ---

strict=(--quiet --threads 1 --set 'Output/VTU interval=0' --set 'Validity/Action=ignore' --set 'Time integration/Step size=5e-3' --set "$(until_time 0.1)")
expect_status 1 "${strict[@]}" --output-directory fails \
  --set 'Time integration/Maximal Newton iterations=2' \
  --set 'Time integration/Newton tolerance=1e-14' --set 'Time integration/Maximal halvings=1' "$pendulum"
expect_text stderr 'a step that fails' 'are kept' '--restart fails/checkpoint.h5 continues'
expect_status 0 "${strict[@]}" --output-directory fails --restart fails/checkpoint.h5 "$pendulum"
check 'the end of a continued run' [ "$(tail -n 1 fails/probes.csv | cut -d, -f1)" = 0.1 ]

# --- again in the same folder ---

cp whole/probes.csv first.csv
expect_status 0 "${short[@]}" --output-directory whole --set "$(until_time 0.01)" "$pendulum"
expect_one_line 'earlier results'
expect_text stderr 'earlier results' 'warning' 'moved to whole/earlier-1'
check 'earlier results are not kept' cmp first.csv whole/earlier-1/probes.csv
check 'a file of the earlier run is left' [ ! -e whole/solution-000007.vtu ]
expect_status 0 "${short[@]}" --overwrite --output-directory whole --set "$(until_time 0.01)" "$pendulum"
check '--overwrite warns' [ ! -s stderr ]
check '--overwrite moves results' [ ! -e whole/earlier-2 ]

# --- folders and disks ---

"$acf" --quiet --threads 1 --set 'Output/VTU interval=0' --set "$(until_time 100)" --output-directory gone "$pendulum" >stdout 2>stderr &
process=$!
wait_for_lines 10 gone/probes.csv
rm -rf gone
wait $process
status=$?
check "exit status $status of a run whose folder vanishes" [ $status -eq 1 ]
expect_one_line 'a folder that vanishes'
expect_text stderr 'a folder that vanishes' 'gone/' 'No such file' 'no checkpoint could be written'
touch file
expect_status 1 --quiet --output-directory file/results "$pendulum"
expect_one_line 'a folder that cannot be made'
expect_text stderr 'a folder that cannot be made' 'output directory file/results' 'Not a directory'

check 'temporary files are left' [ -z "$(find . -name '*.tmp')" ]

finish
