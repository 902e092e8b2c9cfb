// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/parameter_patterns.h>

namespace ACF
{
  namespace
  {
    std::string
    compose(const std::string &section,
            const std::string &entry,
            const std::string &found,
            const std::string &allowed)
    {
      std::string message;
      if (!section.empty())
        message += "section " + in_quotes(section) + ", ";
      if (!entry.empty())
        message += "entry " + in_quotes(entry) + ": ";
      return message + "found " + shorten(found) +
             "; allowed: " + shorten(allowed);
    }
  } // namespace

  InputError::InputError(const std::string &section,
                         const std::string &entry,
                         const std::string &found,
                         const std::string &allowed)
    : std::runtime_error(compose(section, entry, found, allowed))
    , section(section)
    , entry(entry)
  {}

  InputError::InputError(const std::string &message)
    : std::runtime_error(message)
  {}

  InputError
  InputError::located(const std::string &file, const unsigned int line) const
  {
    InputError error(file + ":" + (line > 0 ? std::to_string(line) + ":" : "") +
                     " " + what());
    error.section = section;
    error.entry   = entry;
    return error;
  }
} // namespace ACF
