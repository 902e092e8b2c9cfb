// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/io/field_output.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include <unit/output_test.h>
#include <unit/vtu_file.h>

namespace
{
  using namespace ACF;
  using namespace OutputTest;
  namespace fs = std::filesystem;
  using Tree   = boost::property_tree::ptree;

  FieldOutputParameters
  output_parameters(const std::vector<std::string> &fields = {"velocity"})
  {
    FieldOutputParameters parameters;
    parameters.interval = 0.5;
    parameters.fields   = fields;
    return parameters;
  }

  Vector3
  quadratic_displacement(const Vector3 &x)
  {
    return vector(0.1 + x[0] * x[1] - 3 * x[2] * x[2],
                  x[0] * x[0] - x[1] + 0.5 * x[1] * x[2],
                  2 * x[2] * x[0] + x[1] * x[1] - 7);
  }

  /** Writes one state and reads it. */
  std::vector<Piece>
  write_and_read(const MultibodySystem &system,
                 const SystemState &state,
                 const std::vector<std::string> &fields = {"velocity"},
                 StressPeaks *const peaks               = nullptr)
  {
    const Directory directory("fields");
    Statistics statistics;
    FieldOutput output(
      system, directory.path, output_parameters(fields), peaks, statistics);
    output.observe(state);
    const bool has_stress =
      std::any_of(fields.begin(), fields.end(), [](const std::string &field) {
        return field != "velocity" && field != "joint forces";
      });
    EXPECT_EQ(statistics.stress_evaluations,
              has_stress ? system.bodies().size() : 0);
    return read_vtu(directory.path / "solution-000000.vtu");
  }

  /** The corners of which each further node of VTK's cell is the centre. */
  std::vector<std::vector<unsigned int>>
  parents(const unsigned int n_nodes)
  {
    if (n_nodes == 10)
      return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    return {{0, 1},
            {1, 2},
            {2, 3},
            {3, 0},
            {4, 5},
            {5, 6},
            {6, 7},
            {7, 4},
            {0, 4},
            {1, 5},
            {2, 6},
            {3, 7},
            {0, 3, 7, 4},
            {1, 2, 6, 5},
            {0, 1, 5, 4},
            {3, 2, 6, 7},
            {0, 1, 2, 3},
            {4, 5, 6, 7},
            {0, 1, 2, 3, 4, 5, 6, 7}};
  }

  /** Volume from the corners in VTK's order; parallelepipeds and tetrahedra. */
  double
  volume(const Piece &piece, const std::vector<std::int64_t> &cell)
  {
    const auto edge = [&](const unsigned int end) {
      return piece.points[cell[end]] - piece.points[cell[0]];
    };
    return cell.size() == 10 ? cross_product_3d(edge(1), edge(2)) * edge(3) / 6
                             : cross_product_3d(edge(1), edge(3)) * edge(4);
  }

  void
  expect_near(const Vector3 &found,
              const Vector3 &expected,
              const double tolerance,
              const std::string &what)
  {
    EXPECT_LE((found - expected).norm(), tolerance)
      << what << ": " << found << " instead of " << expected;
  }
} // namespace



TEST(VtuOutput, CellsHaveTheNodeOrderOfVtk)
{
  const MultibodySystem system = make_system(all_shapes());
  const auto pieces            = write_and_read(system, system.initial_state());
  ASSERT_EQ(pieces.size(), 4U);

  // 3 x 2 x 2 hexahedra, or 24 tetrahedra of each
  EXPECT_EQ(pieces[0].cells.size(), 12U);
  EXPECT_EQ(pieces[0].points.size(), 7U * 5U * 5U);
  EXPECT_EQ(pieces[1].cells.size(), 288U);
  for (unsigned int b = 0; b < pieces.size(); ++b)
    {
      const Piece &piece         = pieces[b];
      const bool simplex         = b % 2 == 1;
      const unsigned int n_nodes = simplex ? 10 : 27;
      std::set<std::int64_t> used;
      for (unsigned int c = 0; c < piece.cells.size(); ++c)
        {
          const auto &cell = piece.cells[c];
          ASSERT_EQ(cell.size(), n_nodes);
          EXPECT_EQ(piece.types[c], simplex ? 24 : 72);
          EXPECT_EQ(piece.bodies[c], int(b));
          used.insert(cell.begin(), cell.end());

          unsigned int n = simplex ? 4 : 8;
          for (const auto &corners : parents(n_nodes))
            {
              Vector3 centre;
              for (const unsigned int corner : corners)
                centre += piece.points[cell[corner]] / double(corners.size());
              expect_near(piece.points[cell[n++]],
                          centre,
                          1e-12,
                          "node of a cell");
            }
          EXPECT_EQ(n, n_nodes);
        }
      // all points belong to cells, and no others
      EXPECT_EQ(used.size(), piece.points.size());
      EXPECT_EQ(*used.begin(), 0);
      EXPECT_EQ(*used.rbegin(), std::int64_t(piece.points.size()) - 1);
    }
}



