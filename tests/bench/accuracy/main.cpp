// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures the heads of this project against what the sources publish, and writes docs/accuracy.md:
//   tests/bench/accuracy.sh [OUT.md]
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace facula {
namespace {

using StudyFunction = Study (*)(const StudyOptions&);

constexpr std::pair<const char*, StudyFunction> kStudies[] = {
    {"b", study_source_b},
    {"a", study_source_a},
    {"c", study_source_c},
    {"d", study_source_d},
    {"e", study_source_e},
    {"sigma", study_sigma},
    {"planes", study_planes},
};

constexpr const char* kHead =
    "# Accuracy\n\n"
    "What the sources publish, and what heads of the same optics reach with Facula. The heads are\n"
    "simulated: the images or stripe positions come from a forward model that shares nothing with\n"
    "the extraction but the projection (docs/simulated_head.md). This page is written by\n\n"
    "    tests/bench/accuracy.sh\n\n"
    "with seed 1; every number on it is measured there, and a figure that is missed says so.\n";

bool all_reached(const Study& study) {
  for (const Verdict& v : study.verdicts) {
    if (!v.reached) std::cerr << "missed: " << v.claim << ": " << v.measured << "\n";
  }
  return std::all_of(
      study.verdicts.begin(), study.verdicts.end(), [](const Verdict& v) { return v.reached; });
}

std::string run(const StudyOptions& options, const std::string& only, bool& reached) {
  std::string text = kHead;
  bool any = false;
  for (const auto& [name, study] : kStudies) {
    if (!only.empty() && only != name) continue;
    std::cerr << "study " << name << "\n";
    const Study done = study(options);
    reached = all_reached(done) && reached;
    text += "\n" + markdown(done);
    any = true;
  }
  require(any, "expected a study a, b, c, d, e, sigma or planes, got '", only, "'");
  return text;
}

}  // namespace
}  // namespace facula

/// accuracy DATA_FOLDER OUT.md [STUDY]: exit code 3 when a figure is missed.
int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 2 || arguments.size() > 3) {
    std::cerr << "usage: accuracy DATA_FOLDER OUT.md [a|b|c|d|e|sigma|planes]\n";
    return 2;
  }
  try {
    facula::StudyOptions options;
    options.data = arguments[0];
    options.small = std::getenv("FACULA_BENCH_SMALL") != nullptr;
    bool reached = true;
    const std::string text =
        facula::run(options, arguments.size() > 2 ? arguments[2] : "", reached);
    facula::AtomicFile file(arguments[1]);
    file.stream() << text;
    file.commit();
    return reached ? 0 : 3;
  } catch (const std::exception& error) {
    std::cerr << "accuracy: " << error.what() << "\n";
    return 1;
  }
}
