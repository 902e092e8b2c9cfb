// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/solvers/factorization_cache.h>

#include <algorithm>

namespace ACF
{
  template <typename Number>
  JointedFactorization<Number>::JointedFactorization(
    const ReferenceBody &body,
    const BlockNodeMatrix &stiffness,
    const Number shift,
    const std::shared_ptr<const EliminationTree> &tree,
    const FactorPrecision precision)
    : factor(body.operators(), stiffness, shift, tree, precision)
    , functionals(body.functionals())
    , n_unknowns(body.operators().n_unknowns())
  {
    if (functionals.empty())
      return;
    std::vector<Number> solutions(dim * functionals.size() * n_unknowns);
    for (unsigned int p = 0; p < functionals.size(); ++p)
      for (unsigned int k = 0; k < functionals[p].nodes.size(); ++k)
        for (unsigned int j = 0; j < dim; ++j)
          solutions[(dim * p + j) * n_unknowns + dim * functionals[p].nodes[k] +
                    j] = functionals[p].weights[k];
    factor.solve(solutions.data(), dim * functionals.size());
    columns = JointColumns<Number>(solutions,
                                   n_unknowns,
                                   factor.statistics().single_precision);

    joint_compliance.resize(dim * functionals.size(), dim * functionals.size());
    for (unsigned int q = 0; q < joint_compliance.cols(); ++q)
      {
        const std::vector<Number> column = columns.column(q);
        for (unsigned int p = 0; p < functionals.size(); ++p)
          joint_compliance.template block<dim, 1>(dim * p, q) =
            functional_value(p, column.data());
      }
  }



