// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_input_problems_h
#define acf_base_input_problems_h

#include <acf/base/exceptions.h>

#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /** Several errors of the input at once; what() has one per line. */
  class InputErrors : public InputError
  {
  public:
    /** @param errors at least one */
    explicit InputErrors(const std::vector<InputError> &errors);

    /** One by one. */
    const std::vector<InputError> &
    errors() const
    {
      return all;
    }

  private:
    std::vector<InputError> all;
  };



  /**
   * Collects errors of the input, so that a user learns of all of them at once:
   * @code
   *   InputProblems problems;
   *   problems.attempt([&]() { mesh.check(); });
   *   problems.attempt([&]() { material.check(); });
   *   problems.throw_all();
   * @endcode
   *
   * It also knows which entries are not what the user meant, so that errors
   * that only follow from others can be left out.
   */
  class InputProblems
  {
  public:
    /**
     * Adds an error, or each one of an InputErrors.
     * @param place where it is in the list: that of the line it is about
     */
    void
    add(const InputError &error, const std::size_t place = 0);

    /** Calls a function and adds what it throws of InputError. */
    template <typename Check>
    void
    attempt(const Check &check);

    bool
    empty() const
    {
      return problems.empty();
    }

    /** In the order of their places, then in that of add(). */
    std::vector<InputError>
    errors() const;

    /** What stands in an entry, or in a whole section, cannot be relied on. */
    void
    doubt(const std::string &section, const std::string &entry = "");

    /** Whether doubt() was called for the entry or a section around it. */
    bool
    is_doubtful(const std::string &section,
                const std::string &entry = "") const;

    /**
     * @throws InputErrors, or the InputError if there is only one; nothing if
     * there are none. Of very many errors only the first ones, and how many
     * there are.
     */
    void
    throw_all() const;

    /** For errors without a line that are to be the last ones. */
    static constexpr std::size_t last_place =
      std::numeric_limits<std::size_t>::max();

  private:
    std::multimap<std::size_t, InputError> problems;

    /** Those that were too many to be kept. */
    std::size_t n_dropped = 0;

    /** Sections and entries; an empty entry means the whole section. */
    std::set<std::pair<std::string, std::string>> doubtful;
  };



  template <typename Check>
  void
  InputProblems::attempt(const Check &check)
  {
    try
      {
        check();
      }
    catch (const InputError &error)
      {
        add(error);
      }
  }
} // namespace ACF

#endif
