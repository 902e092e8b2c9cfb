// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_types_h
#define acf_base_types_h

#include <deal.II/base/tensor.h>

#include <deal.II/lac/vector.h>

#include <complex>
#include <vector>

/**
 * Flexible multibody dynamics with the absolute coordinate formulation of
 * Gerstmayr and Schoeberl.
 */
namespace ACF
{
  using namespace dealii;

  /** The program simulates three-dimensional solids only. */
  constexpr unsigned int dim = 3;

  /** A direction, a force, a moment or a difference of positions. */
  using Vector3 = Tensor<1, dim>;

  /** A deformation gradient, a rotation or a stretch. */
  using Matrix3 = Tensor<2, dim>;

  /** Coefficients of a body: three per node, node by node. */
  using NodalVector = Vector<double>;
} // namespace ACF

#endif