  template <typename Number>
  Eigen::Matrix<Number, dim, 1>
  JointedFactorization<Number>::functional_value(const unsigned int functional,
                                                 const Number *x) const
  {
    const NodalFunctional &weights = functionals[functional];
    Eigen::Matrix<Number, dim, 1> result =
      Eigen::Matrix<Number, dim, 1>::Zero();
    for (unsigned int k = 0; k < weights.nodes.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        result(i) += weights.weights[k] * x[dim * weights.nodes[k] + i];
    return result;
  }



  template <typename Number>
  void
  JointedFactorization<Number>::subtract_columns(const Vector &F,
                                                 Number *x,
                                                 const bool x_is_zero) const
  {
    columns.subtract_product(F, x, x_is_zero);
  }



  FactorizationCache::FactorizationCache(Statistics &statistics,
                                         const FactorPrecision precision,
                                         const std::size_t max_bytes)
    : statistics(statistics)
    , precision(precision)
    , max_bytes(max_bytes)
  {}



  void
  FactorizationCache::use(const double step_size)
  {
    present_step_size   = step_size;
    last_use[step_size] = ++n_uses;
  }



  bool
  FactorizationCache::holds(const double step_size) const
  {
    return last_use.find(step_size) != last_use.end();
  }



  template <typename Number>
  JointedFactorization<Number> &
  FactorizationCache::find_or_factorize(Factors<Number> &factors,
                                        const Body &body,
                                        const Number shift,
                                        unsigned long &counter)
  {
    const auto own         = stiffness.find(&body);
    const bool is_replaced = own != stiffness.end();
    const void *const kind = is_replaced
                               ? static_cast<const void *>(&body)
                               : static_cast<const void *>(&body.reference());
    auto &[entry, step_size, entry_bytes] =
      factors[Key(kind, std::real(shift), std::imag(shift))];
    step_size = present_step_size;
    if (!entry)
      {
        const PhaseTimer timer(statistics, "factorisation");
        try
          {
            auto &tree = trees[&body.reference()];
            if (!tree)
              tree = std::make_shared<const EliminationTree>(
                body.operators().mass_matrix.graph());
            entry = std::make_unique<JointedFactorization<Number>>(
              body.reference(),
              is_replaced ? *own->second : body.operators().stiffness_matrix,
              shift,
              tree,
              precision);
          }
        catch (const SimulationError &error)
          {
            n_bytes -= entry_bytes;
            factors.erase(Key(kind, std::real(shift), std::imag(shift)));
            throw SimulationError("Body '" + body.name() +
                                  "': " + error.what());
          }
        ++counter;
        const FactorizationStatistics &cost =
          entry->factorization().statistics();
        statistics.setup_solves +=
          1 + dim * body.reference().functionals().size();
        statistics.single_factorizations += (cost.single_precision ? 1 : 0);
        statistics.factor_contraction =
          std::max(statistics.factor_contraction, cost.contraction);
        statistics.factor_entries += cost.n_entries;
        statistics.factor_bytes += cost.n_bytes;
        statistics.joint_column_bytes += entry->column_bytes();
        statistics.factor_backward_error =
          std::max(statistics.factor_backward_error, cost.backward_error);
        n_bytes -= entry_bytes;
        entry_bytes = cost.n_bytes + entry->column_bytes();
        n_bytes += entry_bytes;
        limit_memory();
      }
    return *entry;
  }



  JointedFactorization<double> &
  FactorizationCache::get(const Body &body, const double shift)
  {
    return find_or_factorize(real_factors,
                             body,
                             shift,
                             statistics.real_factorizations);
  }



  JointedFactorization<std::complex<double>> &
  FactorizationCache::get(const Body &body, const std::complex<double> shift)
  {
    return find_or_factorize(complex_factors,
                             body,
                             shift,
                             statistics.complex_factorizations);
  }



  template <typename Number, typename Condition>
  unsigned int
  FactorizationCache::drop(Factors<Number> &factors, const Condition &condition)
  {
    unsigned int n_dropped = 0;
    for (auto it = factors.begin(); it != factors.end();)
      if (condition(*it))
        {
          if (const auto &factor = it->second.factor)
            {
              const FactorizationStatistics &cost =
                factor->factorization().statistics();
              statistics.factor_entries -= cost.n_entries;
              statistics.factor_bytes -= cost.n_bytes;
              statistics.joint_column_bytes -= factor->column_bytes();
            }
          n_bytes -= it->second.n_bytes;
          it = factors.erase(it);
          ++n_dropped;
        }
      else
        ++it;
    return n_dropped;
  }



  void
  FactorizationCache::limit_memory()
  {
    while (n_bytes > max_bytes && last_use.size() > 1)
      {
        const auto oldest    = std::min_element(last_use.begin(),
                                             last_use.end(),
                                             [](const auto &a, const auto &b) {
                                               return a.second < b.second;
                                             });
        const auto is_oldest = [&](const auto &item) {
          return item.second.step_size == oldest->first;
        };
        statistics.evicted_factors +=
          drop(real_factors, is_oldest) + drop(complex_factors, is_oldest);
        last_use.erase(oldest);
      }
  }



  void
  FactorizationCache::replace_stiffness(
    const Body &body,
    std::unique_ptr<const BlockNodeMatrix> matrix)
  {
    restore_stiffness(body);
    stiffness[&body] = std::move(matrix);
  }



  void
  FactorizationCache::restore_stiffness(const Body &body)
  {
    const auto is_own = [&](const auto &item) {
      return std::get<0>(item.first) == &body;
    };
    drop(real_factors, is_own);
    drop(complex_factors, is_own);
    stiffness.erase(&body);
  }



  struct FactorizationCache::EntryRecord
  {
    unsigned int body;
    bool is_own;
    double real_shift;
    double imaginary_shift;
    double step_size;
    std::size_t n_bytes;

    void
    exchange(Archive &archive)
    {
      archive("body", body);
      archive("is its own", is_own);
      archive("real shift", real_shift);
      archive("imaginary shift", imaginary_shift);
      archive("step size", step_size);
      archive("bytes", n_bytes);
    }
  };



  template <typename Number>
  void
  FactorizationCache::exchange(Archive &archive,
                               const std::string &name,
                               const std::vector<Body> &bodies,
                               Factors<Number> &factors)
  {
    std::vector<EntryRecord> records;
    for (const auto &[key, entry] : factors)
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          const auto &[kind, real_shift, imaginary_shift] = key;
          const bool is_own = kind == static_cast<const void *>(&bodies[b]);
          if (!is_own && kind != &bodies[b].reference())
            continue;
          records.push_back({b,
                             is_own,
                             real_shift,
                             imaginary_shift,
                             entry.step_size,
                             entry.n_bytes});
          break;
        }
    archive(name, records);
    if (!archive.is_loading())
      return;
    factors.clear();
    for (const EntryRecord &record : records)
      {
        const Body &body = bodies.at(record.body);
        const void *const kind =
          record.is_own ? static_cast<const void *>(&body)
                        : static_cast<const void *>(&body.reference());
        factors[Key(kind, record.real_shift, record.imaginary_shift)] = {
          nullptr, record.step_size, record.n_bytes};
        n_bytes += record.n_bytes;
      }
  }



  void
  FactorizationCache::exchange(Archive &archive,
                               const std::vector<Body> &bodies)
  {
    archive("uses", n_uses);
    std::vector<double> step_sizes;
    std::vector<unsigned long> uses;
    for (const auto &[step_size, use] : last_use)
      {
        step_sizes.push_back(step_size);
        uses.push_back(use);
      }
    archive("step sizes", step_sizes);
    archive("last uses", uses);
    std::vector<unsigned int> replaced;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (stiffness.count(&bodies[b]) > 0)
        replaced.push_back(b);
    archive("replaced stiffness", replaced);
    if (archive.is_loading())
      {
        n_bytes = 0;
        last_use.clear();
        for (unsigned int k = 0; k < step_sizes.size(); ++k)
          last_use[step_sizes[k]] = uses.at(k);
        stiffness.clear();
      }
    for (const unsigned int b : replaced)
      {
        auto &own   = stiffness[&bodies.at(b)];
        auto matrix = std::make_unique<BlockNodeMatrix>(
          own ? *own : bodies[b].operators().stiffness_matrix);
        archive("stiffness of body " + std::to_string(b), *matrix);
        own = std::move(matrix);
      }
    exchange(archive, "real factors", bodies, real_factors);
    exchange(archive, "complex factors", bodies, complex_factors);
  }



  template class JointedFactorization<double>;
  template class JointedFactorization<std::complex<double>>;
} // namespace ACF
