// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <deal.II/base/exceptions.h>

#include <gtest/gtest.h>

#include <mpi.h>

int
main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  dealii::deal_II_exceptions::disable_abort_on_exception();
  const int status = RUN_ALL_TESTS();
  MPI_Finalize();
  return status;
}
