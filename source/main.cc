// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/huge_pages.h>
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
          ACF::print_error(std::cerr, error.what());
        return 2;
      }
    catch (const ACF::InputError &error)
      {
        ACF::print_error(std::cerr, error.what());
        return 2;
      }
    catch (const std::bad_alloc &)
      {
        ACF::print_error(std::cerr, "not enough memory");
      }
    catch (const std::exception &error)
      {
        ACF::print_error(std::cerr, error.what());
      }
    catch (...)
      {
        ACF::print_error(std::cerr, "an unknown error");
      }
    return 1;
  }
} // namespace



int
main(int argc, char **argv)
{
  ACF::ignore_signals_of_writes();
  ACF::keep_heap_in_huge_pages();
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
