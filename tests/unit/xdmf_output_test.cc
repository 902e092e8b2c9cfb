// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/io/field_output.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include <unit/output_test.h>
#include <unit/vtu_file.h>

namespace
{
  using namespace ACF;
  using namespace OutputTest;
  namespace fs = std::filesystem;

  FieldOutputParameters
  xdmf_parameters(const std::vector<std::string> &fields = {"velocity"})
  {
    FieldOutputParameters parameters;
    parameters.format   = FieldOutputParameters::Format::xdmf;
    parameters.interval = 0.5;
    parameters.fields   = fields;
    return parameters;
  }

  /** An array of HDF5 and the sizes that the list says. */
  struct Array
  {
    std::vector<hsize_t> size;
    std::vector<double> values;
    bool double_precision;
  };

  // Reads what an element DataItem names, and compares both.
  Array
  read_array(const fs::path &folder, const Tree &parent)
  {
    const Tree &item       = parent.get_child("DataItem");
    const std::string text = item.data();
    const std::size_t end  = text.find(":/");
    const H5::H5File file((folder / text.substr(0, end)).string(),
                          H5F_ACC_RDONLY);
    const H5::DataSet data = file.openDataSet(text.substr(end + 1));
    Array array;
    array.size.resize(data.getSpace().getSimpleExtentNdims());
    data.getSpace().getSimpleExtentDims(array.size.data());
    array.values.resize(data.getSpace().getSimpleExtentNpoints());
    data.read(array.values.data(), H5::PredType::NATIVE_DOUBLE);
    array.double_precision = data.getDataType() == H5::PredType::NATIVE_DOUBLE;

    std::istringstream dimensions(
      item.get<std::string>("<xmlattr>.Dimensions"));
    for (const hsize_t n : array.size)
      {
        hsize_t said = 0;
        dimensions >> said;
        EXPECT_EQ(said, n) << text;
      }
    EXPECT_EQ(item.get<std::size_t>("<xmlattr>.Precision"),
              data.getDataType().getSize());
    EXPECT_EQ(item.get<std::string>("<xmlattr>.NumberType"),
              data.getTypeClass() == H5T_FLOAT ? "Float" : "Int");
    EXPECT_EQ(item.get<std::string>("<xmlattr>.Format"), "HDF");
    return array;
  }

  struct BodyGrid
  {
    std::string name;
    std::string topology;
    unsigned int n_cells;
    Array points, cells;
    std::map<std::string, Array> at_nodes, in_cells;
  };

  struct Time
  {
    double time;
    std::vector<BodyGrid> bodies;
  };

  std::vector<Tree>
  children(const Tree &parent, const std::string &tag)
  {
    std::vector<Tree> result;
    for (const auto &[name, child] : parent)
      if (name == tag)
        result.push_back(child);
    return result;
  }

  // The list and everything that it names.
  std::vector<Time>
  read_xdmf(const fs::path &list)
  {
    const fs::path folder = list.parent_path();
    Tree tree;
    boost::property_tree::read_xml(list.string(), tree);
    const Tree top = tree.get_child("Xdmf.Domain.Grid");
    EXPECT_EQ(top.get<std::string>("<xmlattr>.CollectionType"), "Temporal");
    std::vector<Time> result;
    for (const Tree &time : children(top, "Grid"))
      {
        EXPECT_EQ(time.get<std::string>("<xmlattr>.CollectionType"), "Spatial");
        result.push_back({time.get<double>("Time.<xmlattr>.Value"), {}});
        for (const Tree &grid : children(time, "Grid"))
          {
            BodyGrid body;
            body.name           = grid.get<std::string>("<xmlattr>.Name");
            const Tree topology = grid.get_child("Topology");
            body.topology = topology.get<std::string>("<xmlattr>.TopologyType");
            body.n_cells =
              topology.get<unsigned int>("<xmlattr>.NumberOfElements");
            body.cells  = read_array(folder, topology);
            body.points = read_array(folder, grid.get_child("Geometry"));
            for (const Tree &attribute : children(grid, "Attribute"))
              (attribute.get<std::string>("<xmlattr>.Center") == "Node"
                 ? body.at_nodes
                 : body
                     .in_cells)[attribute.get<std::string>("<xmlattr>.Name")] =
                read_array(folder, attribute);
            result.back().bodies.push_back(body);
          }
      }
    return result;
  }

  std::set<std::string>
  files_of(const unsigned int n_times)
  {
    std::set<std::string> files = {"solution.xdmf", "solution-mesh.h5"};
    for (unsigned int n = 0; n < n_times; ++n)
      files.insert("solution-00000" + std::to_string(n) + ".h5");
    return files;
  }

