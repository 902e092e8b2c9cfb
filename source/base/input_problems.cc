// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_problems.h>

namespace ACF
{
  namespace
  {
    // More than anybody reads at once.
    constexpr std::size_t max_shown = 50;

    // A file that is no model may have millions.
    constexpr std::size_t max_kept = 10000;



    std::string
    join_lines(const std::vector<InputError> &errors)
    {
      std::string text;
      for (const InputError &error : errors)
        text += (text.empty() ? "" : "\n") + std::string(error.what());
      return text;
    }
  } // namespace



  InputErrors::InputErrors(const std::vector<InputError> &errors)
    : InputError(join_lines(errors))
    , all(errors)
  {}



  void
  InputProblems::add(const InputError &error, const std::size_t place)
  {
    if (const auto *const several = dynamic_cast<const InputErrors *>(&error))
      for (const InputError &one : several->errors())
        add(one, place);
    else if (problems.size() < max_kept)
      problems.emplace(place, error);
    else
      ++n_dropped;
  }



  std::vector<InputError>
  InputProblems::errors() const
  {
    std::vector<InputError> result;
    for (const auto &problem : problems)
      result.push_back(problem.second);
    return result;
  }



  void
  InputProblems::doubt(const std::string &section, const std::string &entry)
  {
    doubtful.emplace(section, entry);
  }



  bool
  InputProblems::is_doubtful(const std::string &section,
                             const std::string &entry) const
  {
    if (doubtful.count({section, entry}) > 0)
      return true;
    // the section and those around it
    std::string path = section;
    while (doubtful.count({path, ""}) == 0)
      {
        const std::size_t slash = path.rfind('/');
        if (slash == std::string::npos)
          return false;
        path.resize(slash);
      }
    return true;
  }



  void
  InputProblems::throw_all() const
  {
    std::vector<InputError> list = errors();
    if (list.empty())
      return;
    if (list.size() == 1)
      throw list[0];
    if (list.size() > max_shown)
      {
        const std::size_t n_more = list.size() - max_shown + n_dropped;
        list.erase(list.begin() + max_shown, list.end());
        list.emplace_back("and " + std::to_string(n_more) +
                          (n_more == 1 ? " more problem" : " more problems"));
      }
    throw InputErrors(list);
  }
} // namespace ACF
