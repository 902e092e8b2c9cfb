// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/solvers/shifted_factorization.h>

#include <cmath>
#include <set>

#include <unit/all_instructions.h>
#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  using Complex = std::complex<double>;

  const BodyOperators &
  operators_of(const std::string &mesh)
  {
    static std::map<std::string, std::unique_ptr<const MultibodySystem>>
      systems;
    auto &system = systems[mesh];
    if (!system)
      system = std::make_unique<const MultibodySystem>(
        std::vector<BodyParameters>{body_parameters("body", mesh)},
        std::vector<JointParameters>(),
        LoadParameters(),
        ".");
    return system->bodies()[0].operators();
  }

  // A long body and a bulky one, for which the orders differ.
  const std::string slender =
    "set Mesh = box\n set Box from = 0, 0, 0\n set Box to = 20, 1, 1\n"
    "set Cells = 40, 2, 2\n set Element = tetrahedron\n";
  const std::string bulky =
    "set Mesh = box\n set Box from = 0, 0, 0\n set Box to = 1, 1, 1\n"
    "set Cells = 6, 6, 6\n set Element = tetrahedron\n";

  // Elimination of nodes one by one: the columns of L.
  std::vector<std::set<unsigned int>>
  eliminate(const NodeGraph &graph, const EliminationTree &tree)
  {
    std::vector<std::set<unsigned int>> columns(graph.n_nodes());
    for (unsigned int k = 0; k < graph.n_nodes(); ++k)
      for (std::size_t e = graph.row_start[tree.node()[k]];
           e < graph.row_start[tree.node()[k] + 1];
           ++e)
        if (tree.place()[graph.column[e]] > k)
          columns[k].insert(tree.place()[graph.column[e]]);
    for (auto &column : columns)
      if (!column.empty())
        columns[*column.begin()].insert(std::next(column.begin()),
                                        column.end());
    return columns;
  }

  template <typename Number>
  std::vector<Number>
  random_vectors(const std::size_t size)
  {
    Random random;
    std::vector<Number> result(size);
    for (Number &entry : result)
      entry = random.number(1);
    return result;
  }

  template <typename Number>
  double
  relative_difference(const std::vector<Number> &a,
                      const std::vector<Number> &b)
  {
    double difference = 0, scale = 0;
    for (unsigned int i = 0; i < a.size(); ++i)
      {
        difference = std::max(difference, std::abs(a[i] - b[i]));
        scale      = std::max(scale, std::abs(b[i]));
      }
    return difference / scale;
  }

  const Complex shift = Complex(2, 4 * std::sqrt(2.)) * 1e6;
} // namespace



TEST(EliminationTree, SupernodesHoldTheFactorAndFewZeros)
{
  for (const std::string &mesh : {slender, bulky})
    {
      const NodeGraph &graph = operators_of(mesh).mass_matrix.graph();
      const EliminationTree tree(graph);
      const auto columns    = eliminate(graph, tree);
      std::size_t n_nonzero = 0, n_stored = 0;
      unsigned int next = 0;
      for (unsigned int s = 0; s < tree.supernodes().size(); ++s)
        {
          const auto &supernode = tree.supernodes()[s];
          ASSERT_EQ(supernode.first, next);
          next += supernode.n_columns;
          if (supernode.rows.empty())
            EXPECT_EQ(supernode.parent, EliminationTree::none);
          else
            EXPECT_EQ(supernode.parent, tree.supernode_at(supernode.rows[0]));
          const std::set<unsigned int> rows(supernode.rows.begin(),
                                            supernode.rows.end());
          EXPECT_EQ(rows.size(), supernode.rows.size());
          for (unsigned int k = supernode.first; k < next; ++k)
            {
              EXPECT_EQ(tree.supernode_at(k), s);
              n_nonzero += columns[k].size();
              n_stored += next - 1 - k + rows.size();
              for (const unsigned int row : columns[k])
                EXPECT_TRUE(row < next || rows.count(row) > 0);
            }
        }
      EXPECT_EQ(next, graph.n_nodes());
      report("stored entries / entries of L", 1. * n_stored / n_nonzero);
      EXPECT_LT(n_stored, 1.2 * n_nonzero);
    }
}



