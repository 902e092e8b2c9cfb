// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_dense_stage_system_h
#define acf_tests_dense_stage_system_h

#include <acf/solvers/stage_solver.h>

#include <unit/multibody_test.h>

namespace ACF::Testing
{
  inline const std::string box =
    "set Mesh = box\n set Box from = 0, 0, 0\n"
    "set Box to = 1, 0.3, 0.2\n set Cells = 1, 1, 1\n";
  inline const std::string tetrahedra = box + "set Element = tetrahedron\n";
  inline const std::string hexahedra  = box + "set Element = hexahedron\n";

  /** Thin bodies at the same place. */
  inline BodyParameters
  body(const std::string &name, const std::string &mesh)
  {
    BodyParameters parameters = body_parameters(name, mesh);
    parameters.rotation       = Vector3({0.3, -0.2, 1});
    return parameters;
  }

  inline JointParameters
  joint(const std::string &type,
        const std::string &between,
        const std::string &directions = "")
  {
    JointParameters parameters;
    parameters.name       = between;
    parameters.type       = type;
    parameters.between    = between;
    parameters.directions = directions;
    if (type == "revolute")
      parameters.axis =
        rotation_matrix(Vector3({0.3, -0.2, 1})) * Vector3({0, 1, 0});
    return parameters;
  }

  /** At the placement, where joints have no geometric stiffness. */
  inline MarkerLinearization
  linearization_of(const MultibodySystem &system)
  {
    const Eigen::VectorXd s = system.marker_values(system.placement());
    return system.linearize(
      0, s, s, Eigen::VectorXd::Zero(system.n_constraints()), {});
  }

