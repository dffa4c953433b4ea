// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/map_mpi/ranks.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>

#include <mpi.h>

namespace facula {
namespace {

// MPI ends all ranks by itself when one of its calls fails (MPI_ERRORS_ARE_FATAL), so none of them
// returns a code worth looking at.

std::vector<std::uint64_t> sizes_of(const std::vector<Bytes>& parts) {
  std::vector<std::uint64_t> sizes;
  sizes.reserve(parts.size());
  for (const Bytes& part : parts) sizes.push_back(part.size());
  return sizes;
}

/// What one pass moves: counts and places of the parts, one behind the other.
struct Layout {
  std::vector<int> counts;
  std::vector<int> places;
  std::size_t total = 0;

  /// Of parts of the given sizes the bytes from `begin` on, at most `most` of each.
  Layout(const std::vector<std::uint64_t>& sizes, std::size_t begin, std::size_t most) {
    for (const std::uint64_t size : sizes) {
      const std::size_t count = std::min<std::size_t>(size - std::min(size, begin), most);
      places.push_back(static_cast<int>(total));
      counts.push_back(static_cast<int>(count));
      total += count;
    }
  }
};

/// Moves the bytes from `begin` on, at most `most` for each rank.
void exchange_pass(const std::vector<Bytes>& parts,
                   std::vector<Bytes>& received,
                   std::size_t begin,
                   std::size_t most) {
  const Layout out(sizes_of(parts), begin, most);
  const Layout in(sizes_of(received), begin, most);
  Bytes sending(out.total);
  Bytes receiving(in.total);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::copy_n(parts[i].data() + std::min(begin, parts[i].size()),
                out.counts[i],
                sending.begin() + out.places[i]);
  }
  MPI_Alltoallv(sending.data(),
                out.counts.data(),
                out.places.data(),
                MPI_BYTE,
                receiving.data(),
                in.counts.data(),
                in.places.data(),
                MPI_BYTE,
                MPI_COMM_WORLD);
  for (std::size_t i = 0; i < received.size(); ++i) {
    std::copy_n(receiving.begin() + in.places[i],
                in.counts[i],
                received[i].data() + std::min(begin, received[i].size()));
  }
}

std::size_t ranks_on_this_machine() {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int count = 1;
  MPI_Comm_size(machine, &count);
  MPI_Comm_free(&machine);
  return static_cast<std::size_t>(count);
}

}  // namespace

Ranks::Ranks() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  int rank = 0;
  int size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  rank_ = static_cast<std::size_t>(rank);
  size_ = static_cast<std::size_t>(size);
  on_this_machine_ = ranks_on_this_machine();
}

Ranks::~Ranks() {
  MPI_Finalize();
}

void Ranks::together(const std::function<void()>& step) const {
  std::exception_ptr failure;
  try {
    step();
  } catch (...) {
    failure = std::current_exception();
  }
  int well = failure ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &well, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (well == 0) throw StepFailed(failure);
}

std::vector<Bytes> Ranks::exchange(const std::vector<Bytes>& parts,
                                   std::size_t most_at_once) const {
  const std::vector<std::uint64_t> sizes = sizes_of(parts);
  std::vector<std::uint64_t> coming(size_);
  MPI_Alltoall(sizes.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  std::vector<Bytes> received(size_);
  for (std::size_t i = 0; i < size_; ++i) received[i].resize(coming[i]);
  std::uint64_t longest = *std::max_element(sizes.begin(), sizes.end());
  MPI_Allreduce(MPI_IN_PLACE, &longest, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  const std::size_t most = std::max<std::size_t>(1, most_at_once / size_);
  for (std::size_t begin = 0; begin < longest; begin += most) {
    exchange_pass(parts, received, begin, most);
  }
  return received;
}

void Ranks::abort() {
  MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  std::abort();
}

}  // namespace facula
