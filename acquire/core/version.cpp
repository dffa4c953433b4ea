// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/version.hpp>

namespace facula {

const char* version() {
  return FACULA_VERSION;
}

}  // namespace facula