  // Writes some times.
  void
  observe(FieldOutput &output,
          const MultibodySystem &system,
          const std::vector<double> &times)
  {
    for (const double time : times)
      {
        SystemState state = system.initial_state();
        state.time        = time;
        for (NodalVector &x : state.positions)
          x.add(time);
        output.observe(state);
      }
  }
} // namespace



TEST(XdmfOutput, ContainsBodiesAndFields)
{
  auto shapes                  = all_shapes();
  shapes[1].name               = "a <b> & \"c\"";
  const MultibodySystem system = make_system(shapes);
  SystemState state            = system.initial_state();
  for (NodalVector &x : state.positions)
    for (unsigned int i = 0; i < x.size(); ++i)
      x[i] += 1e-4 * std::sin(i);

  const Directory directory("xdmf");
  Statistics statistics;
  StressPeaks peaks(system, statistics);
  FieldOutput output(system,
                     directory.path,
                     xdmf_parameters({"velocity",
                                      "von Mises stress",
                                      "peak von Mises stress",
                                      "stress",
                                      "strain",
                                      "joint forces"}),
                     &peaks,
                     statistics);
  output.observe(state);
  EXPECT_EQ(statistics.hdf5_files, 1U);
  EXPECT_EQ(statistics.vtu_files, 0U);
  EXPECT_EQ(directory.files(), files_of(1));

  const auto times = read_xdmf(directory.path / "solution.xdmf");
  ASSERT_EQ(times.size(), 1U);
  ASSERT_EQ(times[0].bodies.size(), shapes.size());
  for (unsigned int b = 0; b < shapes.size(); ++b)
    {
      const BodyGrid &body     = times[0].bodies[b];
      const bool is_hexahedral = b % 2 == 0;
      const NodalVector &start = system.bodies()[b].initial_positions();
      const hsize_t n_nodes    = start.size() / dim;
      EXPECT_EQ(body.name, shapes[b].name);
      EXPECT_EQ(body.topology,
                is_hexahedral ? "Hexahedron_27" : "Tetrahedron_10");
      EXPECT_EQ(body.cells.size,
                (std::vector<hsize_t>{body.n_cells,
                                      is_hexahedral ? 27U : 10U}));
      EXPECT_EQ(body.points.size, (std::vector<hsize_t>{n_nodes, dim}));
      EXPECT_TRUE(body.points.double_precision);

      // node 8 of a hexahedron and 4 of a tetrahedron are between the first two
      for (unsigned int c = 0; c < body.n_cells; ++c)
        {
          const double *cell  = &body.cells.values[c * body.cells.size[1]];
          const auto distance = [&](const unsigned int i,
                                    const unsigned int k) {
            return (node(start, cell[i]) - node(start, cell[k])).norm();
          };
          const unsigned int middle = is_hexahedral ? 8 : 4;
          EXPECT_NEAR(distance(0, middle), distance(0, 1) / 2, 1e-12);
          EXPECT_NEAR(distance(1, middle), distance(0, 1) / 2, 1e-12);
        }
      EXPECT_EQ(body.in_cells.at("body").values,
                std::vector<double>(body.n_cells, b));

      const Array &displacement = body.at_nodes.at("displacement");
      EXPECT_TRUE(displacement.double_precision);
      for (unsigned int i = 0; i < start.size(); ++i)
        {
          EXPECT_EQ(body.points.values[i], start[i]);
          EXPECT_EQ(displacement.values[i], state.positions[b][i] - start[i]);
          EXPECT_EQ(body.at_nodes.at("velocity").values[i],
                    float(state.velocities[b][i]));
        }
      EXPECT_FALSE(body.at_nodes.at("velocity").double_precision);
      for (const auto &[name, n_components] :
           {std::pair<std::string, hsize_t>("von_mises_stress", 1),
            {"peak_von_mises_stress", 1},
            {"stress", 6},
            {"strain", 6},
            {"joint_force", 3}})
        EXPECT_EQ(body.at_nodes.at(name).size,
                  (std::vector<hsize_t>{n_nodes, n_components}));
      EXPECT_EQ(body.at_nodes.size(), 7U);
      EXPECT_EQ(body.in_cells.at("largest_von_mises_stress").size,
                (std::vector<hsize_t>{body.n_cells, 1}));
      EXPECT_EQ(body.in_cells.at("cell_stress").size,
                (std::vector<hsize_t>{body.n_cells, 6}));
      EXPECT_EQ(body.in_cells.size(), 3U);
    }
}



namespace
{
  void
  expect_equal(const std::vector<Vector3> &expected, const Array &found)
  {
    ASSERT_EQ(found.size, (std::vector<hsize_t>{expected.size(), dim}));
    for (unsigned int a = 0; a < expected.size(); ++a)
      for (unsigned int i = 0; i < dim; ++i)
        ASSERT_EQ(found.values[dim * a + i], expected[a][i]);
  }
} // namespace



