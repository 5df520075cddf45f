// What the sidecar of Agones says of the server that it stands beside: the JSON of GET /gameserver and of
// each line of GET /watch/gameserver.
//
// Source: the interface's published description (sdk.swagger.json of Agones): object_meta, spec, status.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

struct GameServerFacts {
  /// Longest text that is read.
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 10;

  std::string name;        ///< of the resource
  std::string state;       ///< "Ready", "Allocated", "Shutdown" …
  std::string address;     ///< by which players reach it
  std::uint16_t port = 0;  ///< the first of its ports; 0: none is known
  int health_seconds = 0;  ///< within which it wants to hear that the server is well; 0: not said

  /// Nothing for what is no such text. Fields that are missing or of another kind are left empty; those that
  /// are not known are left out. `is_line`: of a watch, the facts are its "result".
  static std::optional<GameServerFacts> parse(std::string_view text, bool is_line);
};

}  // namespace naiad
