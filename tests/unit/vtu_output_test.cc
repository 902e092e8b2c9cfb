// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/io/vtu_output.h>

#include <deal.II/base/utilities.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gtest/gtest.h>

#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

namespace
{
  using namespace ACF;
  namespace fs = std::filesystem;
  using Tree   = boost::property_tree::ptree;
  using Field  = std::function<Vector3(const Vector3 &)>;

  /** An empty directory that goes away with the object. */
  class Directory
  {
  public:
    explicit Directory(const std::string &name)
      : path(fs::current_path() / ("vtu_output_test_" + name))
    {
      fs::remove_all(path);
      fs::create_directory(path);
    }

    ~Directory()
    {
      fs::remove_all(path);
    }

    std::set<std::string>
    files() const
    {
      std::set<std::string> names;
      for (const auto &entry : fs::directory_iterator(path))
        names.insert(entry.path().filename());
      return names;
    }

    const fs::path path;
  };

  Vector3
  vector(const double x, const double y, const double z)
  {
    Vector3 result;
    result[0] = x;
    result[1] = y;
    result[2] = z;
    return result;
  }

  // A box from (-1, -0.5, -0.25) to (2, 0.5, 0.75), placed far away and turned
  // by an angle beyond 90 degrees.
  BodyParameters
  box(const std::string &element)
  {
    BodyParameters body;
    body.name                    = element + " box";
    body.mesh.mesh               = "box";
    body.mesh.element            = element;
    body.mesh.box_from           = {-1, -0.5, -0.25};
    body.mesh.box_to             = {2, 0.5, 0.75};
    body.mesh.cells              = {3, 2, 2};
    body.material.youngs_modulus = 2e11;
    body.material.poissons_ratio = 0;
    body.material.density        = 7800;
    body.position                = Point<dim>(10, -20, 30);
    body.rotation                = vector(1.2, -0.7, 1.9);
    body.velocity                = vector(3, 2, 1);
    body.angular_velocity        = vector(-1, 4, 2);
    return body;
  }

  BodyParameters
  cylinder(const std::string &element)
  {
    BodyParameters body       = box(element);
    body.name                 = element + " cylinder";
    body.mesh                 = MeshParameters();
    body.mesh.mesh            = "cylinder";
    body.mesh.element         = element;
    body.mesh.cylinder_from   = {0, 0, 0};
    body.mesh.cylinder_to     = {1, 2, 2};
    body.mesh.cylinder_radius = 0.5;
    body.mesh.cells           = {5, 3};
    return body;
  }

  std::vector<BodyParameters>
  all_shapes()
  {
    return {box("hexahedron"),
            box("tetrahedron"),
            cylinder("hexahedron"),
            cylinder("tetrahedron")};
  }

  MultibodySystem
  make_system(const std::vector<BodyParameters> &bodies)
  {
    return MultibodySystem(bodies, {}, LoadParameters(), fs::current_path());
  }

  VtuParameters
  output_parameters(const bool stress)
  {
    VtuParameters parameters;
    parameters.interval = 0.5;
    parameters.stress   = stress;
    return parameters;
  }

  Vector3
  node(const NodalVector &values, const unsigned int a)
  {
    return vector(values[dim * a], values[dim * a + 1], values[dim * a + 2]);
  }

  /** Nodal values f(x_a). */
  NodalVector
  nodal_values(const NodalVector &positions, const Field &f)
  {
    NodalVector result(positions.size());
    for (unsigned int a = 0; a < positions.size() / dim; ++a)
      {
        const Vector3 value = f(node(positions, a));
        for (unsigned int i = 0; i < dim; ++i)
          result[dim * a + i] = value[i];
      }
    return result;
  }

  Vector3
  quadratic_displacement(const Vector3 &x)
  {
    return vector(0.1 + x[0] * x[1] - 3 * x[2] * x[2],
                  x[0] * x[0] - x[1] + 0.5 * x[1] * x[2],
                  2 * x[2] * x[0] + x[1] * x[1] - 7);
  }

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
    std::vector<float> stress;
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

  std::map<std::string, Tree>
  arrays(const Tree &parent)
  {
    std::map<std::string, Tree> result;
    for (const auto &[tag, child] : parent)
      if (tag == "DataArray")
        result[child.get<std::string>("<xmlattr>.Name")] = child;
    return result;
  }

  Piece
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
    piece.velocity = decode_vectors<float>(fields.at("velocity"), "Float32");
    if (fields.count("von_mises_stress") > 0)
      piece.stress = decode<float>(fields.at("von_mises_stress"), "Float32");

