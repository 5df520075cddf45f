// The launcher's and the keepers' side of a WorldLauncher: what their processes do.
#pragma once

#include <array>
#include <cstddef>

#include "host/world/WorldLauncher.h"

namespace naiad {

/// What the front sends for each world: the other ends, and where the world's output goes.
struct WorldDescriptors {
  int world = -1;
  int keeper = -1;
  int output = -1;
  int page = -1;
  int copies = -1;  ///< of a world that makes copies

  /// As they are sent: those that are there.
  static constexpr std::size_t kMost = 5;
  using List = std::array<int, kMost>;
  List list() const { return {world, keeper, output, page, copies}; }
  std::size_t count() const { return copies < 0 ? kMost - 1 : kMost; }
  void closeAll() const;
};

/// In a forked process: what it is from now on. `front`: says when worlds are wanted, and ends it when it
/// closes.
[[noreturn]] void runLauncher(int front, const WorldProgram& program);

}  // namespace naiad
