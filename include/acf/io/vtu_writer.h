// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_vtu_writer_h
#define acf_io_vtu_writer_h

#include <acf/io/field_writer.h>
#include <acf/mechanics/multibody_system.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /**
   * Writes VTU files, of which each contains points and cells, too, and a list
   * of them in the form of ParaView (PVD). ParaView reads them from version
   * 5.10 on (VTK 9.1).
   */
  class VtuWriter : public FieldWriter
  {
  public:
    /**
     * @param system lives longer than this object
     * @param points of the nodes of all bodies, m
     * @param directory where to write; exists
     * @param list name of the list
     */
    VtuWriter(const MultibodySystem &system,
              const SystemVector &points,
              const std::filesystem::path &directory,
              const std::string &list);

    void
    write(const std::string &name,
          const std::vector<OutputField> &fields,
          const double time) override;

    void
    exchange(Archive &archive) override;

  private:
    void
    write_list() const;

    const MultibodySystem &system;
    const std::filesystem::path directory;
    const std::string list;

    /** Of each body: the XML elements that are the same in all files, points
     * and cells, and the index of the body in each cell. */
    std::vector<std::string> geometries;
    std::vector<std::string> indices;

    std::vector<std::pair<double, std::string>> times_and_names;
  };
} // namespace ACF

#endif
