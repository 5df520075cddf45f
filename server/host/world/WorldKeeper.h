// The code of the launcher's and the keepers' processes (WorldLauncher.h).
#pragma once

#include <array>
#include <cstddef>

#include "host/world/WorldLauncher.h"

namespace naiad {

/// The descriptors that the front sends for each world.
struct WorldDescriptors {
  int world = -1;
  int keeper = -1;
  int output = -1;
  int page = -1;
  int copies = -1;  ///< only for a world that makes copies

  /// Returns them in the order in which they are sent; only the first count() exist.
  static constexpr std::size_t kMost = 5;
  using List = std::array<int, kMost>;
  List list() const { return {world, keeper, output, page, copies}; }
  std::size_t count() const { return copies < 0 ? kMost - 1 : kMost; }
  void closeAll() const;
};

/// Runs the launcher in a forked process. `front`: the socket of its orders; the process ends when it closes.
[[noreturn]] void runLauncher(int front, const WorldProgram& program);

}  // namespace naiad
