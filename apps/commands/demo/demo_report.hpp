// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/commands/demo/object_demo.hpp>
#include <facula/apps/commands/demo/room_demo.hpp>

namespace facula {

/// Pictures and tables of the whole demo: report.html in its folder, and pictures/.
void write_demo_report(const RoomDemo& room,
                       const ObjectDemo& object,
                       const DemoSettings& settings,
                       Session& session);

}  // namespace facula
