// The caller of an admin command, and a player as commands report them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "shared/admin/AdminCommands.h"

namespace naiad {

/// Who gives a command.
struct AdminCaller {
  AdminCommand::Level level = AdminCommand::Level::kPlayer;
  AdminCommand::Place place = AdminCommand::Place::kChat;
  std::string name;           ///< for the log: `user 1000, process 4711`, `player "Ann" at 192.0.2.7:50312`
  std::string player{};       ///< of the chat: their name; empty: the server's console
  std::uint64_t session = 0;  ///< of the chat
};

/// A player, with or without a connection.
struct AdminPlayer {
  std::uint64_t session = 0;  ///< names the session for as long as the server runs
  std::uint32_t id = 0;       ///< of the player, as others see it
  std::string name;
  std::string address;                ///< "192.0.2.7:50312"
  std::chrono::seconds connected{0};  ///< since they joined
  std::chrono::seconds idle{0};       ///< since their last key, click or line
  std::uint32_t rtt_millis = 0;       ///< 0: not known yet
  bool detached = false;              ///< their connection broke, and they may come back
  bool muted = false;
  bool admin = false;
  std::string room;  ///< empty: the server has none
};

}  // namespace naiad
