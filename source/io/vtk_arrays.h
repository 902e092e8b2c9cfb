// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_vtk_arrays_h
#define acf_io_vtk_arrays_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace ACF
{
  /** Files of VTK: data arrays in XML. */
  namespace Vtk
  {
    static_assert(
      __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
      "The byte order of the VTU files is written as little endian");

    template <typename Number>
    constexpr const char *type_name = nullptr;
    template <>
    inline constexpr const char *type_name<double> = "Float64";
    template <>
    inline constexpr const char *type_name<float> = "Float32";
    template <>
    inline constexpr const char *type_name<std::int64_t> = "Int64";
    template <>
    inline constexpr const char *type_name<std::int32_t> = "Int32";
    template <>
    inline constexpr const char *type_name<std::uint8_t> = "UInt8";



    /** Begin and end of a file of cells; what is between are pieces. The
     * version stands for today's order of the nodes of Lagrange cells. */
    inline std::string
    file_begin()
    {
      return "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" "
             "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
             "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
    }

    inline std::string
    file_end()
    {
      return "</UnstructuredGrid>\n</VTKFile>\n";
    }



    /**
     * Bytes in VTK's form: base64 of the numbers of blocks (one), bytes per
     * block, bytes in an incomplete block (none) and compressed bytes; then
     * base64 of what zlib makes of the values.
     */
    inline std::string
    encode(const unsigned char *const bytes, const std::size_t n_bytes)
    {
      uLongf n_packed = compressBound(n_bytes);
      std::vector<unsigned char> packed(n_packed);
      const int status =
        compress2(packed.data(), &n_packed, bytes, n_bytes, Z_BEST_SPEED);
      AssertThrow(status == Z_OK, dealii::ExcInternalError());
      packed.resize(n_packed);

      const std::array<std::uint64_t, 4> sizes = {{1, n_bytes, 0, n_packed}};
      std::vector<unsigned char> header(sizeof(sizes));
      std::memcpy(header.data(), sizes.data(), header.size());
      return dealii::Utilities::encode_base64(header) +
             dealii::Utilities::encode_base64(packed);
    }



    template <typename Number>
    std::string
    data_array(const std::string &name,
               const unsigned int n_components,
               const std::vector<Number> &values)
    {
      return "<DataArray type=\"" + std::string(type_name<Number>) +
             "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(n_components) + "\" format=\"binary\">" +
             encode(reinterpret_cast<const unsigned char *>(values.data()),
                    values.size() * sizeof(Number)) +
             "</DataArray>\n";
    }

    template <typename Number, typename Values>
    std::string
    data_array(const std::string &name,
               const unsigned int n_components,
               const Values &values)
    {
      return data_array(name,
                        n_components,
                        std::vector<Number>(values.begin(), values.end()));
    }



    /** Texts, each followed by a zero. */
    inline std::string
    text_array(const std::string &name, const std::vector<std::string> &texts)
    {
      std::vector<unsigned char> bytes;
      for (const std::string &text : texts)
        {
          bytes.insert(bytes.end(), text.begin(), text.end());
          bytes.push_back(0);
        }
      return "<DataArray type=\"String\" Name=\"" + name +
             "\" NumberOfTuples=\"" + std::to_string(texts.size()) +
             "\" format=\"binary\">" + encode(bytes.data(), bytes.size()) +
             "</DataArray>\n";
    }
  } // namespace Vtk
} // namespace ACF

#endif
