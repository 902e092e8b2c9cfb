// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_green_lagrange_kernels_h
#define acf_mechanics_green_lagrange_kernels_h

#include <acf/base/processor.h>
#include <acf/mechanics/green_lagrange.h>

/*
 * The loops of GreenLagrangeOperator over the quadrature points of a batch of
 * cells, for the lanes of one vector at a time: a batch is one vector of eight
 * numbers, or several shorter ones where the processor has no longer.
 */

namespace ACF
{
  namespace Kernels
  {
    constexpr unsigned int batch_size = GreenLagrangeOperator::batch_size;

    typedef double TwoCells __attribute__((vector_size(16), may_alias));
    typedef double FourCells __attribute__((vector_size(32), may_alias));
    typedef double EightCells __attribute__((vector_size(64), may_alias));

    /** Entries [i][j], one per cell. */
    template <typename Cells>
    struct CellMatrix
    {
      Cells entry[3][3];
    };

    template <typename Cells>
    ACF_INLINE Cells
    load(const double *const p)
    {
      return *reinterpret_cast<const Cells *>(p);
    }

    template <typename Cells>
    ACF_INLINE void
    store(double *const p, const Cells &x)
    {
      *reinterpret_cast<Cells *>(p) = x;
    }

    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    load_matrix(const double *const p)
    {
      CellMatrix<Cells> A;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          A.entry[i][j] = load<Cells>(p + batch_size * (3 * i + j));
      return A;
    }

    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    product(const CellMatrix<Cells> &A, const CellMatrix<Cells> &B)
    {
      CellMatrix<Cells> C;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          C.entry[i][j] = A.entry[i][0] * B.entry[0][j] +
                          A.entry[i][1] * B.entry[1][j] +
                          A.entry[i][2] * B.entry[2][j];
      return C;
    }

    /** c A B^T */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    scaled_product_with_transpose(const Cells &c,
                                  const CellMatrix<Cells> &A,
                                  const CellMatrix<Cells> &B)
    {
      CellMatrix<Cells> C;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          C.entry[i][j] =
            c * (A.entry[i][0] * B.entry[j][0] + A.entry[i][1] * B.entry[j][1] +
                 A.entry[i][2] * B.entry[j][2]);
      return C;
    }

    /** Symmetric part of A^T B. */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    symmetric_product(const CellMatrix<Cells> &A, const CellMatrix<Cells> &B)
    {
      CellMatrix<Cells> C;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          C.entry[i][j] = A.entry[0][i] * B.entry[0][j] +
                          A.entry[1][i] * B.entry[1][j] +
                          A.entry[2][i] * B.entry[2][j];
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < i; ++j)
          C.entry[i][j] = C.entry[j][i] = 0.5 * (C.entry[i][j] + C.entry[j][i]);
      return C;
    }

    template <typename Cells>
    ACF_INLINE Cells
    determinant(const CellMatrix<Cells> &A)
    {
      return A.entry[0][0] *
               (A.entry[1][1] * A.entry[2][2] - A.entry[1][2] * A.entry[2][1]) -
             A.entry[0][1] *
               (A.entry[1][0] * A.entry[2][2] - A.entry[1][2] * A.entry[2][0]) +
             A.entry[0][2] *
               (A.entry[1][0] * A.entry[2][1] - A.entry[1][1] * A.entry[2][0]);
    }

    /** (F^T F - I) / 2 */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    green_lagrange_strain(const CellMatrix<Cells> &F)
    {
      CellMatrix<Cells> E;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          {
            E.entry[i][j] =
              0.5 *
              (F.entry[0][i] * F.entry[0][j] + F.entry[1][i] * F.entry[1][j] +
               F.entry[2][i] * F.entry[2][j] - (i == j ? 1. : 0.));
            E.entry[j][i] = E.entry[i][j];
          }
      return E;
    }

    /** $\lambda\, \mathrm{tr}(E)\, I + 2 \mu E$ */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    stress(const double lambda, const double mu, const CellMatrix<Cells> &E)
    {
      const Cells volumetric =
        lambda * (E.entry[0][0] + E.entry[1][1] + E.entry[2][2]);
      CellMatrix<Cells> S;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          S.entry[i][j] = 2 * mu * E.entry[i][j];
      for (unsigned int i = 0; i < 3; ++i)
        S.entry[i][i] += volumetric;
      return S;
    }

