// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_file.h>
#include <acf/base/parameter_patterns.h>
#include <acf/mechanics/abaqus_file.h>

#include <deal.II/base/utilities.h>

#include <cctype>
#include <sstream>
#include <utility>

#include "abaqus_lines.h"
#include "abaqus_sets.h"

// The format: "Input Syntax Rules" and the keywords of the Abaqus manual.

namespace ACF
{
  namespace
  {
    using namespace Abaqus;

    // Numbers of nodes and elements have at most nine digits.
    constexpr std::size_t largest_number = 999999999;

    const std::set<std::string> keywords_that_change_meshes = {"ELCOPY",
                                                               "ELGEN",
                                                               "IMPORT",
                                                               "INCLUDE",
                                                               "NCOPY",
                                                               "NFILL",
                                                               "NGEN",
                                                               "NMAP",
                                                               "PARAMETER",
                                                               "SYSTEM",
                                                               "TRANSFORM"};



    const std::set<std::string> keywords_with_data =
      {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "PART", "INSTANCE"};



    class Reader
    {
    public:
      explicit Reader(const MeshSource &source)
        : source(source)
      {}

      GmshMesh
      read(const std::string &text);

    private:
      [[noreturn]] void
      fail(const std::string &found, const std::string &allowed) const
      {
        throw source.error("line " + std::to_string(n_line) + ": " + found,
                           allowed);
      }

      // Stops if the bytes are no characters.
      void
      check_text(const std::string &text) const
      {
        if (find_non_text(text) != std::string::npos)
          fail("a byte that is not text in UTF-8", "a text file in UTF-8");
      }

      void
      read_keyword(const std::string &line);
      void
      open_instance();
      void
      open_set(const std::string &kind, std::map<std::string, Set> &sets);
      void
      open_surface();
      void
      open_elements();
      void
      read_data(const std::vector<std::string> &fields);
      void
      read_node(const std::vector<std::string> &fields);
      void
      read_element(const std::vector<std::string> &fields);
      void
      finish_element();
      void
      read_members(const std::vector<std::string> &fields);
      void
      read_surface(const std::vector<std::string> &fields);

      template <typename Number>
      Number
      number(const std::string &field, const std::string &what) const;

      std::size_t
      label(const std::string &field, const std::string &what) const;

      // The name of a set, without that of the instance before it.
      std::string
      local(const std::string &field) const;

      // Of the present keyword; an error if it is required and missing.
      std::string
      parameter(const std::string &name, const bool is_required) const;

      Set &
      set_of(std::map<std::string, Set> &sets, const std::string &name);

      void
      take_notes();

      const MeshSource &source;
      unsigned int n_line = 0;

      Keyword keyword;

      bool has_part = false, has_instance = false;
      std::string instance;

      // What data lines add to.
      Set *current_set                 = nullptr;
      std::map<std::string, Set> *kind = nullptr;
      Surface *current_surface         = nullptr;
      const SolidType *current_type    = nullptr;
      std::vector<std::size_t> pending; // numbers of an incomplete element

      Contents contents;
      std::set<std::string> ignored_keywords;
      std::set<std::string> ignored_elements;
    };



    GmshMesh
    Reader::read(const std::string &text)
    {
      std::istringstream lines(text);
      std::string line, continued;
      while (std::getline(lines, line))
        {
          ++n_line;
          if (line.find('\0') != std::string::npos)
            fail("a byte 0", "a text file");
          line = Utilities::trim(line);
          if (!line.empty() && line.back() == '\r')
            line = Utilities::trim(line.substr(0, line.size() - 1));
          if (line.empty() || line.compare(0, 2, "**") == 0)
            continue;
          // keyword lines go on after a comma
          if (!continued.empty())
            line = std::exchange(continued, "") + line;
          if (line[0] == '*')
            {
              if (line.back() == ',' && line.size() < 100000)
                continued = line;
              else
                read_keyword(line);
            }
          else
            {
              if (keyword.name.empty() ||
                  keywords_with_data.count(keyword.name) > 0)
                check_text(line);
              read_data(split_line(line));
            }
        }
      if (!continued.empty())
        read_keyword(continued.substr(0, continued.size() - 1));
      finish_element();
      if (contents.nodes.empty())
        fail("the end of a file without nodes",
             "a file with the keywords *NODE and *ELEMENT");
      take_notes();
      return make_mesh(contents, source);
    }



