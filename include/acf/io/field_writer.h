// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_field_writer_h
#define acf_io_field_writer_h

#include <acf/base/archive.h>

#include <string>
#include <vector>

namespace ACF
{
  /** What kind of values a field has. */
  struct FieldKind
  {
    enum class Place
    {
      nodes,
      cells
    };

    std::string name;
    unsigned int n_components = 1;
    bool double_precision     = false;
    Place place               = Place::nodes;

    bool
    operator==(const FieldKind &other) const;

    void
    exchange(Archive &archive);
  };



  /** Values at the nodes or in the cells of all bodies, for one file. */
  struct OutputField
  {
    FieldKind kind;

    /** Of each body. */
    std::vector<std::vector<double>> values = {};
  };



  /**
   * Writes fields on all bodies into files for ParaView, in one format: a file
   * for each time, and a list of them, which is written anew after each.
   *
   * A body consists of quadratic cells (10-node tetrahedra or 27-node
   * hexahedra) that share their nodes; the value `body` of cells is its index.
   * A file gets its name when it is complete; before that, it ends in `.tmp`.
   */
  class FieldWriter
  {
  public:
    virtual ~FieldWriter() = default;

    /**
     * Writes fields, the first one being the vectors that warp, into a file and
     * makes it the last entry of the list.
     * @param name of the file, without its extension
     * @throws SimulationError if a file cannot be written; the list is as it
     * was then
     */
    virtual void
    write(const std::string &name,
          const std::vector<OutputField> &fields,
          const double time) = 0;

    /**
     * Saves or loads the entries of the list; loaded ones count if the file is
     * there, and the list is written.
     */
    virtual void
    exchange(Archive &archive) = 0;
  };
} // namespace ACF

#endif
