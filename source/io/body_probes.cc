// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/io/probe_types.h>
#include <acf/mechanics/stress.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ACF
{
  namespace
  {
    // A linear functional of a body.
    struct ProbeEnd
    {
      unsigned int body;
      NodalFunctional functional;

      Vector3
      position(const SystemState &state) const
      {
        return functional(state.positions[body]);
      }
    };



    // Mean of a surface, or a material point: its position or its velocity.
    class FunctionalProbe : public Probe
    {
    public:
      FunctionalProbe(const unsigned int body,
                      const NodalFunctional &functional,
                      const bool velocity)
        : body(body)
        , functional(functional)
        , velocity(velocity)
      {}

      std::vector<std::string>
      columns() const override
      {
        return vector_columns(velocity ? "m/s" : "m");
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        return components(functional(velocity ? state.velocities[body]
                                              : state.positions[body]));
      }

    private:
      const unsigned int body;
      const NodalFunctional functional;
      const bool velocity;
    };



    // Angle of the line between two surfaces and distance of a material point
    // from it, in the plane perpendicular to a world axis.
    class ChordProbe : public Probe
    {
    public:
      ChordProbe(const ProbeEnd &from,
                 const ProbeEnd &to,
                 const std::optional<ProbeEnd> &point,
                 const unsigned int axis)
        : from(from)
        , to(to)
        , point(point)
        , first((axis + 1) % dim)
        , second((axis + 2) % dim)
      {}

      std::vector<std::string>
      columns() const override
      {
        if (point)
          return {"angle [rad]", "deflection [m]"};
        return {"angle [rad]"};
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        const Vector3 start  = from.position(state);
        const Vector3 chord  = to.position(state) - start;
        const double wrapped = std::atan2(chord[second], chord[first]);
        if (n_evaluations++ == 0)
          angle = wrapped;
        else // the branch nearest to the angle before
          angle += std::remainder(wrapped - angle, 2 * numbers::PI);

        if (!point)
          return {angle};
        const Vector3 arm = point->position(state) - start;
        return {angle,
                std::cos(wrapped) * arm[second] -
                  std::sin(wrapped) * arm[first]};
      }

      void
      exchange(Archive &archive) override
      {
        archive("evaluations", n_evaluations);
        archive("angle", angle);
      }

    private:
      const ProbeEnd from;
      const ProbeEnd to;
      const std::optional<ProbeEnd> point;
      const unsigned int first;
      const unsigned int second;
      unsigned long n_evaluations = 0;
      double angle                = 0;
    };



    // Change of length of the line between two surfaces, and displacement of a
    // material point in the frame of that line and an axis of the body: along
    // the line, along axis x line, and along the third direction.
    class ChordFrameProbe : public Probe
    {
    public:
      ChordFrameProbe(const MultibodySystem &system,
                      const ProbeEnd &from,
                      const ProbeEnd &to,
                      const ProbeEnd &point,
                      const unsigned int axis)
        : body(system.bodies()[from.body])
        , from(from)
        , to(to)
        , point(point)
      {
        start_axis[axis] = 1;
        SystemState start;
        start.positions = system.placement();
        reference       = coordinates(start, length);
      }

      std::vector<std::string>
      columns() const override
      {
        return {"stretch [m]", "along [m]", "across [m]", "normal [m]"};
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        double now                 = 0;
        const Vector3 displacement = coordinates(state, now) - reference;
        return {now - length,
                displacement[0],
                displacement[1],
                displacement[2]};
      }

    private:
      // Of the point in the frame.
      Vector3
      coordinates(const SystemState &state, double &chord_length) const
      {
        const Vector3 start = from.position(state);
        Vector3 along       = to.position(state) - start;
        chord_length        = along.norm();
        along /= chord_length;
        const auto frame =
          body_rotation(mean_deformation_gradient(body.operators(),
                                                  state.positions[from.body]),
                        body.rotation_measure());
        const Vector3 axis =
          frame->rotation * (transpose(body.placement_rotation()) * start_axis);
        Vector3 across = cross_product_3d(axis, along);
        across /= across.norm();
        const Vector3 arm = point.position(state) - start;
        return Vector3(
          {arm * along, arm * across, arm * cross_product_3d(along, across)});
      }

      const Body &body;
      const ProbeEnd from;
      const ProbeEnd to;
      const ProbeEnd point;
      Vector3 start_axis;
      Vector3 reference;
      double length = 0;
    };



    // Cauchy's stress at a material point.
    class StressProbe : public Probe
    {
    public:
      StressProbe(const MultibodySystem &system,
                  const unsigned int body,
                  const Point<dim> &point,
                  const bool in_body_axes)
        : system(system)
        , body(body)
        , stress(system.bodies()[body], point)
        , in_body_axes(in_body_axes)
      {}

      std::vector<std::string>
      columns() const override
      {
        return {
          "xx [Pa]", "yy [Pa]", "zz [Pa]", "xy [Pa]", "yz [Pa]", "xz [Pa]"};
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        const StressEvaluation evaluation(system.bodies()[body],
                                          state.positions[body],
                                          state.time);
        Matrix3 value = stress(evaluation).stress;
        if (in_body_axes)
          value =
            transpose(evaluation.rotation()) * value * evaluation.rotation();
        return {value[0][0],
                value[1][1],
                value[2][2],
                value[0][1],
                value[1][2],
                value[0][2]};
      }

      unsigned int
      n_stress_evaluations() const override
      {
        return 1;
      }

    private:
      const MultibodySystem &system;
      const unsigned int body;
      const PointStress stress;
      const bool in_body_axes;
    };



    // The largest von Mises stress at the nodes of a body or of its parts.
    class LargestStressProbe : public Probe
    {
    public:
      LargestStressProbe(const MultibodySystem &system,
                         const std::vector<unsigned int> &bodies)
        : system(system)
        , bodies(bodies)
      {}

      std::vector<std::string>
      columns() const override
      {
        return {"von Mises [Pa]"};
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        double largest = 0;
        for (const unsigned int b : bodies)
          for (const StressAndStrain &value :
               StressEvaluation(system.bodies()[b],
                                state.positions[b],
                                state.time)
                 .nodal_values())
            largest = std::max(largest, von_mises_stress(value.stress));
        return {largest};
      }

      unsigned int
      n_stress_evaluations() const override
      {
        return bodies.size();
      }

    private:
      const MultibodySystem &system;
      const std::vector<unsigned int> bodies;
    };



    ProbeEnd
    surface_end(const MultibodySystem &system,
                const ProbeParameters &parameters,
                const std::string &text,
                const std::string &entry)
    {
      const BodySurface found =
        find_surface(text, system.bodies(), parameters.section(), entry);
      return {found.body,
              surface_mean(system.bodies()[found.body].discretization(),
                           found.surface)};
    }



    Point<dim>
    material_coordinates(const ProbeParameters &parameters)
    {
      return Point<dim>(parameters.point[0],
                        parameters.point[1],
                        parameters.point[2]);
    }



    // The body of a name, or the part of it, that contains the point.
    unsigned int
    body_at_point(const MultibodySystem &system,
                  const ProbeParameters &parameters,
                  const std::string &name,
                  const std::string &entry)
    {
      const auto candidates =
        find_bodies(system.bodies(), name, parameters.section(), entry);
      std::string problem;
      for (const unsigned int b : candidates)
        try
          {
            cells_at(system.bodies()[b].discretization(),
                     material_coordinates(parameters));
            return b;
          }
        catch (const SimulationError &error)
          {
            problem = candidates.size() == 1 ? error.what()
                                             : "a point outside all parts";
          }
      throw InputError(parameters.section(),
                       "Point",
                       problem,
                       "a point of the body '" + name +
                         "' in the coordinates of its mesh");
    }



    ProbeEnd
    point_end(const MultibodySystem &system,
              const ProbeParameters &parameters,
              const std::string &name,
              const std::string &entry)
    {
      const unsigned int b = body_at_point(system, parameters, name, entry);
      return {b,
              material_point(system.bodies()[b].discretization(),
                             material_coordinates(parameters))};
    }
  } // namespace



  std::unique_ptr<Probe>
  make_body_probe(const ProbeParameters &parameters,
                  const MultibodySystem &system)
  {
    const std::string &type = parameters.type;
    const bool velocity     = type.find("velocity") != std::string::npos;
    if (type == "mean position" || type == "mean velocity")
      {
        const ProbeEnd end =
          surface_end(system, parameters, parameters.of, "Of");
        return std::make_unique<FunctionalProbe>(end.body,
                                                 end.functional,
                                                 velocity);
      }
    if (type == "point position" || type == "point velocity")
      {
        const ProbeEnd end = point_end(system, parameters, parameters.of, "Of");
        return std::make_unique<FunctionalProbe>(end.body,
                                                 end.functional,
                                                 velocity);
      }

    if (type == "stress")
      return std::make_unique<StressProbe>(
        system,
        body_at_point(system, parameters, parameters.of, "Of"),
        material_coordinates(parameters),
        parameters.axes == "body");
    if (type == "largest stress")
      return std::make_unique<LargestStressProbe>(
        system,
        find_bodies(
          system.bodies(), parameters.of, parameters.section(), "Of"));

    const ProbeEnd from =
      surface_end(system, parameters, parameters.from, "From");
    const ProbeEnd to = surface_end(system, parameters, parameters.to, "To");
    const unsigned int axis = parameters.axis[0] - 'x';
    std::optional<ProbeEnd> point;
    if (!parameters.point.empty())
      {
        const Body &body = system.bodies()[from.body];
        point            = point_end(system,
                          parameters,
                          body.whole().empty() ? body.name() : body.whole(),
                          "From");
      }
    if (type == "chord")
      return std::make_unique<ChordProbe>(from, to, point, axis);
    return std::make_unique<ChordFrameProbe>(system, from, to, *point, axis);
  }
} // namespace ACF
