// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/node_lanes.h>
#include <acf/mechanics/reduced_strain.h>

#include <array>

namespace ACF
{
  namespace
  {
    Vector3
    node_value(const NodalVector &v, const std::size_t a)
    {
      const double *const value = v.begin() + dim * a;
      return Vector3({value[0], value[1], value[2]});
    }



    void
    set_node_value(NodalVector &v, const std::size_t a, const Vector3 &value)
    {
      double *const entry = v.begin() + dim * a;
      for (unsigned int i = 0; i < dim; ++i)
        entry[i] = value[i];
    }



    /** From k and c to $f_a = R (k_a - P g_a)$, in place. */
    void
    balance_moment(const BodyOperators &body,
                   const BodyRotation &frame,
                   const Vector3 &c,
                   NodalVector &force)
    {
      const Matrix3 P = frame.contract(c);
      const Matrix3 R = frame.rotation;
      run_ranges(
        body.n_nodes, [&](const std::size_t begin, const std::size_t end) {
          for (std::size_t a = begin; a < end; ++a)
            set_node_value(force,
                           a,
                           R * (node_value(force, a) -
                                P * node_value(body.averaging_vectors, a)));
        });
    }
  } // namespace



  namespace
  {
    // The sums of NodalMoments for the nodes from begin to end; the mean is not
    // divided by the mass.
    template <unsigned int n>
    struct AddMoments
    {
      ACF_INLINE void
      operator()() const
      {
        Four gradients[n][dim] = {};
        Four means[n]          = {};
        for (std::size_t a = begin; a < end; ++a)
          {
            const Four g_a = load_three(g + dim * a);
            ACF_UNROLL
            for (unsigned int v = 0; v < n; ++v)
              {
                const Four x_a = load_three(x[v] + dim * a);
                gradients[v][0] += splat<0>(x_a) * g_a;
                gradients[v][1] += splat<1>(x_a) * g_a;
                gradients[v][2] += splat<2>(x_a) * g_a;
                means[v] += m[a] * x_a;
              }
          }
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int i = 0; i < dim; ++i)
            {
              for (unsigned int j = 0; j < dim; ++j)
                result[v].gradient[i][j] = gradients[v][i][j];
              result[v].mean[i] = means[v][i];
            }
      }

      std::size_t begin, end;
      const double *x[n];
      const double *g, *m;
      NodalMoments *result;
    };



