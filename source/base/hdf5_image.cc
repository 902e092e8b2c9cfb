// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/hdf5_image.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // A closed file cannot be asked for it.
    std::string
    image_of(H5::H5File &file)
    {
      file.flush(H5F_SCOPE_GLOBAL);
      const ssize_t size = H5Fget_file_image(file.getId(), nullptr, 0);
      std::string image(std::max<ssize_t>(size, 0), 0);
      if (size < 0 ||
          H5Fget_file_image(file.getId(), image.data(), image.size()) < 0)
        throw H5::FileIException("H5Fget_file_image", "no image");
      return image;
    }
  } // namespace



  H5::FileAccPropList
  hdf5_in_memory()
  {
    H5::FileAccPropList properties;
    properties.setCore(1 << 20, false);
    return properties;
  }



  std::string
  hdf5_image(const std::filesystem::path &file,
             const std::function<void(H5::H5File &)> &fill,
             const bool compact)
  {
    H5::Exception::dontPrint();
    try
      {
        // In the oldest format: newer ones sum up their first bytes, and the
        // flag of an open file, which is not in the image, is in that sum.
        H5::FileCreatPropList creation;
        if (compact)
          {
            creation.setIstorek(1);
            creation.setSymk(2, 2);
          }
        H5::H5File h5(file.string(), H5F_ACC_TRUNC, creation, hdf5_in_memory());
        fill(h5);
        return image_of(h5);
      }
    catch (const H5::Exception &error)
      {
        throw SimulationError("The file '" + file.string() +
                              "' cannot be written: HDF5 says '" +
                              error.getDetailMsg() + "'.");
      }
  }
} // namespace ACF