template <typename Number>
void
compare_threads(const Number shift)
{
  const BodyOperators &body = operators_of(slender);
  const auto tree =
    std::make_shared<const EliminationTree>(body.mass_matrix.graph());
  const unsigned int n_vectors = 23; // eight, four and three at once
  const auto load =
    random_vectors<Number>(n_vectors * std::size_t(body.n_unknowns()));
  std::vector<std::vector<Number>> solutions;
  for (const unsigned int n_threads : {1, 2, 2, 5})
    {
      SupernodalFactor<Number, double> factor(tree, n_threads);
      factorize_multifrontal<Number>(
        *tree,
        {body.mass_matrix, body.stiffness_matrix, shift},
        [&](const unsigned int s, const Number *columns, const std::size_t ld) {
          factor.store(s, columns, ld);
        });
      // large enough that there are branches for threads
      ASSERT_GT(factor.n_bytes(), 2U << 20);
      solutions.push_back(load);
      factor.solve(solutions.back().data(), n_vectors);
      EXPECT_LT(relative_difference(solutions.back(), solutions.front()), 1e-11)
        << n_threads;
      auto alone = load;
      for (unsigned int v = 0; v < n_vectors; ++v)
        factor.solve(alone.data() + v * body.n_unknowns(), 1);
      EXPECT_LT(relative_difference(solutions.back(), alone), 1e-11);
    }
  EXPECT_EQ(solutions[1], solutions[2]); // to the last bit
}

TEST_WITH_ALL_INSTRUCTIONS(SupernodalFactor,
                           DoesNotDependOnThreadsAndNumberOfVectors)
{
  compare_threads(1e6);
  compare_threads(shift);
}



TEST_WITH_ALL_INSTRUCTIONS(ShiftedFactorization,
                           SinglePrecisionIsAsGoodAsItsContraction)
{
  for (const std::string &mesh : {slender, bulky})
    {
      const BodyOperators &body = operators_of(mesh);
      const auto tree =
        std::make_shared<const EliminationTree>(body.mass_matrix.graph());
      const ShiftedFactorization<Complex> exact(body, shift);
      const ShiftedFactorization<Complex> automatic(
        body, body.stiffness_matrix, shift, tree, FactorPrecision::automatic);
      EXPECT_TRUE(automatic.statistics().single_precision);
      EXPECT_LT(automatic.statistics().n_bytes,
                0.6 * exact.statistics().n_bytes);
      // of any size
      for (const double size : {1e-30, 1., 1e30})
        {
          auto x = random_vectors<Complex>(body.n_unknowns());
          for (Complex &entry : x)
            entry *= size;
          auto y = x;
          exact.solve(x.data());
          automatic.solve(y.data());
          const double error = relative_difference(y, x);
          report("error, contraction",
                 error / automatic.statistics().contraction);
          EXPECT_LT(error, 10 * automatic.statistics().contraction);
          EXPECT_GT(error, 0);
        }
    }
}



TEST(ShiftedFactorization, DoublePrecisionWhereSingleIsNotEnough)
{
  // Slow motion of a stiff body: the stiffness of bending is lost in that of
  // the cells.
  const BodyOperators &body = operators_of(slender);
  const auto tree =
    std::make_shared<const EliminationTree>(body.mass_matrix.graph());
  const double slow = 1e-5;
  const ShiftedFactorization<double> automatic(
    body, body.stiffness_matrix, slow, tree, FactorPrecision::automatic);
  EXPECT_FALSE(automatic.statistics().single_precision);
  EXPECT_GT(automatic.statistics().contraction,
            ShiftedFactorization<double>::largest_contraction);
  EXPECT_LT(automatic.statistics().backward_error, 1e-13);
  EXPECT_THROW(ShiftedFactorization<double>(body,
                                            body.stiffness_matrix,
                                            slow * 1e-6,
                                            tree,
                                            FactorPrecision::single_precision),
               SimulationError);
}
