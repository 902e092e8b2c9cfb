// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_vtu_file_h
#define acf_tests_vtu_file_h

#include <deal.II/base/utilities.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gtest/gtest.h>

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <unit/output_test.h>

/** VTU files, read without VTK. */
namespace OutputTest
{
  using Tree = boost::property_tree::ptree;

  /** The values of a data array as VTK's format defines them. */
  template <typename Number>
  std::vector<Number>
  decode(const Tree &array, const std::string &type)
  {
    EXPECT_EQ(array.get<std::string>("<xmlattr>.type"), type);
    EXPECT_EQ(array.get<std::string>("<xmlattr>.format"), "binary");

    // 4 integers of 8 bytes are 44 characters, the last of them padding
    const std::string text = array.data();
    const std::vector<unsigned char> header =
      Utilities::decode_base64(text.substr(0, 44));
    const std::vector<unsigned char> packed =
      Utilities::decode_base64(text.substr(44));
    std::array<std::uint64_t, 4> sizes;
    EXPECT_EQ(header.size(), sizeof(sizes));
    std::memcpy(sizes.data(), header.data(), sizeof(sizes));
    EXPECT_EQ(sizes[0], 1U);
    EXPECT_EQ(sizes[2], 0U);
    EXPECT_EQ(sizes[3], packed.size());

    std::vector<Number> values(sizes[1] / sizeof(Number));
    uLongf n_bytes = sizes[1];
    EXPECT_EQ(uncompress(reinterpret_cast<unsigned char *>(values.data()),
                         &n_bytes,
                         packed.data(),
                         packed.size()),
              Z_OK);
    EXPECT_EQ(n_bytes, values.size() * sizeof(Number));
    return values;
  }

  /** What a file says of a body. */
  struct Piece
  {
    std::vector<Vector3> points;
    std::vector<std::vector<std::int64_t>> cells;
    std::vector<std::uint8_t> types;
    std::vector<std::int32_t> bodies;
    std::vector<Vector3> displacement;
    std::vector<Vector3> velocity;

    // single precision: values of all points or cells, one after the other
    std::map<std::string, std::vector<float>> more;
    std::set<std::string> fields;
  };

  template <typename Number>
  std::vector<Vector3>
  decode_vectors(const Tree &array, const std::string &type)
  {
    EXPECT_EQ(array.get<unsigned int>("<xmlattr>.NumberOfComponents"), dim);
    const std::vector<Number> values = decode<Number>(array, type);
    std::vector<Vector3> result;
    for (unsigned int i = 0; i + 2 < values.size(); i += dim)
      result.push_back(vector(values[i], values[i + 1], values[i + 2]));
    return result;
  }

  inline std::map<std::string, Tree>
  arrays(const Tree &parent)
  {
    std::map<std::string, Tree> result;
    for (const auto &[tag, child] : parent)
      if (tag == "DataArray")
        result[child.get<std::string>("<xmlattr>.Name")] = child;
    return result;
  }

  inline Piece
  read_piece(const Tree &tree)
  {
    Piece piece;
    piece.points =
      decode_vectors<double>(tree.get_child("Points.DataArray"), "Float64");

    const auto cells   = arrays(tree.get_child("Cells"));
    piece.types        = decode<std::uint8_t>(cells.at("types"), "UInt8");
    const auto offsets = decode<std::int64_t>(cells.at("offsets"), "Int64");
    const auto nodes = decode<std::int64_t>(cells.at("connectivity"), "Int64");
    std::int64_t first = 0;
    for (const std::int64_t end : offsets)
      {
        piece.cells.emplace_back(nodes.begin() + first, nodes.begin() + end);
        first = end;
      }
    EXPECT_EQ(first, std::int64_t(nodes.size()));
    piece.bodies =
      decode<std::int32_t>(arrays(tree.get_child("CellData")).at("body"),
                           "Int32");

    const auto fields = arrays(tree.get_child("PointData"));
    for (const auto &field : fields)
      piece.fields.insert(field.first);
    piece.displacement =
      decode_vectors<double>(fields.at("displacement"), "Float64");
    if (fields.count("velocity") > 0)
      piece.velocity = decode_vectors<float>(fields.at("velocity"), "Float32");
    for (const std::string place : {"PointData", "CellData"})
      for (const auto &[name, array] : arrays(tree.get_child(place)))
        if (name != "displacement" && name != "body")
          piece.more[name] = decode<float>(array, "Float32");

    EXPECT_EQ(tree.get<std::size_t>("<xmlattr>.NumberOfPoints"),
              piece.points.size());
    EXPECT_EQ(tree.get<std::size_t>("<xmlattr>.NumberOfCells"),
              piece.cells.size());
    EXPECT_EQ(piece.types.size(), piece.cells.size());
    EXPECT_EQ(piece.bodies.size(), piece.cells.size());
    EXPECT_EQ(piece.displacement.size(), piece.points.size());
    EXPECT_EQ(piece.velocity.size(),
              fields.count("velocity") * piece.points.size());
    return piece;
  }

  inline std::vector<Piece>
  read_vtu(const fs::path &file)
  {
    Tree tree;
    boost::property_tree::read_xml(file.string(), tree);
    // older versions mean another order of nodes
    EXPECT_EQ(tree.get<std::string>("VTKFile.<xmlattr>.version"), "2.2");
    EXPECT_EQ(tree.get<std::string>("VTKFile.<xmlattr>.header_type"), "UInt64");
    std::vector<Piece> pieces;
    for (const auto &[tag, child] : tree.get_child("VTKFile.UnstructuredGrid"))
      if (tag == "Piece")
        pieces.push_back(read_piece(child));
    return pieces;
  }
} // namespace OutputTest

#endif
