// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <algorithm>
#include <fstream>

namespace facula {

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  require(std::filesystem::exists(status),
          "cannot read '",
          path.string(),
          "': there is no such file; check the path");
  require(std::filesystem::is_regular_file(status),
          "cannot read '",
          path.string(),
          "': it is not a file; name a file in it");
  std::ifstream stream(path, std::ios::binary);
  const auto size = std::filesystem::file_size(path, failure);
  require(
      stream.is_open() && !failure, "cannot read '", path.string(), "'; check that it may be read");
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  require(static_cast<std::size_t>(stream.gcount()) == size,
          "cannot read '",
          path.string(),
          "' to its end; check the disk and read again");
  return bytes;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

}  // namespace facula