TEST(VtuOutput, CellsFillTheBody)
{
  const MultibodySystem system =
    make_system({box("hexahedron"), box("tetrahedron")});
  for (const Piece &piece : write_and_read(system, system.initial_state()))
    {
      double total = 0;
      for (const auto &cell : piece.cells)
        {
          EXPECT_GT(volume(piece, cell), 0);
          total += volume(piece, cell);
        }
      EXPECT_NEAR(total, 3, 1e-12);
    }
}



TEST(VtuOutput, PointsArePlacedPositions)
{
  const auto shapes            = all_shapes();
  const MultibodySystem system = make_system(shapes);
  const auto pieces            = write_and_read(system, system.initial_state());
  for (unsigned int b = 0; b < 2; ++b)
    {
      // back to the mesh: the corners of the box are points, none is outside
      const Matrix3 back     = transpose(rotation_matrix(shapes[b].rotation));
      unsigned int n_corners = 0;
      for (const Vector3 &x : pieces[b].points)
        {
          const Vector3 X = back * (x - Vector3(shapes[b].position));
          bool corner     = true;
          for (unsigned int i = 0; i < dim; ++i)
            {
              const double lower = shapes[b].mesh.box_from[i];
              const double upper = shapes[b].mesh.box_to[i];
              EXPECT_GE(X[i], lower - 1e-12);
              EXPECT_LE(X[i], upper + 1e-12);
              corner = corner && (std::abs(X[i] - lower) < 1e-12 ||
                                  std::abs(X[i] - upper) < 1e-12);
            }
          n_corners += corner;
        }
      EXPECT_EQ(n_corners, 8U);
    }
}



TEST(VtuOutput, FieldsBelongToTheirPoints)
{
  const auto shapes            = all_shapes();
  const MultibodySystem system = make_system(shapes);
  SystemState state            = system.initial_state();
  for (unsigned int b = 0; b < shapes.size(); ++b)
    state.positions[b] +=
      nodal_values(state.positions[b], quadratic_displacement);

  const auto pieces = write_and_read(system, state);
  ASSERT_EQ(pieces.size(), shapes.size());
  for (unsigned int b = 0; b < shapes.size(); ++b)
    {
      const Piece &piece = pieces[b];
      EXPECT_EQ(piece.fields,
                (std::set<std::string>{"displacement", "velocity"}));

      // centres of the box and of the cylinder
      const Vector3 centre =
        Vector3(shapes[b].position) +
        rotation_matrix(shapes[b].rotation) *
          (b < 2 ? vector(0.5, 0, 0.25) : vector(0.5, 1, 1));
      for (unsigned int p = 0; p < piece.points.size(); ++p)
        {
          expect_near(piece.displacement[p],
                      quadratic_displacement(piece.points[p]),
                      1e-9,
                      "displacement");
          expect_near(piece.velocity[p],
                      shapes[b].velocity +
                        cross_product_3d(shapes[b].angular_velocity,
                                         piece.points[p] - centre),
                      1e-5,
                      "velocity");
        }
    }
}



namespace
{
  // Stretched along the first axis of the mesh, then turned.
  SystemState
  stretched(const MultibodySystem &system, const double strain)
  {
    SystemState state      = system.initial_state();
    const Matrix3 rotation = rotation_matrix(vector(-2, 1, 1.5));
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      state.positions[b] =
        nodal_values(system.bodies()[b].operators().reference_positions,
                     [&](const Vector3 &X) {
                       return rotation *
                              vector((1 + strain) * X[0] + 5, X[1], X[2]);
                     });
    return state;
  }
} // namespace



// Uniform: sigma = E epsilon r r with the turned axis r, as nu = 0.
TEST(VtuOutput, StressesAndStrains)
{
  constexpr double strain      = 1e-3;
  const MultibodySystem system = make_system(all_shapes());
  const Vector3 r = rotation_matrix(vector(-2, 1, 1.5)) * vector(1, 0, 0);
  // xx, yy, zz, xy, yz, xz
  const std::array<double, 6> products = {{r[0] * r[0],
                                           r[1] * r[1],
                                           r[2] * r[2],
                                           r[0] * r[1],
                                           r[1] * r[2],
                                           r[0] * r[2]}};
  const auto pieces                    = write_and_read(system,
                                     stretched(system, strain),
                                     {"von Mises stress", "stress", "strain"});
  ASSERT_EQ(pieces.size(), system.bodies().size());
  for (const Piece &piece : pieces)
    {
      EXPECT_EQ(piece.more.size(), 5U);
      for (const auto &[name, n_values, scale] :
           {std::make_tuple("von_mises_stress", piece.points.size(), 2e11),
            std::make_tuple("largest_von_mises_stress",
                            piece.cells.size(),
                            2e11)})
        {
          const auto &values = piece.more.at(name);
          ASSERT_EQ(values.size(), n_values);
          for (const float value : values)
            EXPECT_NEAR(value, scale * strain, scale * strain * 1e-6);
        }
      for (const auto &[name, n_values, scale] :
           {std::make_tuple("stress", piece.points.size(), 2e11),
            std::make_tuple("strain", piece.points.size(), 1.),
            std::make_tuple("cell_stress", piece.cells.size(), 2e11)})
        {
          const auto &values = piece.more.at(name);
          ASSERT_EQ(values.size(), 6 * n_values);
          for (unsigned int k = 0; k < values.size(); ++k)
            EXPECT_NEAR(values[k],
                        scale * strain * products[k % 6],
                        scale * strain * 1e-6);
        }
    }
}



