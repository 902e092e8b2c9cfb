#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Short runs of the crankshaft, the gear shaft and the robot arm against the hand
# calculations beside them (prm/*/rigid.py, beam.py), whose tolerances are here.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

quick=(--quiet --set 'Output/VTU interval=0')

# Compares by a script of a model: by_hand STATUS SCRIPT ARGUMENTS ...
by_hand() {
  local expected=$1 status
  shift
  python3 "$top/prm/$1" "${@:2}" >by_hand.txt 2>stderr
  status=$?
  check "$1: exit status $status instead of $expected: $(cat by_hand.txt)" [ "$status" -eq "$expected" ]
}

# --- gear shaft ---

# Lever rule, and the first bending frequency: 1.0 % below that of the beam, whose
# wheel is rigid.
gear=$top/prm/gear-shaft/gear-shaft.prm
expect_status 0 --output-directory gear "${quick[@]}" --set 'Time integration/End time=0.005' "$gear"
by_hand 0 gear-shaft/beam.py gear/probes.csv --modes gear/modes.csv --tolerance 0.015
# the motor drives against the torque of the teeth, 400 N m and 5 % of it
check 'torque of the motor' awk -F, '
  NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "torque.moment x [N m]") column = k; next }
  { sum += $column; ++n }
  END { exit !(n == 21 && sum / n < -380 && sum / n > -420) }' gear/probes.csv
# Steel that is too heavy by 15 % lowers the frequency by 7 %.
expect_status 0 --output-directory heavy "${quick[@]}" --set 'Time integration/End time=0' \
  --set 'Bodies/shaft/Density=9000' "$gear"
by_hand 1 gear-shaft/beam.py heavy/probes.csv --modes heavy/modes.csv --tolerance 0.015

# --- crankshaft ---

# The forces of rigid bodies, when strong damping has ended the vibrations of the
# start, and the torsional frequency of Ker Wilson's formula. The forces differ by
# 0.6 %, the small lateral force of the bearings by 4.2 %.
damped=()
for body in crankshaft rod piston; do damped+=(--set "Bodies/$body/Stiffness damping=1e-4"); done
expect_status 0 --output-directory crank "${quick[@]}" "${damped[@]}" --set 'Time integration/End time=0.008' \
  --set 'Time integration/Step size=4e-4' "$top/prm/crankshaft/crankshaft.prm"
by_hand 0 crankshaft/rigid.py crank/probes.csv --from 0.002 --modes crank/modes.csv --tolerance 0.06
# rows that claim to be ten times as early
sed 's/^0\.00\([1-7]\)/0.000\1/' crank/probes.csv >wrong.csv
by_hand 1 crankshaft/rigid.py wrong.csv --tolerance 0.06

# --- robot arm ---

# At rest in equilibrium; the elastic arm hangs lower by half a millimetre.
arm=$top/prm/robot-arm/robot-arm.prm
expect_status 0 --output-directory rest "${quick[@]}" --set 'Modes/Number=0' --set 'Time integration/End time=0.003' \
  --set 'Joints/base/Angle=0*t' --set 'Joints/shoulder/Angle=0*t' --set 'Joints/elbow/Angle=0*t' "$arm"
by_hand 0 robot-arm/rigid.py rest/probes.csv --tolerance 0.002

# Torques of rigid inverse dynamics in a smooth move of 0.4 s, damped; the first
# vibration, of 17 Hz, is still seen.
damped=()
for body in column 'upper arm' forearm; do damped+=(--set "Bodies/$body/Stiffness damping=2e-3"); done
smooth='(t < 0.4 ? (t/0.4)^3*(10 - 15*t/0.4 + 6*(t/0.4)^2) : 1)'
expect_status 0 --output-directory arm "${quick[@]}" "${damped[@]}" --set 'Modes/Number=0' \
  --set 'Time integration/End time=0.6' --set 'Time integration/Step size=1e-2' \
  --set "Joints/base/Angle=1.5*$smooth" --set "Joints/shoulder/Angle=-0.7*$smooth" \
  --set "Joints/elbow/Angle=0.5*$smooth" "$arm"
by_hand 0 robot-arm/rigid.py arm/probes.csv --tolerance 0.06
by_hand 1 robot-arm/rigid.py arm/probes.csv --tolerance 0.02

finish
