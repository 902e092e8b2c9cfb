// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/dot_product.h>
#include <acf/base/huge_pages.h>
#include <acf/base/linear_combination.h>
#include <acf/base/parallel.h>
#include <acf/mechanics/node_matrix.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <unit/all_instructions.h>
#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  // Some nodes are coupled to far ones, across the parts of two threads.
  bool
  are_coupled(const unsigned int a, const unsigned int b)
  {
    const unsigned int distance = a < b ? b - a : a - b;
    return distance <= 2 || distance == 17 ||
           (distance == 3000 && a % 5 == b % 5);
  }

  std::shared_ptr<const NodeGraph>
  make_graph(const unsigned int n_nodes)
  {
    std::vector<std::size_t> row_start{0};
    std::vector<unsigned int> column;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        for (const int step : {-3000, -17, -2, -1, 0, 1, 2, 17, 3000})
          {
            const long b = static_cast<long>(a) + step;
            if (b >= 0 && b < n_nodes && are_coupled(a, b))
              column.push_back(b);
          }
        row_start.push_back(column.size());
      }
    return std::make_shared<const NodeGraph>(row_start, column);
  }

  // Symmetric; blocks are not.
  double
  entry(const unsigned int k, const unsigned int l)
  {
    return std::sin(1 + std::min(k, l) + 0.37 * std::max(k, l));
  }

  double
  mass(const unsigned int a, const unsigned int b)
  {
    return std::cos(1. * a + b);
  }

  struct Matrices
  {
    explicit Matrices(const std::shared_ptr<const NodeGraph> &graph)
      : blocks(graph)
      , scalars(graph)
    {
      for (unsigned int a = 0; a < graph->n_nodes(); ++a)
        for (std::size_t e = graph->row_start[a]; e < graph->row_start[a + 1];
             ++e)
          {
            const unsigned int b = graph->column[e];
            Matrix3 block;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                block[i][j] = entry(dim * a + i, dim * b + j);
            blocks.add(a, b, block);
            scalars.add(a, b, mass(a, b));
          }
    }

    BlockNodeMatrix blocks;
    ScalarNodeMatrix scalars;
  };

  // Entry by entry, from the definitions.
  NodalVector
  product(const NodeGraph &graph, const NodalVector &x, const bool with_blocks)
  {
    NodalVector y(x.size());
    for (unsigned int a = 0; a < graph.n_nodes(); ++a)
      for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1]; ++e)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            {
              const unsigned int k = dim * a + i;
              const unsigned int l = dim * graph.column[e] + j;
              if (with_blocks)
                y[k] += entry(k, l) * x[l];
              else if (i == j)
                y[k] += mass(a, graph.column[e]) * x[l];
            }
    return y;
  }

  std::vector<NodalVector>
  test_vectors(const unsigned int n_vectors, const unsigned int size)
  {
    std::vector<NodalVector> x(n_vectors, NodalVector(size));
    for (unsigned int v = 0; v < n_vectors; ++v)
      for (unsigned int k = 0; k < size; ++k)
        x[v][k] = std::sin(0.1 * k * (v + 1) + v);
    return x;
  }
} // namespace

TEST_WITH_ALL_INSTRUCTIONS(NodeMatrix, ProductsWithSeveralVectorsAndThreads)
{
  const ThreadLimit threads;
  double error = 0;
  for (const unsigned int n_nodes : {1, 4, 30, 9001})
    {
      const auto graph = make_graph(n_nodes);
      const Matrices matrices(graph);
      const auto all = test_vectors(6, dim * n_nodes);
      for (const bool with_blocks : {true, false})
        {
          std::vector<NodalVector> expected;
          for (const NodalVector &x : all)
            expected.push_back(product(*graph, x, with_blocks));
          for (const unsigned int n_vectors : {1, 2, 3, 5, 6})
            for (const unsigned int n_threads : {1, 2, 3})
              {
                MultithreadInfo::set_thread_limit(n_threads);
                std::vector<NodalVector> y(n_vectors,
                                           NodalVector(dim * n_nodes));
                std::vector<NodalVector *> targets;
                std::vector<const NodalVector *> sources;
                for (unsigned int v = 0; v < n_vectors; ++v)
                  {
                    y[v] = 1e10; // to be overwritten
                    targets.push_back(&y[v]);
                    sources.push_back(&all[v]);
                  }
                if (with_blocks)
                  matrices.blocks.vmult(targets, sources);
                else
                  matrices.scalars.vmult(targets, sources);
                for (unsigned int v = 0; v < n_vectors; ++v)
                  {
                    y[v] -= expected[v];
                    error = std::max(error, y[v].linfty_norm());
                  }
              }
        }
    }
  // sums of up to 27 products of numbers up to 1
  EXPECT_LT(error, 1e-14);
  report("products with node matrices", error);
}

