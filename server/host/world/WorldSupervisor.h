// The code of the launcher's and the supervisors' processes (WorldLauncher.h).
#pragma once

#include <array>
#include <cstddef>

#include "host/world/WorldLauncher.h"

namespace naiad {

/// The descriptors that the front sends for each world.
struct WorldDescriptors {
  int world = -1;
  int supervisor = -1;
  int output = -1;
  int page = -1;
  int copies = -1;  ///< only for a world that makes copies

  /// list() returns the descriptors in the order in which they are sent; only the first count() exist.
  static constexpr std::size_t kMaxCount = 5;
  using List = std::array<int, kMaxCount>;
  List list() const { return {world, supervisor, output, page, copies}; }
  std::size_t count() const { return copies < 0 ? kMaxCount - 1 : kMaxCount; }
  void closeAll() const;
};

/// Runs the launcher in a forked process, until the other end of `front`, the socket for requests, is closed.
[[noreturn]] void runLauncher(int front, const WorldProgram& program);

}  // namespace naiad
