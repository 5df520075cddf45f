// Records rounds as dfserver does, but without a network: a world in a process of its own, with a journal and
// players that press random keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/support/TempFolder.h"

namespace naiad {

struct Recording {
  std::string game;  ///< name, or path of a module
  std::uint64_t seed = 1;
  std::uint32_t ticks = 300;
  std::size_t players = 4;
};

/// Records rounds in a temporary folder, which the destructor removes.
class Recorder {
 public:
  const std::filesystem::path& folder() const { return m_folder.path(); }
  /// Records a round; returns its file.
  std::filesystem::path record(const Recording& what);

 private:
  test::TempFolder m_folder;
};

}  // namespace naiad
