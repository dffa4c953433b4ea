// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <stdlib.h>

namespace facula {
namespace {

bool is_packed(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" || extension == ".xz";
}

std::filesystem::path make_temporary_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "facula-XXXXXX").string();
  require(mkdtemp(name.data()) != nullptr,
          "cannot make a temporary folder '",
          name,
          "' to unpack a file into: ",
          std::strerror(errno));
  return name;
}

/// Boost takes a stream that stops before its last byte for a short one; both formats end in a
/// known way, so the end of the file tells.
void require_whole(const std::filesystem::path& packed) {
  if (lower_extension(packed) != ".xz") return;
  const std::string bytes = read_whole_file(packed);
  require(bytes.size() >= 32 && bytes.ends_with("YZ"),  // magic bytes of the .xz stream footer
          "'",
          packed.string(),
          "' is cut short: an .xz file ends in 'YZ'; copy or download it again");
}

void unpack(const std::filesystem::path& packed, const std::filesystem::path& plain) {
  require_whole(packed);
  std::ifstream in(packed, std::ios::binary);
  std::ofstream out(plain, std::ios::binary);
  require(in.is_open(), "cannot open '", packed.string(), "'");
  try {
    boost::iostreams::filtering_istream chain;
    if (lower_extension(packed) == ".gz") {
      chain.push(boost::iostreams::gzip_decompressor());
    } else {
      chain.push(boost::iostreams::lzma_decompressor());
    }
    chain.push(in);
    boost::iostreams::copy(chain, out);
  } catch (const std::exception& problem) {
    fail("cannot unpack '",
         packed.string(),
         "' (",
         problem.what(),
         "): it is cut short or not what its name says; copy or download it again");
  }
  require(
      out.good(), "cannot unpack '", packed.string(), "' to '", plain.string(), "': disk full?");
}

}  // namespace

UnpackedFile::UnpackedFile(const std::filesystem::path& path) : path_(path) {
  if (!is_packed(path)) return;
  require(std::filesystem::is_regular_file(path), "there is no file '", path.string(), "'");
  temporary_folder_ = make_temporary_folder();
  path_ = temporary_folder_ / path.stem();
  try {
    unpack(path, path_);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove_all(temporary_folder_, ignored);
    throw;
  }
}

UnpackedFile::~UnpackedFile() {
  if (temporary_folder_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(temporary_folder_, ignored);
}

std::filesystem::path without_packing(const std::filesystem::path& path) {
  return is_packed(path) ? path.parent_path() / path.stem() : path;
}

std::filesystem::path packed_or_plain(const std::filesystem::path& path) {
  for (const char* ending : {"", ".gz", ".xz"}) {
    std::filesystem::path candidate = path;
    candidate += ending;
    if (std::filesystem::is_regular_file(candidate)) return candidate;
  }
  return path;
}

}  // namespace facula
