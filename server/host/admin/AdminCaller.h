// Who gives a command.
#pragma once

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

}  // namespace naiad