    void
    Reader::read_keyword(const std::string &line)
    {
      finish_element();
      keyword = Keyword(line);
      // what is left out may have any bytes, but for its name
      check_text(keywords_with_data.count(keyword.name) > 0 ? line
                                                            : keyword.name);
      if (!keyword.repeated.empty())
        fail("a second parameter " + in_quotes(keyword.repeated),
             "each parameter of a keyword once");
      current_set     = nullptr;
      current_surface = nullptr;
      current_type    = nullptr;

      if (keywords_that_change_meshes.count(keyword.name) > 0)
        fail("the keyword *" + keyword.name,
             "files in which all nodes and elements are written out, in one "
             "system of coordinates");
      if (keyword.has("INPUT") &&
          (keyword.name == "NODE" || keyword.name == "ELEMENT" ||
           keyword.name == "NSET" || keyword.name == "ELSET"))
        fail("the parameter INPUT of *" + keyword.name,
             "files that contain all of their data");
      if (keyword.name == "NODE")
        {
          const std::string system = upper(parameter("SYSTEM", false));
          if (!system.empty() && system != "R")
            fail("the parameter SYSTEM = " + in_quotes(system),
                 "rectangular coordinates, SYSTEM = R");
          const std::string name = parameter("NSET", false);
          if (!name.empty())
            current_set = &set_of(contents.node_sets, name);
        }
      else if (keyword.name == "ELEMENT")
        open_elements();
      else if (keyword.name == "NSET")
        open_set("NSET", contents.node_sets);
      else if (keyword.name == "ELSET")
        open_set("ELSET", contents.element_sets);
      else if (keyword.name == "SURFACE")
        open_surface();
      else if (keyword.name == "PART")
        {
          if (std::exchange(has_part, true))
            fail("a second *PART", "files with one part");
        }
      else if (keyword.name == "INSTANCE")
        open_instance();
      else if (keyword.name != "HEADING" && keyword.name != "END PART" &&
               keyword.name != "ASSEMBLY" && keyword.name != "END ASSEMBLY" &&
               keyword.name != "END INSTANCE")
        {
          if (keyword.name.empty())
            fail("a line without a keyword after '*'", "*NODE, *ELEMENT, ...");
          ignored_keywords.insert("*" + shorten(keyword.name));
        }
    }



    void
    Reader::open_instance()
    {
      if (std::exchange(has_instance, true))
        fail("a second *INSTANCE", "files with one instance of one part");
      if (keyword.has("LIBRARY"))
        fail("the parameter LIBRARY of *INSTANCE",
             "files that contain all of their data");
      instance = upper(parameter("NAME", true)) + ".";
    }



    void
    Reader::open_set(const std::string &name, std::map<std::string, Set> &sets)
    {
      const std::string other = (name == "NSET" ? "ELSET" : "NSET");
      if (keyword.has(other))
        fail("the parameter " + other + " of *" + name,
             "sets of numbers and of other sets of the same kind");
      const std::string of = upper(parameter("INSTANCE", false));
      if (!of.empty() && of + "." != instance)
        fail("the instance " + in_quotes(of), "the instance of the file");
      current_set = &set_of(sets, parameter(name, true));
      kind        = &sets;
      current_set->is_internal |= (keyword.has("INTERNAL"));
    }



    void
    Reader::open_surface()
    {
      const std::string type = upper(parameter("TYPE", false));
      if (!type.empty() && type != "ELEMENT" && type != "NODE")
        {
          ignored_keywords.insert("*SURFACE, TYPE=" + shorten(type));
          return;
        }
      for (const std::string name : {"COMBINE", "CROP", "REGION TYPE"})
        if (keyword.has(name))
          fail("the parameter " + name + " of *SURFACE",
               "surfaces of faces or of nodes");
      const std::string name = parameter("NAME", true);
      const auto [entry, is_new] =
        contents.surfaces.try_emplace(upper(name), Surface());
      if (!is_new)
        fail("a second surface " + in_quotes(name), "each surface once");
      current_surface           = &entry->second;
      current_surface->name     = name;
      current_surface->of_nodes = (type == "NODE");
    }



