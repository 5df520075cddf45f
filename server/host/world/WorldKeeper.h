// The launcher's and the keepers' side of a WorldLauncher: what their processes do.
#pragma once

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

  /// Of those that are there: they come first.
  std::size_t bytes() const { return sizeof *this - (copies < 0 ? sizeof copies : 0); }
  void closeAll() const;
};

/// In a forked process: what it is from now on. `front`: says when worlds are wanted, and ends it when it
/// closes.
[[noreturn]] void runLauncher(int front, const WorldProgram& program);

}  // namespace naiad
