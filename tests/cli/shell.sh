#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# The man page and the completion of bash know the options of the program.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

expect_status 0 --help
# "--option" or "--option VALUE"
sed -n 's/^  \(--[a-z]\S*\( \S\+\)\?\)  .*/\1/p' stdout | sort >options
check "options in --help: $(wc -l <options)" [ "$(wc -l <options)" -ge 8 ]

# --- man page ---

page=$top/doc/acf-dealii.1.in
awk '
  /^\.SH/ { inside = $2 == "OPTIONS" }
  inside && /^\.BI? \\-\\-[a-z]/ {
    sub(/^\.BI? /, ""); gsub(/"/, ""); gsub(/\\\(aq/, "\047"); gsub(/\\/, ""); print
  }' "$page" | tr -s ' ' | sort >man_options
check "options of the man page (>) are not those of --help (<): $(diff options man_options)" \
  cmp -s options man_options
if command -v groff >/dev/null; then
  groff -man -ww -Tutf8 "$page" >formatted 2>warnings
  check "groff warns: $(head -n 3 warnings)" [ ! -s warnings ]
  check 'the man page has no text' grep -q 'quadratic' formatted
fi

# --- completion ---

# shellcheck source=doc/completion/acf-dealii
. "$top/doc/completion/acf-dealii"
check 'no completion for acf-dealii' eval "complete -p acf-dealii | grep -q _acf_dealii"

# What is offered for the last word: offered WORD ...
offered() {
  COMP_WORDS=("$acf" "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _acf_dealii "$acf" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
  printf '%s\n' "${COMPREPLY[@]}" | sort
}

# expect_offer TEXT WORD ...: TEXT is all offers, separated by '|'.
expect_offer() {
  local expected=$1 found
  shift
  found=$(offered "$@" | paste -sd '|')
  check "offered for '$*': $found instead of $expected" [ "$found" = "$expected" ]
}

cut -d ' ' -f 1 options | sort >names
offered -- >offers
check "offered options (>) are not those of --help (<): $(diff names offers)" cmp -s names offers
# what takes a value is not followed by an option
while read -r name _; do
  check "$name is followed by an option" [ -z "$(offered "$name" --)" ]
done < <(grep ' ' options)

mkdir folder 'a folder'
cp "$top/prm/four-bar/four-bar.prm" 'four bar.prm'
touch other.txt checkpoint.h5 part.step plate.geo
expect_offer 'a folder|folder|four bar.prm' ''
expect_offer 'four bar.prm' --quiet 'four\ b'
expect_offer 'four bar.prm' --quiet "'four b"
expect_offer 'folder' --validate fol
expect_offer 'a folder|folder' --output-directory ''
expect_offer 'folder' --output-directory = f
expect_offer 'a folder|checkpoint.h5|folder' --restart ''
expect_offer 'a folder|folder|part.step|plate.geo' --inspect ''
expect_offer 'part.step' --inspect = pa
expect_offer '1' --threads 1
expect_offer '--output-directory|--overwrite' --quiet --o
expect_offer 'Loads/Gravity|Loads/Gravity factor' --set Loads/G
expect_offer "Bodies/body/Young's modulus" --set "\"Bodies/body/Y"
joints=$(sed -n '/^subsection Joints/,/^end/s/^  subsection //p' 'four bar.prm' |
  sed 's|.*|Joints/&/Type|' | sort | paste -sd '|')
found=$(offered --output-directory folder 'four\ bar.prm' --set Joints/ | grep '/Type$' | paste -sd '|')
check "entries of the model's joints: $found instead of $joints" \
  [ -n "$joints" -a "$found" = "$joints" ]
expect_offer '' --set 'Loads/Gravity' = ''

finish