// The same points, cells and values, bit by bit, as VTU files, whose order of
// nodes has tests of its own.
TEST(XdmfOutput, IsTheSameAsVtu)
{
  auto shapes          = all_shapes();
  shapes[0].mesh.cells = {2, 1, 1};
  JointParameters joint;
  joint.name    = "root";
  joint.type    = "fixed";
  joint.between = shapes[1].name + ": x min, ground";
  const MultibodySystem system(shapes,
                               {joint},
                               LoadParameters(),
                               fs::current_path());
  SystemState state = system.initial_state();
  state.multipliers.resize(system.n_constraints());
  for (unsigned int r = 0; r < system.n_constraints(); ++r)
    state.multipliers[r] = 100 * std::cos(r + 1.);
  for (NodalVector &x : state.positions)
    for (unsigned int i = 0; i < x.size(); ++i)
      x[i] += 1e-4 * std::sin(i);

  const Directory directory("xdmf_and_vtu");
  Statistics statistics;
  StressPeaks peaks(system, statistics);
  FieldOutputParameters parameters = xdmf_parameters({"velocity",
                                                      "von Mises stress",
                                                      "peak von Mises stress",
                                                      "stress",
                                                      "strain",
                                                      "joint forces"});
  FieldOutput(system, directory.path, parameters, &peaks, statistics)
    .observe(state);
  parameters.format = FieldOutputParameters::Format::vtu;
  FieldOutput(system, directory.path, parameters, &peaks, statistics)
    .observe(state);

  const auto pieces = read_vtu(directory.path / "solution-000000.vtu");
  const auto bodies = read_xdmf(directory.path / "solution.xdmf").at(0).bodies;
  ASSERT_EQ(pieces.size(), shapes.size());
  ASSERT_EQ(bodies.size(), shapes.size());
  for (unsigned int b = 0; b < shapes.size(); ++b)
    {
      expect_equal(pieces[b].points, bodies[b].points);
      expect_equal(pieces[b].displacement,
                   bodies[b].at_nodes.at("displacement"));
      expect_equal(pieces[b].velocity, bodies[b].at_nodes.at("velocity"));
      std::vector<double> nodes;
      for (const auto &cell : pieces[b].cells)
        nodes.insert(nodes.end(), cell.begin(), cell.end());
      EXPECT_EQ(bodies[b].cells.values, nodes);
      // displacement and body are not among the others of a piece
      auto fields = bodies[b].at_nodes;
      fields.insert(bodies[b].in_cells.begin(), bodies[b].in_cells.end());
      EXPECT_EQ(fields.size(), pieces[b].more.size() + 2);
      for (const auto &[name, values] : pieces[b].more)
        EXPECT_EQ(fields.at(name).values,
                  std::vector<double>(values.begin(), values.end()))
          << name;
    }
}



TEST(XdmfOutput, ListIsCompleteAtAnyTime)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  const Directory directory("xdmf_list");
  Statistics statistics;
  FieldOutput output(
    system, directory.path, xdmf_parameters(), nullptr, statistics);
  // without a file nothing is written, also not the mesh
  EXPECT_TRUE(directory.files().empty());
  const std::vector<double> times = {0, 0.5, 1. / 3 + 1};
  for (unsigned int n = 0; n < times.size(); ++n)
    {
      observe(output, system, {times[n]});
      EXPECT_EQ(statistics.hdf5_files, n + 1);
      EXPECT_EQ(directory.files(), files_of(n + 1));
      const auto found = read_xdmf(directory.path / "solution.xdmf");
      ASSERT_EQ(found.size(), n + 1);
      for (unsigned int k = 0; k <= n; ++k)
        {
          EXPECT_EQ(found[k].time, times[k]);
          for (const double u :
               found[k].bodies[0].at_nodes.at("displacement").values)
            EXPECT_NEAR(u, times[k], 1e-12);
        }
    }
}