    void
    Reader::open_elements()
    {
      const std::string name = upper(parameter("TYPE", true));
      current_type           = find_type(name);
      if (current_type == nullptr)
        {
          if (name != "T3D2" && name != "T3D3")
            fail("elements of the type " + in_quotes(name),
                 "solid elements C3D4, C3D10, C3D8 and C3D20 with their "
                 "variants, surface elements CPS3, CPS4, CPS6, CPS8 and SFM3D, "
                 "and T3D2 and T3D3, which are left out");
          ignored_elements.insert(name);
        }
      const std::string set = parameter("ELSET", false);
      if (!set.empty() && current_type != nullptr)
        current_set = &set_of(contents.element_sets, set);
    }



    void
    Reader::read_data(const std::vector<std::string> &fields)
    {
      if (keyword.name == "NODE")
        read_node(fields);
      else if (keyword.name == "ELEMENT" && current_type != nullptr)
        read_element(fields);
      else if (keyword.name == "ELEMENT")
        contents.left_out_elements.insert(
          label(fields[0], "the number of an element"));
      else if (keyword.name == "NSET" || keyword.name == "ELSET")
        read_members(fields);
      else if (current_surface != nullptr)
        read_surface(fields);
      else if (keyword.name == "INSTANCE")
        fail("data of *INSTANCE, which move the part",
             "instances without translation and rotation");
      else if (keyword.name.empty())
        fail(in_quotes(fields[0]) + " before the first keyword",
             "an input file of Abaqus, which begins with a keyword *...");
    }



    void
    Reader::read_node(const std::vector<std::string> &fields)
    {
      if (fields.size() < 4)
        fail(std::to_string(fields.size()) + " fields of a node",
             "a number and three coordinates");
      const std::size_t node = label(fields[0], "the number of a node");
      Point<dim> position;
      for (unsigned int d = 0; d < dim; ++d)
        position[d] = number<double>(fields[d + 1], "a coordinate of a node");
      if (!contents.nodes.try_emplace(node, position).second)
        fail("the node " + std::to_string(node) + " a second time",
             "each node once");
      if (current_set != nullptr)
        current_set->members.try_emplace({{node, node, 1}}, n_line);
    }



    void
    Reader::read_element(const std::vector<std::string> &fields)
    {
      for (std::size_t i = 0; i < fields.size(); ++i)
        {
          if (fields[i].empty() && i + 1 == fields.size())
            break; // the numbers go on in the next line
          pending.push_back(label(fields[i],
                                  pending.empty() ? "the number of an element"
                                                  : "a node of an element"));
          if (pending.size() > 1 + current_type->order.size())
            fail(std::to_string(i + 1) + " fields of an element of the type " +
                   current_type->name,
                 "a number and " + std::to_string(current_type->order.size()) +
                   " nodes");
        }
      if (pending.size() == 1 + current_type->order.size())
        finish_element();
    }



    void
    Reader::finish_element()
    {
      if (pending.empty())
        return;
      const std::vector<std::size_t> numbers = std::exchange(pending, {});
      const auto &order                      = current_type->order;
      if (numbers.size() != 1 + order.size())
        fail("the element " + std::to_string(numbers[0]) + " with " +
               std::to_string(numbers.size() - 1) + " nodes",
             std::to_string(order.size()) + " nodes of " + current_type->name);
      Element element;
      element.type = current_type;
      element.line = n_line;
      for (const unsigned int n : order)
        element.nodes.push_back(numbers[1 + n]);
      if (!contents.elements.try_emplace(numbers[0], element).second)
        fail("the element " + std::to_string(numbers[0]) + " a second time",
             "each element once");
      if (current_set != nullptr)
        current_set->members.try_emplace({{numbers[0], numbers[0], 1}}, n_line);
    }



