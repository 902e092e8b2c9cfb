// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/io/checkpoint.h>
#include <acf/io/result_directory.h>

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/utilities.h>

#include <zlib.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <system_error>

namespace ACF
{
  namespace
  {
    template <typename Values>
    void
    add_to_sum(const Values &values, unsigned long &sum)
    {
      sum = crc32_z(sum,
                    reinterpret_cast<const Bytef *>(values.data()),
                    values.size() * sizeof(*values.data()));
    }



    // Sum (CRC-32) of the nodes, cells and surfaces of all bodies.
    unsigned long
    sum_of_meshes(const MultibodySystem &system)
    {
      unsigned long sum = 0;
      std::set<const ReferenceBody *> seen;
      for (const Body &body : system.bodies())
        {
          if (!seen.insert(&body.reference()).second)
            continue;
          const BodyDiscretization &space = body.discretization();
          add_to_sum(space.reference_positions(), sum);
          std::vector<unsigned int> nodes(
            space.scalar_element().n_dofs_per_cell());
          for (const auto &cell : space.dof_handler().active_cell_iterators())
            {
              space.get_nodes(cell, nodes);
              add_to_sum(nodes, sum);
              std::vector<types::boundary_id> surfaces;
              for (const unsigned int f : cell->face_indices())
                surfaces.push_back(cell->face(f)->boundary_id());
              add_to_sum(surfaces, sum);
            }
        }
      return sum;
    }



    struct Entry
    {
      std::string section;
      std::string name;
      std::string value;
    };

    // Of a text of used_parameters(), in its order.
    std::vector<Entry>
    entries(const std::string &used_parameters)
    {
      std::vector<Entry> result;
      std::vector<std::string> sections{""};
      std::istringstream text(used_parameters);
      for (std::string line; std::getline(text, line);)
        {
          line                     = Utilities::trim(line);
          const std::size_t equals = line.find('=');
          if (line.rfind("subsection ", 0) == 0)
            sections.push_back(sections.back() +
                               (sections.back().empty() ? "" : "/") +
                               Utilities::trim(line.substr(11)));
          else if (line == "end" && sections.size() > 1)
            sections.pop_back();
          else if (line.rfind("set ", 0) == 0 && equals != std::string::npos)
            result.push_back({sections.back(),
                              Utilities::trim(line.substr(4, equals - 4)),
                              Utilities::trim(line.substr(equals + 1))});
        }
      return result;
    }



    bool
    may_change(const Entry &entry)
    {
      if (entry.section == "Output" || entry.section == "Validity" ||
          entry.section == "Modes")
        return true;
      if (entry.section == "Time integration")
        return entry.name != "Stages" && entry.name != "Stage matrices";
      // meshes are compared, and files may have moved
      return entry.name == "Title" ||
             (entry.name == "Mesh" && entry.section.rfind("Bodies/", 0) == 0);
    }



    void
    check_parameters(const std::string &saved,
                     const std::string &present,
                     const std::string &file)
    {
      const std::string allowed =
        " as in the checkpoint " + file +
        " (at a restart the sections Output, Validity, Modes and Time "
        "integration may change, the latter but for its stages)";
      std::vector<Entry> fixed;
      for (const Entry &entry : entries(saved))
        if (!may_change(entry))
          fixed.push_back(entry);
      std::size_t k = 0;
      for (const Entry &entry : entries(present))
        {
          if (may_change(entry))
            continue;
          const bool is_known = k < fixed.size() &&
                                fixed[k].section == entry.section &&
                                fixed[k].name == entry.name;
          if (!is_known)
            throw InputError(entry.section,
                             entry.name,
                             "it",
                             "the bodies, joints, loads and probes" + allowed);
          if (fixed[k].value != entry.value)
            throw InputError(entry.section,
                             entry.name,
                             "'" + entry.value + "'",
                             "'" + fixed[k].value + "'" + allowed);
          ++k;
        }
      if (k < fixed.size())
        throw InputError(fixed[k].section,
                         fixed[k].name,
                         "nothing",
                         "the bodies, joints, loads and probes" + allowed);
    }



    // What is saved in front of the simulation, to be checked.
    struct Header
    {
      std::string parameters;
      unsigned long meshes   = 0;
      double time            = 0;
      unsigned int n_threads = 0;

      void
      exchange(Archive &archive)
      {
        archive("used parameters", parameters);
        archive("sum of the meshes", meshes);
        archive("time", time);
        archive("threads", n_threads);
      }
    };



    void
    check_header(const Header &header,
                 const CheckpointedModel &model,
                 const std::string &file)
    {
      check_parameters(header.parameters, model.used_parameters, file);
      if (header.meshes != sum_of_meshes(model.system))
        throw InputError("Bodies",
                         "",
                         "other meshes than those of the checkpoint " + file,
                         "the meshes with which it was written");
      if (header.time > model.end_time * (1 + 1e-9))
        throw InputError("Time integration",
                         "End time",
                         format_number(model.end_time),
                         "at least the time of the checkpoint " + file + ", " +
                           format_number(header.time) + " s");
    }
  } // namespace



  void
  save_checkpoint(const std::filesystem::path &directory,
                  CheckpointedModel model,
                  TimeLoop &loop,
                  Statistics &statistics)
  {
    const PhaseTimer timer(statistics, "saving");
    ++statistics.checkpoints;
    Header header{model.used_parameters,
                  sum_of_meshes(model.system),
                  std::min(loop.state().time, model.end_time),
                  MultithreadInfo::n_threads()};
    const auto newest   = directory / checkpoint_file;
    const auto previous = directory / previous_checkpoint_file;
    const auto fresh    = directory / "checkpoint-new.h5";
    Archive::save(fresh, [&](Archive &archive) {
      archive("header", header);
      archive("simulation", loop);
      archive("statistics", statistics);
    });

    // There is a file of each name at any time, if links can be made.
    std::error_code error;
    if (std::filesystem::exists(newest))
      {
        const std::filesystem::path link = previous.string() + ".tmp";
        std::filesystem::remove(link, error);
        std::filesystem::create_hard_link(newest, link, error);
        std::filesystem::rename(error ? newest : link, previous, error);
        // which does nothing if both are the same file, as a program that was
        // killed at the next line has left them
        std::error_code ignored;
        std::filesystem::remove(link, ignored);
      }
    std::filesystem::rename(fresh, newest, error);
    if (error)
      throw SimulationError("The file '" + newest.string() +
                            "' cannot be written: " + error.message() + ".");
  }



  unsigned int
  load_checkpoint(const std::filesystem::path &file,
                  const CheckpointedModel &model,
                  const std::function<void()> &prepare,
                  TimeLoop &loop,
                  Statistics &statistics)
  {
    Header header;
    Archive::load(file, [&](Archive &archive) {
      archive("header", header);
      check_header(header, model, file.string());
      prepare();
      archive("simulation", loop);
      archive("statistics", statistics);
    });
    ++statistics.restarts;
    return header.n_threads;
  }
} // namespace ACF
