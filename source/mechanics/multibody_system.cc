// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/elastic_force.h>
#include <acf/mechanics/multibody_system.h>
#include <acf/mechanics/sub_bodies.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ACF
{
  namespace
  {
    Vector3
    marker_value(const Eigen::VectorXd &s, const unsigned int m)
    {
      return Vector3({s(dim * m), s(dim * m + 1), s(dim * m + 2)});
    }



    // The values of some markers.
    Eigen::VectorXd
    gather(const Eigen::VectorXd &s, const std::vector<unsigned int> &numbers)
    {
      Eigen::VectorXd local(s.size() > 0 ? dim * numbers.size() : 0);
      if (s.size() > 0)
        for (unsigned int p = 0; p < numbers.size(); ++p)
          local.segment<dim>(dim * p) = s.segment<dim>(dim * numbers[p]);
      return local;
    }



    void
    scatter_add(const Eigen::VectorXd &local,
                const std::vector<unsigned int> &numbers,
                Eigen::VectorXd &s)
    {
      for (unsigned int p = 0; p < numbers.size(); ++p)
        s.segment<dim>(dim * numbers[p]) += local.segment<dim>(dim * p);
    }



    // All entries of a local matrix, zeros too: the pattern does not change.
    void
    add_triplets(const Eigen::MatrixXd &local,
                 const std::vector<unsigned int> &numbers,
                 MarkerLinearization::Triplets &triplets)
    {
      for (unsigned int j = 0; j < local.cols(); ++j)
        for (unsigned int i = 0; i < local.rows(); ++i)
          triplets.emplace_back(dim * numbers[i / dim] + i % dim,
                                dim * numbers[j / dim] + j % dim,
                                local(i, j));
    }
  } // namespace



  std::vector<JointParameters>
  MultibodySystem::make_bodies(const SystemParameters &parameters,
                               const std::filesystem::path &directory)
  {
    SystemBodies made = ACF::make_bodies(parameters.bodies, directory);
    reference_bodies  = std::move(made.references);
    system_bodies     = std::move(made.bodies);
    markers.resize(system_bodies.size());
    for (const Body &body : system_bodies)
      damped = damped || body.is_damped();

    std::vector<JointParameters> joints = parameters.joints;
    for (const JointParameters &glue : made.joints)
      {
        for (const JointParameters &joint : joints)
          if (joint.name == glue.name)
            throw InputError("Joints",
                             "Names",
                             "'" + joint.name +
                               "', the name of the joint between two parts of "
                               "a body",
                             "another name");
        joints.push_back(glue);
      }
    return joints;
  }



  MultibodySystem::MultibodySystem(const SystemParameters &parameters,
                                   const std::filesystem::path &directory)
    : gravity_acceleration(parameters.loads.gravity)
    , gravity_factor(parameters.loads.gravity_factor, "Loads", "Gravity factor")
  {
    for (const JointParameters &joint : make_bodies(parameters, directory))
      {
        system_joints.push_back(make_joint(joint, system_bodies));
        first_rows.push_back(n_rows);
        n_rows += system_joints.back().n_constraints();
        affine_joints = affine_joints && system_joints.back().is_affine();
        joint_markers.push_back(register_markers(system_joints.back().markers));
      }
    for (const ForceElementParameters &element : parameters.force_elements)
      {
        elements.push_back(make_force_element(element, system_bodies));
        damped = damped || elements.back().is_damped();
        element_markers.push_back(register_markers(elements.back().markers));
      }
    for (const LumpedMassParameters &mass : parameters.masses)
      {
        lumped_masses.push_back(make_lumped_mass(mass, system_bodies));
        mass_markers.push_back(register_markers(lumped_masses.back().markers));
      }
    for (const SurfaceLoadParameters &load : parameters.surface_loads)
      for (const SurfaceLoad &part : make_surface_loads(load, system_bodies))
        surface_loads.push_back(part);
    number_markers();
    repeated = repeated_constraints(marker_values(placement()));
  }



  MultibodySystem::MultibodySystem(const std::vector<BodyParameters> &bodies,
                                   const std::vector<JointParameters> &joints,
                                   const LoadParameters &loads,
                                   const std::filesystem::path &directory)
    : MultibodySystem(SystemParameters{bodies, joints, loads, {}, {}, {}},
                      directory)
  {}



  std::vector<unsigned int>
  MultibodySystem::register_markers(const MarkerSet &set)
  {
    // for now the number among the markers of its body
    std::vector<unsigned int> numbers;
    for (const Marker &marker : set.markers())
      {
        const unsigned int functional =
          system_bodies[marker.body].reference().add_functional(
            marker.functional);
        auto &own     = markers[marker.body];
        const auto it = std::find(own.begin(), own.end(), functional);
        numbers.push_back(it - own.begin());
        if (it == own.end())
          own.push_back(functional);
      }
    return numbers;
  }



  void
  MultibodySystem::number_markers()
  {
    first_markers = {0};
    for (const auto &own : markers)
      first_markers.push_back(first_markers.back() + own.size());
    const auto shift = [&](const MarkerSet &set,
                           std::vector<unsigned int> &numbers) {
      for (unsigned int p = 0; p < numbers.size(); ++p)
        numbers[p] += first_markers[set.markers()[p].body];
    };
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      shift(system_joints[j].markers, joint_markers[j]);
    for (unsigned int e = 0; e < elements.size(); ++e)
      shift(elements[e].markers, element_markers[e]);
    for (unsigned int l = 0; l < lumped_masses.size(); ++l)
      shift(lumped_masses[l].markers, mass_markers[l]);
  }



  RepeatedConstraints
  MultibodySystem::repeated_constraints(const Eigen::VectorXd &s) const
  {
    // B B^T with B = D S, from the products of the functionals' weights
    MarkerLinearization::Triplets products, gradients;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        const auto &functionals = system_bodies[b].reference().functionals();
        for (unsigned int p = 0; p < markers[b].size(); ++p)
          for (unsigned int q = 0; q < markers[b].size(); ++q)
            for (unsigned int i = 0; i < dim; ++i)
              products.emplace_back(dim * (first_markers[b] + p) + i,
                                    dim * (first_markers[b] + q) + i,
                                    scalar_product(functionals[markers[b][p]],
                                                   functionals[markers[b][q]]));
      }
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const Eigen::MatrixXd D =
          system_joints[j].jacobian(gather(s, joint_markers[j]));
        for (unsigned int r = 0; r < D.rows(); ++r)
          for (unsigned int i = 0; i < D.cols(); ++i)
            gradients.emplace_back(first_rows[j] + r,
                                   dim * joint_markers[j][i / dim] + i % dim,
                                   D(r, i));
      }
    Eigen::SparseMatrix<double> P(n_marker_values(), n_marker_values());
    Eigen::SparseMatrix<double> D(n_rows, n_marker_values());
    P.setFromTriplets(products.begin(), products.end());
    D.setFromTriplets(gradients.begin(), gradients.end());
    return find_repeated_constraints(D * P * D.transpose());
  }



  unsigned int
  MultibodySystem::joint_of_row(const unsigned int row) const
  {
    return std::upper_bound(first_rows.begin(), first_rows.end(), row) -
           first_rows.begin() - 1;
  }



  std::string
  MultibodySystem::repeating_joints() const
  {
    std::set<unsigned int> joints;
    for (unsigned int r = 0; r < n_rows; ++r)
      if (n_repeated_constraints() > 0 &&
          repeated.null_space.row(r).lpNorm<Eigen::Infinity>() > 1e-6)
        joints.insert(joint_of_row(r));
    std::string text;
    for (const unsigned int j : joints)
      text += (text.empty() ? "'" : ", '") + system_joints[j].name + "'";
    return text;
  }



  double
  MultibodySystem::contradiction(const double t, const Eigen::VectorXd &s) const
  {
    if (n_repeated_constraints() == 0)
      return 0;
    const Eigen::VectorXd residual = constraint_residual(t, s);
    const Eigen::VectorXd parts    = repeated.null_space.transpose() *
                                  repeated.row_scales.cwiseProduct(residual);
    // in the units of the constraints
    return (repeated.null_space * parts)
      .cwiseQuotient(repeated.row_scales)
      .lpNorm<Eigen::Infinity>();
  }



  SystemState
  MultibodySystem::initial_state() const
  {
    SystemState state;
    for (const Body &body : system_bodies)
      {
        state.positions.push_back(body.initial_positions());
        state.velocities.push_back(body.initial_velocities());
      }
    state.multipliers = Eigen::VectorXd::Zero(n_constraints());
    if (!elements.empty())
      state.law_values =
        law_values(marker_values(state.positions), Eigen::VectorXd());
    return state;
  }



  SystemVector
  MultibodySystem::placement() const
  {
    SystemVector positions;
    for (const Body &body : system_bodies)
      positions.push_back(body.placement());
    return positions;
  }



  Eigen::VectorXd
  MultibodySystem::marker_values(const SystemVector &x) const
  {
    Eigen::VectorXd s(n_marker_values());
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      for (unsigned int p = 0; p < markers[b].size(); ++p)
        {
          const Vector3 value =
            system_bodies[b].reference().functionals()[markers[b][p]](x[b]);
          for (unsigned int i = 0; i < dim; ++i)
            s(dim * (first_markers[b] + p) + i) = value[i];
        }
    return s;
  }



  Eigen::VectorXd
  MultibodySystem::constraint_residual(const double t,
                                       const Eigen::VectorXd &s) const
  {
    Eigen::VectorXd residual(n_rows);
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      residual.segment(first_rows[j], system_joints[j].n_constraints()) =
        system_joints[j].residual(t, gather(s, joint_markers[j]));
    return residual;
  }



  Eigen::VectorXd
  MultibodySystem::constraint_residual(const SystemVector &positions,
                                       const double t) const
  {
    return constraint_residual(t, marker_values(positions));
  }



  Eigen::VectorXd
  MultibodySystem::constraint_velocity(const double t,
                                       const Eigen::VectorXd &s,
                                       const Eigen::VectorXd &v) const
  {
    Eigen::VectorXd result(n_rows);
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const Joint &joint = system_joints[j];
        result.segment(first_rows[j], joint.n_constraints()) =
          joint.jacobian(gather(s, joint_markers[j])) *
            gather(v, joint_markers[j]) -
          joint.drive_rates(t);
      }
    return result;
  }



  Eigen::VectorXd
  MultibodySystem::law_values(const Eigen::VectorXd &s,
                              const Eigen::VectorXd &reference) const
  {
    unsigned int n = 0;
    for (const ForceElement &element : elements)
      n += element.laws.size();
    Eigen::VectorXd values(n);
    unsigned int k = 0;
    for (unsigned int e = 0; e < elements.size(); ++e)
      {
        const Eigen::VectorXd y =
          elements[e].values(gather(s, element_markers[e]));
        for (unsigned int i = 0; i < y.size(); ++i, ++k)
          {
            values(k) = y(i);
            if (reference.size() > 0 && elements[e].laws[i].function.is_angle())
              values(k) = reference(k) +
                          std::remainder(y(i) - reference(k), 2 * numbers::PI);
          }
      }
    return values;
  }



  Eigen::VectorXd
  MultibodySystem::marker_forces(const double t,
                                 const Eigen::VectorXd &s,
                                 const Eigen::VectorXd &v,
                                 const Eigen::VectorXd &a,
                                 const Eigen::VectorXd &multipliers,
                                 const Eigen::VectorXd &law_reference,
                                 const double load_factor) const
  {
    Eigen::VectorXd F = Eigen::VectorXd::Zero(n_marker_values());
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      scatter_add(
        -system_joints[j].jacobian(gather(s, joint_markers[j])).transpose() *
          multipliers.segment(first_rows[j], system_joints[j].n_constraints()),
        joint_markers[j],
        F);
    if (!elements.empty())
      {
        const Eigen::VectorXd y = law_values(s, law_reference);
        unsigned int k          = 0;
        for (unsigned int e = 0; e < elements.size(); ++e)
          {
            const unsigned int n = elements[e].laws.size();
            scatter_add(elements[e].force(t,
                                          gather(s, element_markers[e]),
                                          gather(v, element_markers[e]),
                                          y.segment(k, n),
                                          load_factor),
                        element_markers[e],
                        F);
            k += n;
          }
      }
    for (unsigned int l = 0; l < lumped_masses.size(); ++l)
      {
        const LumpedMass &lump = lumped_masses[l];
        const auto &numbers    = mass_markers[l];
        const Vector3 weight   = load_factor * lump.mass * gravity(t);
        for (unsigned int p = 0; p < numbers.size(); ++p)
          {
            for (unsigned int q = 0; q < numbers.size(); ++q)
              F.segment<dim>(dim * numbers[p]) -=
                lump.mass_matrix(p, q) * a.segment<dim>(dim * numbers[q]);
            if (p == 0)
              for (unsigned int i = 0; i < dim; ++i)
                F(dim * numbers[p] + i) += weight[i];
          }
      }
    return F;
  }



  MarkerLinearization
  MultibodySystem::linearize(const double t,
                             const Eigen::VectorXd &s,
                             const Eigen::VectorXd &v,
                             const Eigen::VectorXd &multipliers,
                             const Eigen::VectorXd &law_reference,
                             const double load_factor) const
  {
    MarkerLinearization result;
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const Joint &joint          = system_joints[j];
        const Eigen::VectorXd local = gather(s, joint_markers[j]);
        const Eigen::MatrixXd D     = joint.jacobian(local);
        for (unsigned int r = 0; r < D.rows(); ++r)
          for (unsigned int i = 0; i < D.cols(); ++i)
            result.constraints.emplace_back(first_rows[j] + r,
                                            dim * joint_markers[j][i / dim] +
                                              i % dim,
                                            D(r, i));
        if (!joint.is_affine())
          add_triplets(
            joint.geometric_stiffness(
              local, multipliers.segment(first_rows[j], joint.n_constraints())),
            joint_markers[j],
            result.stiffness);
      }
    unsigned int k = 0;
    const Eigen::VectorXd y =
      elements.empty() ? Eigen::VectorXd() : law_values(s, law_reference);
    for (unsigned int e = 0; e < elements.size(); ++e)
      {
        const unsigned int n        = elements[e].laws.size();
        const Eigen::VectorXd local = gather(s, element_markers[e]);
        add_triplets(elements[e].stiffness(t,
                                           local,
                                           gather(v, element_markers[e]),
                                           y.segment(k, n),
                                           load_factor),
                     element_markers[e],
                     result.stiffness);
        if (elements[e].is_damped())
          add_triplets(elements[e].damping(local),
                       element_markers[e],
                       result.damping);
        k += n;
      }
    for (unsigned int l = 0; l < lumped_masses.size(); ++l)
      for (unsigned int p = 0; p < mass_markers[l].size(); ++p)
        for (unsigned int q = 0; q < mass_markers[l].size(); ++q)
          for (unsigned int i = 0; i < dim; ++i)
            result.mass.emplace_back(dim * mass_markers[l][p] + i,
                                     dim * mass_markers[l][q] + i,
                                     lumped_masses[l].mass_matrix(p, q));
    if (n_repeated_constraints() > 0)
      {
        const RepeatedConstraints now =
          affine_joints ? repeated : repeated_constraints(s);
        const Eigen::MatrixXd N =
          now.row_scales.cwiseInverse().asDiagonal() * now.null_space;
        for (unsigned int r = 0; r < n_rows; ++r)
          for (unsigned int q = 0; q < n_rows; ++q)
            if (N.row(r).squaredNorm() * N.row(q).squaredNorm() > 0)
              result.redundancy.emplace_back(r, q, N.row(r).dot(N.row(q)));
      }
    return result;
  }



  void
  MultibodySystem::add_marker_forces(const unsigned int body,
                                     const Eigen::VectorXd &F,
                                     NodalVector &force) const
  {
    for (unsigned int p = 0; p < markers[body].size(); ++p)
      system_bodies[body]
        .reference()
        .functionals()[markers[body][p]]
        .add_adjoint(marker_value(F, first_markers[body] + p), force);
  }



  bool
  MultibodySystem::has_surface_loads(const unsigned int body) const
  {
    return std::any_of(surface_loads.begin(),
                       surface_loads.end(),
                       [&](const SurfaceLoad &load) {
                         return load.body() == body;
                       });
  }



  void
  MultibodySystem::add_surface_loads(const unsigned int body,
                                     const double t,
                                     const NodalVector &positions,
                                     NodalVector &force,
                                     const double load_factor) const
  {
    std::optional<BodyRotation> frame;
    for (const SurfaceLoad &load : surface_loads)
      if (load.body() == body)
        {
          if (load.depends_on_rotation() && !frame)
            frame = body_rotation(mean_deformation_gradient(
                                    system_bodies[body].operators(), positions),
                                  system_bodies[body].rotation_measure());
          load.add_force(t,
                         frame ? frame->rotation : Matrix3(),
                         force,
                         load_factor);
        }
  }



  void
  MultibodySystem::add_loads(const unsigned int body,
                             const double t,
                             const NodalVector &positions,
                             NodalVector &force,
                             const double load_factor) const
  {
    const BodyOperators &operators = system_bodies[body].operators();
    if (gravity_acceleration.norm_square() > 0)
      {
        const Vector3 acceleration = load_factor * gravity(t);
        for (unsigned int a = 0; a < operators.n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            force[dim * a + i] += operators.nodal_masses[a] * acceleration[i];
      }
    add_surface_loads(body, t, positions, force, load_factor);
  }



  SystemEnergy
  MultibodySystem::energy(const SystemState &state) const
  {
    SystemEnergy energy;
    const Vector3 g = gravity(state.time);
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        const BodyOperators &operators = system_bodies[b].operators();
        energy.kinetic +=
          0.5 * operators.mass_matrix.quadratic_form(state.velocities[b]);
        energy.elastic +=
          elastic_energy(system_bodies[b], state.positions[b]).value();
        energy.potential -=
          operators.mass * (g * mass_mean(operators, state.positions[b]));
      }
    if (elements.empty() && lumped_masses.empty())
      return energy;

    const Eigen::VectorXd s = marker_values(state.positions);
    const Eigen::VectorXd v = marker_values(state.velocities);
    unsigned int k          = 0;
    for (const ForceElement &element : elements)
      {
        energy.elastic +=
          element.energy(state.law_values.segment(k, element.laws.size()));
        k += element.laws.size();
      }
    for (unsigned int l = 0; l < lumped_masses.size(); ++l)
      {
        const LumpedMass &lump = lumped_masses[l];
        const auto &numbers    = mass_markers[l];
        for (unsigned int p = 0; p < numbers.size(); ++p)
          for (unsigned int q = 0; q < numbers.size(); ++q)
            energy.kinetic +=
              0.5 * lump.mass_matrix(p, q) *
              (marker_value(v, numbers[p]) * marker_value(v, numbers[q]));
        energy.potential -= lump.mass * (g * marker_value(s, numbers[0]));
      }
    return energy;
  }



  Vector3
  MultibodySystem::momentum(const SystemState &state) const
  {
    Vector3 momentum;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      momentum += system_bodies[b].operators().mass *
                  mass_mean(system_bodies[b].operators(), state.velocities[b]);
    if (!lumped_masses.empty())
      {
        const Eigen::VectorXd v = marker_values(state.velocities);
        for (unsigned int l = 0; l < lumped_masses.size(); ++l)
          momentum +=
            lumped_masses[l].mass * marker_value(v, mass_markers[l][0]);
      }
    return momentum;
  }



  Vector3
  MultibodySystem::angular_momentum(const SystemState &state) const
  {
    Vector3 result;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        const BodyOperators &operators = system_bodies[b].operators();
        NodalVector product(operators.n_unknowns());
        operators.mass_matrix.vmult(product, state.velocities[b]);
        for (unsigned int a = 0; a < operators.n_nodes; ++a)
          {
            Vector3 x, momentum;
            for (unsigned int i = 0; i < dim; ++i)
              {
                x[i]        = state.positions[b][dim * a + i];
                momentum[i] = product[dim * a + i];
              }
            result += cross_product_3d(x, momentum);
          }
      }
    if (lumped_masses.empty())
      return result;
    const Eigen::VectorXd s = marker_values(state.positions);
    const Eigen::VectorXd v = marker_values(state.velocities);
    for (unsigned int l = 0; l < lumped_masses.size(); ++l)
      for (unsigned int p = 0; p < mass_markers[l].size(); ++p)
        for (unsigned int q = 0; q < mass_markers[l].size(); ++q)
          result += lumped_masses[l].mass_matrix(p, q) *
                    cross_product_3d(marker_value(s, mass_markers[l][p]),
                                     marker_value(v, mass_markers[l][q]));
    return result;
  }



  Eigen::VectorXd
  MultibodySystem::joint_marker_forces(const unsigned int index,
                                       const Eigen::VectorXd &s,
                                       const SystemState &state) const
  {
    const Joint &joint = system_joints[index];
    return -joint.jacobian(s).transpose() *
           state.multipliers.segment(first_rows[index], joint.n_constraints());
  }



  void
  MultibodySystem::add_joint_forces(const unsigned int body,
                                    const SystemState &state,
                                    NodalVector &force) const
  {
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const MarkerSet &set  = system_joints[j].markers;
        const auto &markers   = set.markers();
        const auto is_on_body = [&](const Marker &marker) {
          return marker.body == body;
        };
        if (std::none_of(markers.begin(), markers.end(), is_on_body))
          continue;
        const Eigen::VectorXd F =
          joint_marker_forces(j, set.values(state.positions), state);
        for (unsigned int p = 0; p < markers.size(); ++p)
          if (is_on_body(markers[p]))
            markers[p].functional.add_adjoint(marker_value(F, p), force);
      }
  }



  MultibodySystem::Reaction
  MultibodySystem::reaction(const unsigned int index,
                            const SystemState &state) const
  {
    const Joint &joint      = system_joints[index];
    const JointSide &side   = joint.sides[joint.sides[0].is_ground() ? 1 : 0];
    const Eigen::VectorXd s = joint.markers.values(state.positions);
    const Eigen::VectorXd F = joint_marker_forces(index, s, state);
    Reaction reaction;
    for (unsigned int p = 0; p < joint.markers.markers().size(); ++p)
      {
        const Marker &marker = joint.markers.markers()[p];
        if (!side.owns(marker))
          continue;
        if (marker.is_position)
          reaction.force += marker_value(F, p);
        else
          reaction.moment +=
            cross_product_3d(marker_value(s, p), marker_value(F, p));
      }
    return reaction;
  }



  void
  SystemState::exchange(Archive &archive)
  {
    archive("time", time);
    archive("positions", positions);
    archive("velocities", velocities);
    archive("multipliers", multipliers);
    archive("law values", law_values);
  }
} // namespace ACF