    void
    Reader::read_members(const std::vector<std::string> &fields)
    {
      const std::string what =
        (keyword.name == "NSET" ? "a node" : "an element");
      if (keyword.has("GENERATE"))
        {
          std::vector<std::size_t> range;
          for (const std::string &field : fields)
            if (!field.empty())
              range.push_back(label(field, what + " of a range"));
          if (range.size() == 2)
            range.push_back(1);
          if (range.size() != 3 || range[0] > range[1] ||
              (range[1] - range[0]) % range[2] != 0)
            fail("a range of " + std::to_string(range.size()) + " numbers",
                 "the first number, the last one, not smaller, and a step "
                 "that divides their difference");
          current_set->members.try_emplace({{range[0], range[1], range[2]}},
                                           n_line);
          return;
        }
      for (const std::string &field : fields)
        {
          if (field.empty())
            continue;
          const std::string name = local(field);
          if (std::isdigit(static_cast<unsigned char>(name[0])) != 0)
            {
              const std::size_t member = label(name, "the number of " + what);
              current_set->members.try_emplace({{member, member, 1}}, n_line);
              continue;
            }
          const auto other = kind->find(upper(name));
          if (other == kind->end())
            fail("the set " + in_quotes(name) + ", which does not exist before",
                 "numbers, and sets that the file defines before");
          if (&other->second != current_set)
            current_set->members.insert(other->second.members.begin(),
                                        other->second.members.end());
        }
    }



    void
    Reader::read_surface(const std::vector<std::string> &fields)
    {
      const std::string name = local(fields[0]);
      const bool is_number =
        !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) != 0;
      Surface::Part part;
      part.line = n_line;
      if (is_number)
        {
          const std::size_t member            = label(name, "a number");
          part.members[{{member, member, 1}}] = n_line;
        }
      else
        {
          const auto &sets = current_surface->of_nodes ? contents.node_sets
                                                       : contents.element_sets;
          const auto set   = sets.find(upper(name));
          if (set == sets.end())
            fail("the set " + in_quotes(name) + ", which does not exist before",
                 std::string("numbers or sets of ") +
                   (current_surface->of_nodes ? "nodes" : "elements"));
          part.members = set->second.members;
        }
      if (!current_surface->of_nodes && fields.size() > 1 && !fields[1].empty())
        {
          const std::string face = upper(fields[1]);
          if (face.size() != 2 || face[0] != 'S' || face[1] < '1' ||
              face[1] > '6')
            fail("the face " + in_quotes(fields[1]), "S1, S2, ... S6");
          part.face = face[1] - '0';
        }
      current_surface->parts.push_back(part);
    }



    template <typename Number>
    Number
    Reader::number(const std::string &field, const std::string &what) const
    {
      const std::optional<Number> result = parse_number<Number>(field);
      if (!result)
        fail(in_quotes(field) + " instead of " + what, "a number");
      return *result;
    }



    std::size_t
    Reader::label(const std::string &field, const std::string &what) const
    {
      const auto result = number<std::size_t>(local(field), what);
      if (result < 1 || result > largest_number)
        fail(in_quotes(field) + " instead of " + what,
             "1 to " + std::to_string(largest_number));
      return result;
    }



    std::string
    Reader::local(const std::string &field) const
    {
      std::string name = without_quotes(field);
      if (!instance.empty() &&
          upper(name.substr(0, instance.size())) == instance)
        name = name.substr(instance.size());
      return name;
    }



    std::string
    Reader::parameter(const std::string &name, const bool is_required) const
    {
      const auto found = keyword.parameters.find(name);
      if (found != keyword.parameters.end() && !found->second.empty())
        return found->second;
      if (is_required || found != keyword.parameters.end())
        fail("*" + keyword.name + " without a value of the parameter " + name,
             "*" + keyword.name + ", " + name + "=...");
      return "";
    }



    Set &
    Reader::set_of(std::map<std::string, Set> &sets, const std::string &name)
    {
      Set &set = sets[upper(name)];
      if (set.name.empty())
        set.name = name;
      return set;
    }



    void
    Reader::take_notes()
    {
      const auto note = [&](const std::set<std::string> &words,
                            const std::string &what) {
        if (words.empty())
          return;
        constexpr std::size_t enough = 20;
        std::vector<std::string> list(words.begin(), words.end());
        if (list.size() > enough)
          {
            const std::size_t n_more = list.size() - enough;
            list.resize(enough);
            list.push_back(std::to_string(n_more) + " more");
          }
        contents.notes.push_back(what + list_words(list, ""));
      };
      note(ignored_keywords, "keywords of the file that are not read: ");
      note(ignored_elements, "elements of the file that are left out: ");
    }
  } // namespace



  GmshMesh
  read_abaqus_file(std::istream &stream, const MeshSource &source)
  {
    std::ostringstream text;
    text << stream.rdbuf();
    return Reader(source).read(text.str());
  }
} // namespace ACF
