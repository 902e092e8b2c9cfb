#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors
#
# Errors in joints, drives, force elements, masses, loads, start and modes; joints
# that repeat or contradict each other.
# shellcheck source=tests/cli/common.sh
. "$(dirname "$(realpath "$0")")/common.sh"

cat >good.prm <<'END'
subsection Bodies
  set Names = arm, rod
  subsection arm
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, 0, 0
    set Box to          = 1, 0.2, 0.2
    set Cells           = 1, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
  end
  subsection rod
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 1, 0, 0
    set Box to          = 3, 0.2, 0.2
    set Cells           = 2, 1, 1
    set Young's modulus = 1e9
    set Density         = 1000
  end
end
subsection Joints
  set Names = motor, pin
  subsection motor
    set Type    = revolute
    set Between = arm: x min, ground
    set Axis    = 0, 0, 1
    set Angle   = 0.1*(1-cos(t))
  end
  subsection pin
    set Type    = universal
    set Between = rod: x min, arm: x max
    set Axis    = 0, 0, 1
    set Cross axis = 0, 1, 0
  end
end
subsection Force elements
  set Names = cable
  subsection cable
    set Between      = rod: x max, ground
    set Stiffness    = 1e3
    set Ground point = 3, 0.1, 2
  end
end
subsection Masses
  set Names = load
  subsection load
    set On   = rod: x max
    set Mass = 10
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
  set Names = wind
  subsection wind
    set Type  = traction
    set On    = rod: z max
    set Value = 0; 0; 100*sin(t)
  end
end
subsection Time integration
  set End time  = 0.02
  set Step size = 0.01
end
END
expect_status 0 --quiet good.prm

# --- joints ---

expect_error 's/rod: x min, arm: x max/rod: x min, arm: x min/' 32 Joints/pin Between \
  'surfaces whose mean positions are 1 m apart (1, 0, 0)' \
  'surfaces that coincide in the blocked directions' 'Offset' 'keep'
sed 's/rod: x min, arm: x max/rod: x min, arm: x min\n    set Offset = keep/' good.prm >offset.prm
expect_status 0 --validate --quiet offset.prm
expect_error '/Cross axis/d' 30 Joints/pin 'Cross axis' nothing 'the second axis'
expect_error 's/Cross axis = 0, 1, 0/Cross axis = 0, 1, 1/' 34 Joints/pin 'Cross axis' \
  'a vector that is not across the axis' 'a vector perpendicular'
expect_error '/Cross axis/a set Free = rotation x' 35 Joints/pin Free "'rotation x'" 'motions that the type'
expect_error 's/Type    = revolute/Type    = fixed/; /set Angle/d' 27 Joints/motor Axis 'a' "nothing for the type 'fixed'"

# --- drives ---

expect_error 's/(1-cos(t))/cos(t)/' 28 Joints/motor Angle 'an angle that starts at 0.1 rad, which is a jump' \
  'an angle that starts at zero'
expect_error 's/(1-cos(t))/sin(t)/' 26 Joints/motor Between \
  'velocities at the start that the joint does not allow: a jump of 0.1' 'a Velocity'
expect_error 's/(1-cos(t))/*cosine(t)/' 28 Joints/motor Angle "'0.1**cosine(t)' (Unexpected operator" 'an expression of the time t'
expect_error 's/set Angle .*/set Angle = 0*t\n    set Angular velocity = 1/' 29 Joints/motor 'Angular velocity' \
  "'1' beside an Angle" 'one of the two'
expect_error 's/set Angle .*/set Angular velocity = sin(t)/; s/= 0.02/= 1e6/; s/= 0.01$/= 1/' 28 Joints/motor 'Angular velocity' \
  'a function that would be integrated over 1e+06 s' 'an Angle in simulations'
expect_error 's/set Angle .*/set Displacement = t/' 28 Joints/motor Displacement '' 'nothing for the type'

# --- force elements, masses, loads ---

expect_error '/Ground point/d' 39 'Force elements/cable' 'Ground point' nothing 'a point if, and only if'
expect_error 's/3, 0.1, 2/3, 0.1, 0.1/' 40 'Force elements/cable' Between 'a spring-damper without length' \
  'mean positions at a distance'
expect_error '/Stiffness/d' 39 'Force elements/cable' Stiffness nothing 'a Stiffness, a Damping or an Actuation'
expect_error 's/Stiffness    = 1e3/Stiffness = 1, 2/' 41 'Force elements/cable' Stiffness '2 numbers' '1 number for'
expect_error 's/Mass = 10/Inertia = 1, 1, 3, 0, 0, 0/' 49 Masses/load Inertia 'a tensor that no rigid body has' \
  'one whose principal values'
expect_error 's/Mass = 10/Mass = -1/' 49 Masses/load Mass "'-1'" 'a number >= 0'
expect_error 's/; 100\*sin(t)//' 58 Loads/wind Value "'0; 0'" 'three expressions of the time t'
expect_error 's/traction/pressure/' 58 Loads/wind Value "'0; 0; 100*sin(t)'" 'an expression of the time t'
expect_error 's/Type  = traction/Type  = weight/' 56 Loads/wind Type "'weight'" 'one of force, torque, traction, pressure'

# --- start and modes ---

expect_error '/subsection Time/i subsection Start\n  set Load steps = 4\nend' 62 Start 'Load steps' 4 "1 without 'Equilibrium = true'"
expect_error '/subsection Time/i subsection Modes\n  set Number = 400\nend' 62 Modes Number 400 'at most 97, as the bodies have 206'
expect_error '/Density/a set Velocity = 0, 0, 1' '' Joints/motor Between \
  'velocities at the start that the joint does not allow' 'a Velocity'
sed '/Density/a set Velocity = 0, 0, 1' good.prm | sed '/subsection Time/i subsection Start\n  set Projection = velocities\nend' >projected.prm
expect_status 0 --quiet projected.prm

# --- repeated and contradictory joints ---

# The same surfaces joined twice: a message that names the joints, and half of
# the force in each.
sed 's/motor, pin/motor, pin, again/
     /subsection pin/i \  subsection again\n    set Type = universal\n    set Between = rod: x min, arm: x max\n    set Axis = 0, 0, 1\n    set Cross axis = 0, 1, 0\n  end
     $a subsection Probes\n  set Names = one, two\n  subsection one\n    set Type = reaction\n    set Of = pin\n  end\n  subsection two\n    set Type = reaction\n    set Of = again\n  end\nend' good.prm >repeated.prm
expect_status 0 repeated.prm
expect_text stdout 'repeated joints' "'pin', 'again'"
check 'repeated joints share the load' awk -F, '
  NR == 1 { for (k = 2; k <= NF; ++k) { name = $k; sub(/^[a-z]*/, "", name)
                                         if ($k ~ /^one/) one[name] = k; else two[name] = k } }
  NR > 1  { for (name in one)
              { a = $one[name]; b = $two[name]
                if ((a - b)^2 > 1e-12) wrong = 1
                if (a^2 > 100) ++n } }
  END     { exit wrong || n < 3 }' repeated-results/probes.csv

# Two drives of the same motion.
sed 's/motor, pin/motor, pin, other/
     /subsection pin/i \  subsection other\n    set Type = revolute\n    set Between = arm: x min, ground\n    set Axis = 0, 0, 1\n    set Angle = 0.2*(1-cos(t))\n  end' good.prm >wrong.prm
run wrong.prm
check "contradictory drives: exit status $status" [ "$status" -ne 0 ]
expect_one_line 'contradictory drives'
expect_text stderr 'contradictory drives' "'motor'" "'other'" contradict

finish
