// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/demo.hpp>
namespace facula {
Command demo_command() {
  return {.name = "demo",
          .summary = "s",
          .description = "d",
          .examples = {"facula demo --quick"},
          .declare = [](Arguments&) {},
          .run = [](Session&) { fail("soon"); }};
}
}  // namespace facula
