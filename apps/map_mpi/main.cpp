// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/cli/complain.hpp>
#include <facula/apps/cli/deliver.hpp>
#include <facula/apps/cli/help.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/occupancy_arguments.hpp>
#include <facula/apps/map_mpi/map_project.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace facula {
namespace {

constexpr const char* kProgram = "facula-map-mpi";

struct MapMpiArguments {
  MapProject project;
  OccupancyArguments occupancy;
  std::filesystem::path json;
  int threads = 0;
  bool help = false;
};

Command described() {
  Command program;
  program.description =
      "Makes the occupancy map that 'facula map --register never' makes, on many processes (MPI): "
      "scans are dealt out for casting, blocks of space belong to one process each, and none ever "
      "holds the whole map. Writes a folder with an OctoMap .ot file per block and the index "
      "map.blocks, which facula reads as a map.";
  program.examples = {"mpirun -n 4 facula-map-mpi poses.toml --resolution-mm 50 --out hall",
                      "facula info hall/map.blocks"};
  return program;
}

void declare(Arguments& arguments, MapMpiArguments& a) {
  arguments.inputs("SCANS",
                   a.project.scans,
                   "scans with poses, or projects of such (poses.toml, .conf, folder); each is "
                   "opened by one process, where it lies");
  arguments.required();
  arguments.output("--out", a.project.out, "a new folder, on a disk that all machines share");
  arguments.required();
  arguments.flag("--overwrite", a.project.overwrite, "replace the map that lies in that folder");
  declare_occupancy(arguments, a.occupancy);
  arguments.output("--json",
                   a.json,
                   "write all figures to this file; - is standard output, then nothing else is "
                   "written there");
  arguments.whole("--threads",
                  a.threads,
                  "threads of each process, 0 = the cores of a machine shared among its processes");
  arguments.flag("--help", a.help, "show this and stop");
}

int threads_of_rank(int asked, const Ranks& ranks) {
  const auto here = static_cast<int>(ranks.on_this_machine());
  return asked > 0 ? asked : std::max(1, thread_count(0) / here);
}

void run(const Arguments& arguments,
         MapMpiArguments& a,
         const std::vector<std::string>& words,
         const Ranks& ranks) {
  std::vector<RankFigures> figures;
  ranks.together([&] {
    parse_arguments(arguments, words);
    a.project.options = a.occupancy.with_box();
    a.project.options.num_threads = threads_of_rank(a.threads, ranks);
    if (!ranks.first()) return;  // what all would find wrong the first rank says
    a.project.options.check();
    if (!a.json.empty() && a.json != "-") check_output(a.json);
  });
  figures = map_project(a.project, ranks);
  ranks.together([&] {
    if (!ranks.first()) return;
    Figures report;
    report_ranks(figures, report);
    deliver(report, a.json);
  });
}

/// Says what went wrong on this rank; what all find wrong with the command line only the first
/// one says.
int complain_here(const std::exception_ptr& reason, const Ranks& ranks) {
  try {
    std::rethrow_exception(reason);
  } catch (const UsageError&) {
    return ranks.first() ? complain(kProgram, reason) : kWrongUsage;
  } catch (...) {
    const std::string rank = ranks.size() > 1 ? ", rank " + std::to_string(ranks.rank()) : "";
    return complain(kProgram + rank, reason);
  }
}

bool asks_for_help(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "--help" || word == "-h";
  });
}

/// Of the processes that mpirun starts the first one speaks; alone it does so too.
bool speaks() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  return rank == nullptr || std::string(rank) == "0";
}

int run_ranks(const std::vector<std::string>& words) {
  MapMpiArguments a;
  Arguments arguments;
  declare(arguments, a);
  if (asks_for_help(words)) {
    if (speaks()) print(program_help(described(), arguments, kProgram));
    return kOk;
  }
  const Ranks ranks;
  try {
    run(arguments, a, words, ranks);
    return kOk;
  } catch (const StepFailed& failure) {
    return failure.reason() ? complain_here(failure.reason(), ranks) : kFailed;
  } catch (...) {  // the others know nothing of it and would wait for ever
    complain_here(std::current_exception(), ranks);
    Ranks::abort();
  }
}

int run_program(const std::vector<std::string>& words) {
  try {
    return run_ranks(words);
  } catch (...) {
    return complain(kProgram, std::current_exception());
  }
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  return facula::run_program(std::vector<std::string>(argv + 1, argv + argc));
}
