// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/base/hdf5_image.h>

#include <zlib.h>

#include <cstdio>
#include <sstream>

namespace ACF
{
  namespace
  {
    constexpr std::size_t block_size = 512;
    constexpr char first_line[]      = "acf-dealii checkpoint";



    unsigned long
    sum_of(const std::string &image)
    {
      return crc32_z(0,
                     reinterpret_cast<const Bytef *>(image.data()),
                     image.size());
    }



    // Ends in a line of its own, for those who look at the file.
    std::string
    text_block(const std::string &image)
    {
      std::ostringstream text;
      text << first_line << "\nformat " << Archive::format_version << "\nbytes "
           << image.size() << "\ncrc32 " << sum_of(image)
           << "\nHDF5 data begin at byte " << block_size << "\n";
      std::string block = text.str();
      block.resize(block_size - 1, ' ');
      return block + "\n";
    }



    // The part of a file that is HDF5's, if the file is whole.
    std::string
    checked_image(const std::filesystem::path &file)
    {
      const std::string content = read_file(file);
      const auto refuse         = [&](const std::string &found) {
        throw InputError(file.string() + ": found " + found +
                         "; allowed: a checkpoint of this program");
      };
      std::istringstream text(content.substr(0, block_size));
      std::string line, word;
      unsigned int version = 0;
      std::size_t n_bytes  = 0;
      unsigned long sum    = 0;
      std::getline(text, line);
      if (line != first_line)
        refuse(content.empty() ? "an empty file" : "something else");
      text >> word >> version;
      if (text && version != Archive::format_version)
        refuse("a checkpoint of format " + std::to_string(version) +
               " (this program: " + std::to_string(Archive::format_version) +
               ")");
      text >> word >> n_bytes >> word >> sum;
      if (!text || content.size() < block_size ||
          content.size() - block_size < n_bytes)
        refuse("an incomplete checkpoint of " + std::to_string(content.size()) +
               " bytes");
      const std::string image = content.substr(block_size);
      if (image.size() != n_bytes || sum_of(image) != sum)
        refuse("a damaged checkpoint");
      return image;
    }
  } // namespace



  Archive::Archive(const H5::Group &group, const bool loading)
    : group(group)
    , loading(loading)
  {}



  void
  Archive::save(const std::filesystem::path &file, const Content &content)
  {
    const std::string image = hdf5_image(file, [&](H5::H5File &h5) {
      Archive archive(h5.openGroup("/"), false);
      content(archive);
    });
    write_file(file, text_block(image) + image, true);
  }



  void
  Archive::load(const std::filesystem::path &file, const Content &content)
  {
    H5::Exception::dontPrint();
    std::string image = checked_image(file);
    try
      {
        const H5::FileAccPropList properties = hdf5_in_memory();
        if (H5Pset_file_image(properties.getId(), image.data(), image.size()) <
            0)
          throw H5::FileIException("H5Pset_file_image", "no image");
        // HDF5 refuses the name of a file that exists
        const H5::H5File h5(file.string() + " in memory",
                            H5F_ACC_RDONLY,
                            H5::FileCreatPropList::DEFAULT,
                            properties);
        Archive archive(h5.openGroup("/"), true);
        content(archive);
      }
    catch (const H5::Exception &error)
      {
        throw InputError(
          file.string() + ": found a checkpoint that lacks something (" +
          error.getDetailMsg() + "); allowed: a checkpoint of this program");
      }
  }



  bool
  Archive::has(const std::string &name) const
  {
    return group.nameExists(name);
  }



  Archive
  Archive::open_group(const std::string &name)
  {
    return Archive(loading ? group.openGroup(name) : group.createGroup(name),
                   loading);
  }



  void
  Archive::exchange_attribute(const std::string &name,
                              const H5::DataType &type,
                              void *value)
  {
    if (loading)
      group.openAttribute(name).read(type, value);
    else
      group.createAttribute(name, type, H5::DataSpace(H5S_SCALAR))
        .write(type, value);
  }



  void
  Archive::exchange_dataset(const std::string &name,
                            const H5::DataType &type,
                            const std::size_t n_values,
                            const std::function<void *(std::size_t)> &resize)
  {
    if (loading)
      {
        const H5::DataSet data = group.openDataSet(name);
        const std::size_t size = data.getSpace().getSimpleExtentNpoints();
        void *const values     = resize(size);
        if (size > 0)
          data.read(values, type);
        return;
      }
    const hsize_t size = n_values;
    const H5::DataSet data =
      group.createDataSet(name, type, H5::DataSpace(1, &size));
    if (size > 0)
      data.write(resize(size), type);
  }



  void
  Archive::operator()(const std::string &name, std::string &value)
  {
    if (loading)
      {
        const H5::DataSet data = group.openDataSet(name);
        data.read(value, data.getDataType());
        return;
      }
    // of a fixed length, of which HDF5 wants at least one; an attribute would
    // be limited to 64 kB
    const H5::StrType type(H5::PredType::C_S1,
                           std::max<std::size_t>(1, value.size()));
    group.createDataSet(name, type, H5::DataSpace(H5S_SCALAR))
      .write(value, type);
  }



  void
  Archive::operator()(const std::string &name, std::vector<bool> &values)
  {
    std::vector<unsigned int> numbers(values.begin(), values.end());
    (*this)(name, numbers);
    values.assign(numbers.begin(), numbers.end());
  }



  void
  Archive::operator()(const std::string &name, NodalVector &vector)
  {
    exchange_dataset(name,
                     H5::PredType::NATIVE_DOUBLE,
                     vector.size(),
                     [&](const std::size_t n) {
                       if (n != vector.size())
                         vector.reinit(n);
                       return vector.data();
                     });
  }



  void
  Archive::operator()(const std::string &name, Eigen::VectorXd &vector)
  {
    exchange_dataset(name,
                     H5::PredType::NATIVE_DOUBLE,
                     vector.size(),
                     [&](const std::size_t n) {
                       vector.resize(n);
                       return vector.data();
                     });
  }



  void
  Archive::operator()(const std::string &name, Eigen::MatrixXd &matrix)
  {
    Archive part         = open_group(name);
    std::uint64_t n_rows = matrix.rows();
    Eigen::VectorXd values =
      Eigen::Map<Eigen::VectorXd>(matrix.data(), matrix.size());
    part("rows", n_rows);
    part("values", values);
    if (loading)
      matrix =
        Eigen::Map<Eigen::MatrixXd>(values.data(),
                                    n_rows,
                                    n_rows == 0 ? 0 : values.size() / n_rows);
  }
} // namespace ACF
