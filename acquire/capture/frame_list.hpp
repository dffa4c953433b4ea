// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// Files that match `pattern`, a path below `folder` whose last part may hold `*` and `?`, in the
/// order people count (image2 before image10). When the pattern's folders are not below `folder`,
/// its last part alone is looked for there. Throws Error when nothing matches.
std::vector<std::filesystem::path> list_frames(const std::filesystem::path& folder,
                                               const std::string& pattern);

/// Whether a file is to be read as a video, by its extension (.avi .mp4 .mkv .mov .m4v .webm).
bool is_video(const std::filesystem::path& file);

}  // namespace facula
