// Parses what the Agones sidecar reports about its server: the JSON of GET /gameserver and of each line of
// GET /watch/gameserver.
//
// Source: the interface's published description (sdk.swagger.json of Agones): object_meta, spec, status.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

struct GameServerInfo {
  /// Maximum length of the JSON text in bytes.
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 10;

  std::string name;        ///< name of the GameServer resource
  std::string state;       ///< "Ready", "Allocated", "Shutdown" and others
  std::string address;     ///< public address of the server
  std::uint16_t port = 0;  ///< first public port of the server; 0: unknown
  int health_seconds = 0;  ///< maximum time between health requests; 0: unknown

  /// Returns nullopt for invalid text. Fields that are missing or have invalid values stay empty; unknown
  /// ones are ignored. `is_line`: the text is a line of a watch, with the facts in its "result".
  static std::optional<GameServerInfo> parse(std::string_view text, bool is_line);
};

}  // namespace naiad
