// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/log.hpp>

#include <memory>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace facula {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> made = [] {
    auto result = spdlog::stderr_logger_st("facula");
    result->set_pattern("%n: %l: %v");
    result->set_level(spdlog::level::warn);
    return result;
  }();
  return *made;
}

}  // namespace

void set_log_verbose(bool verbose) {
  logger().set_level(verbose ? spdlog::level::info : spdlog::level::warn);
}

void log_step(const std::string& sentence) {
  logger().info("{}", sentence);
}
void log_warning(const std::string& sentence) {
  logger().warn("{}", sentence);
}

}  // namespace facula
