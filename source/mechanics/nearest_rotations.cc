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
    typedef long long EightTruths __attribute__((vector_size(64)));

    constexpr unsigned int n_lanes = 8;



    ACF_INLINE bool
    is_any(const EightTruths &truths)
    {
      long long any = 0;
      ACF_UNROLL
      for (unsigned int i = 0; i < n_lanes; ++i)
        any |= truths[i];
      return any != 0;
    }



    // C with R^-1 = C^T / determinant. @return the determinant
    ACF_INLINE Eight
    cofactors(const Eight (&R)[dim][dim], Eight (&C)[dim][dim])
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



    // nearest_rotation() of eight matrices, entry by entry. A matrix does not
    // change any more when its own iteration has ended.
    // @return which have a rotation
    ACF_INLINE EightTruths
    iterate(Eight (&R)[dim][dim])
    {
      constexpr unsigned int max_iterations = 40;
      constexpr double largest = std::numeric_limits<double>::max();
      Eight C[dim][dim];
      Eight determinant    = cofactors(R, C);
      EightTruths is_found = {};
      EightTruths goes_on  = (determinant > 0.) & (determinant <= largest);
      for (unsigned int step = 0; step < max_iterations && is_any(goes_on);
           ++step)
        {
          const Eight half_inverse = 0.5 / determinant;
          Eight change             = {};
          ACF_UNROLL
          for (unsigned int i = 0; i < dim; ++i)
            {
              ACF_UNROLL
              for (unsigned int j = 0; j < dim; ++j)
                {
                  const Eight next = 0.5 * R[i][j] + half_inverse * C[i][j];
                  const Eight difference = next - R[i][j];
                  change += difference * difference;
                  R[i][j] = goes_on ? next : R[i][j];
                }
            }
          // quadratic: the next change is of the order of this one squared
          const EightTruths is_small = goes_on & (change < 1e-16);
          is_found |= is_small;
          goes_on &= ~is_small;
          determinant = cofactors(R, C);
        }
      return is_found;
    }



    // Of at most eight nodes.
    ACF_INLINE void
    find_rotations(const Matrix3 *const gradients,
                   const unsigned int n,
                   const Matrix3 &fallback,
                   Matrix3 *const rotations)
    {
      Eight R[dim][dim];
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            R[i][j][lane] = gradients[std::min(lane, n - 1)][i][j];
      const EightTruths is_found = iterate(R);
      for (unsigned int lane = 0; lane < n; ++lane)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            rotations[lane][i][j] =
              is_found[lane] != 0 ? R[i][j][lane] : fallback[i][j];
    }



    // One function per instruction set.
#define ACF_ROTATIONS(name, attributes)                       \
  attributes void find_##name(const Matrix3 *const gradients, \
                              const unsigned int n,           \
                              const Matrix3 &fallback,        \
                              Matrix3 *const rotations)       \
  {                                                           \
    find_rotations(gradients, n, fallback, rotations);        \
  }

    ACF_ROTATIONS(any, )
#if defined(__x86_64__)
    ACF_ROTATIONS(avx2, ACF_AVX2)
    ACF_ROTATIONS(avx512, ACF_AVX512)
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
    run_ranges((n + n_lanes - 1) / n_lanes,
               [&](const std::size_t begin, const std::size_t end) {
                 for (std::size_t k = begin * n_lanes;
                      k < std::min(end * n_lanes, n);
                      k += n_lanes)
                   find(&gradients[k],
                        std::min<std::size_t>(n_lanes, n - k),
                        fallback,
                        &rotations[k]);
               },
               smallest_range / n_lanes);
    return rotations;
  }
} // namespace ACF
