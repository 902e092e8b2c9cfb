// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_pendulum_model_h
#define acf_tests_pendulum_model_h

#include <string>

namespace Tests
{
  /**
   * The pendulum of Gerstmayr and Schoeberl (2006), Sec. 8, as a model file
   * with a built-in mesh; 2 stages, 1 ms, 1 s.
   * @param element "hexahedron" or "tetrahedron"
   * @param cells counts along width, length and height, "1, 20, 2"
   */
  inline std::string
  pendulum_model(const std::string &element, const std::string &cells)
  {
    return R"(
subsection Bodies
  set Names = pendulum
  subsection pendulum
    set Mesh            = box
    set Element         = )" +
           element + R"(
    set Box from        = -0.00125, 0, -0.025
    set Box to          =  0.00125, 1,  0.025
    set Cells           = )" +
           cells + R"(
    set Young's modulus = 2.1e8
    set Poisson's ratio = 0.3
    set Density         = 7800
  end
end
subsection Joints
  set Names = hinge
  subsection hinge
    set Type    = revolute
    set Between = pendulum: y min, ground
    set Axis    = 1, 0, 0
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 1
  set Step size = 1e-3
end
subsection Probes
  set Names = chord
  subsection chord
    set Type  = chord
    set From  = pendulum: y min
    set To    = pendulum: y max
    set Point = 0, 0.5, 0
  end
end
)";
  }
} // namespace Tests

#endif
