// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_stage_frames_h
#define acf_solvers_stage_frames_h

#include <acf/mechanics/node_rotations.h>

#include <vector>

namespace ACF
{
  /**
   * $w_a = \sum_i f_i R_{i,a}^T r_{i,a}$: a combination of the stages of a
   * body, in its frames. Number: double or std::complex<double>.
   * @param stages $r_i$, size 3 n_nodes each, at most NodeLanes::max_vectors
   * @param[out] w 3 n_nodes numbers
   */
  template <typename Number>
  void
  combine_in_body_frame(const std::vector<const NodalVector *> &stages,
                        const std::vector<Number> &factors,
                        const std::vector<const NodeRotations *> &rotations,
                        Number *w);

  /**
   * $z_{i,a} = R_{i,a} \,\mathrm{Re}(f_i w_a)$ for all stages, or the same
   * added to z_i.
   * @param stages $z_i$
   * @param replace whether z_i is replaced
   */
  template <typename Number>
  void
  add_in_world_frame(const Number *w,
                     const std::vector<Number> &factors,
                     const std::vector<const NodeRotations *> &rotations,
                     const bool replace,
                     const std::vector<NodalVector *> &stages);
} // namespace ACF

#endif
