// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/rotation.h>

#include <algorithm>
#include <limits>

namespace ACF
{
  namespace
  {
    // Nodes that are handed over at once.
    constexpr unsigned int batch_size = 8;

    template <typename Lanes>
    struct Truths
    {
      typedef long long type __attribute__((vector_size(sizeof(Lanes))));
    };



    template <typename Lanes>
    ACF_INLINE bool
    is_any(const typename Truths<Lanes>::type &truths)
    {
      long long any = 0;
      ACF_UNROLL
      for (unsigned int i = 0; i < n_lanes<Lanes>; ++i)
        any |= truths[i];
      return any != 0;
    }



    // C with R^-1 = C^T / determinant. @return the determinant
    template <typename Lanes>
    ACF_INLINE Lanes
    cofactors(const Lanes (&R)[dim][dim], Lanes (&C)[dim][dim])
    {
      ACF_UNROLL
      for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int k = (i + 1) % dim, l = (i + 2) % dim;
          ACF_UNROLL
          for (unsigned int j = 0; j < dim; ++j)
            {
              const unsigned int m = (j + 1) % dim, n = (j + 2) % dim;
              C[i][j] = R[k][m] * R[l][n] - R[k][n] * R[l][m];
            }
        }
      return R[0][0] * C[0][0] + R[0][1] * C[0][1] + R[0][2] * C[0][2];
    }



    // nearest_rotation() of some matrices, entry by entry. A matrix does not
    // change any more when its own iteration has ended.
    // @return which have a rotation
    template <typename Lanes>
    ACF_INLINE typename Truths<Lanes>::type
    iterate(Lanes (&R)[dim][dim])
    {
      using LaneTruths                      = typename Truths<Lanes>::type;
      constexpr unsigned int max_iterations = 40;
      constexpr double largest = std::numeric_limits<double>::max();
      Lanes C[dim][dim];
      Lanes determinant   = cofactors(R, C);
      LaneTruths is_found = {};
      LaneTruths goes_on  = (determinant > 0.) & (determinant <= largest);
      for (unsigned int step = 0;
           step < max_iterations && is_any<Lanes>(goes_on);
           ++step)
        {
          const Lanes half_inverse = 0.5 / determinant;
          Lanes change             = {};
          ACF_UNROLL
          for (unsigned int i = 0; i < dim; ++i)
            {
              ACF_UNROLL
              for (unsigned int j = 0; j < dim; ++j)
                {
                  const Lanes next = 0.5 * R[i][j] + half_inverse * C[i][j];
                  const Lanes difference = next - R[i][j];
                  change += difference * difference;
                  R[i][j] = goes_on ? next : R[i][j];
                }
            }
          // quadratic: the next change is of the order of this one squared
          const LaneTruths is_small = goes_on & (change < 1e-16);
          is_found |= is_small;
          goes_on &= ~is_small;
          determinant = cofactors(R, C);
        }
      return is_found;
    }



    // Of at most as many nodes as there are lanes.
    template <typename Lanes>
    ACF_INLINE void
    find_some(const Matrix3 *const gradients,
              const unsigned int n,
              const Matrix3 &fallback,
              Matrix3 *const rotations)
    {
      Lanes R[dim][dim];
      for (unsigned int lane = 0; lane < n_lanes<Lanes>; ++lane)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            R[i][j][lane] = gradients[std::min(lane, n - 1)][i][j];
      const auto is_found = iterate(R);
      for (unsigned int lane = 0; lane < n; ++lane)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            rotations[lane][i][j] =
              is_found[lane] != 0 ? R[i][j][lane] : fallback[i][j];
    }

    template <typename Lanes>
    ACF_INLINE void
    find_rotations(const Matrix3 *const gradients,
                   const unsigned int n,
                   const Matrix3 &fallback,
                   Matrix3 *const rotations)
    {
      for (unsigned int k = 0; k < n; k += n_lanes<Lanes>)
        find_some<Lanes>(gradients + k,
                         std::min(n - k, n_lanes<Lanes>),
                         fallback,
                         rotations + k);
    }



    // One function per instruction set.
#define ACF_ROTATIONS(name, attributes, Lanes)                \
  attributes void find_##name(const Matrix3 *const gradients, \
                              const unsigned int n,           \
                              const Matrix3 &fallback,        \
                              Matrix3 *const rotations)       \
  {                                                           \
    find_rotations<Lanes>(gradients, n, fallback, rotations); \
  }

    ACF_ROTATIONS(any, , Two)
#if defined(__x86_64__)
    ACF_ROTATIONS(avx2, ACF_AVX2, Four)
    ACF_ROTATIONS(avx512, ACF_AVX512, Eight)
#endif
#undef ACF_ROTATIONS



    using FindRotations = void (*)(const Matrix3 *,
                                   unsigned int,
                                   const Matrix3 &,
                                   Matrix3 *);

    FindRotations
    present_function()
    {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return find_avx512;
      if (present_processor() == Processor::avx2)
        return find_avx2;
#endif
      return find_any;
    }
  } // namespace



  std::vector<Matrix3>
  nearest_rotations(const std::vector<Matrix3> &gradients,
                    const Matrix3 &fallback)
  {
    const FindRotations find = present_function();
    const std::size_t n      = gradients.size();
    std::vector<Matrix3> rotations(n);
    run_ranges((n + batch_size - 1) / batch_size,
               [&](const std::size_t begin, const std::size_t end) {
                 for (std::size_t k = begin * batch_size;
                      k < std::min(end * batch_size, n);
                      k += batch_size)
                   find(&gradients[k],
                        std::min<std::size_t>(batch_size, n - k),
                        fallback,
                        &rotations[k]);
               },
               smallest_range / batch_size);
    return rotations;
  }
} // namespace ACF