    /** $\sum_a x_a \otimes \nabla\phi_a$ at quadrature point q.
     * @param x [a][i][cell] */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    gradient(const GreenLagrangeOperator::Geometry &geometry,
             const double *const x,
             const unsigned int q,
             const CellMatrix<Cells> &inverse_jacobian)
    {
      const unsigned int n     = geometry.n_shape_functions;
      const double *const grad = &geometry.unit_gradients[3 * n * q];
      CellMatrix<Cells> unit;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          unit.entry[i][j] = Cells{};
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Cells value = load<Cells>(x + batch_size * (3 * a + i));
            for (unsigned int j = 0; j < 3; ++j)
              unit.entry[i][j] += grad[3 * a + j] * value;
          }
      return product(unit, inverse_jacobian);
    }

    /** Adds $P\, \nabla\phi_a$ dV of quadrature point q to f, [a][i][cell]. */
    template <typename Cells>
    ACF_INLINE void
    add_divergence(const GreenLagrangeOperator::Geometry &geometry,
                   const CellMatrix<Cells> &P,
                   const unsigned int q,
                   const CellMatrix<Cells> &inverse_jacobian,
                   const Cells &dV,
                   double *const f)
    {
      const unsigned int n     = geometry.n_shape_functions;
      const double *const grad = &geometry.unit_gradients[3 * n * q];
      const CellMatrix<Cells> unit =
        scaled_product_with_transpose(dV, P, inverse_jacobian);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          {
            double *const entry = f + batch_size * (3 * a + i);
            Cells sum           = load<Cells>(entry);
            for (unsigned int j = 0; j < 3; ++j)
              sum += grad[3 * a + j] * unit.entry[i][j];
            store(entry, sum);
          }
    }

    /** Inverse Jacobian at quadrature point q of a batch. */
    template <typename Cells>
    ACF_INLINE CellMatrix<Cells>
    inverse_jacobian(const GreenLagrangeOperator::Geometry &geometry,
                     const std::size_t batch,
                     const unsigned int q,
                     const unsigned int lane)
    {
      return load_matrix<Cells>(
        &geometry.inverse_jacobians[geometry.jacobian_index(batch, q) + lane]);
    }

    template <typename Cells>
    ACF_INLINE Cells
    volume_element(const GreenLagrangeOperator::Geometry &geometry,
                   const std::size_t batch,
                   const unsigned int q,
                   const unsigned int lane)
    {
      return load<Cells>(
        &geometry.weights[batch_size * (batch * geometry.n_points + q) + lane]);
    }

    /**
     * Forces and energies of a batch.
     * @param x positions, [a][i][cell]
     * @param[out] f [a][i][cell]
     * @param[out] energies [cell]
     * @return whether det F is positive at all points of all cells
     */
    template <typename Cells>
    ACF_INLINE bool
    force(const GreenLagrangeOperator::Geometry &geometry,
          const std::size_t batch,
          const double *const x,
          double *const f,
          double *const energies)
    {
      constexpr unsigned int width = sizeof(Cells) / sizeof(double);
      bool is_valid                = true;
      for (unsigned int lane = 0; lane < batch_size; lane += width)
        {
          Cells energy{};
          auto positive = energy == energy;
          for (unsigned int a = 0; a < 3 * geometry.n_shape_functions; ++a)
            store(f + batch_size * a + lane, Cells{});
          for (unsigned int q = 0; q < geometry.n_points; ++q)
            {
              const CellMatrix<Cells> J =
                inverse_jacobian<Cells>(geometry, batch, q, lane);
              const Cells dV = volume_element<Cells>(geometry, batch, q, lane);
              const CellMatrix<Cells> F = gradient(geometry, x + lane, q, J);
              const CellMatrix<Cells> E = green_lagrange_strain(F);
              const CellMatrix<Cells> S =
                stress(geometry.lambda, geometry.mu, E);
              Cells density{};
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  density += E.entry[i][j] * S.entry[i][j];
              energy += 0.5 * dV * density;
              // not a number is no positive one
              positive &= determinant(F) > Cells{};
              add_divergence(geometry, product(F, S), q, J, dV, f + lane);
            }
          store(energies + lane, energy);
          for (unsigned int k = 0; k < width; ++k)
            is_valid = is_valid && positive[k];
        }
      return is_valid;
    }

    /** The derivative of the force of a batch. @param dx direction */
    template <typename Cells>
    ACF_INLINE void
    apply_tangent(const GreenLagrangeOperator::Geometry &geometry,
                  const std::size_t batch,
                  const double *const x,
                  const double *const dx,
                  double *const f)
    {
      constexpr unsigned int width = sizeof(Cells) / sizeof(double);
      for (unsigned int lane = 0; lane < batch_size; lane += width)
        {
          for (unsigned int a = 0; a < 3 * geometry.n_shape_functions; ++a)
            store(f + batch_size * a + lane, Cells{});
          for (unsigned int q = 0; q < geometry.n_points; ++q)
            {
              const CellMatrix<Cells> J =
                inverse_jacobian<Cells>(geometry, batch, q, lane);
              const CellMatrix<Cells> F  = gradient(geometry, x + lane, q, J);
              const CellMatrix<Cells> dF = gradient(geometry, dx + lane, q, J);
              const CellMatrix<Cells> S =
                stress(geometry.lambda, geometry.mu, green_lagrange_strain(F));
              const CellMatrix<Cells> dS =
                stress(geometry.lambda, geometry.mu, symmetric_product(F, dF));
              CellMatrix<Cells> dP              = product(dF, S);
              const CellMatrix<Cells> of_stress = product(F, dS);
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  dP.entry[i][j] += of_stress.entry[i][j];
              add_divergence(geometry,
                             dP,
                             q,
                             J,
                             volume_element<Cells>(geometry, batch, q, lane),
                             f + lane);
            }
        }
    }

    /** $\int F dV$, [i][j][cell], and the volume, [cell]. */
    template <typename Cells>
    ACF_INLINE void
    integrate_gradient(const GreenLagrangeOperator::Geometry &geometry,
                       const std::size_t batch,
                       const double *const x,
                       double *const integral,
                       double *const volumes)
    {
      constexpr unsigned int width = sizeof(Cells) / sizeof(double);
      for (unsigned int lane = 0; lane < batch_size; lane += width)
        {
          CellMatrix<Cells> sum;
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              sum.entry[i][j] = Cells{};
          Cells volume{};
          for (unsigned int q = 0; q < geometry.n_points; ++q)
            {
              const Cells dV = volume_element<Cells>(geometry, batch, q, lane);
              const CellMatrix<Cells> F =
                gradient(geometry,
                         x + lane,
                         q,
                         inverse_jacobian<Cells>(geometry, batch, q, lane));
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  sum.entry[i][j] += dV * F.entry[i][j];
              volume += dV;
            }
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              store(integral + batch_size * (3 * i + j) + lane,
                    sum.entry[i][j]);
          store(volumes + lane, volume);
        }
    }
  } // namespace Kernels
} // namespace ACF

#endif
