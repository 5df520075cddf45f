// The caller of an admin command, and a player as commands report them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "shared/admin/AdminCommands.h"

namespace naiad {

/// The caller of a command.
struct AdminCaller {
  AdminCommand::Level level = AdminCommand::Level::kPlayer;
  AdminCommand::Frontend place = AdminCommand::Frontend::kChat;
  std::string name;      ///< shown in the log: `user 1000, process 4711`, `player "Ann" at 192.0.2.7:50312`
  std::string player{};  ///< name of the player, if called in the chat; empty: control socket
  std::uint64_t session = 0;  ///< session of the player, if called in the chat; 0: control socket
};

/// A player, with or without a connection.
struct AdminPlayer {
  std::uint64_t session = 0;  ///< id of the session, unique while the server runs
  std::uint32_t id = 0;       ///< player id, as shown to others
  std::string name;
  std::string address;                ///< "192.0.2.7:50312"
  std::chrono::seconds connected{0};  ///< time since they joined
  std::chrono::seconds idle{0};       ///< time since their last key, click or chat line
  std::uint32_t rtt_millis = 0;       ///< 0: not known yet
  bool detached = false;              ///< true if they lost the connection and may reconnect
  bool muted = false;
  bool admin = false;
  std::string room;  ///< name of their room; empty: the server has no named rooms
};

}  // namespace naiad
