// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// libFuzzer's entry points for model files; see tests/fuzz/run.

#define ACF_FUZZ_TARGET fuzz_model
#define ACF_FUZZ_SEEDS ACF_FUZZ "/seeds/model"

#include <fuzz/fuzzer_entry.h>
