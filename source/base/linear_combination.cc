// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/lanes.h>
#include <acf/base/linear_combination.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>

namespace ACF
{
  namespace
  {
    // What loops read of terms.
    struct Terms
    {
      explicit Terms(const std::vector<ScaledVector> &terms)
      {
        for (const ScaledVector &term : terms)
          {
            AssertDimension(term.vector->size(), terms[0].vector->size());
            c.push_back(term.factor);
            x.push_back(term.vector->begin());
          }
      }

      std::vector<double> c;
      std::vector<const double *> x;
    };



    // The numbers of a linear combination. All terms are read at once, so that
    // they do not wait for the memory one after the other.
    struct Combination
    {
      explicit Combination(const Terms &terms)
        : n_terms(terms.c.size())
        , c(terms.c.data())
        , x(terms.x.data())
      {}

      // Two vectors of them.
      template <typename Lanes>
      ACF_INLINE void
      evaluate(const std::size_t i, Lanes &first, Lanes &second) const
      {
        constexpr unsigned int n = n_lanes<Lanes>;
        first                    = c[0] * load_lanes<Lanes>(x[0] + i);
        second                   = c[0] * load_lanes<Lanes>(x[0] + i + n);
        for (std::size_t k = 1; k < n_terms; ++k)
          {
            first += c[k] * load_lanes<Lanes>(x[k] + i);
            second += c[k] * load_lanes<Lanes>(x[k] + i + n);
          }
      }

      ACF_INLINE double
      one(const std::size_t i) const
      {
        double sum = c[0] * x[0][i];
        for (std::size_t k = 1; k < n_terms; ++k)
          sum += c[k] * x[k][i];
        return sum;
      }

      std::size_t n_terms;
      const double *c;
      const double *const *x;
    };



    struct Store
    {
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        constexpr unsigned int n = n_lanes<Lanes>;
        std::size_t i            = begin;
        for (; i + 2 * n <= end; i += 2 * n)
          {
            Lanes first, second;
            combination.evaluate(i, first, second);
            store_lanes(first, y + i);
            store_lanes(second, y + i + n);
          }
        for (; i < end; ++i)
          y[i] = combination.one(i);
      }

      Combination combination;
      double *y;
      std::size_t begin, end;
    };



    // Adds the square of the combination.
    struct AddSquare
    {
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        constexpr unsigned int n = n_lanes<Lanes>;
        Lanes squares[2]         = {};
        std::size_t i            = begin;
        for (; i + 2 * n <= end; i += 2 * n)
          {
            Lanes first, second;
            combination.evaluate(i, first, second);
            squares[0] += first * first;
            squares[1] += second * second;
          }
        total += sum_of_lanes(squares[0] + squares[1]);
        for (; i < end; ++i)
          {
            const double y = combination.one(i);
            total += y * y;
          }
      }

      Combination combination;
      std::size_t begin, end;
      double &total;
    };



    // Stores the combination, and adds its products with itself and with some
    // vectors.
    template <unsigned int n_vectors>
    struct StoreAndMultiply
    {
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        constexpr unsigned int n  = n_lanes<Lanes>;
        Lanes sums[n_vectors + 1] = {};
        std::size_t i             = begin;
        for (; i + 2 * n <= end; i += 2 * n)
          {
            Lanes first, second;
            combination.evaluate(i, first, second);
            store_lanes(first, y + i);
            store_lanes(second, y + i + n);
            sums[0] += first * first + second * second;
            ACF_UNROLL
            for (unsigned int k = 0; k < n_vectors; ++k)
              sums[k + 1] += first * load_lanes<Lanes>(z[k] + i) +
                             second * load_lanes<Lanes>(z[k] + i + n);
          }
        for (unsigned int k = 0; k <= n_vectors; ++k)
          products[k] += sum_of_lanes(sums[k]);
        for (; i < end; ++i)
          {
            y[i] = combination.one(i);
            products[0] += y[i] * y[i];
            for (unsigned int k = 0; k < n_vectors; ++k)
              products[k + 1] += y[i] * z[k][i];
          }
      }

      Combination combination;
      double *y;
      const double *const *z;
      std::size_t begin, end;
      double *products;
    };



    // that sum_ranges() adds up
    struct Sums
    {
      Sums &
      operator+=(const Sums &other)
      {
        for (std::size_t k = 0; k < values.size(); ++k)
          values[k] += other.values[k];
        return *this;
      }

      std::vector<double> values;
    };



    void
    set_size(const std::vector<ScaledVector> &terms, NodalVector &y)
    {
      const std::size_t n = terms.front().vector->size();
      if (y.size() != n)
        y.reinit(n, true);
    }



    template <unsigned int n_vectors>
    std::vector<double>
    store_and_multiply(const Combination &combination,
                       const std::vector<const double *> &vectors,
                       NodalVector &y)
    {
      return sum_ranges<Sums>(
               y.size(),
               [&](const std::size_t begin, const std::size_t end) {
                 Sums sums;
                 sums.values.resize(n_vectors + 1);
                 run_in_lanes(StoreAndMultiply<n_vectors>{combination,
                                                          y.begin(),
                                                          vectors.data(),
                                                          begin,
                                                          end,
                                                          sums.values.data()});
                 return sums;
               })
        .values;
    }
  } // namespace



  void
  linear_combination(const std::vector<ScaledVector> &terms, NodalVector &y)
  {
    set_size(terms, y);
    const Terms all(terms);
    run_ranges(y.size(), [&](const std::size_t begin, const std::size_t end) {
      run_in_lanes(Store{Combination(all), y.begin(), begin, end});
    });
  }



  std::vector<double>
  linear_combination(const std::vector<ScaledVector> &terms,
                     const std::vector<const NodalVector *> &z,
                     NodalVector &y)
  {
    set_size(terms, y);
    const Terms all(terms);
    const Combination combination(all);
    std::vector<const double *> vectors;
    for (const NodalVector *const vector : z)
      {
        AssertDimension(vector->size(), y.size());
        vectors.push_back(vector->begin());
      }
    switch (z.size())
      {
        case 0:
          return store_and_multiply<0>(combination, vectors, y);
        case 1:
          return store_and_multiply<1>(combination, vectors, y);
        case 2:
          return store_and_multiply<2>(combination, vectors, y);
        case 3:
          return store_and_multiply<3>(combination, vectors, y);
        default:
          AssertThrow(false, ExcNotImplemented());
          return {};
      }
  }



  double
  square_of_combination(const std::vector<ScaledVector> &terms)
  {
    const Terms all(terms);
    return sum_ranges<double>(
      terms.front().vector->size(),
      [&](const std::size_t begin, const std::size_t end) {
        double total = 0;
        run_in_lanes(AddSquare{Combination(all), begin, end, total});
        return total;
      });
  }
} // namespace ACF