// Windows on the nodes that some rows reach, which are smaller than the body,
// and against the sum over all entries.
TEST_WITH_ALL_INSTRUCTIONS(NodeMatrix, RowsAndQuadraticForms)
{
  const ThreadLimit threads;
  double error = 0, form_error = 0;
  for (const unsigned int n_nodes : {1, 30, 9001})
    {
      const auto graph = make_graph(n_nodes);
      EXPECT_EQ(graph->bandwidth,
                n_nodes == 1 ? 1 : (n_nodes == 30 ? 18 : 3001));
      const Matrices matrices(graph);
      const auto x = test_vectors(3, dim * n_nodes);
      for (const bool with_blocks : {true, false})
        {
          std::vector<NodalVector> expected;
          for (const NodalVector &vector : x)
            expected.push_back(product(*graph, vector, with_blocks));
          for (const unsigned int n_threads : {1, 2})
            {
              MultithreadInfo::set_thread_limit(n_threads);
              const double form = with_blocks
                                    ? matrices.blocks.quadratic_form(x[0])
                                    : matrices.scalars.quadratic_form(x[0]);
              form_error =
                std::max(form_error,
                         std::abs(form - x[0] * expected[0]) / n_nodes);
            }
          for (unsigned int n_vectors = 1; n_vectors <= 3; ++n_vectors)
            {
              constexpr unsigned int size = 4096, n_rows = 700;
              NodeLanes source, sum;
              source.resize(size, n_vectors);
              sum.resize(size, n_vectors);
              std::size_t reach = 0;
              for (unsigned int begin = 0; begin < n_nodes; begin += n_rows)
                {
                  const unsigned int end = std::min(begin + n_rows, n_nodes);
                  const RowRange rows{begin, end, reach};
                  for (; reach < graph->reach[end - 1]; ++reach)
                    for (unsigned int v = 0; v < n_vectors; ++v)
                      {
                        double *const place =
                          source.data() + 4 * (n_vectors * (reach % size) + v);
                        store_lanes(load_three(x[v].begin() + dim * reach),
                                    place);
                      }
                  if (with_blocks)
                    matrices.blocks.add_rows(rows, sum, source);
                  else
                    matrices.scalars.add_rows(rows, sum, source);
                  for (unsigned int a = begin; a < end; ++a)
                    for (unsigned int v = 0; v < n_vectors; ++v)
                      for (unsigned int i = 0; i < dim; ++i)
                        error = std::max(
                          error,
                          std::abs(
                            sum.data()[4 * (n_vectors * (a % size) + v) + i] -
                            expected[v][dim * a + i]));
                }
            }
        }
    }
  EXPECT_LT(error, 1e-14);
  EXPECT_LT(form_error, 1e-14);
  report("rows of products with node matrices", error);
  report("quadratic forms, for each node", form_error);
}

TEST(NodeMatrix, BlocksAndRowSums)
{
  const auto graph = make_graph(40);
  const Matrices matrices(graph);
  const std::vector<double> sums = matrices.scalars.row_sums();
  for (unsigned int a = 0; a < 40; ++a)
    {
      double sum = 0;
      for (unsigned int b = 0; b < 40; ++b)
        if (are_coupled(a, b))
          {
            sum += mass(a, b);
            EXPECT_EQ(matrices.scalars.value(a, b), mass(a, b));
            const NodeBlock block = matrices.blocks.block(a, b);
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                EXPECT_EQ(block(i, j), entry(dim * a + i, dim * b + j));
          }
      EXPECT_NEAR(sums[a], sum, 1e-14);
    }
}