// From a checkpoint in the middle, with other fields: the files that were
// written before keep theirs.
TEST(XdmfOutput, GoesOnFromACheckpoint)
{
  const MultibodySystem system = make_system({box("tetrahedron")});
  const Directory whole("xdmf_whole"), parts("xdmf_parts"),
    elsewhere("xdmf_elsewhere");
  const fs::path checkpoint = parts.path / "checkpoint.h5";
  Statistics statistics;
  const auto output =
    [&](const Directory &directory,
        const std::vector<std::string> &fields = {"velocity"}) {
      return std::make_unique<FieldOutput>(
        system, directory.path, xdmf_parameters(fields), nullptr, statistics);
    };
  const auto load = [&](FieldOutput &observer) {
    Archive::load(checkpoint,
                  [&](Archive &archive) { observer.exchange(archive); });
  };
  observe(*output(whole), system, {0, 0.5, 1, 1.5});
  const auto first = output(parts);
  observe(*first, system, {0, 0.5});
  Archive::save(checkpoint,
                [&](Archive &archive) { first->exchange(archive); });
  observe(*first, system, {7, 8}); // lost

  const auto second = output(parts);
  load(*second);
  EXPECT_EQ(read_xdmf(parts.path / "solution.xdmf").size(), 2U);
  observe(*second, system, {1, 1.5});
  fs::rename(checkpoint, elsewhere.path / "checkpoint.h5");
  EXPECT_EQ(parts.files(), whole.files());
  for (const std::string &file : whole.files())
    EXPECT_EQ(read_file(parts.path / file), read_file(whole.path / file))
      << file;

  fs::rename(elsewhere.path / "checkpoint.h5", checkpoint);
  const auto third = output(parts, {});
  load(*third);
  observe(*third, system, {1});
  const auto times = read_xdmf(parts.path / "solution.xdmf");
  ASSERT_EQ(times.size(), 3U);
  EXPECT_EQ(times[1].bodies[0].at_nodes.count("velocity"), 1U);
  EXPECT_EQ(times[2].bodies[0].at_nodes.count("velocity"), 0U);

  // in another folder: what comes later, with a mesh of its own
  const auto fourth = output(elsewhere);
  load(*fourth);
  EXPECT_EQ(read_xdmf(elsewhere.path / "solution.xdmf").size(), 0U);
  observe(*fourth, system, {1});
  EXPECT_EQ(elsewhere.files(),
            (std::set<std::string>{"solution.xdmf",
                                   "solution-mesh.h5",
                                   "solution-000002.h5"}));
  EXPECT_EQ(read_xdmf(elsewhere.path / "solution.xdmf").at(0).time, 1);
}



namespace
{
  // Both times, so that the state can be written again.
  void
  expect_write_error(const fs::path &directory, const std::string &file)
  {
    const MultibodySystem system = make_system({box("hexahedron")});
    Statistics statistics;
    FieldOutput output(
      system, directory, xdmf_parameters(), nullptr, statistics);
    try
      {
        output.observe(system.initial_state());
        FAIL() << "no exception";
      }
    catch (const SimulationError &error)
      {
        const std::string message = error.what();
        EXPECT_NE(message.find((directory / file).string()), std::string::npos)
          << message;
        EXPECT_NE(message.find("cannot be written"), std::string::npos);
      }
    EXPECT_EQ(statistics.hdf5_files, 0U);
  }
} // namespace



TEST(XdmfOutput, MissingDirectory)
{
  const Directory directory("xdmf_missing");
  expect_write_error(directory.path / "absent", "solution-mesh.h5");
  EXPECT_TRUE(directory.files().empty());
}



// A full device: the files can be opened, but not written.
TEST(XdmfOutput, FullDisk)
{
  ASSERT_TRUE(fs::exists("/dev/full"));
  for (const auto &[file, left] :
       {std::pair<std::string, std::set<std::string>>("solution-mesh.h5", {}),
        {"solution-000000.h5", {"solution-mesh.h5"}},
        {"solution.xdmf", {"solution-mesh.h5", "solution-000000.h5"}}})
    {
      const Directory directory("xdmf_full");
      fs::create_symlink("/dev/full", directory.path / (file + ".tmp"));
      expect_write_error(directory.path, file);
      EXPECT_EQ(directory.files(), left);
    }
}



// When the list cannot be written, the same state can be written again.
TEST(XdmfOutput, ListCanBeWrittenLater)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  const Directory directory("xdmf_later");
  Statistics statistics;
  FieldOutput output(
    system, directory.path, xdmf_parameters(), nullptr, statistics);
  fs::create_directories(directory.path / "solution.xdmf" / "occupied");
  EXPECT_THROW(observe(output, system, {0}), SimulationError);
  fs::remove_all(directory.path / "solution.xdmf");
  observe(output, system, {0});
  EXPECT_EQ(read_xdmf(directory.path / "solution.xdmf").size(), 1U);
  EXPECT_EQ(directory.files(), files_of(1));
}



TEST(XdmfOutput, IsAskedForByAModelFile)
{
  FieldOutputParameters parameters;
  ParameterHandler prm;
  parameters.add_parameters(prm);
  prm.parse_input_from_string("");
  EXPECT_EQ(parameters.format, FieldOutputParameters::Format::vtu);
  prm.parse_input_from_string("set Format = XDMF");
  EXPECT_EQ(parameters.format, FieldOutputParameters::Format::xdmf);
  prm.parse_input_from_string("set Format = VTU");
  EXPECT_EQ(parameters.format, FieldOutputParameters::Format::vtu);
  EXPECT_THROW(prm.parse_input_from_string("set Format = HDF5"),
               dealii::ExceptionBase);
}