  /** Stages that turn about a random axis from one to the next by an angle. */
  inline StageRotations
  random_rotations(const MultibodySystem &system,
                   Random &random,
                   const unsigned int n_stages,
                   const double angle = 0)
  {
    StageRotations rotations;
    rotations.stages.resize(n_stages);
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const Matrix3 mean = random.rotation();
        const Vector3 axis = random.rotation() * Vector3({1, 0, 0});
        rotations.mean.push_back(mean);
        for (unsigned int i = 0; i < n_stages; ++i)
          rotations.stages[i].push_back(
            rotation_matrix((i - 0.5 * (n_stages - 1)) * angle * axis) * mean);
      }
    return rotations;
  }

  /** The same in all stages, but for each node that is not one of a marker. */
  inline StageRotations
  random_node_rotations(const MultibodySystem &system,
                        Random &random,
                        const unsigned int n_stages)
  {
    StageRotations rotations;
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        std::vector<Matrix3> nodes;
        for (unsigned int a = 0; a < system.bodies()[b].operators().n_nodes;
             ++a)
          nodes.push_back(random.rotation());
        std::vector<const NodalFunctional *> functionals;
        for (const unsigned int p : system.body_markers(b))
          functionals.push_back(
            &system.bodies()[b].reference().functionals()[p]);
        for (const auto &set : connected_nodes(functionals))
          for (const unsigned int a : set)
            nodes[a] = nodes[set[0]];
        rotations.mean.push_back(NodeRotations(nodes));
      }
    rotations.stages.assign(n_stages, rotations.mean);
    return rotations;
  }

  /** Right-hand sides or solutions of all stages in one. */
  struct Stages
  {
    StageVector bodies;
    StageConstraints constraints;
  };

  /**
   * The full linear system of the stages as a dense matrix,
   * \f[ \tau^{-2} A^{-2} \otimes M + \tau^{-1} A^{-1} \otimes C
   *     + I \otimes K \f]
   * bordered by $I \otimes B$, with everything of bodies and markers in M, C
   * and K, and with the C and K of bodies turned to each stage, node by node. M
   * is turned by the mean rotations, which matters only if those differ between
   * the nodes of a body.
   */
  class DenseStageSystem
  {
  public:
    DenseStageSystem(const MultibodySystem &system,
                     const ButcherTableau &tableau,
                     const double step_size,
                     const StageRotations &rotations,
                     const MarkerLinearization &linearization,
                     const std::vector<LowRankChange> &changes = {})
      : system(system)
      , n_stages(tableau.n_stages())
      , n_constraints(system.n_constraints())
    {
      for (const Body &body : system.bodies())
        n_unknowns += body.operators().n_unknowns();
      const Eigen::MatrixXd rates = tableau.A.inverse() / step_size;
      const Eigen::MatrixXd squared_rates =
        (tableau.A * tableau.A).inverse() / (step_size * step_size);
      matrix = Eigen::MatrixXd::Zero(size(), size());
      for (unsigned int i = 0; i < n_stages; ++i)
        {
          assemble_bodies(rotations.stages[i], rotations.mean, changes);
          assemble_markers(linearization);
          for (unsigned int j = 0; j < n_stages; ++j)
            matrix.block(i * n_unknowns,
                         j * n_unknowns,
                         n_unknowns,
                         n_unknowns) =
              squared_rates(i, j) * M + rates(i, j) * C;
          matrix.block(i * n_unknowns,
                       i * n_unknowns,
                       n_unknowns,
                       n_unknowns) += K;
          matrix.block(first_row(i),
                       i * n_unknowns,
                       n_constraints,
                       n_unknowns)    = B;
          matrix.block(i * n_unknowns,
                       first_row(i),
                       n_unknowns,
                       n_constraints) = B.transpose();
        }
    }

    /** Multipliers are larger than displacements by the size of the stiffness:
     * scaled before the factorisation, refined after it. */
    Eigen::VectorXd
    solve(const Eigen::VectorXd &right_hand_side) const
    {
      const double scale = K.cwiseAbs().maxCoeff();
      Eigen::VectorXd S  = Eigen::VectorXd::Ones(size());
      S.tail(n_stages * n_constraints).setConstant(scale);
      const Eigen::PartialPivLU<Eigen::MatrixXd> factor(
        S.asDiagonal() * matrix * S.asDiagonal());
      Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
      for (unsigned int k = 0; k < 3; ++k)
        x += S.cwiseProduct(
          factor.solve(S.cwiseProduct(right_hand_side - matrix * x)));
      return x;
    }

    Eigen::VectorXd
    vmult(const Eigen::VectorXd &x) const
    {
      return matrix * x;
    }

    Eigen::VectorXd
    flatten(const Stages &stages) const
    {
      Eigen::VectorXd result(size());
      unsigned int k = 0;
      for (const SystemVector &stage : stages.bodies)
        for (const NodalVector &vector : stage)
          for (const double value : vector)
            result(k++) = value;
      for (const Eigen::VectorXd &rows : stages.constraints)
        for (const double value : rows)
          result(k++) = value;
      return result;
    }

    Stages
    unflatten(const Eigen::VectorXd &x) const
    {
      Stages stages;
      unsigned int k = 0;
      for (unsigned int i = 0; i < n_stages; ++i)
        {
          stages.bodies.emplace_back();
          for (const Body &body : system.bodies())
            {
              NodalVector vector(body.operators().n_unknowns());
              for (double &value : vector)
                value = x(k++);
              stages.bodies[i].push_back(vector);
            }
        }
      for (unsigned int i = 0; i < n_stages; ++i)
        stages.constraints.push_back(x.segment(first_row(i), n_constraints));
      return stages;
    }

    /** Forces like the inertia of accelerations of some 10 m/s^2, and gaps. */
    Eigen::VectorXd
    random_right_hand_side(Random &random) const
    {
      Eigen::VectorXd r(size());
      for (double &value : r)
        value = random.number(1);
      r.head(n_stages * n_unknowns) *= 10 * M.diagonal().maxCoeff();
      r.tail(n_stages * n_constraints) *= 1e-4;
      return r;
    }

    /** The part of a vector that are displacements. */
    Eigen::VectorXd
    displacements(const Eigen::VectorXd &x) const
    {
      return x.head(n_stages * n_unknowns);
    }

    /** Largest relative error of displacements and of multipliers. */
    double
    error(const Eigen::VectorXd &x, const Eigen::VectorXd &exact) const
    {
      const unsigned int n = n_stages * n_unknowns;
      double result        = relative_difference(x.head(n), exact.head(n));
      if (n_constraints > 0)
        result = std::max(result,
                          relative_difference(x.tail(size() - n),
                                              exact.tail(size() - n)));
      return result;
    }

  private:
    unsigned int
    size() const
    {
      return n_stages * (n_unknowns + n_constraints);
    }

    unsigned int
    first_row(const unsigned int stage) const
    {
      return n_stages * n_unknowns + stage * n_constraints;
    }

    void
    assemble_bodies(const std::vector<NodeRotations> &rotations,
                    const std::vector<NodeRotations> &mean,
                    const std::vector<LowRankChange> &changes)
    {
      M = C = K          = Eigen::MatrixXd::Zero(n_unknowns, n_unknowns);
      unsigned int first = 0;
      for (unsigned int b = 0; b < rotations.size(); ++b)
        {
          const Body &body               = system.bodies()[b];
          const BodyOperators &operators = body.operators();
          const unsigned int n           = operators.n_unknowns();
          Eigen::MatrixXd R              = Eigen::MatrixXd::Zero(n, n);
          Eigen::MatrixXd R_mean         = R;
          for (unsigned int a = 0; a < operators.n_nodes; ++a)
            {
              R.block<dim, dim>(dim * a, dim * a) = to_eigen(rotations[b][a]);
              R_mean.block<dim, dim>(dim * a, dim * a) = to_eigen(mean[b][a]);
            }
          const Eigen::MatrixXd mass =
            R_mean * to_dense(operators.mass_matrix) * R_mean.transpose();
          const Eigen::MatrixXd stiffness =
            R * to_dense(operators.stiffness_matrix) * R.transpose();
          M.block(first, first, n, n) = mass;
          K.block(first, first, n, n) = stiffness;
          C.block(first, first, n, n) =
            body.mass_damping() * mass + body.stiffness_damping() * stiffness;
          if (!changes.empty())
            {
              const Eigen::MatrixXd U = R * changes[b].columns;
              K.block(first, first, n, n) +=
                U * changes[b].coefficients * U.transpose();
            }
          first += n;
        }
    }

    /** S column by column, as marker values of single unknowns. */
    void
    assemble_markers(const MarkerLinearization &linearization)
    {
      SystemVector unit = system.placement();
      for (NodalVector &vector : unit)
        vector = 0;
      const unsigned int n = system.n_marker_values();
      Eigen::MatrixXd S(n, n_unknowns);
      unsigned int column = 0;
      for (NodalVector &vector : unit)
        for (double &value : vector)
          {
            value           = 1;
            S.col(column++) = system.marker_values(unit);
            value           = 0;
          }
      const auto on_nodes = [&](const MarkerLinearization::Triplets &matrix) {
        return (S.transpose() * to_dense(matrix, n, n) * S).eval();
      };
      M += on_nodes(linearization.mass);
      C += on_nodes(linearization.damping);
      K += on_nodes(linearization.stiffness);
      B = to_dense(linearization.constraints, n_constraints, n) * S;
    }

    const MultibodySystem &system;
    const unsigned int n_stages;
    const unsigned int n_constraints;
    unsigned int n_unknowns = 0;
    Eigen::MatrixXd M, C, K, B, matrix;
  };
} // namespace ACF::Testing

#endif
