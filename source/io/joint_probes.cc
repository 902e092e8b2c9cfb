// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/io/probe_types.h>

#include <deal.II/base/numbers.h>

#include <cmath>

namespace ACF
{
  namespace
  {
    // The axes of a joint, which turn with its second side.
    class JointAxes
    {
    public:
      explicit JointAxes(const Joint &joint)
      {
        for (unsigned int i = 0; i < dim; ++i)
          directions[i] = joint.sides[1].direction(markers, joint.axes[i]);
      }

      std::array<Vector3, dim>
      operator()(const SystemState &state) const
      {
        const Eigen::VectorXd s = markers.values(state.positions);
        std::array<Vector3, dim> axes;
        for (unsigned int i = 0; i < dim; ++i)
          axes[i] = directions[i](s);
        return axes;
      }

    private:
      MarkerSet markers;
      std::array<SurfaceDirection, dim> directions;
    };



    class ReactionProbe : public Probe
    {
    public:
      ReactionProbe(const MultibodySystem &system,
                    const unsigned int joint,
                    const bool in_joint_axes)
        : system(system)
        , joint(joint)
      {
        if (in_joint_axes)
          axes.emplace(system.joints()[joint]);
      }

      std::vector<std::string>
      columns() const override
      {
        auto names        = vector_columns("N", "force ");
        const auto moment = vector_columns("N m", "moment ");
        names.insert(names.end(), moment.begin(), moment.end());
        return names;
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        auto reaction = system.reaction(joint, state);
        if (axes)
          {
            const auto directions = (*axes)(state);
            Vector3 force, moment;
            for (unsigned int i = 0; i < dim; ++i)
              {
                force[i]  = reaction.force * directions[i];
                moment[i] = reaction.moment * directions[i];
              }
            reaction = {force, moment};
          }
        auto values       = components(reaction.force);
        const auto moment = components(reaction.moment);
        values.insert(values.end(), moment.begin(), moment.end());
        return values;
      }

    private:
      const MultibodySystem &system;
      const unsigned int joint;
      std::optional<JointAxes> axes;
    };



    // Relative motion of the sides of a joint: functions of markers of its own,
    // with their rates.
    class JointMotionProbe : public Probe
    {
    public:
      JointMotionProbe(const Joint &joint, const std::string &type)
        : type(type)
      {
        const auto &sides = joint.sides;
        if (type == "joint angle")
          functions.push_back(
            relative_angle(markers, sides[0], sides[1], joint.axes[2]));
        else
          for (const Vector3 &axis : joint.axes)
            functions.push_back(
              type == "joint displacement"
                ? relative_displacement(markers, sides[0], sides[1], axis)
                : relative_rotation(markers, sides[0], sides[1], axis));
      }

      std::vector<std::string>
      columns() const override
      {
        if (type == "joint angle")
          return {"angle [rad]", "rate [rad/s]"};
        return vector_columns(type == "joint displacement" ? "m" : "rad");
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        const Eigen::VectorXd s = markers.values(state.positions);
        std::vector<double> values;
        for (const MarkerFunction &function : functions)
          values.push_back(function.value(s));
        if (type == "joint angle")
          {
            // the branch nearest to the angle before
            angle =
              n_evaluations++ == 0
                ? values[0]
                : angle + std::remainder(values[0] - angle, 2 * numbers::PI);
            const Eigen::VectorXd v = markers.values(state.velocities);
            return {angle, functions[0].gradient(s).dot(v)};
          }
        return values;
      }

      void
      exchange(Archive &archive) override
      {
        archive("evaluations", n_evaluations);
        archive("angle", angle);
      }

    private:
      const std::string type;
      MarkerSet markers;
      std::vector<MarkerFunction> functions;
      unsigned long n_evaluations = 0;
      double angle                = 0;
    };



    unsigned int
    find_joint(const MultibodySystem &system, const ProbeParameters &parameters)
    {
      std::string names;
      for (unsigned int j = 0; j < system.joints().size(); ++j)
        {
          if (system.joints()[j].name == parameters.of)
            return j;
          names += (j > 0 ? ", " : "") + system.joints()[j].name;
        }
      throw InputError(parameters.section(),
                       "Of",
                       "the joint '" + parameters.of +
                         "', which does not exist",
                       names.empty() ? "nothing, as there are no joints"
                                     : names);
    }
  } // namespace



  std::unique_ptr<Probe>
  make_joint_probe(const ProbeParameters &parameters,
                   const MultibodySystem &system)
  {
    const unsigned int j = find_joint(system, parameters);
    if (parameters.type == "reaction")
      return std::make_unique<ReactionProbe>(system,
                                             j,
                                             parameters.axes == "joint");
    return std::make_unique<JointMotionProbe>(system.joints()[j],
                                              parameters.type);
  }
} // namespace ACF