    EXPECT_EQ(tree.get<std::size_t>("<xmlattr>.NumberOfPoints"),
              piece.points.size());
    EXPECT_EQ(tree.get<std::size_t>("<xmlattr>.NumberOfCells"),
              piece.cells.size());
    EXPECT_EQ(piece.types.size(), piece.cells.size());
    EXPECT_EQ(piece.bodies.size(), piece.cells.size());
    EXPECT_EQ(piece.displacement.size(), piece.points.size());
    EXPECT_EQ(piece.velocity.size(), piece.points.size());
    return piece;
  }

  std::vector<Piece>
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

  /** Writes one state and reads it. */
  std::vector<Piece>
  write_and_read(const MultibodySystem &system,
                 const SystemState &state,
                 const bool stress)
  {
    const Directory directory("fields");
    Statistics statistics;
    VtuOutput output(system,
                     directory.path,
                     output_parameters(stress),
                     statistics);
    output.observe(state);
    EXPECT_EQ(statistics.stress_evaluations,
              stress ? system.bodies().size() : 0);
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
  const auto pieces = write_and_read(system, system.initial_state(), false);
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
  for (const Piece &piece :
       write_and_read(system, system.initial_state(), false))
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
  const auto pieces = write_and_read(system, system.initial_state(), false);
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

  const auto pieces = write_and_read(system, state, false);
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



TEST(VonMisesStress, UniaxialStretch)
{
  constexpr double strain = 1e-3;
  for (BodyParameters parameters : all_shapes())
    for (const RotationMeasure measure :
         {RotationMeasure::polar, RotationMeasure::three_points})
      {
        parameters.rotation_measure  = measure;
        const MultibodySystem system = make_system({parameters});
        SystemState state            = system.initial_state();

        // stretch along the first axis of the mesh, then a large rotation
        const Matrix3 rotation = rotation_matrix(vector(-2, 1, 1.5));
        const auto stretch     = [&](const Vector3 &X) {
          return rotation * vector((1 + strain) * X[0] + 5, X[1], X[2]);
        };
        state.positions[0] =
          nodal_values(system.bodies()[0].operators().reference_positions,
                       stretch);
        const auto pieces = write_and_read(system, state, true);
        EXPECT_EQ(pieces[0].stress.size(), pieces[0].points.size());
        for (const float stress : pieces[0].stress)
          EXPECT_NEAR(stress, 2e11 * strain, 2e11 * strain * 1e-6);
      }
}



TEST(VonMisesStress, VanishesForRotations)
{
  const MultibodySystem system = make_system(all_shapes());
  const Matrix3 rotation       = rotation_matrix(vector(1, -2, 0.5));
  for (const Body &body : system.bodies())
    {
      const auto stresses = von_mises_stress(
        body, nodal_values(body.initial_positions(), [&](const Vector3 &x) {
          return rotation * x + vector(1, 2, 3);
        }));
      ASSERT_TRUE(stresses.has_value());
      ASSERT_EQ(stresses->size(), body.discretization().n_nodes());
      // rounding: strains of 1e-13, from coordinates of 40 m
      for (const double stress : *stresses)
        EXPECT_LT(stress, 2e11 * 1e-12);
    }
}



// u = k (x y, -x^2 / 2, 0), of which the mean gradient vanishes in a box around
// the origin: the only strain is k y along x, so that the deviator of the
// stress is that of 2 mu k y e_x e_x, whatever lambda is.
TEST(VonMisesStress, PureBendingWithLateralContraction)
{
  constexpr double curvature = 1e-3;
  for (const std::string element : {"hexahedron", "tetrahedron"})
    {
      BodyParameters parameters          = box(element);
      parameters.mesh.box_from           = {-2, -1, -0.5};
      parameters.mesh.box_to             = {2, 1, 0.5};
      parameters.material.poissons_ratio = 0.3;
      const MultibodySystem system       = make_system({parameters});
      const Body &body                   = system.bodies()[0];
      const NodalVector &X               = body.operators().reference_positions;
      const Matrix3 rotation             = rotation_matrix(vector(0.3, -2, 1));
      const auto stresses                = von_mises_stress(
        body, nodal_values(X, [&](const Vector3 &p) {
          return rotation *
                 (p + curvature * vector(p[0] * p[1], -p[0] * p[0] / 2, 0));
        }));
      ASSERT_TRUE(stresses.has_value());
      for (unsigned int a = 0; a < stresses->size(); ++a)
        EXPECT_NEAR((*stresses)[a],
                    2 * (2e11 / 2.6) * curvature * std::abs(X[dim * a + 1]),
                    1e-6 * 2e11 * curvature);
    }
}



TEST(VonMisesStress, NeedsARotation)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  SystemState state            = system.initial_state();
  state.time                   = 0.25;
  // a mirrored body
  for (unsigned int i = 0; i < state.positions[0].size(); i += dim)
    state.positions[0][i] *= -1;
  EXPECT_FALSE(
    von_mises_stress(system.bodies()[0], state.positions[0]).has_value());

  const Directory directory("rotation");
  Statistics statistics;
  VtuOutput output(system, directory.path, output_parameters(true), statistics);
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



TEST(VtuOutput, RecordListsAllTimes)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  const Directory directory("record");
  Statistics statistics;
  VtuOutput output(system,
                   directory.path,
                   output_parameters(false),
                   statistics);
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
    VtuOutput output(system, directory, output_parameters(false), statistics);
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



TEST(VtuParameters, AreReadFromAModelFile)
{
  VtuParameters parameters;
  ParameterHandler prm;
  parameters.add_parameters(prm);
  prm.parse_input_from_string("");
  EXPECT_EQ(parameters.interval, 0);
  EXPECT_FALSE(parameters.stress);
  prm.parse_input_from_string("set VTU interval = 0.02\nset VTU stress = true");
  EXPECT_EQ(parameters.interval, 0.02);
  EXPECT_TRUE(parameters.stress);
  EXPECT_THROW(prm.parse_input_from_string("set VTU interval = -1"),
               dealii::ExceptionBase);
}
