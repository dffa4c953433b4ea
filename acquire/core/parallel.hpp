// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace facula {

/// How work is shared out. Chunks have a fixed size, so results do not depend on num_threads.
struct ParallelOptions {
  int num_threads = 0;     ///< worker threads, 0 = all cores [1]
  std::size_t chunk = 64;  ///< items per piece of work [1]
};

/// Threads that `num_threads` asks for on this machine (0 = all cores).
int thread_count(int num_threads);

/// Calls body(begin, end) for every chunk of [0, count), in any order, possibly at once. Serial
/// when there is one chunk. The first exception a body throws is thrown again here.
void parallel_for(std::size_t count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body,
                  const ParallelOptions& options = {});

/// Combines map(begin, end) over all chunks from left to right, starting from `initial`: the same
/// result for every number of threads.
template <typename Value, typename Map, typename Combine>
Value parallel_reduce(std::size_t count,
                      Value initial,
                      const Map& map,
                      const Combine& combine,
                      const ParallelOptions& options = {}) {
  const std::size_t chunk = options.chunk == 0 ? 1 : options.chunk;
  std::vector<Value> parts((count + chunk - 1) / chunk, initial);
  parallel_for(
      count,
      [&](std::size_t begin, std::size_t end) { parts[begin / chunk] = map(begin, end); },
      options);
  for (const Value& part : parts) initial = combine(initial, part);
  return initial;
}

}  // namespace facula