    template <unsigned int n>
    std::array<NodalMoments, n>
    add_moments(const BodyOperators &body,
                const std::array<const NodalVector *, n> &fields)
    {
      AddMoments<n> all{};
      for (unsigned int v = 0; v < n; ++v)
        {
          AssertDimension(fields[v]->size(), body.n_unknowns());
          all.x[v] = fields[v]->begin();
        }
      all.g = body.averaging_vectors.begin();
      all.m = body.nodal_masses.data();

      const unsigned int n_parts = n_ranges(body.n_nodes);
      std::vector<std::array<NodalMoments, n>> parts(n_parts);
      run_tasks(n_parts, [&](const unsigned int p) {
        AddMoments<n> part = all;
        part.begin         = std::size_t(body.n_nodes) * p / n_parts;
        part.end           = std::size_t(body.n_nodes) * (p + 1) / n_parts;
        part.result        = parts[p].data();
        run_vectorized(part);
      });
      for (unsigned int v = 0; v < n; ++v)
        {
          for (unsigned int p = 1; p < n_parts; ++p)
            parts[0][v] += parts[p][v];
          parts[0][v].mean /= body.mass;
        }
      return parts[0];
    }
  } // namespace



  NodalMoments &
  NodalMoments::operator+=(const NodalMoments &other)
  {
    gradient += other.gradient;
    mean += other.mean;
    return *this;
  }



  NodalMoments
  add(const NodalMoments &x, const double factor, const NodalMoments &y)
  {
    return {x.gradient + factor * y.gradient, x.mean + factor * y.mean};
  }



  NodalMoments
  nodal_moments(const BodyOperators &body, const NodalVector &field)
  {
    return add_moments<1>(body, {{&field}})[0];
  }



  std::vector<NodalMoments>
  nodal_moments(const BodyOperators &body,
                const std::vector<const NodalVector *> &fields)
  {
    std::vector<NodalMoments> moments;
    const auto add_all = [&moments](const auto &some) {
      moments.insert(moments.end(), some.begin(), some.end());
    };
    std::size_t v = 0;
    for (; v + 3 <= fields.size(); v += 3)
      add_all(
        add_moments<3>(body, {{fields[v], fields[v + 1], fields[v + 2]}}));
    if (v + 2 == fields.size())
      add_all(add_moments<2>(body, {{fields[v], fields[v + 1]}}));
    else if (v + 1 == fields.size())
      add_all(add_moments<1>(body, {{fields[v]}}));
    return moments;
  }



  Matrix3
  mean_deformation_gradient(const BodyOperators &body,
                            const NodalVector &positions)
  {
    return nodal_moments(body, positions).gradient;
  }



  Vector3
  mass_mean(const BodyOperators &body, const NodalVector &field)
  {
    return nodal_moments(body, field).mean;
  }



  void
  co_rotated_displacement(const BodyOperators &body,
                          const NodalVector &positions,
                          const Matrix3 &rotation,
                          NodalVector &displacement)
  {
    AssertDimension(displacement.size(), body.n_unknowns());
    const Vector3 centre = mass_mean(body, positions);
    const Matrix3 R      = rotation;
    run_ranges(body.n_nodes,
               [&](const std::size_t begin, const std::size_t end) {
                 for (std::size_t a = begin; a < end; ++a)
                   set_node_value(displacement,
                                  a,
                                  (node_value(positions, a) - centre) * R -
                                    (node_value(body.reference_positions, a) -
                                     body.centre));
               });
  }



  Vector3
  frame_spin(const BodyRotation &frame, const Matrix3 &velocity_gradient)
  {
    const Matrix3 H = transpose(frame.rotation) * velocity_gradient;
    Vector3 spin;
    for (unsigned int i = 0; i < dim; ++i)
      spin[i] = scalar_product(frame.spin_gradient[i], H);
    return spin;
  }



  std::optional<Vector3>
  body_spin(const RotationMeasure measure,
            const Matrix3 &gradient,
            const Matrix3 &velocity_gradient)
  {
    const auto frame = body_rotation(gradient, measure);
    if (!frame)
      return {};
    return frame->rotation * frame_spin(*frame, velocity_gradient);
  }



  void
  co_rotated_velocity(const BodyOperators &body,
                      const BodyRotation &frame,
                      const NodalVector &positions,
                      const NodalVector &velocities,
                      NodalVector &rate)
  {
    AssertDimension(rate.size(), body.n_unknowns());
    const Matrix3 inverse         = transpose(frame.rotation);
    const NodalMoments moments    = nodal_moments(body, velocities);
    const Vector3 spin            = frame_spin(frame, moments.gradient);
    const Vector3 centre          = mass_mean(body, positions);
    const Vector3 centre_velocity = moments.mean;
    for (unsigned int a = 0; a < body.n_nodes; ++a)
      {
        const Vector3 y = inverse * (node_value(positions, a) - centre);
        set_node_value(rate,
                       a,
                       inverse * (node_value(velocities, a) - centre_velocity) -
                         cross_product_3d(spin, y));
      }
  }



  namespace
  {
    // From k = A q to the force, in place. @return the energy
    double
    force_of_products(const BodyOperators &body,
                      const BodyRotation &frame,
                      const NodalVector &q,
                      NodalVector &force)
    {
      // the moment c and twice the energy
      const auto sums = sum_ranges<Tensor<1, dim + 1>>(
        body.n_nodes, [&](const std::size_t begin, const std::size_t end) {
          Tensor<1, dim + 1> sum;
          for (std::size_t a = begin; a < end; ++a)
            {
              const Vector3 q_a    = node_value(q, a);
              const Vector3 k_a    = node_value(force, a);
              const Vector3 moment = cross_product_3d(q_a, k_a);
              for (unsigned int i = 0; i < dim; ++i)
                sum[i] += moment[i];
              sum[dim] += q_a * k_a;
            }
          return sum;
        });
      balance_moment(body, frame, Vector3({sums[0], sums[1], sums[2]}), force);
      return 0.5 * sums[dim];
    }
  } // namespace



  std::optional<double>
  reduced_strain_force(const BodyOperators &body,
                       const RotationMeasure measure,
                       const NodalVector &positions,
                       NodalVector &force,
                       NodalVector &scratch)
  {
    const std::optional<BodyRotation> frame =
      body_rotation(mean_deformation_gradient(body, positions), measure);
    if (!frame)
      return {};

    NodalVector &q = scratch;
    co_rotated_displacement(body, positions, frame->rotation, q);
    body.stiffness_matrix.vmult(force, q);

    return force_of_products(body, *frame, q, force);
  }



  std::optional<double>
  reduced_strain_energy(const BodyOperators &body,
                        const RotationMeasure measure,
                        const NodalVector &positions)
  {
    const std::optional<BodyRotation> frame =
      body_rotation(mean_deformation_gradient(body, positions), measure);
    if (!frame)
      return {};
    NodalVector q(positions.size());
    co_rotated_displacement(body, positions, frame->rotation, q);
    return 0.5 * body.stiffness_matrix.quadratic_form(q);
  }



  bool
  damped_reduced_strain_force(const BodyOperators &body,
                              const RotationMeasure measure,
                              const NodalVector &positions,
                              const NodalVector &velocities,
                              const double mass_damping,
                              const double stiffness_damping,
                              NodalVector &force,
                              NodalVector &scratch,
                              const bool with_elasticity)
  {
    const std::optional<BodyRotation> frame =
      body_rotation(mean_deformation_gradient(body, positions), measure);
    if (!frame)
      return false;

    NodalVector &rate = scratch;
    NodalVector momentum;
    co_rotated_velocity(body, *frame, positions, velocities, rate);
    if (mass_damping != 0)
      {
        momentum.reinit(rate.size(), true);
        body.mass_matrix.vmult(momentum, rate);
      }

    // force = A (q + beta q'), by way of force = q
    co_rotated_displacement(body, positions, frame->rotation, force);
    rate.sadd(stiffness_damping, with_elasticity ? 1 : 0, force);
    body.stiffness_matrix.vmult(force, rate);

    // A annihilates rotations of the reference body, so that its part of the
    // moment c needs only the small q, not y = q + X.
    NodalVector &q = scratch;
    co_rotated_displacement(body, positions, frame->rotation, q);
    Vector3 c;
    for (unsigned int a = 0; a < body.n_nodes; ++a)
      {
        const Vector3 q_a = node_value(q, a);
        c += cross_product_3d(q_a, node_value(force, a));
        if (mass_damping == 0)
          continue;
        const Vector3 y_a =
          q_a + node_value(body.reference_positions, a) - body.centre;
        const Vector3 drag = mass_damping * node_value(momentum, a);
        c += cross_product_3d(y_a, drag);
        set_node_value(force, a, node_value(force, a) + drag);
      }

    balance_moment(body, *frame, c, force);
    return true;
  }
} // namespace ACF
