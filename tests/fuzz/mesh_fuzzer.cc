// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// libFuzzer's entry points for mesh files; see tests/fuzz/run.

#define ACF_FUZZ_TARGET fuzz_mesh
#define ACF_FUZZ_SEEDS ACF_FUZZ "/seeds/mesh"

#include <fuzz/fuzzer_entry.h>
