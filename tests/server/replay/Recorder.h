// Records rounds as dfserver does, but without a network: a world in a process of its own, with a journal and
// players that press random keys.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "host/rounds/Round.h"
#include "tests/support/TempFolder.h"

namespace naiad {

/// Serves the round for at most a minute, until `done` or its end.
template <class Done>
void serveRound(asio::io_context& home, Round& world, Done done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done() && !world.end() && std::chrono::steady_clock::now() < end) {
    home.restart();
    home.run_one_for(std::chrono::milliseconds(10));
    world.checkProcess(1);
  }
}

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
