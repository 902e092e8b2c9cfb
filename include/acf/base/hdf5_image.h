// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_hdf5_image_h
#define acf_base_hdf5_image_h

#include <filesystem>
#include <functional>
#include <string>

#include <H5Cpp.h>

namespace ACF
{
  /** For HDF5 files that are in memory only. */
  H5::FileAccPropList
  hdf5_in_memory();

  /**
   * The bytes of an HDF5 file, made in memory, to be written by write_file().
   * @param file for messages
   * @param compact whether to leave little space for lists of chunks and of the
   * members of groups: for small files with data sets of one chunk each
   * @throws SimulationError with the reason of HDF5
   */
  std::string
  hdf5_image(const std::filesystem::path &file,
             const std::function<void(H5::H5File &)> &fill,
             const bool compact = false);
} // namespace ACF

#endif
