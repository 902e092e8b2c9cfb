// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/reduced_strain_residual.h>

#include <algorithm>

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



    // What is needed of the nodes that a few rows of the matrices reach: it
    // stays in the caches, and serves one body after the other.
    struct Windows
    {
      NodeLanes displacements, accelerations;
      NodeLanes stiffness_products, mass_products;

      // with damping: q + beta q'; q' and M q'
      NodeLanes strained, rates, momenta;
    };

    // Rows of the matrices at once.
    constexpr std::size_t n_rows = 256;

    thread_local Windows windows;

    std::size_t
    window_size(const NodeGraph &graph)
    {
      std::size_t size = 1;
      while (size < n_rows + graph.bandwidth)
        size *= 2;
      return size;
    }



    // q_i and a_i - g_i of the nodes from begin to end, and with damping their
    // q_i + beta q_i' and, unless there is no place for it, q_i'.
    template <unsigned int n, bool is_damped>
    struct FillWindows
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
                const std::size_t place = 4 * (n * (a & mask) + i);
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

      std::size_t begin, end, mask;
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
    FillWindows<n, is_damped>
    fill_windows(const BodyOperators &body,
                 const NodalMotion &motion,
                 const std::vector<BodyRotation> &frames)
    {
      FillWindows<n, is_damped> fill{};
      fill.mask             = windows.displacements.n_nodes() - 1;
      fill.x                = motion.position->begin();
      fill.v                = motion.velocity->begin();
      fill.X                = body.reference_positions.begin();
      fill.reference_centre = lanes_of(body.centre);
      fill.displacements    = windows.displacements.data();
      fill.accelerations    = windows.accelerations.data();
      for (unsigned int i = 0; i < n; ++i)
        {
          fill.z[i]                 = motion.increments[i]->begin();
          fill.times[i]             = motion.times[i];
          fill.centres[i]           = lanes_of(motion.moments[i].mean);
          fill.inverse_rotations[i] = Columns(transpose(frames[i].rotation));
          fill.gravity[i]           = lanes_of(motion.gravity[i]);
          for (unsigned int j = 0; j < n; ++j)
            fill.second_rates[i][j] = motion.second_rates(i, j);
        }
      if (is_damped)
        {
          fill.stiffness_damping = motion.stiffness_damping;
          fill.strained          = windows.strained.data();
          fill.rates =
            motion.mass_damping != 0 ? windows.rates.data() : nullptr;
          for (unsigned int i = 0; i < n; ++i)
            {
              const NodalMoments &velocity = motion.velocity_moments[i];
              fill.centre_velocities[i]    = lanes_of(velocity.mean);
              fill.spins[i] =
                lanes_of(frame_spin(frames[i], velocity.gradient));
              for (unsigned int j = 0; j < n; ++j)
                fill.first_rates[i][j] = motion.first_rates(i, j);
            }
        }
      return fill;
    }



    // Adds sum_a q_a x k_a, and with momenta d, if there are any,
    // alpha sum_a (q_a + X_a) x d_a, of the nodes from begin to end; forces
    // become -R (k_a + alpha d_a) - m_a.
    template <unsigned int n>
    struct CollectForces
    {
      ACF_INLINE void
      operator()() const
      {
        Four sum[n];
        ACF_UNROLL
        for (unsigned int i = 0; i < n; ++i)
          sum[i] = load_lanes<Four>(moments + 4 * i);
        for (std::size_t a = begin; a < end; ++a)
          {
            ACF_UNROLL
            for (unsigned int i = 0; i < n; ++i)
              {
                const std::size_t place = 4 * (n * (a & mask) + i);
                const Four q_a          = load_lanes<Four>(q + place);
                Four k_a                = load_lanes<Four>(k + place);
                sum[i] += cross_product(q_a, k_a);
                if (d != nullptr)
                  {
                    const Four d_a = drag_factor * load_lanes<Four>(d + place);
                    sum[i] += cross_product(q_a + load_three(X + dim * a) -
                                              reference_centre,
                                            d_a);
                    k_a += d_a;
                  }
                store_three(-(rotations[i] * k_a) - load_lanes<Four>(m + place),
                            forces[i] + dim * (a - first_force));
              }
          }
        ACF_UNROLL
        for (unsigned int i = 0; i < n; ++i)
          store_lanes(sum[i], moments + 4 * i);
      }

      std::size_t begin, end, mask;
      Columns rotations[n];
      const double *q, *k, *d, *m;
      const double *X;
      Four reference_centre;
      double drag_factor;
      double *moments;

      // those of the nodes from this one on
      double *forces[n];
      std::size_t first_force;
    };



    template <unsigned int n>
    CollectForces<n>
    collect_forces(const BodyOperators &body,
                   const NodalMotion &motion,
                   const std::vector<BodyRotation> &frames,
                   const std::vector<NodalVector *> &forces)
    {
      CollectForces<n> collect{};
      collect.mask = windows.displacements.n_nodes() - 1;
      collect.q    = windows.displacements.data();
      collect.k    = windows.stiffness_products.data();
      collect.m    = windows.mass_products.data();
      if (motion.mass_damping != 0)
        collect.d = windows.momenta.data();
      collect.X                = body.reference_positions.begin();
      collect.reference_centre = lanes_of(body.centre);
      collect.drag_factor      = motion.mass_damping;
      for (unsigned int i = 0; i < n; ++i)
        {
          collect.rotations[i] = Columns(frames[i].rotation);
          collect.forces[i]    = forces[i]->begin();
        }
      return collect;
    }



    // What some rows of the matrices give.
    struct Part
    {
      // about the centre, of the internal forces at each time
      std::vector<Vector3> moments;

      // and of the forces on nodes behind the rows
      std::vector<NodalVector> rest;
    };

    template <unsigned int n, bool is_damped>
    Part
    add_rows(const BodyOperators &body,
             const NodalMotion &motion,
             const std::vector<BodyRotation> &frames,
             const std::vector<NodalVector *> &forces,
             const std::size_t begin,
             const std::size_t end)
    {
      const bool has_drag    = motion.mass_damping != 0;
      const NodeGraph &graph = body.stiffness_matrix.graph();
      const std::size_t size = window_size(graph);
      for (NodeLanes *const lanes : {&windows.displacements,
                                     &windows.accelerations,
                                     &windows.stiffness_products,
                                     &windows.mass_products})
        lanes->resize(size, n);
      if (is_damped)
        windows.strained.resize(size, n);
      if (has_drag)
        {
          windows.rates.resize(size, n);
          windows.momenta.resize(size, n);
        }

      double moments[4 * n] = {};
      auto fill             = fill_windows<n, is_damped>(body, motion, frames);
      auto collect          = collect_forces<n>(body, motion, frames, forces);
      collect.moments       = moments;

      fill.end = begin;
      for (std::size_t first = begin; first < end; first += n_rows)
        {
          const std::size_t last = std::min(first + n_rows, end);
          const RowRange rows{first, last, fill.end};
          fill.begin = fill.end;
          fill.end   = graph.reach[last - 1];
          run_vectorized(fill);
          body.stiffness_matrix.add_rows(rows,
                                         windows.stiffness_products,
                                         is_damped ? windows.strained
                                                   : windows.displacements);
          body.mass_matrix.add_rows(rows,
                                    windows.mass_products,
                                    windows.accelerations);
          if (has_drag)
            body.mass_matrix.add_rows(rows, windows.momenta, windows.rates);
          collect.begin = first;
          collect.end   = last;
          run_vectorized(collect);
        }

      Part part;
      part.rest.resize(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          part.rest[i].reinit(dim * (fill.end - end));
          collect.forces[i] = part.rest[i].begin();
        }
      collect.first_force = end;
      collect.begin       = end;
      collect.end         = fill.end;
      run_vectorized(collect);
      for (unsigned int i = 0; i < n; ++i)
        part.moments.emplace_back(
          Vector3({moments[4 * i], moments[4 * i + 1], moments[4 * i + 2]}));
      return part;
    }



    // f_a += R P g_a at each of n times.
    template <unsigned int n>
    struct AddBalance
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          {
            const Four g_a = load_three(g + dim * a);
            ACF_UNROLL
            for (unsigned int i = 0; i < n; ++i)
              {
                double *const f = forces[i] + dim * a;
                store_three(load_three(f) + balances[i] * g_a, f);
              }
          }
      }

      std::size_t begin, end;
      const double *g;
      Columns balances[n];
      double *forces[n];
    };



    template <unsigned int n, bool is_damped>
    void
    add_forces(const BodyOperators &body,
               const NodalMotion &motion,
               const std::vector<BodyRotation> &frames,
               const std::vector<NodalVector *> &forces)
    {
      const std::size_t n_nodes  = body.n_nodes;
      const unsigned int n_parts = n_ranges(n_nodes);
      std::vector<Part> parts(n_parts);
      run_tasks(n_parts, [&](const unsigned int p) {
        parts[p] = add_rows<n, is_damped>(body,
                                          motion,
                                          frames,
                                          forces,
                                          n_nodes * p / n_parts,
                                          n_nodes * (p + 1) / n_parts);
      });
      for (unsigned int p = 1; p < n_parts; ++p)
        for (unsigned int i = 0; i < n; ++i)
          {
            parts[0].moments[i] += parts[p].moments[i];
            const NodalVector &rest = parts[p - 1].rest[i];
            double *const force =
              forces[i]->begin() + dim * (n_nodes * p / n_parts);
            for (std::size_t k = 0; k < rest.size(); ++k)
              force[k] += rest[k];
          }

      AddBalance<n> all{};
      all.g = body.averaging_vectors.begin();
      for (unsigned int i = 0; i < n; ++i)
        {
          all.balances[i] = Columns(frames[i].rotation *
                                    frames[i].contract(parts[0].moments[i]));
          all.forces[i]   = forces[i]->begin();
        }
      run_ranges(n_nodes, [&](const std::size_t begin, const std::size_t end) {
        AddBalance<n> part = all;
        part.begin         = begin;
        part.end           = end;
        run_vectorized(part);
      });
    }



    template <bool is_damped>
    void
    add_forces(const BodyOperators &body,
               const NodalMotion &motion,
               const std::vector<BodyRotation> &frames,
               const std::vector<NodalVector *> &forces)
    {
      switch (frames.size())
        {
          case 1:
            return add_forces<1, is_damped>(body, motion, frames, forces);
          case 2:
            return add_forces<2, is_damped>(body, motion, frames, forces);
          default:
            return add_forces<3, is_damped>(body, motion, frames, forces);
        }
    }
  } // namespace



  bool
  reduced_strain_residual(const BodyOperators &body,
                          const RotationMeasure measure,
                          const NodalMotion &motion,
                          const std::vector<NodalVector *> &residual)
  {
    std::vector<BodyRotation> frames;
    for (const NodalMoments &moments : motion.moments)
      {
        const auto frame = body_rotation(moments.gradient, measure);
        if (!frame)
          return false;
        frames.push_back(*frame);
      }

    for (unsigned int i = 0; i < residual.size(); ++i)
      AssertDimension(residual[i]->size(), body.n_unknowns());
    if (motion.is_damped())
      add_forces<true>(body, motion, frames, residual);
    else
      add_forces<false>(body, motion, frames, residual);
    return true;
  }
} // namespace ACF
