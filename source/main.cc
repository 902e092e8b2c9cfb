// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_problems.h>
#include <acf/base/interruption.h>
#include <acf/simulation.h>

#include <deal.II/base/exceptions.h>

#include <iostream>
#include <new>

namespace
{
  // The only place that reports exceptions; returns the exit status.
  int
  report_current_exception()
  {
    try
      {
        throw;
      }
    catch (const ACF::InputErrors &errors)
      {
        for (const ACF::InputError &error : errors.errors())
          std::cerr << "acf-dealii: " << error.what() << "\n";
        std::cerr << std::flush;
        return 2;
      }
    catch (const ACF::InputError &error)
      {
        std::cerr << "acf-dealii: " << error.what() << std::endl;
        return 2;
      }
    catch (const std::bad_alloc &)
      {
        std::cerr << "acf-dealii: not enough memory" << std::endl;
      }
    catch (const std::exception &error)
      {
        std::cerr << "acf-dealii: " << error.what() << std::endl;
      }
    catch (...)
      {
        std::cerr << "acf-dealii: an unknown error" << std::endl;
      }
    return 1;
  }
} // namespace



int
main(int argc, char **argv)
{
  ACF::ignore_signals_of_writes();
  try
    {
      ACF::run_command(ACF::parse_command_line({argv + 1, argv + argc}),
                       std::cout,
                       std::cerr);
      return 0;
    }
  catch (...)
    {
      return report_current_exception();
    }
}
