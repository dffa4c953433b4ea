// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/machine_memory.hpp>

#include <algorithm>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

namespace facula {

double machine_memory() {
  double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  std::ifstream group("/sys/fs/cgroup/memory.max");  // "max", or a number
  double limit = 0;
  if (group >> limit && limit > 0) bytes = std::min(bytes, limit);
  rlimit own{};
  if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(own.rlim_cur));
  }
  return bytes;
}

}  // namespace facula
