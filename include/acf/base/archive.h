// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_archive_h
#define acf_base_archive_h

#include <acf/base/types.h>

#include <Eigen/Core>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>

#include <H5Cpp.h>

namespace ACF
{
  /**
   * A group of an HDF5 file in which named values are kept. The same function
   * of a class saves and loads its values, so that both fit:
   * @code
   * void
   * Clock::exchange(Archive &archive)
   * {
   *   archive("ticks", ticks);
   *   archive("hands", hands); // a class with exchange(), or a list of them
   * }
   * @endcode
   * Numbers become attributes of the group, texts and vectors of numbers data
   * sets, everything else groups.
   *
   * The file begins with a block of 512 bytes of text, as HDF5 allows: what it
   * is, the version of its format, and length and sum (CRC-32) of what follows.
   * Nothing of a file that does not fit them is given to HDF5.
   */
  class Archive
  {
  public:
    using Content = std::function<void(Archive &)>;

    /** Of what is in the files. */
    static constexpr unsigned int format_version = 1;

    /**
     * Writes a file, see write_file(), and waits until it is on the disk.
     * @throws SimulationError
     */
    static void
    save(const std::filesystem::path &file, const Content &content);

    /**
     * Reads a file.
     * @throws InputError if the file does not exist, is incomplete or damaged,
     * has another format, or lacks something
     */
    static void
    load(const std::filesystem::path &file, const Content &content);

    bool
    is_loading() const
    {
      return loading;
    }

    /** Whether there is a group of this name. */
    bool
    has(const std::string &name) const;

    /** Saves or loads. */
    template <typename T>
    void
    operator()(const std::string &name, T &value);

    template <typename T>
    void
    operator()(const std::string &name, std::vector<T> &values);

    template <typename T>
    void
    operator()(const std::string &name, std::deque<T> &values)
    {
      exchange_list(name, values);
    }

    void
    operator()(const std::string &name, std::string &value);

    void
    operator()(const std::string &name, std::vector<bool> &values);

    void
    operator()(const std::string &name, NodalVector &vector);

    void
    operator()(const std::string &name, Eigen::VectorXd &vector);

    void
    operator()(const std::string &name, Eigen::MatrixXd &matrix);

  private:
    Archive(const H5::Group &group, const bool loading);

    Archive
    open_group(const std::string &name);

    void
    exchange_attribute(const std::string &name,
                       const H5::DataType &type,
                       void *value);

    /** @param resize returns where the given number of values is or goes */
    void
    exchange_dataset(const std::string &name,
                     const H5::DataType &type,
                     const std::size_t n_values,
                     const std::function<void *(std::size_t)> &resize);

    template <typename List>
    void
    exchange_list(const std::string &name, List &values);

    H5::Group group;
    bool loading;
  };



  namespace internal
  {
    /** The type in which a number is kept. */
    template <typename T>
    using KeptNumber =
      std::conditional_t<std::is_floating_point<T>::value,
                         double,
                         std::conditional_t<std::is_signed<T>::value,
                                            std::int64_t,
                                            std::uint64_t>>;

    template <typename T>
    const H5::PredType &
    number_type()
    {
      if constexpr (std::is_floating_point<T>::value)
        return H5::PredType::NATIVE_DOUBLE;
      else if constexpr (std::is_signed<T>::value)
        return H5::PredType::NATIVE_INT64;
      else
        return H5::PredType::NATIVE_UINT64;
    }
  } // namespace internal



  template <typename T>
  void
  Archive::operator()(const std::string &name, T &value)
  {
    if constexpr (std::is_enum<T>::value)
      {
        auto number = static_cast<std::int64_t>(value);
        (*this)(name, number);
        value = static_cast<T>(number);
      }
    else if constexpr (std::is_arithmetic<T>::value)
      {
        internal::KeptNumber<T> kept = value;
        exchange_attribute(name, internal::number_type<T>(), &kept);
        value = static_cast<T>(kept);
      }
    else
      {
        Archive part = open_group(name);
        value.exchange(part);
      }
  }



  template <typename T>
  void
  Archive::operator()(const std::string &name, std::vector<T> &values)
  {
    if constexpr (std::is_arithmetic<T>::value)
      {
        std::vector<internal::KeptNumber<T>> kept(values.begin(), values.end());
        exchange_dataset(name,
                         internal::number_type<T>(),
                         kept.size(),
                         [&](const std::size_t n) {
                           kept.resize(n);
                           return kept.data();
                         });
        values.assign(kept.begin(), kept.end());
      }
    else
      exchange_list(name, values);
  }



  template <typename List>
  void
  Archive::exchange_list(const std::string &name, List &values)
  {
    Archive part          = open_group(name);
    std::uint64_t n_items = values.size();
    part("size", n_items);
    values.resize(n_items);
    for (std::uint64_t k = 0; k < n_items; ++k)
      part(std::to_string(k), values[k]);
  }
} // namespace ACF

#endif
