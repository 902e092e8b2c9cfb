// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/reduced_strain_residual.h>

#include <array>

namespace ACF
{
  namespace
  {
    Four
    lanes_of(const Vector3 &v)
    {
      return Four{v[0], v[1], v[2], 0};
    }



    // The columns of a matrix.
    struct Columns
    {
      Columns() = default;

      explicit Columns(const Matrix3 &A)
      {
        for (unsigned int j = 0; j < dim; ++j)
          column[j] = Four{A[0][j], A[1][j], A[2][j], 0};
      }

      ACF_INLINE Four
      operator*(const Four &x) const
      {
        return splat<0>(x) * column[0] + splat<1>(x) * column[1] +
               splat<2>(x) * column[2];
      }

      Four column[dim];
    };



    // q_i and a_i - g_i of the nodes from begin to end.
    template <unsigned int n>
    struct FillLanes
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          {
            const Four x_a = load_three(x + dim * a);
            const Four v_a = load_three(v + dim * a);
            const Four X_a = load_three(X + dim * a) - reference_centre;
            Four z_a[n];
            ACF_UNROLL
            for (unsigned int i = 0; i < n; ++i)
              z_a[i] = load_three(z[i] + dim * a);
            ACF_UNROLL
            for (unsigned int i = 0; i < n; ++i)
              {
                const Four y = x_a + times[i] * v_a + z_a[i] - centres[i];
                store_lanes(inverse_rotations[i] * y - X_a,
                            displacements + 4 * (n * a + i));
                Four acceleration = -gravity[i];
                ACF_UNROLL
                for (unsigned int j = 0; j < n; ++j)
                  acceleration += rates[i][j] * z_a[j];
                store_lanes(acceleration, accelerations + 4 * (n * a + i));
              }
          }
      }

      std::size_t begin, end;
      const double *x, *v, *X;
      Four reference_centre;
      const double *z[n];
      double times[n];
      double rates[n][n];
      Four centres[n];
      Columns inverse_rotations[n];
      Four gravity[n];
      double *displacements, *accelerations;
    };



    template <unsigned int n>
    void
    fill_lanes(const BodyOperators &body,
               const NodalMotion &motion,
               const std::vector<BodyRotation> &frames,
               ReducedStrainWork &work)
    {
      FillLanes<n> all;
      all.x                = motion.position->begin();
      all.v                = motion.velocity->begin();
      all.X                = body.reference_positions.begin();
      all.reference_centre = lanes_of(body.centre);
      all.displacements    = work.displacements.data();
      all.accelerations    = work.accelerations.data();
      for (unsigned int i = 0; i < n; ++i)
        {
          all.z[i]                 = motion.increments[i]->begin();
          all.times[i]             = motion.times[i];
          all.centres[i]           = lanes_of(motion.moments[i].mean);
          all.inverse_rotations[i] = Columns(transpose(frames[i].rotation));
          all.gravity[i]           = lanes_of(motion.gravity[i]);
          for (unsigned int j = 0; j < n; ++j)
            all.rates[i][j] = motion.rates(i, j);
        }
      run_ranges(body.n_nodes,
                 [&](const std::size_t begin, const std::size_t end) {
                   FillLanes<n> part = all;
                   part.begin        = begin;
                   part.end          = end;
                   run_vectorized(part);
                 });
    }



    // sum_a q_a x k_a of one of n vectors.
    struct AddMoments
    {
      ACF_INLINE void
      operator()() const
      {
        Four sum = {};
        for (std::size_t a = begin; a < end; ++a)
          {
            const Four q_a = load_lanes<Four>(q + 4 * n * a);
            const Four k_a = load_lanes<Four>(k + 4 * n * a);
            sum += __builtin_shufflevector(q_a, q_a, 1, 2, 0, 3) *
                     __builtin_shufflevector(k_a, k_a, 2, 0, 1, 3) -
                   __builtin_shufflevector(q_a, q_a, 2, 0, 1, 3) *
                     __builtin_shufflevector(k_a, k_a, 1, 2, 0, 3);
          }
        store_three(sum, result);
      }

      std::size_t begin, end;
      unsigned int n;
      const double *q, *k;
      double *result;
    };



    Vector3
    moment(const NodeLanes &q, const NodeLanes &k, const unsigned int i)
    {
      return sum_ranges<Vector3>(q.n_nodes(),
                                 [&](const std::size_t begin,
                                     const std::size_t end) {
                                   double sum[dim];
                                   run_vectorized(AddMoments{begin,
                                                             end,
                                                             q.n_vectors(),
                                                             q.data() + 4 * i,
                                                             k.data() + 4 * i,
                                                             sum});
                                   return Vector3(sum);
                                 });
    }



    // R (P g_a - k_a) - m_a for one of n vectors.
    struct CollectForces
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          store_three(balance * load_three(g + dim * a) -
                        rotation * load_lanes<Four>(k + 4 * n * a) -
                        load_lanes<Four>(m + 4 * n * a),
                      force + dim * a);
      }

      std::size_t begin, end;
      unsigned int n;
      Columns rotation, balance;
      const double *g, *k, *m;
      double *force;
    };
  } // namespace



  bool
  reduced_strain_residual(const BodyOperators &body,
                          const RotationMeasure measure,
                          const NodalMotion &motion,
                          const std::vector<NodalVector *> &residual,
                          ReducedStrainWork &work)
  {
    const unsigned int n = motion.times.size();
    std::vector<BodyRotation> frames;
    for (const NodalMoments &moments : motion.moments)
      {
        const auto frame = body_rotation(moments.gradient, measure);
        if (!frame)
          return false;
        frames.push_back(*frame);
      }

    work.displacements.resize(body.n_nodes, n);
    work.accelerations.resize(body.n_nodes, n);
    if (n == 1)
      fill_lanes<1>(body, motion, frames, work);
    else if (n == 2)
      fill_lanes<2>(body, motion, frames, work);
    else
      fill_lanes<3>(body, motion, frames, work);
    body.stiffness_matrix.vmult(work.stiffness_products, work.displacements);
    body.mass_matrix.vmult(work.mass_products, work.accelerations);

    for (unsigned int i = 0; i < n; ++i)
      {
        const Matrix3 &R = frames[i].rotation;
        const Matrix3 P  = frames[i].contract(
          moment(work.displacements, work.stiffness_products, i));
        NodalVector &force = *residual[i];
        AssertDimension(force.size(), body.n_unknowns());
        const Columns rotation(R), balance(R * P);
        run_ranges(body.n_nodes,
                   [&](const std::size_t begin, const std::size_t end) {
                     run_vectorized(
                       CollectForces{begin,
                                     end,
                                     n,
                                     rotation,
                                     balance,
                                     body.averaging_vectors.begin(),
                                     work.stiffness_products.data() + 4 * i,
                                     work.mass_products.data() + 4 * i,
                                     force.begin()});
                   });
      }
    return true;
  }
} // namespace ACF
