# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# shellcheck shell=bash disable=SC2034
#
# What the scripts of this folder share. Usage of each: SCRIPT EXECUTABLE TOP.
# Every failed check is reported; the exit status of the script says whether
# there were any. The scripts work in a temporary folder.
set -u
if [ $# -ne 2 ]; then
  echo "usage: $0 EXECUTABLE TOP_OF_THE_SOURCES" >&2
  exit 2
fi
acf=$(realpath "$1")
top=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

n_checks=0
n_failures=0

# Counts a check: check MESSAGE COMMAND ...
check() {
  local message=$1
  shift
  n_checks=$((n_checks + 1))
  if ! "$@"; then
    n_failures=$((n_failures + 1))
    echo "FAILED: $message"
    if [ -f stderr ]; then sed 's/^/  stderr: /' stderr | head -n 5; fi
  fi
}

# Starts the program; its output is in the files stdout and stderr.
run() {
  "$acf" "$@" >stdout 2>stderr
  status=$?
}

# Runs the program: expect_status STATUS ARGUMENTS ...
expect_status() {
  local expected=$1
  shift
  run "$@"
  check "exit status $status instead of $expected: $*" [ "$status" -eq "$expected" ]
}

# Looks for fixed strings in a file: expect_text FILE WHAT TEXT ...
expect_text() {
  local file=$1 what=$2 text
  shift 2
  for text in "$@"; do
    check "$what: '$file' does not contain: $text" grep -qF -- "$text" "$file"
  done
}

# The error of the last run is one line of the program's form.
expect_one_line() {
  check "$1: $(wc -l <stderr) lines on stderr instead of one" [ "$(wc -l <stderr)" -eq 1 ]
  check "$1: stderr does not begin with the program's name" grep -q '^acf-dealii: ' stderr
}

# The errors of the last run are lines of the program's form that name these
# lines of a file, in this order: expect_lines WHAT FILE LINE ...
expect_lines() {
  local what=$1 file=$2 lines
  shift 2
  check "$what: a line on stderr does not begin with the program's name" \
    [ -z "$(grep -v '^acf-dealii: ' stderr)" ]
  lines=$(sed -n "s|^acf-dealii: $file:\([0-9]*\):.*|\1|p" stderr | tr '\n' ' ')
  check "$what: errors in the lines $lines instead of $*" [ "$lines" = "$* " ]
}

# Changes good.prm by sed and expects a warning about it:
# expect_warning SED_SCRIPT TEXT ...
expect_warning() {
  local script=$1
  shift
  sed "$script" good.prm >doubtful.prm
  expect_status 0 --validate --quiet doubtful.prm
  expect_one_line "$script"
  expect_text stderr "$script" 'acf-dealii: warning: ' "$@"
}

# Changes good.prm by sed and expects an error in it:
# expect_error SED_SCRIPT LINE SECTION ENTRY FOUND ALLOWED [TEXT ...]
# An empty section, entry or line is not looked for.
expect_error() {
  local script=$1 line=$2 section=$3 entry=$4 found=$5 allowed=$6
  shift 6
  sed "$script" good.prm >wrong.prm
  check "the sed script changes nothing: $script" [ -n "$(diff good.prm wrong.prm)" ]
  expect_status 2 --validate wrong.prm
  expect_one_line "$script"
  check "$script: output on stdout" [ ! -s stdout ]
  expect_text stderr "$script" "acf-dealii: wrong.prm:${line:+$line: }" \
    ${section:+"section '$section'"} ${entry:+"entry '$entry'"} \
    "found $found" "allowed: $allowed" "$@"
}

# Prints the outcome and ends the script.
finish() {
  echo "$n_checks checks, $n_failures failed"
  [ "$n_failures" -eq 0 ] && [ "$n_checks" -gt 0 ]
  exit
}
