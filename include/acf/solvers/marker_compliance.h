// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_marker_compliance_h
#define acf_solvers_marker_compliance_h

#include <acf/base/types.h>

#include <Eigen/Dense>

#include <vector>

namespace ACF
{
  /**
   * Compliance of a body at its markers, $R_b C_b R_b^T / \text{scale}$ in
   * world directions.
   */
  template <typename Number>
  struct MarkerCompliance
  {
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    /** $C_b$ of the functionals of the reference body, in its frame. */
    const Matrix *functionals;

    /** Of each marker of the body, and their functionals. */
    const Eigen::Matrix3d *rotations;
    const std::vector<unsigned int> *markers;

    Number inverse_scale;

    /** Size of the marker values of the body. */
    unsigned int
    n_values() const
    {
      return dim * markers->size();
    }

    /** Block of two markers of the body, by their numbers in it. */
    Eigen::Matrix<Number, dim, dim>
    block(const unsigned int row, const unsigned int column) const;

    /** Forces on the functionals, in the frame of the body.
     * @param phi on the markers, world directions */
    Vector
    functional_forces(const Eigen::Ref<const Vector> &phi) const;

    /** Displacements of the markers due to forces on them. */
    Vector
    displacements(const Eigen::Ref<const Vector> &phi) const;

    /** The largest entry's absolute value. */
    double
    largest() const;

    /** Appends the absolute trace of each marker's own block: what its squared
     * values are compared with. */
    void
    append_sizes(std::vector<double> &sizes) const;
  };
} // namespace ACF

#endif
