// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/interruption.h>

namespace ACF
{
  namespace
  {
    constexpr std::array<int, 3> signals = {{SIGINT, SIGTERM, SIGHUP}};

    // Handlers of signals can reach nothing else.
    volatile std::sig_atomic_t received = 0;

    extern "C" void
    note_signal(const int number)
    {
      received = number;
      for (const int k : signals)
        std::signal(k, SIG_DFL);
    }
  } // namespace



  InterruptionGuard::InterruptionGuard()
  {
    received = 0;
    for (unsigned int k = 0; k < signals.size(); ++k)
      {
        struct sigaction action = {};
        action.sa_handler       = note_signal;
        action.sa_flags         = SA_RESTART;
        sigaction(signals[k], nullptr, &old_actions[k]);
        if (old_actions[k].sa_handler != SIG_IGN)
          sigaction(signals[k], &action, nullptr);
      }
  }



  InterruptionGuard::~InterruptionGuard()
  {
    for (unsigned int k = 0; k < signals.size(); ++k)
      sigaction(signals[k], &old_actions[k], nullptr);
  }



  std::string
  InterruptionGuard::signal() const
  {
    switch (received)
      {
        case 0:
          return "";
        case SIGINT:
          return "SIGINT";
        case SIGTERM:
          return "SIGTERM";
        default:
          return "SIGHUP";
      }
  }



  void
  ignore_signals_of_writes()
  {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
  }
} // namespace ACF
