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



    // (a_2, a_3, a_1) and (a_3, a_1, a_2)
    ACF_INLINE Four
    rotate_down(const Four &a)
    {
      return __builtin_shufflevector(a, a, 1, 2, 0, 3);
    }

    ACF_INLINE Four
    rotate_up(const Four &a)
    {
      return __builtin_shufflevector(a, a, 2, 0, 1, 3);
    }

    ACF_INLINE Four
    cross_product(const Four &a, const Four &b)
    {
      return rotate_down(a) * rotate_up(b) - rotate_up(a) * rotate_down(b);
    }



    // q_i and a_i - g_i of the nodes from begin to end, and with damping their
    // q_i + beta q_i' and, unless there is no place for it, q_i'.
    template <unsigned int n, bool is_damped>
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
                const std::size_t place = 4 * (n * a + i);
                const Four y            = inverse_rotations[i] *
                               (x_a + times[i] * v_a + z_a[i] - centres[i]);
                const Four q = y - X_a;
                store_lanes(q, displacements + place);
                Four acceleration = -gravity[i];
                ACF_UNROLL
                for (unsigned int j = 0; j < n; ++j)
                  acceleration += second_rates[i][j] * z_a[j];
                store_lanes(acceleration, accelerations + place);
                if (!is_damped)
                  continue;
                Four velocity = v_a - centre_velocities[i];
                ACF_UNROLL
                for (unsigned int j = 0; j < n; ++j)
                  velocity += first_rates[i][j] * z_a[j];
                const Four rate =
                  inverse_rotations[i] * velocity - cross_product(spins[i], y);
                store_lanes(q + stiffness_damping * rate, strained + place);
                if (rates != nullptr)
                  store_lanes(rate, rates + place);
              }
          }
      }

      std::size_t begin, end;
      const double *x, *v, *X;
      Four reference_centre;
      const double *z[n];
      double times[n];
      double second_rates[n][n];
      Four centres[n];
      Columns inverse_rotations[n];
      Four gravity[n];
      double *displacements, *accelerations;

      // with damping only
      double first_rates[n][n];
      Four centre_velocities[n];
      Four spins[n];
      double stiffness_damping;
      double *strained, *rates;
    };



    template <unsigned int n, bool is_damped>
    void
    fill_lanes(const BodyOperators &body,
               const NodalMotion &motion,
               const std::vector<BodyRotation> &frames,
               ReducedStrainWork &work)
    {
      FillLanes<n, is_damped> all{};
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
            all.second_rates[i][j] = motion.second_rates(i, j);
        }
      if (is_damped)
        {
          all.stiffness_damping = motion.stiffness_damping;
          all.strained          = work.strained.data();
          all.rates = motion.mass_damping != 0 ? work.rates.data() : nullptr;
          for (unsigned int i = 0; i < n; ++i)
            {
              const NodalMoments &velocity = motion.velocity_moments[i];
              all.centre_velocities[i]     = lanes_of(velocity.mean);
              all.spins[i] = lanes_of(frame_spin(frames[i], velocity.gradient));
              for (unsigned int j = 0; j < n; ++j)
                all.first_rates[i][j] = motion.first_rates(i, j);
            }
        }
      run_ranges(body.n_nodes,
                 [&](const std::size_t begin, const std::size_t end) {
                   FillLanes<n, is_damped> part = all;
                   part.begin                   = begin;
                   part.end                     = end;
                   run_vectorized(part);
                 });
    }



    template <bool is_damped>
    void
    fill_lanes(const BodyOperators &body,
               const NodalMotion &motion,
               const std::vector<BodyRotation> &frames,
               ReducedStrainWork &work)
    {
      const unsigned int n = motion.times.size();
      work.displacements.resize(body.n_nodes, n);
      work.accelerations.resize(body.n_nodes, n);
      if (is_damped)
        work.strained.resize(body.n_nodes, n);
      if (motion.mass_damping != 0)
        work.rates.resize(body.n_nodes, n);
      if (n == 1)
        fill_lanes<1, is_damped>(body, motion, frames, work);
      else if (n == 2)
        fill_lanes<2, is_damped>(body, motion, frames, work);
      else
        fill_lanes<3, is_damped>(body, motion, frames, work);
    }



    // sum_a q_a x k_a of one of n vectors, and with forces d there
    // sum_a (q_a + X_a) x d_a.
    template <bool has_drag>
    struct AddMoments
    {
      ACF_INLINE void
      operator()() const
      {
        Four sum = {}, drag_sum = {};
        for (std::size_t a = begin; a < end; ++a)
          {
            const Four q_a = load_lanes<Four>(q + 4 * n * a);
            sum += cross_product(q_a, load_lanes<Four>(k + 4 * n * a));
            if (has_drag)
              drag_sum +=
                cross_product(q_a + load_three(X + dim * a) - reference_centre,
                              load_lanes<Four>(d + 4 * n * a));
          }
        store_three(sum + drag_factor * drag_sum, result);
      }

      std::size_t begin, end;
      unsigned int n;
      const double *q, *k, *d;
      const double *X;
      Four reference_centre;
      double drag_factor;
      double *result;
    };



    // About the centre, of the internal forces at time i.
    template <bool has_drag>
    Vector3
    moment(const BodyOperators &body,
           const NodalMotion &motion,
           const ReducedStrainWork &work,
           const unsigned int i)
    {
      AddMoments<has_drag> all{};
      all.n = motion.times.size();
      all.q = work.displacements.data() + 4 * i;
      all.k = work.stiffness_products.data() + 4 * i;
      if (has_drag)
        all.d = work.momenta.data() + 4 * i;
      all.X                = body.reference_positions.begin();
      all.reference_centre = lanes_of(body.centre);
      all.drag_factor      = motion.mass_damping;
      return sum_ranges<Vector3>(body.n_nodes,
                                 [&](const std::size_t begin,
                                     const std::size_t end) {
                                   double sum[dim];
                                   AddMoments<has_drag> part = all;
                                   part.begin                = begin;
                                   part.end                  = end;
                                   part.result               = sum;
                                   run_vectorized(part);
                                   return Vector3(sum);
                                 });
    }



    // R (P g_a - k_a - alpha d_a) - m_a for one of n vectors.
    template <bool has_drag>
    struct CollectForces
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          {
            Four k_a = load_lanes<Four>(k + 4 * n * a);
            if (has_drag)
              k_a += drag_factor * load_lanes<Four>(d + 4 * n * a);
            store_three(balance * load_three(g + dim * a) - rotation * k_a -
                          load_lanes<Four>(m + 4 * n * a),
                        force + dim * a);
          }
      }

      std::size_t begin, end;
      unsigned int n;
      Columns rotation, balance;
      const double *g, *k, *d, *m;
      double drag_factor;
      double *force;
    };



    template <bool has_drag>
    void
    collect_forces(const BodyOperators &body,
                   const NodalMotion &motion,
                   const std::vector<BodyRotation> &frames,
                   const ReducedStrainWork &work,
                   const std::vector<NodalVector *> &residual)
    {
      for (unsigned int i = 0; i < frames.size(); ++i)
        {
          const Matrix3 &R = frames[i].rotation;
          const Matrix3 P =
            frames[i].contract(moment<has_drag>(body, motion, work, i));
          AssertDimension(residual[i]->size(), body.n_unknowns());
          CollectForces<has_drag> all{};
          all.n        = frames.size();
          all.rotation = Columns(R);
          all.balance  = Columns(R * P);
          all.g        = body.averaging_vectors.begin();
          all.k        = work.stiffness_products.data() + 4 * i;
          if (has_drag)
            all.d = work.momenta.data() + 4 * i;
          all.m           = work.mass_products.data() + 4 * i;
          all.drag_factor = motion.mass_damping;
          all.force       = residual[i]->begin();
          run_ranges(body.n_nodes,
                     [&](const std::size_t begin, const std::size_t end) {
                       CollectForces<has_drag> part = all;
                       part.begin                   = begin;
                       part.end                     = end;
                       run_vectorized(part);
                     });
        }
    }
  } // namespace



  bool
  reduced_strain_residual(const BodyOperators &body,
                          const RotationMeasure measure,
                          const NodalMotion &motion,
                          const std::vector<NodalVector *> &residual,
                          ReducedStrainWork &work)
  {
    std::vector<BodyRotation> frames;
    for (const NodalMoments &moments : motion.moments)
      {
        const auto frame = body_rotation(moments.gradient, measure);
        if (!frame)
          return false;
        frames.push_back(*frame);
      }

    if (motion.is_damped())
      fill_lanes<true>(body, motion, frames, work);
    else
      fill_lanes<false>(body, motion, frames, work);
    body.stiffness_matrix.vmult(work.stiffness_products,
                                motion.is_damped() ? work.strained
                                                   : work.displacements);
    body.mass_matrix.vmult(work.mass_products, work.accelerations);
    if (motion.mass_damping != 0)
      {
        body.mass_matrix.vmult(work.momenta, work.rates);
        collect_forces<true>(body, motion, frames, work, residual);
      }
    else
      collect_forces<false>(body, motion, frames, work, residual);
    return true;
  }
} // namespace ACF
