// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_side_names_h
#define acf_mechanics_side_names_h

#include <array>
#include <string>

namespace ACF
{
  /**
   * The two sides of "BODY: SURFACE, BODY: SURFACE" or "BODY: SURFACE, ground",
   * by their texts.
   * @throws InputError if there are not two different ones
   */
  std::array<std::string, 2>
  split_sides(const std::string &text,
              const std::string &section,
              const std::string &entry = "Between");
} // namespace ACF

#endif