TEST(VtuOutput, StressNeedsARotation)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  SystemState state            = system.initial_state();
  state.time                   = 0.25;
  // a mirrored body
  for (unsigned int i = 0; i < state.positions[0].size(); i += dim)
    state.positions[0][i] *= -1;

  const Directory directory("rotation");
  Statistics statistics;
  FieldOutput output(
    system, directory.path, output_parameters({"strain"}), nullptr, statistics);
  try
    {
      output.observe(state);
      FAIL() << "no exception";
    }
  catch (const SimulationError &error)
    {
      const std::string message = error.what();
      EXPECT_NE(message.find("hexahedron box"), std::string::npos) << message;
      EXPECT_NE(message.find("0.25"), std::string::npos) << message;
    }
  EXPECT_TRUE(directory.files().empty());
}



// After a small, a large and again a small stress, and when they are kept in a
// checkpoint.
TEST(StressPeaks, StayAfterTheirTime)
{
  const MultibodySystem system =
    make_system({box("hexahedron"), box("tetrahedron")});
  Statistics statistics;
  StressPeaks peaks(system, statistics);
  EXPECT_EQ(peaks.interval(), 0);
  for (const double strain : {1e-4, 1e-3, -2e-4})
    peaks.observe(stretched(system, strain));
  EXPECT_EQ(statistics.stress_evaluations, 6U);

  const Directory directory("peaks");
  const fs::path file = directory.path / "peaks.h5";
  Archive::save(file, [&](Archive &archive) { peaks.exchange(archive); });
  StressPeaks loaded(system, statistics);
  Archive::load(file, [&](Archive &archive) { loaded.exchange(archive); });

  // what a file shows, it includes
  const auto pieces =
    write_and_read(system,
                   stretched(system, 5e-4),
                   {"peak von Mises stress", "von Mises stress"},
                   &loaded);
  for (const Piece &piece : pieces)
    {
      EXPECT_EQ(piece.more.at("peak_von_mises_stress").size(),
                piece.points.size());
      for (const float value : piece.more.at("peak_von_mises_stress"))
        EXPECT_NEAR(value, 2e8, 2e2);
      for (const float value : piece.more.at("von_mises_stress"))
        EXPECT_NEAR(value, 1e8, 1e2);
    }
  const auto larger = write_and_read(system,
                                     stretched(system, 4e-3),
                                     {"peak von Mises stress"},
                                     &loaded);
  for (const float value : larger[0].more.at("peak_von_mises_stress"))
    EXPECT_NEAR(value, 8e8, 8e2);
}



// Nodal forces of a fixed joint: their sum and their moment about the mean
// position of the surface are its reaction.
TEST(VtuOutput, JointForces)
{
  for (const std::string element : {"hexahedron", "tetrahedron"})
    {
      JointParameters joint;
      joint.name    = "root";
      joint.type    = "fixed";
      joint.between = element + " box: x min, ground";
      const MultibodySystem system({box(element)},
                                   {joint},
                                   LoadParameters(),
                                   fs::current_path());
      SystemState state = system.initial_state();
      state.multipliers.resize(system.n_constraints());
      for (unsigned int r = 0; r < system.n_constraints(); ++r)
        state.multipliers[r] = 100 * std::cos(r + 1.);

      const auto piece  = write_and_read(system, state, {"joint forces"})[0];
      const auto &force = piece.more.at("joint_force");
      ASSERT_EQ(force.size(), dim * piece.points.size());
      const Body &body = system.bodies()[0];
      const Vector3 centre =
        surface_mean(body.discretization(),
                     body.discretization().mesh().surface("x min", "", ""))(
          state.positions[0]);
      Vector3 sum, moment;
      unsigned int n_loaded = 0;
      for (unsigned int a = 0; a < piece.points.size(); ++a)
        {
          const Vector3 f =
            vector(force[dim * a], force[dim * a + 1], force[dim * a + 2]);
          sum += f;
          moment += cross_product_3d(node(state.positions[0], a) - centre, f);
          if (f.norm() < 1e-9)
            continue;
          ++n_loaded;
          // of the surface only
          EXPECT_NEAR(body.operators().reference_positions[dim * a], -1, 1e-12);
        }
      const auto reaction = system.reaction(0, state);
      EXPECT_GT(reaction.force.norm(), 10);
      EXPECT_GT(reaction.moment.norm(), 10);
      // single precision
      EXPECT_LT((sum - reaction.force).norm(), 1e-3);
      EXPECT_LT((moment - reaction.moment).norm(), 1e-3);
      EXPECT_GT(n_loaded, 4U);
    }
}



