// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/io/field_writer.h>

#include <tuple>

namespace ACF
{
  bool
  FieldKind::operator==(const FieldKind &other) const
  {
    return std::tie(name, n_components, double_precision, place) ==
           std::tie(other.name,
                    other.n_components,
                    other.double_precision,
                    other.place);
  }



  void
  FieldKind::exchange(Archive &archive)
  {
    archive("name", name);
    archive("components", n_components);
    archive("double precision", double_precision);
    archive("place", place);
  }
} // namespace ACF
