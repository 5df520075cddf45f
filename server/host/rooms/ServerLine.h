// What a server itself says to a player.
#pragma once

#include <string>

#include "host/session/Session.h"

namespace naiad {

/// A line of the server's own in the chat of one player, cut to the length of one.
void sendServerLine(Session& session, const std::string& text);

}  // namespace naiad