TEST(VtuOutput, RecordListsAllTimes)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  const Directory directory("record");
  Statistics statistics;
  FieldOutput output(
    system, directory.path, output_parameters(), nullptr, statistics);
  EXPECT_EQ(output.interval(), 0.5);

  SystemState state = system.initial_state();
  std::vector<double> times;
  for (const double time : {0., 0.5, 1. / 3 + 1})
    {
      state.time = time;
      times.push_back(time);
      output.observe(state);
      EXPECT_EQ(statistics.vtu_files, times.size());

      // after every observation the record is complete
      Tree tree;
      boost::property_tree::read_xml((directory.path / "solution.pvd").string(),
                                     tree);
      unsigned int n = 0;
      for (const auto &[tag, child] : tree.get_child("VTKFile.Collection"))
        if (tag == "DataSet")
          {
            ASSERT_LT(n, times.size());
            EXPECT_NEAR(child.get<double>("<xmlattr>.timestep"),
                        times[n],
                        1e-11);
            EXPECT_EQ(child.get<std::string>("<xmlattr>.file"),
                      "solution-00000" + std::to_string(n) + ".vtu");
            ++n;
          }
      EXPECT_EQ(n, times.size());
    }
  EXPECT_EQ(directory.files(),
            (std::set<std::string>{"solution-000000.vtu",
                                   "solution-000001.vtu",
                                   "solution-000002.vtu",
                                   "solution.pvd"}));
}



namespace
{
  void
  expect_write_error(const fs::path &directory, const std::string &file)
  {
    const MultibodySystem system = make_system({box("hexahedron")});
    Statistics statistics;
    FieldOutput output(
      system, directory, output_parameters(), nullptr, statistics);
    try
      {
        output.observe(system.initial_state());
        FAIL() << "no exception";
      }
    catch (const SimulationError &error)
      {
        EXPECT_NE(std::string(error.what()).find(file), std::string::npos)
          << error.what();
      }
  }
} // namespace



TEST(VtuOutput, MissingDirectory)
{
  const Directory directory("missing");
  const fs::path missing = directory.path / "absent";
  expect_write_error(missing, (missing / "solution-000000.vtu").string());
  EXPECT_FALSE(fs::exists(missing));
}



// A full device: the file can be opened, but not written.
TEST(VtuOutput, FullDisk)
{
  ASSERT_TRUE(fs::exists("/dev/full"));
  const Directory directory("full");
  fs::create_symlink("/dev/full", directory.path / "solution-000000.vtu.tmp");
  expect_write_error(directory.path, "solution-000000.vtu");
  EXPECT_TRUE(directory.files().empty());
}



TEST(VtuOutput, NameIsTaken)
{
  const Directory directory("taken");
  fs::create_directories(directory.path / "solution.pvd" / "occupied");
  expect_write_error(directory.path, "solution.pvd");
  EXPECT_EQ(directory.files(),
            (std::set<std::string>{"solution-000000.vtu", "solution.pvd"}));
}



TEST(FieldOutputParameters, AreReadFromAModelFile)
{
  FieldOutputParameters parameters;
  ParameterHandler prm;
  parameters.add_parameters(prm);
  prm.parse_input_from_string("");
  EXPECT_EQ(parameters.interval, 0);
  EXPECT_EQ(parameters.fields, std::vector<std::string>{"velocity"});
  prm.parse_input_from_string(
    "set VTU interval = 0.02\nset VTU fields = stress, von Mises stress");
  EXPECT_EQ(parameters.interval, 0.02);
  EXPECT_FALSE(parameters.contain("velocity"));
  EXPECT_TRUE(parameters.contain("stress"));
  EXPECT_TRUE(parameters.contain("von Mises stress"));
  prm.parse_input_from_string("set VTU fields =");
  EXPECT_TRUE(parameters.fields.empty());
  EXPECT_THROW(prm.parse_input_from_string("set VTU fields = pressure"),
               dealii::ExceptionBase);
  EXPECT_THROW(prm.parse_input_from_string("set VTU interval = -1"),
               dealii::ExceptionBase);
}
