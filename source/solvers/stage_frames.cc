// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/node_lanes.h>
#include <acf/solvers/stage_frames.h>

#include <array>

namespace ACF
{
  namespace
  {
    constexpr unsigned int max_stages = NodeLanes::max_vectors;

    using StageFrames = std::array<const NodeRotations *, max_stages>;

    ACF_INLINE Four
    row(const Matrix3 &R, const unsigned int i)
    {
      return Four{R[i][0], R[i][1], R[i][2], 0};
    }

    ACF_INLINE Four
    column(const Matrix3 &R, const unsigned int j)
    {
      return Four{R[0][j], R[1][j], R[2][j], 0};
    }



    // Rotations of the stages at the nodes, which may be those of one node.
    template <bool is_uniform>
    class Rotations
    {
    public:
      ACF_INLINE
      Rotations(const StageFrames &stages, const unsigned int n)
        : stages(stages)
      {
        if (is_uniform)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int k = 0; k < dim; ++k)
              {
                rows[i][k]    = row((*stages[i])[0], k);
                columns[i][k] = column((*stages[i])[0], k);
              }
      }

      ACF_INLINE Four
      to_body(const unsigned int i, const std::size_t a, const Four &x) const
      {
        if (is_uniform)
          return splat<0>(x) * rows[i][0] + splat<1>(x) * rows[i][1] +
                 splat<2>(x) * rows[i][2];
        const Matrix3 &R = (*stages[i])[a];
        return splat<0>(x) * row(R, 0) + splat<1>(x) * row(R, 1) +
               splat<2>(x) * row(R, 2);
      }

      ACF_INLINE Four
      to_world(const unsigned int i, const std::size_t a, const Four &x) const
      {
        if (is_uniform)
          return splat<0>(x) * columns[i][0] + splat<1>(x) * columns[i][1] +
                 splat<2>(x) * columns[i][2];
        const Matrix3 &R = (*stages[i])[a];
        return splat<0>(x) * column(R, 0) + splat<1>(x) * column(R, 1) +
               splat<2>(x) * column(R, 2);
      }

    private:
      const StageFrames &stages;
      Four rows[max_stages][dim], columns[max_stages][dim];
    };



    // A real number and its imaginary part, which is zero.
    struct Factor
    {
      Factor() = default;

      Factor(const double f)
        : real(f)
        , imaginary(0)
      {}

      Factor(const std::complex<double> &f)
        : real(f.real())
        , imaginary(f.imag())
      {}

      double real, imaginary;
    };

    // Three real numbers, or the real and imaginary parts of three.
    ACF_INLINE void
    store_numbers(const Four &real, const Four &, double *const w)
    {
      store_three(real, w);
    }

    ACF_INLINE void
    store_numbers(const Four &real,
                  const Four &imaginary,
                  std::complex<double> *const w)
    {
      double *const p = reinterpret_cast<double *>(w);
      store_lanes(__builtin_shufflevector(real, imaginary, 0, 4, 1, 5), p);
      p[4] = real[2];
      p[5] = imaginary[2];
    }

    ACF_INLINE Four
    real_part(const Factor &f, const double *const w)
    {
      return f.real * load_three(w);
    }

    ACF_INLINE Four
    real_part(const Factor &f, const std::complex<double> *const w)
    {
      const double *const p = reinterpret_cast<const double *>(w);
      const Four first      = load_lanes<Four>(p);
      const Four last       = load_lanes<Four>(p + 2);
      return f.real * __builtin_shufflevector(first, last, 0, 2, 6, 6) -
             f.imaginary * __builtin_shufflevector(first, last, 1, 3, 7, 7);
    }



    template <typename Number, bool is_uniform>
    struct Combine
    {
      ACF_INLINE void
      operator()() const
      {
        const Rotations<is_uniform> rotations(frames, n);
        for (std::size_t a = begin; a < end; ++a)
          {
            Four real = {}, imaginary = {};
            for (unsigned int i = 0; i < n; ++i)
              {
                const Four r =
                  rotations.to_body(i, a, load_three(stages[i] + dim * a));
                real += factors[i].real * r;
                imaginary += factors[i].imaginary * r;
              }
            store_numbers(real, imaginary, w + dim * a);
          }
      }

      unsigned int n;
      std::array<const double *, max_stages> stages;
      std::array<Factor, max_stages> factors;
      StageFrames frames;
      Number *w;
      std::size_t begin = 0, end = 0;
    };



