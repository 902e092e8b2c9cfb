// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_xdmf_writer_h
#define acf_io_xdmf_writer_h

#include <acf/io/field_writer.h>
#include <acf/mechanics/multibody_system.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ACF
{
  /**
   * Writes the values of fields into HDF5 files, one for each time, points and
   * cells once into NAME-mesh.h5, and the list NAME.xdmf that describes them in
   * the form of XDMF: a collection of times, each with a grid per body.
   *
   * In all files the group `body0` belongs to the first body, and so on. The
   * same content gives the same bytes.
   */
  class XdmfWriter : public FieldWriter
  {
  public:
    /**
     * @param system lives longer than this object
     * @param points of the nodes of all bodies, m
     * @param directory where to write; exists
     * @param name of the list, without its extension
     */
    XdmfWriter(const MultibodySystem &system,
               const SystemVector &points,
               const std::filesystem::path &directory,
               const std::string &name);

    void
    write(const std::string &name,
          const std::vector<OutputField> &fields,
          const double time) override;

    void
    exchange(Archive &archive) override;

  private:
    struct Entry
    {
      double time;
      std::string file;

      /** Which of the layouts the file has. */
      unsigned int layout;
    };

    /** The file of points and cells, which is needed before the list. */
    void
    write_mesh() const;

    /** The XML elements of an entry. */
    std::string
    description(const Entry &entry) const;

    void
    write_list() const;

    const MultibodySystem &system;
    const SystemVector points;
    const std::filesystem::path directory;
    const std::string name;

    /** Of each body: the XML elements that are the same at all times. */
    std::vector<std::string> geometries;

    /** Lists of fields: one, unless a restart asks for others. */
    std::vector<std::vector<FieldKind>> layouts;

    std::vector<Entry> entries;

    /** Of all entries. */
    std::string descriptions;
    bool mesh_is_written = false;
  };
} // namespace ACF

#endif
