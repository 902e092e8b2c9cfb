// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>
#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/solvers/joint_columns.h>

namespace ACF
{
  namespace
  {
    // Numbers of each column that are side by side: a line of the cache in
    // single precision.
    constexpr std::size_t block_size = 16;

    template <unsigned int n>
    struct Singles
    {
      typedef float type __attribute__((vector_size(n * sizeof(float))));
    };

    template <typename Lanes>
    ACF_INLINE Lanes
    load(const float *const p)
    {
      using Vector = typename Singles<n_lanes<Lanes>>::type;
      return __builtin_convertvector(load_lanes<Vector>(p), Lanes);
    }

    template <typename Lanes>
    ACF_INLINE Lanes
    load(const double *const p)
    {
      return load_lanes<Lanes>(p);
    }



    // Real and imaginary parts of complex numbers change places.
    ACF_INLINE Two
    swap_parts(const Two &x)
    {
      return __builtin_shufflevector(x, x, 1, 0);
    }

    ACF_INLINE Four
    swap_parts(const Four &x)
    {
      return __builtin_shufflevector(x, x, 1, 0, 3, 2);
    }

    ACF_INLINE Eight
    swap_parts(const Eight &x)
    {
      return __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
    }



    // x -= Y F, or x = -Y F, for the blocks from begin to end. Complex numbers
    // are pairs.
    template <typename Real, bool is_complex>
    struct SubtractProduct
    {
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        for (std::size_t block = begin; block < end; ++block)
          {
            const std::size_t first = block * block_size;
            if (first + block_size <= n)
              subtract<Lanes>(block, x + first);
            else
              {
                double rest[block_size] = {};
                for (std::size_t i = first; i < n; ++i)
                  rest[i - first] = x[i];
                subtract<Lanes>(block, rest);
                for (std::size_t i = first; i < n; ++i)
                  x[i] = rest[i - first];
              }
          }
      }

      template <typename Lanes>
      ACF_INLINE void
      subtract(const std::size_t block, double *const x_block) const
      {
        constexpr unsigned int width    = n_lanes<Lanes>;
        constexpr unsigned int n_pieces = block_size / width;
        // products with the real and the imaginary parts of F
        Lanes real[n_pieces] = {}, imaginary[n_pieces] = {};
        const Real *y = values + block * n_columns * block_size;
        for (std::size_t k = 0; k < n_columns; ++k, y += block_size)
          {
            ACF_UNROLL
            for (unsigned int piece = 0; piece < n_pieces; ++piece)
              {
                const Lanes numbers = load<Lanes>(y + width * piece);
                real[piece] += factors[2 * k] * numbers;
                if (is_complex)
                  imaginary[piece] += factors[2 * k + 1] * numbers;
              }
          }
        Lanes signs = {};
        for (unsigned int lane = 0; lane < width; ++lane)
          signs[lane] = lane % 2 == 0 ? -1 : 1;
        ACF_UNROLL
        for (unsigned int piece = 0; piece < n_pieces; ++piece)
          {
            if (is_complex)
              real[piece] += signs * swap_parts(imaginary[piece]);
            if (x_is_zero)
              store_lanes(-real[piece], x_block + width * piece);
            else
              add_lanes(-real[piece], x_block + width * piece);
          }
      }

      const Real *values;
      std::size_t n_columns;

      // real and imaginary part of each
      const double *factors;
      double *x;
      bool x_is_zero;

      // numbers of x
      std::size_t n;
      std::size_t begin, end;
    };



    template <typename Number>
    constexpr std::size_t n_parts = sizeof(Number) / sizeof(double);



    template <typename Number, typename Real>
    void
    subtract(const dealii::AlignedVector<Real> &values,
             const Eigen::Matrix<Number, Eigen::Dynamic, 1> &F,
             const std::size_t n_rows,
             Number *const x,
             const bool x_is_zero)
    {
      std::vector<double> factors;
      for (unsigned int k = 0; k < F.size(); ++k)
        {
          factors.push_back(std::real(F(k)));
          factors.push_back(std::imag(F(k)));
        }
      const std::size_t n        = n_parts<Number> * n_rows;
      const std::size_t n_blocks = (n + block_size - 1) / block_size;
      run_ranges(
        n_blocks,
        [&](const std::size_t begin, const std::size_t end) {
          run_in_lanes(SubtractProduct<Real, (n_parts<Number> > 1)>{
            values.data(),
            static_cast<std::size_t>(F.size()),
            factors.data(),
            reinterpret_cast<double *>(x),
            x_is_zero,
            n,
            begin,
            end});
        },
        smallest_range / block_size);
    }



    // Where number i of a column is.
    std::size_t
    index_of(const std::size_t i,
             const std::size_t column,
             const std::size_t n_columns)
    {
      return (i / block_size * n_columns + column) * block_size +
             i % block_size;
    }



    std::size_t
    padded(const std::size_t n)
    {
      return (n + block_size - 1) / block_size * block_size;
    }



    template <typename Real>
    void
    store(const double *const numbers,
          const std::size_t n,
          const std::size_t n_columns,
          dealii::AlignedVector<Real> &values)
    {
      resize_in_huge_pages(values, padded(n) * n_columns);
      for (std::size_t k = 0; k < n_columns; ++k)
        for (std::size_t i = 0; i < n; ++i)
          values[index_of(i, k, n_columns)] = numbers[k * n + i];
    }
  } // namespace



  template <typename Number>
  JointColumns<Number>::JointColumns(const std::vector<Number> &columns,
                                     const std::size_t n_rows,
                                     const bool single)
    : n_rows(n_rows)
    , n_columns(columns.size() / n_rows)
  {
    const double *const numbers =
      reinterpret_cast<const double *>(columns.data());
    const std::size_t n = n_parts<Number> * n_rows;
    if (single)
      store(numbers, n, n_columns, single_values);
    else
      store(numbers, n, n_columns, double_values);
  }



  template <typename Number>
  std::size_t
  JointColumns<Number>::n_bytes(const std::size_t n_rows,
                                const std::size_t n_columns,
                                const bool single)
  {
    return padded(n_parts<Number> * n_rows) * n_columns *
           (single ? sizeof(float) : sizeof(double));
  }



  template <typename Number>
  std::vector<Number>
  JointColumns<Number>::column(const std::size_t index) const
  {
    std::vector<Number> result(n_rows);
    double *const numbers = reinterpret_cast<double *>(result.data());
    for (std::size_t i = 0; i < n_parts<Number> * n_rows; ++i)
      {
        const std::size_t place = index_of(i, index, n_columns);
        numbers[i] =
          single_values.empty() ? double_values[place] : single_values[place];
      }
    return result;
  }



  template <typename Number>
  void
  JointColumns<Number>::subtract_product(const Vector &F,
                                         Number *const x,
                                         const bool x_is_zero) const
  {
    AssertDimension(static_cast<std::size_t>(F.size()), n_columns);
    if (single_values.empty())
      subtract(double_values, F, n_rows, x, x_is_zero);
    else
      subtract(single_values, F, n_rows, x, x_is_zero);
  }



  template class JointColumns<double>;
  template class JointColumns<std::complex<double>>;
} // namespace ACF