    template <typename Number, bool is_uniform>
    struct Add
    {
      ACF_INLINE void
      operator()() const
      {
        const Rotations<is_uniform> rotations(frames, n);
        for (std::size_t a = begin; a < end; ++a)
          for (unsigned int i = 0; i < n; ++i)
            {
              double *const z_a = stages[i] + dim * a;
              const Four z =
                rotations.to_world(i, a, real_part(factors[i], w + dim * a));
              store_three(replace ? z : load_three(z_a) + z, z_a);
            }
      }

      unsigned int n;
      std::array<double *, max_stages> stages;
      std::array<Factor, max_stages> factors;
      StageFrames frames;
      const Number *w;
      bool replace;
      std::size_t begin = 0, end = 0;
    };



    // In parallel.
    template <typename Loop>
    void
    run_nodes(const Loop &all, const std::size_t n_nodes)
    {
      run_ranges(n_nodes, [&](const std::size_t begin, const std::size_t end) {
        Loop part  = all;
        part.begin = begin;
        part.end   = end;
        run_vectorized(part);
      });
    }

    template <typename Loop, typename Stages, typename Number>
    void
    set_stages(Loop &loop,
               const Stages &stages,
               const std::vector<Number> &factors,
               const std::vector<const NodeRotations *> &rotations)
    {
      Assert(stages.size() <= max_stages, ExcInternalError());
      loop.n = stages.size();
      for (unsigned int i = 0; i < stages.size(); ++i)
        {
          loop.stages[i]  = stages[i]->begin();
          loop.factors[i] = factors[i];
          loop.frames[i]  = rotations[i];
        }
    }

    bool
    are_uniform(const std::vector<const NodeRotations *> &rotations)
    {
      return std::all_of(rotations.begin(),
                         rotations.end(),
                         [](const NodeRotations *const frames) {
                           return frames->is_uniform();
                         });
    }



    template <bool is_uniform, typename Number>
    void
    combine(const std::vector<const NodalVector *> &stages,
            const std::vector<Number> &factors,
            const std::vector<const NodeRotations *> &rotations,
            Number *const w)
    {
      Combine<Number, is_uniform> loop;
      set_stages(loop, stages, factors, rotations);
      loop.w = w;
      run_nodes(loop, stages[0]->size() / dim);
    }



    template <bool is_uniform, typename Number>
    void
    add(const Number *const w,
        const std::vector<Number> &factors,
        const std::vector<const NodeRotations *> &rotations,
        const bool replace,
        const std::vector<NodalVector *> &stages)
    {
      Add<Number, is_uniform> loop;
      set_stages(loop, stages, factors, rotations);
      loop.w       = w;
      loop.replace = replace;
      run_nodes(loop, stages[0]->size() / dim);
    }
  } // namespace



  template <typename Number>
  void
  combine_in_body_frame(const std::vector<const NodalVector *> &stages,
                        const std::vector<Number> &factors,
                        const std::vector<const NodeRotations *> &rotations,
                        Number *const w)
  {
    if (are_uniform(rotations))
      combine<true>(stages, factors, rotations, w);
    else
      combine<false>(stages, factors, rotations, w);
  }



  template <typename Number>
  void
  add_in_world_frame(const Number *const w,
                     const std::vector<Number> &factors,
                     const std::vector<const NodeRotations *> &rotations,
                     const bool replace,
                     const std::vector<NodalVector *> &stages)
  {
    if (are_uniform(rotations))
      add<true>(w, factors, rotations, replace, stages);
    else
      add<false>(w, factors, rotations, replace, stages);
  }



  template void
  combine_in_body_frame(const std::vector<const NodalVector *> &,
                        const std::vector<double> &,
                        const std::vector<const NodeRotations *> &,
                        double *);

  template void
  combine_in_body_frame(const std::vector<const NodalVector *> &,
                        const std::vector<std::complex<double>> &,
                        const std::vector<const NodeRotations *> &,
                        std::complex<double> *);

  template void
  add_in_world_frame(const double *,
                     const std::vector<double> &,
                     const std::vector<const NodeRotations *> &,
                     const bool,
                     const std::vector<NodalVector *> &);

  template void
  add_in_world_frame(const std::complex<double> *,
                     const std::vector<std::complex<double>> &,
                     const std::vector<const NodeRotations *> &,
                     const bool,
                     const std::vector<NodalVector *> &);
} // namespace ACF