TEST_WITH_ALL_INSTRUCTIONS(LinearCombination, AnyNumberOfTermsAndProducts)
{
  const ThreadLimit threads;
  for (const unsigned int size : {1, 7, 8, 16, 1000, 20001})
    for (unsigned int n = 1; n <= 7; ++n)
      for (const unsigned int n_threads : {1, 2})
        {
          MultithreadInfo::set_thread_limit(n_threads);
          std::vector<NodalVector> x = test_vectors(n, size);
          std::vector<ScaledVector> terms;
          for (unsigned int k = 0; k < n; ++k)
            terms.push_back({1.5 - k, &x[k]});
          NodalVector expected(size), y;
          for (unsigned int k = 0; k < n; ++k)
            expected.add(1.5 - k, x[k]);
          linear_combination(terms, y);
          EXPECT_EQ(y.size(), size);

          const std::vector<NodalVector> z = test_vectors(3, size);
          const double square              = expected * expected;
          EXPECT_NEAR(square_of_combination(terms), square, 1e-14 * square);
          for (unsigned int n_products = 0; n_products <= 3; ++n_products)
            {
              std::vector<const NodalVector *> vectors;
              for (unsigned int k = 0; k < n_products; ++k)
                vectors.push_back(&z[k]);
              NodalVector same;
              const std::vector<double> products =
                linear_combination(terms, vectors, same);
              EXPECT_EQ(same, y);
              ASSERT_EQ(products.size(), 1 + n_products);
              EXPECT_NEAR(products[0], square, 1e-14 * square);
              for (unsigned int k = 0; k < n_products; ++k)
                EXPECT_NEAR(products[k + 1], expected * z[k], 1e-14 * size);
            }

          linear_combination(terms, x[0]);
          EXPECT_EQ(x[0], y);
          y -= expected;
          EXPECT_LT(y.linfty_norm(), 1e-14);
        }
}

TEST_WITH_ALL_INSTRUCTIONS(DotProduct, AnySize)
{
  const ThreadLimit threads;
  for (const unsigned int size : {0, 1, 7, 8, 31, 32, 1000, 20001})
    for (const unsigned int n_threads : {1, 2})
      {
        MultithreadInfo::set_thread_limit(n_threads);
        const std::vector<NodalVector> x = test_vectors(2, size);
        long double expected             = 0;
        for (unsigned int k = 0; k < size; ++k)
          expected += static_cast<long double>(x[0][k]) * x[1][k];
        EXPECT_NEAR(dot_product(x[0], x[1]),
                    static_cast<double>(expected),
                    1e-15 * size);
      }
}

#if defined(__linux__) && defined(__GLIBC__) && \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// The flags of the part of the address space that holds an address.
std::string
flags_of_address(const void *const address)
{
  std::ifstream maps("/proc/self/smaps");
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  bool is_inside    = false;
  for (std::string line; std::getline(maps, line);)
    {
      std::istringstream words(line);
      std::uintptr_t begin, end;
      char minus;
      if (words >> std::hex >> begin >> minus >> end && minus == '-')
        is_inside = begin <= wanted && wanted < end;
      else if (is_inside && line.rfind("VmFlags:", 0) == 0)
        return line + " ";
    }
  return "";
}

TEST(HugePages, HeapIsAdvised)
{
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage"))
    GTEST_SKIP() << "the system has no huge pages";
  keep_heap_in_huge_pages();
  // more than what was free before
  std::vector<std::unique_ptr<char[]>> memory;
  for (unsigned int k = 0; k < 8; ++k)
    memory.emplace_back(new char[8 << 20]);
  const std::string flags = flags_of_address(&memory.back()[4 << 20]);
  EXPECT_NE(flags.find(" hg "), std::string::npos) << flags;
}
#endif



TEST(Parallel, SumsDoNotDependOnTiming)
{
  const ThreadLimit threads;
  const unsigned int n = 100000;
  const auto sum       = [](const std::size_t begin, const std::size_t end) {
    double result = 0;
    for (std::size_t k = begin; k < end; ++k)
      result += 1. / (1 + k);
    return result;
  };
  MultithreadInfo::set_thread_limit(3);
  const double first = sum_ranges<double>(n, sum);
  // Euler's constant and the first terms of the asymptotic series
  EXPECT_NEAR(first, std::log(n) + 0.5772156649015329 + 0.5 / n, 1e-10);
  for (unsigned int repetition = 0; repetition < 20; ++repetition)
    EXPECT_EQ(sum_ranges<double>(n, sum), first);
}
